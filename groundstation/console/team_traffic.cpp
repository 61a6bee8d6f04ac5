// SPDX-License-Identifier: Apache-2.0
#include "skein/console/team_traffic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/codec/json_text.hpp"
#include "skein/wording/wording.hpp"

namespace skein::console {
namespace {

using codec::Json;

Json rounded(double value, double unit) {
  if (!std::isfinite(value)) return nullptr;
  return std::round(value / unit) * unit;
}

/// Where an aircraft is now, and whom of the team it is nearest to.
struct Placed {
  const TrafficPicture* shown;
  mission::Aircraft there;
  std::optional<mission::NearestMember> nearest;

  [[nodiscard]] double speed_mps() const { return std::hypot(there.east_mps, there.north_mps); }
  [[nodiscard]] double track_rad() const { return std::atan2(there.north_mps, there.east_mps); }
  [[nodiscard]] double distance_m() const {
    return nearest ? nearest->distance_m : there.position.norm();
  }
};

/// The nearest first.
std::vector<Placed> placed(const Picture& picture, const mission::Fleet& fleet, Instant now) {
  std::vector<Placed> all;
  for (const auto& [address, shown] : picture.traffic()) {
    const mission::Aircraft there = mission::carried_to(shown.seen.aircraft, now);
    all.push_back({&shown, there, mission::nearest_member(there, fleet, now)});
  }
  std::ranges::stable_sort(all, {}, &Placed::distance_m);
  return all;
}

Json aircraft_json(const Placed& placed, Instant now) {
  const auto& [shown, there, nearest] = placed;
  const mission::SeenAircraft& seen = shown->seen;
  Json warned = Json::array();
  for (const auto& [vehicle, gives_way] : shown->warned) {
    warned.push_back({{"vehicle", vehicle.value}, {"gives_way", gives_way}});
  }
  Json json{{"address", fmt::format("{:06x}", there.address)},
            {"callsign", seen.callsign},
            {"x", rounded(there.position.x(), 1.0)},
            {"y", rounded(there.position.y(), 1.0)},
            {"z", rounded(there.height_m, 1.0)},
            {"track_deg", rounded(compass_deg_from_heading(placed.track_rad()), 1.0)},
            {"speed_mps", rounded(placed.speed_mps(), 0.125)},
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

std::string heard_text(const Placed& placed, Instant now) {
  const mission::SeenAircraft& seen = placed.shown->seen;
  std::string text =
      fmt::format("{:06x} {:<8}", placed.there.address,
                  seen.callsign.empty() ? std::string_view{"-"} : std::string_view{seen.callsign});
  const auto line = std::back_inserter(text);
  if (seen.on_ground) {
    text += "on the ground";
  } else {
    fmt::format_to(line, "{:.0f} m above the origin", placed.there.height_m);
    if (placed.speed_mps() > 0.0) {
      fmt::format_to(line, ", {:.0f} m/s towards {}", placed.speed_mps(),
                     wording::bearing_text(placed.track_rad()));
    }
  }
  if (const auto& nearest = placed.nearest) {
    fmt::format_to(line, "; {:.0f} m from {}, {:.0f} m {} it", nearest->distance_m,
                   wording::text_of(nearest->vehicle), std::abs(nearest->above_m),
                   nearest->above_m < 0.0 ? "below" : "above");
    if (nearest->closest_in_s > 0.0) {
      fmt::format_to(line, ", nearest in {:.0f} s at {:.0f} m", nearest->closest_in_s,
                     nearest->closest_m);
    }
  } else {
    fmt::format_to(line, "; {} of the origin", wording::place_text(placed.there.position));
  }
  for (const auto& [vehicle, gives_way] : placed.shown->warned) {
    fmt::format_to(line, "; {} {}", wording::text_of(vehicle),
                   gives_way ? "gives way" : "has no room to give way");
  }
  fmt::format_to(line, "; heard {:.0f} s ago\n",
                 std::max(0.0, to_seconds(now - seen.aircraft.time)));
  return text;
}

}  // namespace

std::string traffic_json(const Picture& picture, const mission::Fleet& fleet, Instant now) {
  Json list = Json::array();
  for (const Placed& one : placed(picture, fleet, now)) list.push_back(aircraft_json(one, now));
  return codec::json_text(list);
}

std::string traffic_text(const Picture& picture, const mission::Fleet& fleet, Instant now) {
  std::string text;
  for (const Placed& one : placed(picture, fleet, now)) text += heard_text(one, now);
  return text.empty() ? "no aircraft is heard\n" : text;
}

}  // namespace skein::console
