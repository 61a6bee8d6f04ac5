// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "skein/base/geometry.hpp"
#include "skein/base/time.hpp"

namespace skein::models {

struct WindParams {
  Vec2 steady_mps{0.0, 0.0};  ///< where the air moves to, not where it comes from; mission frame
  double gust_mps = 0.0;      ///< standard deviation per axis; 0 for none
  Duration gust_time = std::chrono::seconds{5};  ///< correlation time, > 0
  std::uint64_t seed = 1;                        ///< of the gusts
};

/// The velocity of the air: steady, and gusts of the first-order (Dryden longitudinal) spectrum
/// 2 sigma^2 T / (pi (1 + (T w)^2)), made of sines of equal energy with seeded phases (spectral
/// representation, Shinozuka 1972). A pure function of time: asked twice, it answers the same.
class Wind {
 public:
  explicit Wind(const WindParams& params);

  /// Mission frame (east, north), m/s. Allocates nothing. Cost: 32 sines, or none without gusts.
  [[nodiscard]] Vec2 velocity_at(Instant t) const;

 private:
  static constexpr std::size_t kSines = 16;
  struct Sine {
    double frequency_rad_per_s = 0.0;
    double phase_rad = 0.0;
  };
  Vec2 steady_mps_;
  double amplitude_mps_;
  std::array<std::array<Sine, kSines>, 2> gusts_{};
};

}  // namespace skein::models
