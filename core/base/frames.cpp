// SPDX-License-Identifier: Apache-2.0
#include "skein/base/frames.hpp"

#include <GeographicLib/LocalCartesian.hpp>
#include <cmath>

namespace skein {
namespace {
GeographicLib::LocalCartesian plane_at(const Wgs84& origin) {
  return {origin.latitude_deg, origin.longitude_deg, origin.height_m};
}
}  // namespace

Result<MissionOrigin> MissionOrigin::make(const Wgs84& origin) {
  const bool finite = std::isfinite(origin.latitude_deg) && std::isfinite(origin.longitude_deg) &&
                      std::isfinite(origin.height_m);
  if (!finite || std::abs(origin.latitude_deg) > 90.0) {
    return Error{"the mission origin needs finite numbers and a latitude within [-90, 90] degrees"};
  }
  return MissionOrigin{origin};
}

Position<MissionEnu> MissionOrigin::to_enu(const Wgs84& geodetic) const {
  Eigen::Vector3d p;
  plane_at(origin_).Forward(geodetic.latitude_deg, geodetic.longitude_deg, geodetic.height_m, p.x(),
                            p.y(), p.z());
  return Position<MissionEnu>{p};
}

Wgs84 MissionOrigin::to_wgs84(const Position<MissionEnu>& position) const {
  Wgs84 g;
  plane_at(origin_).Reverse(position.x(), position.y(), position.z(), g.latitude_deg,
                            g.longitude_deg, g.height_m);
  return g;
}

}  // namespace skein
