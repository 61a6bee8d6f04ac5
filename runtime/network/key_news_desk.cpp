// SPDX-License-Identifier: Apache-2.0
#include "key_news_desk.hpp"

#include <algorithm>
#include <utility>

namespace skein::network {
void KeyNewsDesk::tell(const std::vector<KeyNews>& all) {
  const std::lock_guard lock{mutex_};
  told_.clear();
  any_ = !all.empty();
  for (const KeyNews& one : all) {
    Told told{one.epoch, one.change};
    told.datagram.push_back(static_cast<std::uint8_t>(self_.value >> 8));
    told.datagram.push_back(static_cast<std::uint8_t>(self_.value & 0xFFU));
    told_.emplace(one.member, std::move(told));
  }
}

std::optional<std::vector<std::uint8_t>> KeyNewsDesk::due(VehicleId node, std::uint8_t its_epoch,
                                                          Instant now) {
  const std::lock_guard lock{mutex_};
  const auto known = told_.find(node);
  if (known == told_.end() || its_epoch >= known->second.epoch || now < known->second.next) {
    return std::nullopt;
  }
  known->second.next = now + kAgain;
  return known->second.datagram;
}

void KeyNewsDesk::hear(std::span<const std::uint8_t> datagram) {
  const auto change = datagram.first(datagram.size() - kNewsSenderBytes);
  const std::lock_guard lock{mutex_};
  const bool known = std::ranges::any_of(
      heard_, [change](const auto& waiting) { return std::ranges::equal(waiting, change); });
  if (known || heard_.size() >= kHeardMax) return;
  heard_.emplace_back(change.begin(), change.end());
}

std::optional<std::vector<std::uint8_t>> KeyNewsDesk::take() {
  const std::lock_guard lock{mutex_};
  if (heard_.empty()) return std::nullopt;
  auto first = std::move(heard_.front());
  heard_.pop_front();
  return first;
}

}  // namespace skein::network
