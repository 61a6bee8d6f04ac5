// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/codec/json_text.hpp"
#include "skein/domain/vehicle.hpp"

/// What the formation desk says alike of multirotors and of planes.
namespace skein::groundstation {

/// ", one, other"
template <class T>
[[nodiscard]] std::string names_of(const std::map<std::string, T>& known) {
  std::string names;
  for (const auto& [name, what] : known) names.append(", ").append(name);
  return names;
}

/// What an order does, for the page; without its movers, who are {id, points}.
[[nodiscard]] inline codec::Json outcome_json(bool only_preview, std::string_view way,
                                              Duration duration, double separation_m,
                                              const std::vector<VehicleId>& lost) {
  codec::Json data{{"kind", only_preview ? "preview" : "begun"},
                   {"way", way},
                   {"duration_s", to_seconds(duration)},
                   {"least_separation_m", separation_m},
                   {"movers", codec::Json::array()},
                   {"lost", codec::Json::array()}};
  for (const VehicleId vehicle : lost) data["lost"].push_back(vehicle.value);
  return data;
}

[[nodiscard]] inline std::string places_header(std::string_view order) {
  return fmt::format("vehicle  heard     east    north   height  from its place  {}\n", order);
}

template <class Member>
[[nodiscard]] std::string place_line(VehicleId vehicle, const Member& member, double off_m,
                                     std::string_view activity, Instant now) {
  const auto& at = member.status.position_m;
  return fmt::format("{:>7}  {:>5.1f}  {:7.1f}  {:7.1f}  {:7.1f}  {:>12.2f} m  {}{}\n",
                     vehicle.value, to_seconds(now - member.heard_at), at.x(), at.y(), at.z(),
                     off_m, member.status.progress.change, member.lost ? ", silent" : activity);
}

}  // namespace skein::groundstation
