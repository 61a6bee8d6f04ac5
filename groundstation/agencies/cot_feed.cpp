// SPDX-License-Identifier: Apache-2.0
#include "skein/agencies/cot_feed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "skein/base/angles.hpp"

namespace skein::agencies {
namespace {

constexpr const char* kPlane = "a-f-A-M-F-Q";   // friend, air, fixed wing, unmanned
constexpr const char* kCopter = "a-f-A-M-H-Q";  // the same, of rotary wing
constexpr const char* kMarker = "b-m-p-s-m";    // a spot on the map
constexpr const char* kCircle = "u-d-c-c";
constexpr const char* kPolyline = "u-d-f";
constexpr const char* kByNavigation = "m-g";
constexpr const char* kByMachine = "m-f";
constexpr const char* kByPeople = "h-e";

constexpr std::uint32_t kYellow = 0xFFFFFF00;
constexpr std::uint32_t kGreen = 0xFF00C000;
constexpr std::uint32_t kRed = 0xFFFF0000;
constexpr std::uint32_t kCyan = 0xFF00FFFF;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

std::string remarks_of(const ShownVehicle& vehicle) {
  std::string text = fmt::format("{}, {:.1f} km left, {} loads", to_string(vehicle.activity),
                                 vehicle.range_left_m / 1000.0, vehicle.loads);
  if (vehicle.state.battery_percent <= kBatteryFull_percent) {
    text += fmt::format(", battery {} %", vehicle.state.battery_percent);
  }
  for (const std::string& problem : vehicle.problems) text += "; " + problem;
  return text;
}

/// But for its times.
bool same_content(CotEvent a, const CotEvent& b) {
  a.time_unix_ns = b.time_unix_ns;
  a.stale_unix_ns = b.stale_unix_ns;
  return a == b;
}

/// It begins now, and tells for that long.
CotEvent event_from(std::int64_t unix_ns) {
  CotEvent event;
  event.time_unix_ns = unix_ns;
  event.stale_unix_ns = unix_ns + CotFeed::kOtherStale.count();
  return event;
}

}  // namespace

CotFeed::CotFeed(std::string team, std::int64_t epoch_unix_ns)
    : team_{std::move(team)}, prefix_{team_ + "-"}, mission_{epoch_unix_ns / kSecond_ns} {}

std::string CotFeed::uid_of(const char* what, std::uint32_t number, bool of_mission) const {
  return of_mission ? fmt::format("{}{}-{}-{}", prefix_, what, mission_, number)
                    : fmt::format("{}{}-{}", prefix_, what, number);
}

CotEvent CotFeed::event_of(const ShownVehicle& vehicle, Instant now, std::int64_t unix_ns) const {
  const VehicleState& state = vehicle.state;
  CotEvent event;
  event.uid = uid_of("vehicle", vehicle.id.value, false);
  event.type = vehicle.copter ? kCopter : kPlane;
  event.how = kByNavigation;
  // Its own time of measurement, so that others can tell how old it is.
  event.time_unix_ns = unix_ns - (now - state.time).count();
  event.stale_unix_ns = event.time_unix_ns + kVehicleStale.count();
  event.place = vehicle.place;
  event.callsign = fmt::format("{}-{}", team_, vehicle.id.value);
  event.remarks = remarks_of(vehicle);
  event.track = {compass_deg_from_heading(state.course_rad), state.groundspeed_mps};
  if (state.battery_percent <= kBatteryFull_percent) event.battery_percent = state.battery_percent;
  return event;
}

CotEvent CotFeed::event_of(const ShownSite& site, std::int64_t unix_ns) const {
  CotEvent event = event_from(unix_ns);
  event.uid = uid_of("site", site.id.value, true);
  event.type = kMarker;
  event.how = kByMachine;
  event.place = site.place;
  event.callsign = fmt::format("{} site {}", team_, site.id.value);
  event.remarks = site.state;
  event.colour_argb = site.done ? kGreen : kYellow;
  return event;
}

CotEvent CotFeed::event_of(const ShownHazard& hazard, std::int64_t unix_ns) const {
  CotEvent event = event_from(unix_ns);
  event.uid = uid_of("hazard", hazard.id.value, true);
  event.type = kCircle;
  event.how = kByPeople;
  event.place = hazard.centre;
  event.callsign = fmt::format("{} hazard {}", team_, hazard.id.value);
  event.remarks = fmt::format("no vehicle of the team enters it, {:.0f} m around", hazard.radius_m);
  event.radius_m = hazard.radius_m;
  event.colour_argb = kRed;
  return event;
}

CotEvent CotFeed::event_of(const ShownTrack& track, std::int64_t unix_ns) const {
  CotEvent event = event_from(unix_ns);
  event.uid = uid_of("track", track.vehicle.value, false);
  event.type = kPolyline;
  event.how = kByMachine;
  event.place = track.points.front();
  event.callsign = fmt::format("{}-{} track", team_, track.vehicle.value);
  event.remarks = "planned; it may change at any time";
  event.line = track.points;
  event.colour_argb = kCyan;
  return event;
}

std::vector<CotEvent> CotFeed::update(const Shown& shown, Instant now, std::int64_t unix_ns) {
  std::vector<CotEvent> due;
  for (auto& [uid, said] : said_) said.shown = false;
  for (const auto& vehicle : shown.vehicles) {
    take_vehicle(event_of(vehicle, now, unix_ns), vehicle.state.time, now, due);
  }
  for (const auto& site : shown.sites) take_other(event_of(site, unix_ns), now, due);
  for (const auto& hazard : shown.hazards) take_other(event_of(hazard, unix_ns), now, due);
  for (const auto& track : shown.tracks) take_other(event_of(track, unix_ns), now, due);
  end_others(now, unix_ns, due);
  return due;
}

void CotFeed::say(Said& said, CotEvent event, Instant now, std::vector<CotEvent>& due) const {
  said.at = now;
  said.event = std::move(event);
  due.push_back(said.event);
}

std::pair<CotFeed::Said&, bool> CotFeed::shown_again(const std::string& uid) {
  const auto [known, is_new] = said_.try_emplace(uid);
  Said& said = known->second;
  said.shown = true;
  const bool was_ended = std::exchange(said.endings, 0) > 0;
  return {said, is_new || was_ended};
}

void CotFeed::take_vehicle(CotEvent event, Instant measured, Instant now,
                           std::vector<CotEvent>& due) {
  const auto [said, at_once] = shown_again(event.uid);
  // One that has been there for a while waits for the next one, which is younger.
  const bool has_come = measured > said.measured;
  said.measured = std::max(said.measured, measured);
  if (at_once || (has_come && now - said.at >= kVehiclePeriod)) {
    say(said, std::move(event), now, due);
  }
}

void CotFeed::take_other(CotEvent event, Instant now, std::vector<CotEvent>& due) {
  const auto [said, at_once] = shown_again(event.uid);
  const Duration since = now - said.at;
  const bool changed = since >= kChangePeriod && !same_content(event, said.event);
  if (at_once || changed || since >= kOtherPeriod) {
    say(said, std::move(event), now, due);
  }
}

void CotFeed::end_others(Instant now, std::int64_t unix_ns, std::vector<CotEvent>& due) {
  for (auto known = said_.begin(); known != said_.end();) {
    Said& said = known->second;
    const bool waits = said.endings > 0 && now - said.at < kChangePeriod;
    if (said.shown || waits) {
      ++known;
      continue;
    }
    if (said.endings == kEndings) {
      known = said_.erase(known);
      continue;
    }
    ++said.endings;
    CotEvent event = said.event;
    event.time_unix_ns = event.stale_unix_ns = unix_ns;
    say(said, std::move(event), now, due);
    ++known;
  }
}

}  // namespace skein::agencies
