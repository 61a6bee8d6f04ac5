// SPDX-License-Identifier: Apache-2.0
#include "skein/models/wind.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"
#include "skein/base/random.hpp"

namespace skein::models {

Wind::Wind(const WindParams& params)
    : steady_mps_{params.steady_mps},
      amplitude_mps_{params.gust_mps * std::sqrt(2.0 / static_cast<double>(kSines))} {
  SKEIN_ASSERT(params.gust_mps >= 0.0);
  SKEIN_ASSERT(params.gust_time > Duration::zero());
  Random random{params.seed};
  const double time_s = to_seconds(params.gust_time);
  for (auto& axis : gusts_) {
    for (std::size_t k = 0; k < kSines; ++k) {
      // The inverse of the spectrum's energy distribution, (2/pi) atan(T w), at a random place of
      // each sixteenth: equal energies, and no common period.
      const double share =
          (static_cast<double>(k) + random.uniform()) / static_cast<double>(kSines);
      const double frequency = std::tan(share * kPi / 2.0) / time_s;
      axis[k] = {.frequency_rad_per_s = std::min(frequency, kTwoPi),
                 .phase_rad = random.uniform(0.0, kTwoPi)};
    }
  }
}

Vec2 Wind::velocity_at(Instant t) const {
  Vec2 velocity = steady_mps_;
  if (amplitude_mps_ <= 0.0) return velocity;
  const double seconds = to_seconds(t);
  for (std::size_t axis = 0; axis < gusts_.size(); ++axis) {
    double sum = 0.0;
    for (const Sine& sine : gusts_[axis]) {
      sum += std::sin(sine.frequency_rad_per_s * seconds + sine.phase_rad);
    }
    velocity[static_cast<Eigen::Index>(axis)] += amplitude_mps_ * sum;
  }
  return velocity;
}

}  // namespace skein::models
