// SPDX-License-Identifier: Apache-2.0
#include "skein/routes/hazards.hpp"

#include "skein/base/assert.hpp"

namespace skein::routes {

std::string_view to_string(HazardKind kind) {
  switch (kind) {
    case HazardKind::detection:
      return "detection";
    case HazardKind::ramp:
      return "ramp";
    case HazardKind::keep_out:
      return "keep_out";
    case HazardKind::count:
      break;
  }
  SKEIN_ASSERT(false);
  return "";
}

double RouteHazard::value_at(const Vec2& point) const {
  const double d = (point - centre).norm();
  if (d >= radius_m) return 0.0;
  switch (kind) {
    case HazardKind::detection:
      return d <= inner_radius_m ? 1.0 : inner_radius_m / d;
    case HazardKind::ramp:
      return d <= inner_radius_m ? peak : peak * (radius_m - d) / (radius_m - inner_radius_m);
    default:
      return peak;
  }
}

}  // namespace skein::routes
