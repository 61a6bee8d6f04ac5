// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/vehicle_text.hpp"

#include <fmt/format.h>

#include <map>

#include "skein/base/angles.hpp"
#include "skein/console/team_links.hpp"
#include "skein/console/team_wind.hpp"
#include "skein/groundstation/views.hpp"
#include "skein/wording/wording.hpp"

namespace skein::groundstation {
namespace {

void add(std::string& text, std::string_view name, const std::string& value) {
  text += fmt::format("{:<18} {}\n", name, value);
}

void add_telemetry(std::string& text, const mission::Telemetry& told) {
  const VehicleState& s = told.state;
  add(text, "place", fmt::format("E {:.0f} N {:.0f} m, height {:.0f} m", s.x_m, s.y_m, s.z_m));
  add(text, "heading, course",
      fmt::format("{} deg, {} deg", wording::bearing_digits(s.heading_rad),
                  wording::bearing_digits(s.course_rad)));
  add(text, "ground, air speed",
      fmt::format("{:.1f} m/s, {:.1f} m/s", s.groundspeed_mps, s.airspeed_mps));
  add(text, "plan", fmt::format("{}", told.plan_number));
}

void add_health(std::string& text, const mission::Health& health) {
  add(text, "program", health.program);
  add(text, "flight controller",
      health.flight_controller + (health.mode.empty() ? "" : ", " + health.mode));
}

}  // namespace

Answer vehicle_answer(VehicleId vehicle, const console::Picture& picture,
                      const mission::Fleet& fleet, const std::string& video, Instant now) {
  const auto known = fleet.vehicles().find(vehicle);
  if (known == fleet.vehicles().end()) {
    return {false, fmt::format("vehicle {} is not of this fleet\n", vehicle.value)};
  }
  const mission::FleetEntry& entry = known->second;
  std::string text = fleet_table({{vehicle, entry}}, now);
  if (entry.telemetry) add_telemetry(text, *entry.telemetry);
  if (entry.health) add_health(text, *entry.health);
  const auto wind = picture.wind().estimate(console::without_airspeed(fleet), now);
  if (wind && wind->vehicles.contains(vehicle)) {
    add(text, "wind that it has", console::words_of(wind->vehicles.at(vehicle)));
  }
  for (const auto& row : console::team_links(fleet, picture.receptions(), now)) {
    if (row.who == vehicle) text += console::links_text({row});
  }
  if (!video.empty()) add(text, "video", video);
  return {true, std::move(text)};
}

}  // namespace skein::groundstation
