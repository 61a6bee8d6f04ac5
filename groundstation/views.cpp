// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/views.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "skein/base/angles.hpp"
#include "skein/mission/shown_state.hpp"
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

std::string state_of(const mission::FleetEntry& entry) {
  if (entry.silent) return words_of(mission::ShownState::silent);
  return words_of(mission::shown_state(entry)) +
         (mission::keeps_clear_besides(entry) ? ", keeps clear" : "");
}

/// That it has by its own word; a dash also where an older release does not say.
std::string task_of(const mission::Telemetry& telemetry) {
  return telemetry.task.site == SiteId{} ? "-" : to_string(telemetry.task);
}

bool can_be_decided(const mission::PendingAuthorisation& pending, Instant now) {
  return !pending.decision && now < pending.request.decide_by;
}

/// "2 of 3 deliveries"
std::string count_text(std::size_t asked, std::size_t missing) {
  const char* noun = asked + missing == 1 ? "delivery" : "deliveries";
  return missing == 0 ? fmt::format("{} {}", asked, noun)
                      : fmt::format("{} of {} {}", asked, asked + missing, noun);
}

void add_marks(std::string& text, std::string_view of, const std::vector<console::Mark>& marks) {
  for (const console::Mark& mark : marks) {
    fmt::format_to(std::back_inserter(text), "        {} {}: {}\n",
                   mark.alarm ? "ATTENTION," : "note,", of, mark.text);
  }
}

struct Share {
  std::size_t done = 0;
  std::size_t of = 0;
};

std::string sites_summary(const console::Picture& picture) {
  Share sites;
  std::array<Share, 3> tasks;
  std::string apart;
  for (const auto& [id, site] : picture.sites()) {
    if (site.withdrawn || site.refused) {
      apart += fmt::format("site {} was {} by the operator\n", id.value,
                           site.taken_back  ? "authorised, and that taken back,"
                           : site.withdrawn ? "withdrawn"
                                            : "refused");
    } else {
      ++sites.of;
      sites.done += site.done ? 1 : 0;
    }
    if (!site.site) continue;
    const bool closed = site.withdrawn || site.refused;
    for (const TaskId& task : tasks_after_survey(*site.site)) {
      Share& share = tasks.at(static_cast<std::size_t>(task.kind));
      const auto known = site.tasks.find(task);
      const bool done =
          known != site.tasks.end() && known->second.state == coalition::TaskState::done;
      // Of a site that was closed what was flown before it was counts.
      share.of += done || !closed ? 1 : 0;
      share.done += done ? 1 : 0;
    }
  }
  if (sites.of == 0 && apart.empty()) return "";
  const Share& deliveries = tasks[static_cast<std::size_t>(TaskKind::deliver)];
  const Share& assessments = tasks[static_cast<std::size_t>(TaskKind::assess)];
  return fmt::format("{} of {} sites done, {} of {} deliveries flown, {} of {} assessments\n",
                     sites.done, sites.of, deliveries.done, deliveries.of, assessments.done,
                     assessments.of) +
         apart;
}

bool is_on_ground(const mission::Telemetry& told) {
  if (told.state.on_ground()) return true;
  const auto state = mission::shown_state(told.activity, told.detail);
  return state == mission::ShownState::landed || state == mission::ShownState::on_the_ground;
}

std::string vehicles_summary(const mission::Fleet& fleet) {
  std::vector<std::uint16_t> flying;
  std::vector<std::uint16_t> ground;
  std::vector<std::uint16_t> silent;
  for (const auto& [id, entry] : fleet.vehicles()) {
    if (!entry.telemetry) continue;
    auto& group = entry.silent ? silent : is_on_ground(*entry.telemetry) ? ground : flying;
    group.push_back(id.value);
  }
  std::string text;
  const auto add = [&text](const std::vector<std::uint16_t>& ids, std::string_view what) {
    if (!ids.empty()) text += fmt::format("{}: {}\n", what, fmt::join(ids, ", "));
  };
  add(flying, "in the air, and fly on without the ground station");
  add(ground, "on the ground");
  add(silent, "silent, where they are is not known");
  return text;
}

/// Of what was granted and can be taken back; empty where all of it has begun.
std::string granted_text(const mission::PendingAuthorisation& pending,
                         const console::Picture& picture, std::int64_t epoch_unix_ns, Instant now) {
  std::string text;
  for (const auto& delivery : pending.request.deliveries) {
    if (!console::may_be_before_gate(delivery, picture, now)) continue;
    text += fmt::format("        vehicle {:>3} at {}\n", delivery.assignment.vehicle.value,
                        wording::moment_text(delivery.assignment.time, epoch_unix_ns));
  }
  if (text.empty()) return text;
  const SiteId site = pending.request.site;
  return fmt::format(
      "--- Authorised at site {} by {}, and not begun ---\n{}type    withdraw "
      "decision {}    to take it back\n",
      site.value, pending.decision->decided_by, text, site.value);
}

/// What is missing and why, and what has changed since the request before.
void add_rest(std::string& text, const console::AuthorisationCard& card) {
  auto line = std::back_inserter(text);
  for (const auto& missing : card.missing) {
    fmt::format_to(line, "missing delivery {} towards {}: {}\n", missing.task.index + 1,
                   wording::bearing_text(missing.bearing_rad), missing.why);
  }
  for (const auto& who : card.did_not_bid) {
    fmt::format_to(line, "        vehicle {:>3} did not bid: {}\n", who.vehicle.value, who.why);
  }
  for (const std::string& change : card.changes) fmt::format_to(line, "changed {}\n", change);
}

}  // namespace

std::string place_text(const Vec2& position, const MissionOrigin& origin) {
  const Wgs84 geodetic = origin.to_wgs84(Position<MissionEnu>{position.x(), position.y(), 0.0});
  const double distance_m = position.norm();
  const std::string from_origin =
      distance_m < 0.5 ? "at the origin"
                       : fmt::format("{:.0f} m from the origin towards {}", distance_m,
                                     wording::bearing_text(std::atan2(position.y(), position.x())));
  return fmt::format("{}, {:.6f} {} {:.6f} {}", from_origin, std::abs(geodetic.latitude_deg),
                     geodetic.latitude_deg < 0.0 ? "S" : "N", std::abs(geodetic.longitude_deg),
                     geodetic.longitude_deg < 0.0 ? "W" : "E");
}

std::string fleet_table(const std::map<VehicleId, mission::FleetEntry>& fleet, Instant now) {
  std::string text = fmt::format("{:>7}  {:<30}{:<18}{:>9}{:>12}{:>7}  {}\n", "vehicle", "state",
                                 "task", "heard", "range left", "loads", "health");
  for (const auto& [vehicle, entry] : fleet) {
    auto line = std::back_inserter(text);
    if (entry.telemetry) {
      fmt::format_to(line, "{:>7}  {:<30}{:<18}{:>7.1f} s{:>9.1f} km{:>7}  {}\n", vehicle.value,
                     state_of(entry), task_of(*entry.telemetry), to_seconds(now - entry.heard_at),
                     entry.telemetry->range_left_m / 1000.0, entry.telemetry->loads,
                     health_of(entry));
    } else {
      fmt::format_to(line, "{:>7}  {:<30}{:<18}{:>9}{:>12}{:>7}  {}\n", vehicle.value, "-", "-",
                     "-", "-", "-", health_of(entry));
    }
  }
  return text;
}

std::string request_text(const mission::PendingAuthorisation& pending,
                         const console::AuthorisationCard& card, const MissionOrigin& origin,
                         std::int64_t epoch_unix_ns, Instant now) {
  const auto& request = pending.request;
  std::string text = fmt::format(
      "--- Authorisation wanted: {} at site {} ---\n"
      "where   {}\n"
      "leader  {}, coalition {} round {}\n",
      count_text(request.deliveries.size(), card.missing.size()), request.site.value,
      place_text(request.site_position, origin), wording::text_of(request.round.coalition.leader),
      request.round.coalition.number, request.round.number);
  auto line = std::back_inserter(text);
  add_marks(text, "leader", card.leader);
  for (std::size_t i = 0; i < request.deliveries.size(); ++i) {
    const auto& delivery = request.deliveries[i];
    const auto& assignment = delivery.assignment;
    fmt::format_to(line, "        vehicle {:>3} at {}, flying towards {}\n",
                   assignment.vehicle.value, wording::moment_text(assignment.time, epoch_unix_ns),
                   wording::bearing_text(delivery.bearing_rad));
    add_marks(text, "vehicle", card.deliveries.at(i));
  }
  add_rest(text, card);
  fmt::format_to(line,
                 "until   {}, {:.0f} s from now; without a decision they hold and ask again\n"
                 "type    authorise {}{}    or    refuse {}\n",
                 wording::moment_text(request.decide_by, epoch_unix_ns),
                 to_seconds(request.decide_by - now), request.site.value,
                 card.silent.empty() ? "" : " override", request.site.value);
  return text;
}

std::string pending_text(const std::vector<mission::PendingAuthorisation>& all,
                         const console::Picture& picture, const mission::Fleet& fleet,
                         const MissionOrigin& origin, std::int64_t epoch_unix_ns, Instant now) {
  std::string text;
  for (const auto& pending : all) {
    if (pending.decision && pending.decision->granted) {
      text += granted_text(pending, picture, epoch_unix_ns, now);
    }
    if (!can_be_decided(pending, now)) continue;
    text += request_text(pending, card_of(pending.request, picture, fleet, now), origin,
                         epoch_unix_ns, now);
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

std::string circle_text(const Hazard& hazard) {
  return fmt::format("radius {:.0f} m around {} of the origin", hazard.radius_m,
                     wording::place_text(hazard.centre));
}

std::string hazards_text(const console::Picture& picture) {
  std::string text;
  for (const auto& [id, hazard] : picture.hazards()) {
    fmt::format_to(std::back_inserter(text), "hazard {}: {}\n", id.value, circle_text(hazard));
  }
  return text.empty() ? "no hazard is known\n" : text;
}

std::string summary_text(const console::Picture& picture, const mission::Fleet& fleet) {
  return sites_summary(picture) + vehicles_summary(fleet);
}

std::string site_state_text(const console::SitePicture& site) {
  std::array<std::size_t, 3> done{};
  for (const auto& [task, of] : site.tasks) {
    done.at(static_cast<std::size_t>(task.kind)) += of.state == coalition::TaskState::done ? 1 : 0;
  }
  return fmt::format("{}, {}, {} delivered, {} assessed",
                     site.taken_back  ? "what was authorised there is taken back"
                     : site.withdrawn ? "withdrawn"
                     : site.refused   ? "refused by the operator"
                     : site.done      ? "done"
                     : site.leader    ? "led by " + wording::text_of(*site.leader)
                     : site.surveyor  ? "told to " + wording::text_of(*site.surveyor)
                                      : "no leader yet",
                     site.surveyed ? "surveyed" : "not surveyed",
                     done[static_cast<std::size_t>(TaskKind::deliver)],
                     done[static_cast<std::size_t>(TaskKind::assess)]);
}

std::string sites_text(const console::Picture& picture) {
  std::string text;
  for (const auto& [id, site] : picture.sites()) {
    fmt::format_to(std::back_inserter(text), "site {}: {}", id.value, site_state_text(site));
    if (site.news) {
      fmt::format_to(std::back_inserter(text), "; {:.1f} s {}", to_seconds(site.news->time),
                     wording::text_of(*site.news));
    }
    text += '\n';
  }
  return text.empty() ? "no site is known yet\n" : text;
}

}  // namespace skein::groundstation
