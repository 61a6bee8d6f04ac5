// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>

#include "skein/base/time.hpp"

namespace skein::mission {

inline constexpr std::uint16_t kFirstOperatorNumber = 10'000;

/// The number of a site or hazard that the operator adds: none that is taken, which it joins. It is
/// kFirstOperatorNumber and the mission second, or more: so not one that this process gave before
/// it was started anew, which vehicles would take for the old one.
template <class Number>
[[nodiscard]] Number new_number(std::set<Number>& taken, Instant now) {
  constexpr std::int64_t kLast = std::numeric_limits<std::uint16_t>::max();
  const auto second = static_cast<std::int64_t>(to_seconds(std::max(now, Instant{})));
  std::int64_t number = std::min<std::int64_t>(kFirstOperatorNumber + second, kLast);
  // Down from the last one where the mission is that long.
  const int step = number == kLast ? -1 : 1;
  while (!taken.insert(Number{static_cast<std::uint16_t>(number)}).second) number += step;
  return Number{static_cast<std::uint16_t>(number)};
}

}  // namespace skein::mission
