// SPDX-License-Identifier: Apache-2.0
#include "skein/models/dryden_gusts.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/assert.hpp"

namespace skein::models {
namespace {

constexpr double kFoot_m = 0.3048;

/// One step of the double pole x'' + 2 x' + x = noise (time in units of T), in coordinates whose
/// stationary covariance is the identity: its transition is e^-d [1+d, d; -d, 1-d], and the noise
/// of a step has what the transition leaves to the identity.
void step_double_pole(Eigen::Vector2d& z, double d, Random& random) {
  const double decay = std::exp(-d);
  Eigen::Matrix2d transition;
  transition << 1.0 + d, d, -d, 1.0 - d;
  transition *= decay;
  const Eigen::Matrix2d noise = Eigen::Matrix2d::Identity() - transition * transition.transpose();
  // Cholesky; rounding may leave tiny negative numbers for steps of next to nothing.
  const double l22 = std::sqrt(std::max(0.0, noise(1, 1)));
  const double l12 = l22 > 0.0 ? noise(0, 1) / l22 : 0.0;
  const double l11 = std::sqrt(std::max(0.0, noise(0, 0) - l12 * l12));
  const double first = random.normal(0.0, 1.0);
  const double second = random.normal(0.0, 1.0);
  z = transition * z + Eigen::Vector2d{l11 * first + l12 * second, l22 * second};
}

/// The numerator 1 + sqrt(3) T s over the double pole, scaled to the variance 1.
double shaped(const Eigen::Vector2d& z) { return 0.5 * (z.x() + std::sqrt(3.0) * z.y()); }

}  // namespace

GustScales gust_scales(double height_above_ground_m, double wind_at_6m_mps) {
  const double vertical_mps = 0.1 * wind_at_6m_mps;
  const double height_ft = std::max(height_above_ground_m / kFoot_m, 10.0);
  const double low_ft = std::min(height_ft, 1000.0);
  const double slope = 0.177 + 0.000823 * low_ft;
  GustScales scales{.length_along_m = kFoot_m * low_ft / std::pow(slope, 1.2),
                    .length_vertical_m = kFoot_m * low_ft,
                    .along_mps = vertical_mps / std::pow(slope, 0.4),
                    .vertical_mps = vertical_mps};
  const double share = std::clamp((height_ft - 1000.0) / 1000.0, 0.0, 1.0);
  constexpr double kHigh_m = 1750.0 * kFoot_m;
  scales.length_along_m += share * (kHigh_m - scales.length_along_m);
  scales.length_vertical_m += share * (kHigh_m - scales.length_vertical_m);
  scales.along_mps += share * (vertical_mps - scales.along_mps);
  return scales;
}

DrydenGusts::DrydenGusts(double wind_at_6m_mps, std::uint64_t seed)
    : wind_at_6m_mps_{wind_at_6m_mps}, random_{seed} {
  SKEIN_ASSERT(wind_at_6m_mps >= 0.0);
  along_ = random_.normal(0.0, 1.0);
  for (auto* z : {&across_, &vertical_}) {
    z->x() = random_.normal(0.0, 1.0);
    z->y() = random_.normal(0.0, 1.0);
  }
}

Vec3 DrydenGusts::step(double seconds, double airspeed_mps, double height_above_ground_m) {
  const GustScales scales = gust_scales(height_above_ground_m, wind_at_6m_mps_);
  const double travelled_m = seconds * std::max(airspeed_mps, 1.0);
  const double d = travelled_m / scales.length_along_m;
  const double decay = std::exp(-d);
  along_ = decay * along_ + std::sqrt(-std::expm1(-2.0 * d)) * random_.normal(0.0, 1.0);
  step_double_pole(across_, d, random_);
  step_double_pole(vertical_, travelled_m / scales.length_vertical_m, random_);
  gust_mps_ = {scales.along_mps * along_, scales.along_mps * shaped(across_),
               scales.vertical_mps * shaped(vertical_)};
  return gust_mps_;
}

Vec3 DrydenGusts::velocity_ned_mps(double yaw_rad) const {
  const double c = std::cos(yaw_rad);
  const double s = std::sin(yaw_rad);
  return {c * gust_mps_.x() - s * gust_mps_.y(), s * gust_mps_.x() + c * gust_mps_.y(),
          gust_mps_.z()};
}

}  // namespace skein::models
