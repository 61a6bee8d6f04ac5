// SPDX-License-Identifier: Apache-2.0
#include "earth.hpp"

#include <cmath>
#include <cstdlib>

namespace skein::hil {
namespace {

constexpr double kEarthRadius_m = 6371000.0;
constexpr std::int32_t kLatitudeMax_e7 = 900'000'000;
constexpr std::int32_t kLongitudeMax_e7 = 1'800'000'000;

}  // namespace

GlobalPosition Earth::global(const Vec3& ned) const {
  // The tangent plane rises over the curved earth: go down to where the height is that asked for.
  const double rise = ned.head<2>().squaredNorm() / (2.0 * kEarthRadius_m);
  const Wgs84 place =
      origin_.to_wgs84(Position<MissionEnu>{enu_from_ned(ned + Vec3{0.0, 0.0, rise})});
  return {.latitude_e7 = static_cast<std::int32_t>(std::lround(place.latitude_deg * 1e7)),
          .longitude_e7 = static_cast<std::int32_t>(std::lround(place.longitude_deg * 1e7)),
          .height_m = origin_height_m() - ned.z()};
}

std::optional<Vec3> Earth::ned(const GlobalPosition& place) const {
  if (std::abs(place.latitude_e7) > kLatitudeMax_e7 ||
      std::abs(static_cast<std::int64_t>(place.longitude_e7)) > kLongitudeMax_e7 ||
      !std::isfinite(place.height_m)) {
    return std::nullopt;
  }
  const auto enu =
      origin_.to_enu({place.latitude_e7 * 1e-7, place.longitude_e7 * 1e-7, place.height_m});
  Vec3 ned = ned_from_enu(enu.metres());
  ned.z() = origin_height_m() - place.height_m;
  return ned;
}

}  // namespace skein::hil
