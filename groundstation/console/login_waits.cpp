// SPDX-License-Identifier: Apache-2.0
#include "login_waits.hpp"

#include <algorithm>

namespace skein::console {

LoginWaits::Time LoginWaits::Entry::until() const {
  const int doublings = wrong - kFree - 1;
  if (doublings < 0) return last;
  // 64 s is more than the longest.
  return last + std::min(kMax, std::chrono::seconds{1L << std::min(doublings, 6)});
}

std::optional<std::chrono::seconds> LoginWaits::wait(const std::string& address, Time now) const {
  const auto entry = known_.find(address);
  if (entry == known_.end() || now >= entry->second.until()) return std::nullopt;
  return std::chrono::ceil<std::chrono::seconds>(entry->second.until() - now);
}

int LoginWaits::wrong(const std::string& address, Time now) {
  std::erase_if(known_, [now](const auto& e) { return now - e.second.last >= kForgotten; });
  if (known_.size() >= kAddressesMax && !known_.contains(address)) {
    known_.erase(
        std::ranges::min_element(known_, {}, [](const auto& entry) { return entry.second.last; }));
  }
  Entry& entry = known_[address];
  entry.last = now;
  return ++entry.wrong;
}

}  // namespace skein::console
