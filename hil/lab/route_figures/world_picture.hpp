// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/routes/hazards.hpp"

namespace skein::route_figures {

struct Curve {
  std::string name;          ///< in the legend
  std::vector<Vec2> points;  ///< as flown, mission frame
  std::vector<Vec2> marks;   ///< waypoints; may be empty
};

/// Curves over the hazards of a square world from 0 to `side_m`, of which they may lead out, north
/// up, as an SVG file of the looks of the plots. Hazards lie darker the more they cost: keep-outs
/// are grey, detections and ramps amber with the radius within which they cost most.
[[nodiscard]] std::string world_svg(const std::string& title, double side_m,
                                    const std::vector<routes::RouteHazard>& hazards,
                                    const std::vector<Curve>& curves, const Vec2& site);

}  // namespace skein::route_figures
