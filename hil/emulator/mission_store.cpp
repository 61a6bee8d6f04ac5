// SPDX-License-Identifier: Apache-2.0
#include "mission_store.hpp"

#include <utility>

namespace skein::hil {
namespace {

constexpr Duration kAskAgain = std::chrono::seconds{1};
constexpr std::size_t kItemsMax = 128;

mavlink::MissionAck ack(mavlink::MissionResult result) {
  mavlink::MissionAck said;
  said.type = static_cast<std::uint8_t>(result);
  return said;
}

}  // namespace

bool MissionStore::on_packet(const mavlink::Packet& packet, Vehicle& vehicle, Instant now) {
  if (const auto count = mavlink::decode<mavlink::MissionCount>(packet)) {
    if (count->mission_type != 0) {
      answer(ack(mavlink::MissionResult::unsupported));
    } else if (count->count == 0 || count->count > kItemsMax) {
      answer(ack(mavlink::MissionResult::no_space));
    } else {
      taken_.clear();
      awaited_ = count->count;
      ask_at_ = now;
    }
  } else if (const auto item = mavlink::decode<mavlink::MissionItemInt>(packet)) {
    receive(*item, vehicle, now);
  } else if (mavlink::decode<mavlink::MissionRequestList>(packet)) {
    answer(mavlink::MissionCount{.count = static_cast<std::uint16_t>(items_.size())});
  } else if (const auto asked = mavlink::decode<mavlink::MissionRequestInt>(packet)) {
    if (asked->seq < items_.size()) {
      answer(items_[asked->seq]);
    } else {
      answer(ack(mavlink::MissionResult::invalid_sequence));
    }
  } else {
    return mavlink::decode<mavlink::MissionAck>(packet).has_value();
  }
  return true;
}

void MissionStore::receive(const mavlink::MissionItemInt& item, Vehicle& vehicle, Instant now) {
  if (awaited_ == 0 || item.seq != taken_.size()) return;
  taken_.push_back(item);
  ask_at_ = now;
  if (taken_.size() < awaited_) return;
  awaited_ = 0;
  const mavlink::MissionResult result = vehicle.load_mission(taken_);
  if (result == mavlink::MissionResult::accepted) items_ = std::exchange(taken_, {});
  answer(ack(result));
}

std::optional<MissionStore::Answer> MissionStore::poll(Instant now) {
  if (awaited_ != 0 && now >= ask_at_) {
    ask_at_ = now + kAskAgain;
    return mavlink::MissionRequest{.seq = static_cast<std::uint16_t>(taken_.size())};
  }
  if (answers_.empty()) return std::nullopt;
  const Answer first = answers_.front();
  answers_.erase(answers_.begin());
  return first;
}

}  // namespace skein::hil
