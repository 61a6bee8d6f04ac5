// SPDX-License-Identifier: Apache-2.0
#include "mission_store.hpp"

namespace skein::hil {
namespace {

constexpr Duration kAskAgain = std::chrono::seconds{1};
constexpr std::size_t kItemsMax = 128;

}  // namespace

mavlink::MissionAck MissionStore::ack(mavlink::MissionResult result) const {
  mavlink::MissionAck said;
  said.type = static_cast<std::uint8_t>(result);
  said.mission_type = type_;
  return said;
}

bool MissionStore::on_packet(const mavlink::Packet& packet, Instant now) {
  if (const auto count = mavlink::decode<mavlink::MissionCount>(packet)) {
    if (count->mission_type != type_) return false;
    on_count(*count, now);
  } else if (const auto item = mavlink::decode<mavlink::MissionItemInt>(packet)) {
    if (item->mission_type != type_) return false;
    receive(*item, now);
  } else if (const auto list = mavlink::decode<mavlink::MissionRequestList>(packet)) {
    if (list->mission_type != type_) return false;
    answer(mavlink::MissionCount{.count = static_cast<std::uint16_t>(items_.size()),
                                 .mission_type = type_});
  } else if (const auto asked = mavlink::decode<mavlink::MissionRequestInt>(packet)) {
    if (asked->mission_type != type_) return false;
    if (asked->seq < items_.size()) {
      answer(items_[asked->seq]);
    } else {
      answer(ack(mavlink::MissionResult::invalid_sequence));
    }
  } else {
    const auto taken = mavlink::decode<mavlink::MissionAck>(packet);
    return taken && taken->mission_type == type_;
  }
  return true;
}

void MissionStore::on_count(const mavlink::MissionCount& count, Instant now) {
  if (count.count == 0 || count.count > kItemsMax) {
    return answer(ack(mavlink::MissionResult::no_space));
  }
  taken_.clear();
  awaited_ = count.count;
  ask_at_ = now;
}

void MissionStore::receive(const mavlink::MissionItemInt& item, Instant now) {
  if (awaited_ == 0 || item.seq != taken_.size()) return;
  taken_.push_back(item);
  ask_at_ = now;
  if (taken_.size() < awaited_) return;
  awaited_ = 0;
  const mavlink::MissionResult result = load_(taken_);
  if (result == mavlink::MissionResult::accepted) items_ = std::exchange(taken_, {});
  answer(ack(result));
}

std::optional<MissionStore::Answer> MissionStore::poll(Instant now) {
  if (awaited_ != 0 && now >= ask_at_) {
    ask_at_ = now + kAskAgain;
    return mavlink::MissionRequest{.seq = static_cast<std::uint16_t>(taken_.size()),
                                   .mission_type = type_};
  }
  if (answers_.empty()) return std::nullopt;
  const Answer first = answers_.front();
  answers_.erase(answers_.begin());
  return first;
}

}  // namespace skein::hil
