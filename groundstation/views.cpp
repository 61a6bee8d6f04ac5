// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "skein/base/angles.hpp"
#include "skein/wording/wording.hpp"

namespace skein::groundstation {
namespace {

std::string health_of(const mission::FleetEntry& entry) {
  if (entry.duplicate) return "TWO VEHICLES WITH THIS ID";
  if (entry.revoked) return "REVOKED, is not heard any more";
  if (!entry.telemetry) return "never heard";
  std::string health;
  const auto add = [&health](const std::string& text) {
    health += (health.empty() ? "" : ", ") + text;
  };
  if (!entry.expected) add("not in the fleet");
  if (entry.silent) add("SILENT");
  if (entry.differs) add(mission::text_of(*entry.differs) + ", NOT WORKED WITH");
  const auto& telemetry = *entry.telemetry;
  if (telemetry.control_overruns > 0) {
    add(fmt::format("{} control overruns", telemetry.control_overruns));
  }
  if (telemetry.messages_dropped > 0) {
    add(fmt::format("{} messages dropped", telemetry.messages_dropped));
  }
  if (entry.health) {
    for (const std::string& problem : entry.health->problems) add(problem);
  }
  return health.empty() ? "good" : health;
}

bool can_be_decided(const mission::PendingAuthorisation& pending, Instant now) {
  return !pending.decision && now < pending.request.decide_by;
}

}  // namespace

std::string place_text(const Vec2& position, const MissionOrigin& origin) {
  const Wgs84 geodetic = origin.to_wgs84(Position<MissionEnu>{position.x(), position.y(), 0.0});
  const double distance_m = position.norm();
  const std::string from_origin =
      distance_m < 0.5
          ? "at the origin"
          : fmt::format("{:.0f} m from the origin towards {:03.0f} deg", distance_m,
                        compass_deg_from_heading(std::atan2(position.y(), position.x())));
  return fmt::format("{}, {:.6f} {} {:.6f} {}", from_origin, std::abs(geodetic.latitude_deg),
                     geodetic.latitude_deg < 0.0 ? "S" : "N", std::abs(geodetic.longitude_deg),
                     geodetic.longitude_deg < 0.0 ? "W" : "E");
}

std::string fleet_table(const std::map<VehicleId, mission::FleetEntry>& fleet, Instant now) {
  std::string text = fmt::format("{:>7}  {:<11}{:>9}{:>12}{:>7}  {}\n", "vehicle", "activity",
                                 "heard", "range left", "loads", "health");
  for (const auto& [vehicle, entry] : fleet) {
    auto line = std::back_inserter(text);
    if (entry.telemetry) {
      fmt::format_to(line, "{:>7}  {:<11}{:>7.1f} s{:>9.1f} km{:>7}  {}\n", vehicle.value,
                     to_string(entry.telemetry->activity), to_seconds(now - entry.heard_at),
                     entry.telemetry->range_left_m / 1000.0, entry.telemetry->loads,
                     health_of(entry));
    } else {
      fmt::format_to(line, "{:>7}  {:<11}{:>9}{:>12}{:>7}  {}\n", vehicle.value, "-", "-", "-", "-",
                     health_of(entry));
    }
  }
  return text;
}

std::string request_text(const mission::PendingAuthorisation& pending, const MissionOrigin& origin,
                         Instant now) {
  const auto& request = pending.request;
  std::string text = fmt::format(
      "--- Authorisation wanted: {} deliveries at site {} ---\n"
      "where   {}\n"
      "leader  {}, coalition {} round {}\n",
      request.deliveries.size(), request.site.value, place_text(request.site_position, origin),
      wording::text_of(request.round.coalition.leader), request.round.coalition.number,
      request.round.number);
  auto line = std::back_inserter(text);
  for (const auto& delivery : request.deliveries) {
    const auto& assignment = delivery.assignment;
    fmt::format_to(line, "        vehicle {:>3} at {:.1f} s, flying towards {:03.0f} deg\n",
                   assignment.vehicle.value, to_seconds(assignment.time),
                   compass_deg_from_heading(delivery.bearing_rad));
  }
  fmt::format_to(line,
                 "until   {:.1f} s, {:.0f} s from now; without a decision they hold and ask again\n"
                 "type    authorise {}    or    refuse {}\n",
                 to_seconds(request.decide_by), to_seconds(request.decide_by - now),
                 request.site.value, request.site.value);
  return text;
}

std::string pending_text(const std::vector<mission::PendingAuthorisation>& all,
                         const MissionOrigin& origin, Instant now) {
  std::string text;
  for (const auto& pending : all) {
    if (can_be_decided(pending, now)) text += request_text(pending, origin, now);
  }
  return text.empty() ? "nothing waits for a decision\n" : text;
}

std::string coalitions_text(const console::Picture& picture) {
  std::string text;
  auto line = std::back_inserter(text);
  for (const auto& [id, coalition] : picture.coalitions()) {
    fmt::format_to(line, "site {}: coalition {} of {}, {}{}\n", coalition.site.value, id.number,
                   wording::text_of(id.leader), to_string(coalition.state),
                   coalition.why == coalition::Why{} ? "" : ": " + wording::text_of(coalition.why));
    for (const auto& round : coalition.rounds) {
      fmt::format_to(line, "  round {}: {} tasks announced, {} bids", round.number,
                     round.announcement ? round.announcement->tasks.size() : 0, round.bids.size());
      for (const auto& bid : round.bids) fmt::format_to(line, " {}", bid.bidder.value);
      text += '\n';
      if (!round.award) continue;
      for (const auto& assignment : round.award->assignments) {
        fmt::format_to(line, "    {:.1f} s  vehicle {:>3}: {}\n", to_seconds(assignment.time),
                       assignment.vehicle.value, to_string(assignment.task));
      }
    }
  }
  return text.empty() ? "no coalition is known yet\n" : text;
}

std::string hazards_text(const console::Picture& picture) {
  std::string text;
  for (const auto& [id, hazard] : picture.hazards()) {
    fmt::format_to(std::back_inserter(text),
                   "hazard {}: {:.0f} m around {:.0f} east, {:.0f} north\n", id.value,
                   hazard.radius_m, hazard.centre.x(), hazard.centre.y());
  }
  return text.empty() ? "no hazard is known\n" : text;
}

std::string sites_text(const console::Picture& picture) {
  std::string text;
  for (const auto& [id, site] : picture.sites()) {
    std::array<std::size_t, 3> done{};
    for (const auto& [task, of] : site.tasks) {
      done.at(static_cast<std::size_t>(task.kind)) +=
          of.state == coalition::TaskState::done ? 1 : 0;
    }
    fmt::format_to(std::back_inserter(text), "site {}: {}, {}, {} delivered, {} assessed", id.value,
                   site.withdrawn  ? "withdrawn"
                   : site.leader   ? "led by " + wording::text_of(*site.leader)
                   : site.surveyor ? "told to " + wording::text_of(*site.surveyor)
                                   : "no leader yet",
                   site.surveyed ? "surveyed" : "not surveyed",
                   done[static_cast<std::size_t>(TaskKind::deliver)],
                   done[static_cast<std::size_t>(TaskKind::assess)]);
    if (site.news) {
      fmt::format_to(std::back_inserter(text), "; {:.1f} s {}", to_seconds(site.news->time),
                     wording::text_of(*site.news));
    }
    text += '\n';
  }
  return text.empty() ? "no site is known yet\n" : text;
}

}  // namespace skein::groundstation
