// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

#include "skein/base/geometry.hpp"
#include "skein/base/time.hpp"

namespace skein::ardupilot {

/// The wind as the mean of what velocity over the ground, nose and airspeed say of it: over all
/// that was flown until that is `kMemory`, then over about so long. A nose that swings, and one
/// that stands out of the turn, are no wind.
class WindEstimate {
 public:
  /// At a time that is not later than the last one it does nothing.
  void on_measurement(Instant measured, const Vec2& wind_mps) {
    if (!last_) {
      last_ = measured;
      mean_mps_ = wind_mps;
      return;
    }
    const Duration since = std::min<Duration>(measured - *last_, kGapMost);
    if (since <= Duration{}) return;
    last_ = measured;
    seen_ = std::min<Duration>(seen_ + since, kMemory);
    mean_mps_ += to_seconds(since) / to_seconds(seen_) * (wind_mps - mean_mps_);
  }
  /// Nothing before the first measurement.
  [[nodiscard]] std::optional<Vec2> mean_mps() const {
    return last_ ? std::optional{mean_mps_} : std::nullopt;
  }

  static constexpr Duration kMemory = std::chrono::seconds{20};
  static constexpr Duration kGapMost = std::chrono::seconds{1};

 private:
  std::optional<Instant> last_;
  Duration seen_{};
  Vec2 mean_mps_{0.0, 0.0};
};

}  // namespace skein::ardupilot
