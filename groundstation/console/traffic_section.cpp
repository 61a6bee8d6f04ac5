// SPDX-License-Identifier: Apache-2.0
#include "traffic_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/codec/json_text.hpp"

namespace skein::console {
namespace {

using codec::Json;

Json rounded(double value, double unit) {
  if (!std::isfinite(value)) return nullptr;
  return std::round(value / unit) * unit;
}

Json aircraft_json(const TrafficPicture& shown, const mission::Aircraft& there,
                   const std::optional<mission::NearestMember>& nearest, Instant now) {
  const mission::SeenAircraft& seen = shown.seen;
  Json warned = Json::array();
  for (const auto& [vehicle, gives_way] : shown.warned) {
    warned.push_back({{"vehicle", vehicle.value}, {"gives_way", gives_way}});
  }
  const double speed_mps = std::hypot(there.east_mps, there.north_mps);
  const double track_rad = std::atan2(there.north_mps, there.east_mps);
  Json json{{"address", fmt::format("{:06x}", there.address)},
            {"callsign", seen.callsign},
            {"x", rounded(there.position.x(), 1.0)},
            {"y", rounded(there.position.y(), 1.0)},
            {"z", rounded(there.height_m, 1.0)},
            {"track_deg", rounded(compass_deg_from_heading(track_rad), 1.0)},
            {"speed_mps", rounded(speed_mps, 0.125)},
            {"climb_mps", rounded(there.climb_mps, 0.125)},
            {"age_s", rounded(std::max(0.0, to_seconds(now - seen.aircraft.time)), 0.125)},
            {"barometric", seen.barometric},
            {"on_ground", seen.on_ground},
            {"warned", std::move(warned)},
            {"nearest", nullptr}};
  if (nearest) {
    json["nearest"] = {{"vehicle", nearest->vehicle.value},
                       {"distance_m", rounded(nearest->distance_m, 1.0)},
                       {"above_m", rounded(nearest->above_m, 1.0)},
                       {"closest_m", rounded(nearest->closest_m, 1.0)},
                       {"closest_in_s", rounded(nearest->closest_in_s, 1.0)}};
  }
  return json;
}

}  // namespace

std::string traffic_json(const Picture& picture, const mission::Fleet& fleet, Instant now) {
  std::vector<std::pair<double, Json>> all;
  for (const auto& [address, shown] : picture.traffic()) {
    const mission::Aircraft there = mission::carried_to(shown.seen.aircraft, now);
    const auto nearest = mission::nearest_member(there, fleet, now);
    const double distance_m = nearest ? nearest->distance_m : there.position.norm();
    all.emplace_back(distance_m, aircraft_json(shown, there, nearest, now));
  }
  std::ranges::stable_sort(all, {}, &std::pair<double, Json>::first);
  Json list = Json::array();
  for (auto& [distance_m, json] : all) list.push_back(std::move(json));
  return codec::json_text(list);
}

}  // namespace skein::console
