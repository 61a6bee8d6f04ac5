// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/radio/radio_model.hpp"

#include <algorithm>

namespace skein::hil::radio {
namespace {

std::size_t group_of(VehicleId node, const std::vector<std::vector<VehicleId>>& groups) {
  const auto has = [node](const auto& g) { return std::find(g.begin(), g.end(), node) != g.end(); };
  return static_cast<std::size_t>(std::find_if(groups.begin(), groups.end(), has) - groups.begin());
}

}  // namespace

Link link_between(const RadioParams& params, VehicleId from, VehicleId to,
                  const std::map<VehicleId, Vec2>& positions,
                  const std::vector<std::vector<VehicleId>>& groups) {
  Link link{true, params.loss, params.delay, params.jitter};
  const auto place = [&](VehicleId node) -> const Vec2* {
    static const Vec2 origin{0.0, 0.0};
    if (node == kGroundStation) return &origin;
    const auto it = positions.find(node);
    return it == positions.end() ? nullptr : &it->second;
  };
  const bool ground = from == kGroundStation || to == kGroundStation;
  const Vec2* a = place(from);
  const Vec2* b = place(to);
  if (a != nullptr && b != nullptr) {
    link.up = (*a - *b).norm() <= (ground ? params.ground_range_m : params.range_m);
  } else {
    link.up = ground;
  }
  link.up = link.up && group_of(from, groups) == group_of(to, groups);
  return link;
}

}  // namespace skein::hil::radio
