// SPDX-License-Identifier: Apache-2.0
#include "fence_keeper.hpp"

#include <utility>

namespace skein::hil {

mavlink::MissionResult FenceKeeper::load(std::span<const mavlink::MissionItemInt> items,
                                         const Earth& earth) {
  std::vector<Vec2> corners;
  for (const mavlink::MissionItemInt& item : items) {
    const auto vertex = mavlink::Command::nav_fence_polygon_vertex_inclusion;
    if (item.command != static_cast<std::uint16_t>(vertex)) {
      return mavlink::MissionResult::unsupported;
    }
    const auto place = earth.ned({item.x, item.y, earth.origin_height_m()});
    if (!place || item.param1 != static_cast<float>(items.size())) {
      return mavlink::MissionResult::invalid;
    }
    corners.emplace_back(place->y(), place->x());
  }
  if (corners.size() < 3) return mavlink::MissionResult::invalid;
  fence_.corners = std::move(corners);
  return mavlink::MissionResult::accepted;
}

std::optional<std::string_view> FenceKeeper::news(const FlightReport& report) {
  if (!enabled() || !report.armed || !report.flying) {
    breached_ = false;
    return std::nullopt;
  }
  const Vec3& at = report.estimate.position_m;  // NED
  const bool aside = fence_.exists() && fence_.inside_m({at.y(), at.x()}) < 0.0;
  const bool above = report.home_m.z() - at.z() > fence_.height_max_m;
  const bool was = std::exchange(breached_, aside || above);
  if (was || !breached_) return std::nullopt;
  return aside ? "Polygon fence breached" : "Max Alt fence breached";
}

}  // namespace skein::hil
