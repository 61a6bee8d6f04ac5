// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "skein/base/geometry.hpp"
#include "skein/base/ids.hpp"

namespace skein::routes {

/// What being near a hazard costs (Wu 2022, eq. 2-4).
enum class HazardKind : std::uint8_t {
  detection,  ///< 0 outside the radius; K / d between K and the radius; 1 within K (eq. 2)
  ramp,       ///< 0 outside the radius; rises linearly to `peak` at the inner radius (eq. 3)
  keep_out,   ///< never to be entered; where a cost alone is asked for, `peak` inside (eq. 4)
  count
};
[[nodiscard]] std::string_view to_string(HazardKind kind);

/// A round hazard known before the mission. Mission frame, metres.
struct RouteHazard {
  HazardId id{};
  HazardKind kind = HazardKind::keep_out;
  Vec2 centre{0.0, 0.0};
  double radius_m = 0.0;        ///< R, of a ramp R_max; > 0
  double inner_radius_m = 0.0;  ///< K of a detection, R_min of a ramp; 0 <= inner < radius
  double peak = 1.0;            ///< w_max of a ramp; detections always have 1, as printed

  [[nodiscard]] double value_at(const Vec2& point) const;
};

}  // namespace skein::routes
