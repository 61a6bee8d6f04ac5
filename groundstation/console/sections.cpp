// SPDX-License-Identifier: Apache-2.0
#include "skein/console/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <type_traits>
#include <utility>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/codec/json_text.hpp"
#include "skein/console/authorisation_card.hpp"
#include "skein/console/team_fence.hpp"
#include "skein/console/team_links.hpp"
#include "skein/console/team_preflight.hpp"
#include "skein/console/team_state.hpp"
#include "skein/console/team_traffic.hpp"
#include "skein/console/team_wind.hpp"
#include "skein/idl/autopilot_fields.hpp"
#include "skein/idl/coalition_fields.hpp"
#include "skein/idl/domain_fields.hpp"
#include "skein/idl/events_fields.hpp"
#include "skein/mission/formation_ground.hpp"
#include "skein/wording/wording.hpp"

namespace skein::console {
namespace {

using codec::Json;

constexpr double kRangeWarningM = 2000.0;
constexpr Duration kOffsetWarning = std::chrono::milliseconds{500};
constexpr double kArcStepRad = 0.16;  ///< of a path's polyline
constexpr std::size_t kPlanPointsMax = 400;
constexpr double kHoldStepRad = 0.26;

/// The shortest text of a number that was rounded.
Json number(double value, int decimals) {
  if (!std::isfinite(value)) return nullptr;
  const double unit = std::pow(10.0, decimals);
  return std::round(value * unit) / unit;
}
Json metres(double m) { return number(m, 2); }
Json seconds(Instant t) { return number(to_seconds(t), 3); }
Json degrees_of(double heading_rad) { return number(compass_deg_from_heading(heading_rad), 1); }
template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? seconds(*value) : Json(nullptr);
}
Json id_or_null(const std::optional<VehicleId>& id) { return id ? Json(id->value) : Json(nullptr); }
Json point(const Vec3& p) { return Json::array({metres(p.x()), metres(p.y()), metres(p.z())}); }

/// The fields of an event by their names; times in seconds, as `name_s`.
template <class Struct>
Json fields_of(const Struct& made) {
  Json json = Json::object();
  codec::for_each_field(made, [&json]<class T>(std::string_view name, const T& value) {
    const std::string key{name};
    if constexpr (std::is_same_v<T, Instant> || std::is_same_v<T, Duration>) {
      constexpr std::string_view kNanoseconds = "_ns";
      json[key.substr(0, key.size() - kNanoseconds.size()) + "_s"] = number(to_seconds(value), 3);
    } else if constexpr (std::is_same_v<T, std::vector<VehicleId>>) {
      json[key] = Json::array();
      for (const VehicleId id : value) json[key].push_back(id.value);
    } else if constexpr (std::is_enum_v<T>) {
      json[key] = to_string(value);
    } else if constexpr (requires { value.value; }) {
      json[key] = value.value;
    } else if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
      json[key] = value;
    } else {
      json[key] = fields_of(value);
    }
  });
  return json;
}

Json task_json(const TaskId& task, const TaskPicture& picture) {
  return {{"site", task.site.value},
          {"kind", to_string(task.kind)},
          {"index", task.index},
          {"time_s", or_null(picture.time)},
          {"state", picture.state ? to_string(*picture.state) : "open"}};
}

Json problem(std::string_view level, std::string text) {
  return {{"level", level}, {"text", std::move(text)}};
}

/// The version is the last word of a program's name.
std::string version_of(const std::string& program) {
  const auto space = program.rfind(' ');
  return space == std::string::npos ? program : program.substr(space + 1);
}

Json problems_of(VehicleId id, const mission::FleetEntry& entry,
                 const std::optional<Duration>& offset, const std::string& version, Instant now) {
  Json all = Json::array();
  if (entry.duplicate) {
    all.push_back(
        problem("alarm", fmt::format("two programs call themselves vehicle {}", id.value)));
  }
  if (entry.differs) {
    all.push_back(problem("alarm", fmt::format("it has {}: it is not worked with",
                                               mission::text_of(*entry.differs))));
  }
  if (entry.revoked) {
    all.push_back(problem("alarm", "it was revoked: nobody hears it, and it hears nobody"));
  }
  if (entry.silent) {
    all.push_back(
        problem("alarm", fmt::format("not heard for {:.0f} s", to_seconds(now - entry.heard_at))));
  }
  const auto& telemetry = entry.telemetry;
  if (telemetry && telemetry->range_left_m < 0.0) {
    all.push_back(problem("alarm", "its range is overdrawn"));
  }
  if (!entry.expected) all.push_back(problem("alarm", "it is not of this fleet"));
  if (!telemetry) all.push_back(problem("warning", "it was never heard"));
  if (entry.health) {
    for (const std::string& text : entry.health->problems) {
      all.push_back(problem("warning", text));
    }
    const std::string theirs = version_of(entry.health->program);
    if (theirs != version) {
      all.push_back(problem("warning", fmt::format("its program is of version {}, the ground "
                                                   "station's of {}",
                                                   theirs, version)));
    }
  }
  // A multirotor counts none, and says 0.
  if (telemetry && telemetry->range_left_m > 0.0 && telemetry->range_left_m < kRangeWarningM) {
    all.push_back(problem(
        "warning", fmt::format("{:.1f} km of range are left", telemetry->range_left_m / 1000.0)));
  }
  if (offset && std::chrono::abs(*offset) > kOffsetWarning) {
    all.push_back(problem("warning", fmt::format("its clock is {:.1f} s off, or its link is slow",
                                                 to_seconds(*offset))));
  }
  return all;
}

mission::ShownState state_of(const mission::FleetEntry& entry) {
  if (entry.silent) return mission::ShownState::silent;
  return mission::shown_state(entry);
}

/// What it does besides that.
Json besides_of(const mission::FleetEntry& entry) {
  if (entry.silent || !mission::keeps_clear_besides(entry)) return nullptr;
  return to_string(mission::ShownState::keeping_clear_of_traffic);
}

Json vehicles_json(const Picture& picture, const mission::Fleet& fleet, const std::string& version,
                   Instant now) {
  Json all = Json::array();
  for (const auto& [id, entry] : fleet.vehicles()) {
    Json v{{"id", id.value},
           {"expected", entry.expected},
           {"silent", entry.silent},
           {"duplicate", entry.duplicate},
           {"revoked", entry.revoked}};
    const auto& t = entry.telemetry;
    const auto set = [&](const char* name, auto value) { v[name] = t ? value() : Json(nullptr); };
    set("x", [&] { return metres(t->state.x_m); });
    set("y", [&] { return metres(t->state.y_m); });
    set("z", [&] { return metres(t->state.z_m); });
    set("heading_deg", [&] { return degrees_of(t->state.heading_rad); });
    set("course_deg", [&] { return degrees_of(t->state.course_rad); });
    set("groundspeed", [&] { return metres(t->state.groundspeed_mps); });
    set("airspeed", [&] { return metres(t->state.airspeed_mps); });
    set("activity", [&] { return Json(to_string(t->activity)); });
    set("state", [&] { return Json(to_string(state_of(entry))); });
    set("besides", [&] { return besides_of(entry); });
    set("measured_s", [&] { return seconds(t->state.time); });
    const auto task = t ? picture.told_task(*t) : std::nullopt;
    v["task"] = task ? task_json(task->first, task->second) : Json(nullptr);
    set("heard_age_s",
        [now, heard_at = entry.heard_at] { return number(to_seconds(now - heard_at), 1); });
    const auto offset = picture.clock_offset(id);
    v["clock_offset_ms"] = offset ? number(to_seconds(*offset) * 1e3, 0) : Json(nullptr);
    set("range_left_m", [&] { return number(t->range_left_m, 0); });
    set("loads", [&] { return Json(t->loads); });
    set("plan_number", [&] { return Json(t->plan_number); });
    const auto& h = entry.health;
    v["version"] = h ? Json(version_of(h->program)) : Json(nullptr);
    v["flight_controller"] = h ? Json(h->flight_controller) : Json(nullptr);
    v["mode"] = h && !h->mode.empty() ? Json(h->mode) : Json(nullptr);
    v["problems"] = problems_of(id, entry, offset, version, now);
    v["links"] = Json::array();
    if (h) {
      for (const auto& heard : h->heard) {
        v["links"].push_back(
            {{"id", heard.vehicle.value}, {"age_s", number(to_seconds(heard.age), 1)}});
      }
    }
    set("control_overruns", [&] { return Json(t->control_overruns); });
    set("messages_dropped", [&] { return Json(t->messages_dropped); });
    all.push_back(std::move(v));
  }
  return all;
}

Json timed_json(VehicleId id, const TimedPath& timed) {
  const Path& path = timed.path;
  const double length = path.length_m();
  Json points = Json::array();
  std::size_t count = 0;
  const auto add = [&](double distance) {
    const Pose2 pose = path.pose_at(distance);
    const Instant at = timed.time_at(distance);
    points.push_back(Json::array({metres(pose.x_m), metres(pose.y_m), number(to_seconds(at), 1)}));
    ++count;
  };
  double begun = 0.0;
  add(0.0);
  for (const Segment& segment : path.segments) {
    const double turn = std::abs(segment.curvature_per_m) * segment.length_m;
    const auto pieces = static_cast<std::size_t>(
        segment.curvature_per_m == 0.0 ? 1.0
                                       : std::clamp(std::ceil(turn / kArcStepRad), 1.0, 60.0));
    for (std::size_t i = 1; i <= pieces && count < kPlanPointsMax; ++i) {
      add(begun + segment.length_m * static_cast<double>(i) / static_cast<double>(pieces));
    }
    begun += segment.length_m;
  }
  Json hold = Json::array();
  if (const double curvature = timed.tail_curvature_per_m; curvature != 0.0) {
    const double round = kTwoPi / std::abs(curvature);
    const auto pieces = static_cast<int>(std::ceil(kTwoPi / kHoldStepRad));
    for (int i = 0; i <= pieces; ++i) {
      const Pose2 pose = timed.pose_at_distance(length + round * i / pieces);
      hold.push_back(Json::array({metres(pose.x_m), metres(pose.y_m)}));
    }
  }
  return {{"id", id.value},
          {"start_s", seconds(timed.start_time)},
          {"end_s", seconds(timed.end_time())},
          {"points", std::move(points)},
          {"hold", std::move(hold)}};
}

Json plan_json(VehicleId id, const mission::FlightPlan& plan) {
  Json json = timed_json(id, plan.timed);
  json["number"] = plan.number;
  return json;
}

Json plans_json(const Picture& picture) {
  Json all = Json::array();
  for (const auto& [id, vehicle] : picture.vehicles()) {
    if (vehicle.plan) all.push_back(plan_json(id, vehicle.plan->plan));
  }
  return all;
}

Json site_json(SiteId id, const SitePicture& site) {
  Json tasks = Json::array();
  const auto add = [&](const TaskId& task, Json bearing) {
    const auto known = site.tasks.find(task);
    const TaskPicture picture = known != site.tasks.end() ? known->second : TaskPicture{};
    tasks.push_back({{"kind", to_string(task.kind)},
                     {"index", task.index},
                     {"bearing_deg", std::move(bearing)},
                     {"vehicle", id_or_null(picture.vehicle)},
                     {"time_s", or_null(picture.time)},
                     {"state", picture.state ? to_string(*picture.state)
                               : task.kind == TaskKind::survey && site.surveyed ? "done"
                                                                                : "open"}});
  };
  add({id, TaskKind::survey, 0}, nullptr);
  if (site.site) {
    for (const TaskId& task : tasks_after_survey(*site.site)) {
      add(task, task.kind == TaskKind::deliver
                    ? degrees_of(site.site->deliveries[task.index].bearing_rad)
                    : Json(nullptr));
    }
  } else {
    for (const auto& [task, known] : site.tasks) {
      if (task.kind != TaskKind::survey) add(task, nullptr);
    }
  }
  return {{"id", id.value},
          {"x", site.site ? metres(site.site->position.x()) : Json(nullptr)},
          {"y", site.site ? metres(site.site->position.y()) : Json(nullptr)},
          {"leader", site.over() ? Json(nullptr) : id_or_null(site.leader)},
          {"surveyor", id_or_null(site.surveyor)},
          {"reward", site.site ? number(site.site->reward, 2) : Json(nullptr)},
          {"status", site.taken_back  ? "taken_back"
                     : site.withdrawn ? "withdrawn"
                     : site.refused   ? "refused"
                     : site.done      ? "done"
                     : site.surveyed  ? "surveyed"
                                      : "found"},
          {"tasks", std::move(tasks)},
          {"news", site.news ? wording::text_of(*site.news) : ""}};
}

Json sites_json(const Picture& picture) {
  Json all = Json::array();
  for (const auto& [id, site] : picture.sites()) all.push_back(site_json(id, site));
  return all;
}

Json round_json(const RoundPicture& round) {
  Json r{{"number", round.number},
         {"announced_s", nullptr},
         {"bids_until_s", nullptr},
         {"reward", nullptr}};
  Json tasks = Json::array();
  if (const auto& a = round.announcement) {
    r["announced_s"] = seconds(a->announced_at);
    r["bids_until_s"] = seconds(a->bids_until);
    r["reward"] = number(a->reward, 2);
    for (const TaskId& task : a->tasks) tasks.push_back(to_string(task));
  }
  r["tasks"] = std::move(tasks);
  r["bids"] = Json::array();
  for (const auto& bid : round.bids) {
    r["bids"].push_back({{"vehicle", bid.bidder.value},
                         {"eta_s", number(to_seconds(bid.eta), 1)},
                         {"range_left_m", number(bid.range_left_m, 0)},
                         {"loads", bid.loads}});
  }
  r["declined"] = Json::array();
  for (const auto& [vehicle, why] : round.declined) {
    r["declined"].push_back({{"vehicle", vehicle.value}, {"why", wording::text_of(why)}});
  }
  r["award"] = Json::array();
  if (round.award) {
    for (const auto& assignment : round.award->assignments) {
      r["award"].push_back({{"vehicle", assignment.vehicle.value},
                            {"task", to_string(assignment.task)},
                            {"time_s", seconds(assignment.time)}});
    }
  }
  r["answers"] = Json::array();
  for (const auto& [member, answer] : round.answers) {
    r["answers"].push_back({{"vehicle", member.value},
                            {"accepted", answer.accepted},
                            {"why", wording::text_of(answer.why)}});
  }
  r["cancelled"] = round.cancelled ? Json(wording::text_of(*round.cancelled)) : Json(nullptr);
  return r;
}

Json coalitions_json(const Picture& picture) {
  Json all = Json::array();
  for (const auto& [id, coalition] : picture.coalitions()) {
    Json members = Json::array();
    for (const VehicleId member : coalition.members) members.push_back(member.value);
    Json rounds = Json::array();
    for (const RoundPicture& round : coalition.rounds) rounds.push_back(round_json(round));
    all.push_back({{"key", key_of(id)},
                   {"leader", id.leader.value},
                   {"number", id.number},
                   {"site", coalition.site.value},
                   {"state", to_string(coalition.state)},
                   {"why", wording::text_of(coalition.why)},
                   {"members", std::move(members)},
                   {"lease_until_s", or_null(coalition.lease_until)},
                   {"rounds", std::move(rounds)}});
  }
  return all;
}

Json marks_json(const std::vector<Mark>& marks) {
  Json all = Json::array();
  for (const Mark& mark : marks)
    all.push_back(problem(mark.alarm ? "alarm" : "warning", mark.text));
  return all;
}

/// What makes a decision of it: of one that waits, nothing of others.
void add_card(Json& json, const AuthorisationCard& card) {
  for (std::size_t i = 0; i < card.deliveries.size(); ++i) {
    json["deliveries"][i]["marks"] = marks_json(card.deliveries[i]);
  }
  json["leader_marks"] = marks_json(card.leader);
  json["silent"] = Json::array();
  for (const VehicleId vehicle : card.silent) json["silent"].push_back(vehicle.value);
  json["missing"] = Json::array();
  for (const auto& missing : card.missing) {
    json["missing"].push_back({{"index", missing.task.index},
                               {"bearing_deg", degrees_of(missing.bearing_rad)},
                               {"why", missing.why}});
  }
  json["did_not_bid"] = Json::array();
  for (const auto& who : card.did_not_bid) {
    json["did_not_bid"].push_back({{"vehicle", who.vehicle.value}, {"why", who.why}});
  }
  json["changes"] = card.changes;
}

Json authorisation_json(const AuthorisationPicture& known, const Picture& picture,
                        const mission::Fleet& fleet, const MissionOrigin& origin, Instant now) {
  const auto& request = known.request;
  const Wgs84 place = origin.to_wgs84({request.site_position.x(), request.site_position.y(), 0.0});
  Json deliveries = Json::array();
  const bool granted = known.decision && known.decision->granted;
  bool can_take_back = false;
  for (const auto& delivery : request.deliveries) {
    const bool before_gate = granted && may_be_before_gate(delivery, picture, now);
    can_take_back = can_take_back || before_gate;
    deliveries.push_back({{"vehicle", delivery.assignment.vehicle.value},
                          {"index", delivery.assignment.task.index},
                          {"time_s", seconds(delivery.assignment.time)},
                          {"bearing_deg", degrees_of(delivery.bearing_rad)},
                          {"before_gate", before_gate},
                          {"marks", Json::array()}});
  }
  Json decision = nullptr;
  if (const auto& d = known.decision) {
    decision = {{"granted", d->granted},
                {"taken_back", known.taken_back},
                {"by", d->decided_by},
                {"at_s", seconds(d->decided_at)}};
  }
  const bool undecided =
      known.standing ? known.standing->undecided : !known.decision && !known.replaced;
  const bool waits = undecided && now < request.decide_by;
  if (known.standing) can_take_back = known.standing->can_be_taken_back;
  Json json{{"site", request.site.value},
            {"leader", request.round.coalition.leader.value},
            {"coalition", key_of(request.round.coalition)},
            {"round", request.round.number},
            {"x", metres(request.site_position.x())},
            {"y", metres(request.site_position.y())},
            {"latitude_deg", number(place.latitude_deg, 7)},
            {"longitude_deg", number(place.longitude_deg, 7)},
            {"asked_s", seconds(known.asked_at)},
            {"decide_by_s", seconds(request.decide_by)},
            {"waiting", waits},
            {"decision", std::move(decision)},
            {"can_take_back", can_take_back},
            {"deliveries", std::move(deliveries)}};
  add_card(json, waits ? card_of(request, picture, fleet, now) : AuthorisationCard{});
  return json;
}

Json authorisations_json(const Picture& picture, const mission::Fleet& fleet,
                         const MissionOrigin& origin, Instant now) {
  Json all = Json::array();
  for (const auto& one : picture.authorisations()) {
    all.push_back(authorisation_json(one, picture, fleet, origin, now));
  }
  return all;
}

Json proposals_json(const Picture& picture) {
  Json all = Json::array();
  for (const auto& [number_of, proposal] : picture.proposals()) {
    const auto& said = proposal.said;
    all.push_back({{"number", number_of},
                   {"kind", to_string(said.kind)},
                   {"x", metres(said.x_m)},
                   {"y", metres(said.y_m)},
                   {"seen_by", said.seen_by.value},
                   {"confidence", said.confidence},
                   {"detector", said.detector},
                   {"time_s", seconds(proposal.at)}});
  }
  return all;
}

Json hazards_json(const Picture& picture) {
  Json all = Json::array();
  for (const auto& [id, hazard] : picture.hazards()) {
    all.push_back({{"id", id.value},
                   {"x", metres(hazard.centre.x())},
                   {"y", metres(hazard.centre.y())},
                   {"radius_m", metres(hazard.radius_m)}});
  }
  return all;
}

/// It has flown the newest change, and is where that leads to.
bool is_in_place(const FormationPicture& formation, VehicleId id,
                 const mission::FormationStatus& status, double tolerance_m, Instant now) {
  // The place of a plane moves; what its status tells is how far it is from there.
  if (const auto flight = formation.flights.find(id); flight != formation.flights.end()) {
    return status.progress.change == flight->second.number && now >= flight->second.joined &&
           status.progress.off_m <= tolerance_m;
  }
  if (!formation.change) return status.at_rest;
  const auto mover = formation::mover_of(*formation.change, id);
  if (!mover) return status.at_rest;
  const Vec3& place = formation.change->movers[*mover].points.back();
  return status.progress.change == formation.change->number &&
         (status.position_m - place).norm() <= tolerance_m;
}

Json formation_json(const Picture& picture, Instant now) {
  const FormationPicture& formation = picture.formation();
  if (formation.members.empty() && !formation.change) return nullptr;
  Json change = nullptr;
  if (const auto& c = formation.change) {
    Json movers = Json::array();
    for (const auto& mover : c->movers) {
      Json points = Json::array();
      for (const Vec3& p : mover.points) points.push_back(point(p));
      movers.push_back({{"id", mover.vehicle.value}, {"points", std::move(points)}});
    }
    change = {{"number", c->number},
              {"start_s", seconds(c->start)},
              {"end_s", seconds(formation.change_ends)},
              {"movers", std::move(movers)}};
  }
  bool at_rest = true;
  bool in_place = !formation.members.empty();
  Json places = Json::array();
  for (const auto& [id, member] : formation.members) {
    const auto& status = member.status;
    const bool lost = now - member.heard_at > mission::kFormationSilence;
    at_rest = at_rest && (status.at_rest || lost);
    in_place = in_place && !lost &&
               is_in_place(formation, id, status, picture.params().place_tolerance_m, now);
    places.push_back({{"id", id.value},
                      {"x", metres(status.position_m.x())},
                      {"y", metres(status.position_m.y())},
                      {"z", metres(status.position_m.z())},
                      {"reference", point(status.reference_m)},
                      {"off_m", metres(status.progress.off_m)},
                      {"change", status.progress.change},
                      {"at_rest", status.at_rest},
                      {"lost", lost}});
  }
  // Planes that are in their places always move.
  const bool moving = (!at_rest && (formation.flights.empty() || !in_place)) ||
                      (formation.change && now < formation.change_ends);
  return {{"in_place", in_place && !moving},
          {"moving", moving},
          {"change", std::move(change)},
          {"places", std::move(places)}};
}

/// Each state until the next one. By columns, with states as places in a list of those that there
/// are: of an hour of many vehicles it is what is longest, and a page holds columns of numbers in a
/// tenth of what it takes for lists of spans. As text at once, for the same reason.
std::string timeline_text(const Picture& picture, const mission::Fleet& fleet) {
  using Spans = decltype(VehiclePicture::spans);
  using Span = Spans::value_type;
  std::vector<mission::ShownState> states;
  const auto place_of = [&states](mission::ShownState state) {
    const auto found = std::find(states.begin(), states.end(), state);
    const auto place = found - states.begin();
    if (found == states.end()) states.push_back(state);
    return place;
  };
  fmt::memory_buffer rows;
  const auto to = std::back_inserter(rows);
  const auto column = [&to](std::string_view name, const Spans& spans, const auto& cell) {
    fmt::format_to(to, R"(,"{}":[)", name);
    const char* between = "";
    for (const Span& span : spans) {
      fmt::format_to(to, "{}", between);
      cell(span);
      between = ",";
    }
    fmt::format_to(to, "]");
  };
  const char* between = "";
  for (const auto& [id, vehicle] : picture.vehicles()) {
    Spans with_silence;
    const auto entry = fleet.vehicles().find(id);
    const bool silent = entry != fleet.vehicles().end() && entry->second.silent;
    if (silent) {
      with_silence = vehicle.spans;
      with_silence.push_back({mission::ShownState::silent, entry->second.heard_at, std::nullopt});
    }
    const Spans& spans = silent ? with_silence : vehicle.spans;
    fmt::format_to(to, R"({}{{"id":{})", between, id.value);
    between = ",";
    column("states", spans, [&](const Span& s) { fmt::format_to(to, "{}", place_of(s.state)); });
    column("from_s", spans,
           [&](const Span& s) { fmt::format_to(to, "{:.1f}", to_seconds(s.from)); });
    column("sites", spans, [&](const Span& s) {
      s.site ? fmt::format_to(to, "{}", s.site->value) : fmt::format_to(to, "null");
    });
    fmt::format_to(to, "}}");
  }
  std::string names;
  for (const mission::ShownState state : states) {
    names += fmt::format(R"({}"{}")", names.empty() ? "" : ",", to_string(state));
  }
  return fmt::format(R"({{"states":[{}],"vehicles":[{}]}})", names, fmt::to_string(rows));
}

}  // namespace

std::string_view to_string(Section section) {
  static constexpr std::array<std::string_view, kSectionCount> kNames{
      "vehicles", "plans", "sites",  "coalitions", "authorisations", "hazards", "formation",
      "timeline", "audit", "replay", "proposals",  "preflight",      "fence",   "links",
      "wind",     "areas", "alarms", "traffic",    "command",        "team"};
  return kNames.at(static_cast<std::size_t>(section));
}

std::optional<coalition::CoalitionId> coalition_of(std::string_view key) {
  coalition::CoalitionId id;
  const char* at = key.data();
  const char* const end = at + key.size();
  const auto take = [&](auto& value, int base, bool last) {
    const auto [next, error] = std::from_chars(at, end, value, base);
    if (error != std::errc{} || (last ? next != end : next == end || *next != '-')) return false;
    at = last ? next : next + 1;
    return true;
  };
  if (take(id.leader.value, 10, false) && take(id.instance.value, 16, false) &&
      take(id.number, 10, true)) {
    return id;
  }
  return std::nullopt;
}

std::string key_of(const coalition::CoalitionId& id) {
  return fmt::format("{}-{:016x}-{}", id.leader.value, id.instance.value, id.number);
}

std::string section_of(Section section, const Picture& picture, const mission::Fleet& fleet,
                       const MissionOrigin& origin, const std::string& version, Instant now) {
  switch (section) {
    case Section::vehicles:
      return codec::json_text(vehicles_json(picture, fleet, version, now));
    case Section::plans:
      return codec::json_text(plans_json(picture));
    case Section::sites:
      return codec::json_text(sites_json(picture));
    case Section::coalitions:
      return codec::json_text(coalitions_json(picture));
    case Section::authorisations:
      return codec::json_text(authorisations_json(picture, fleet, origin, now));
    case Section::hazards:
      return codec::json_text(hazards_json(picture));
    case Section::formation:
      return codec::json_text(formation_json(picture, now));
    case Section::timeline:
      return timeline_text(picture, fleet);
    case Section::proposals:
      return codec::json_text(proposals_json(picture));
    case Section::preflight:
      return preflight_json(team_preflight(fleet, now));
    case Section::fence:
      return fence_json(picture, fleet);
    case Section::links:
      return links_json(team_links(fleet, picture.receptions(), now));
    case Section::wind:
      return wind_json(picture.wind().estimate(without_airspeed(fleet), now), now);
    case Section::traffic:
      return traffic_json(picture, fleet, now);
    case Section::team:
      return team_json(team_state(fleet, {}, now));
    case Section::audit:
    case Section::areas:
    case Section::command:
    case Section::replay:
    case Section::alarms:
    case Section::count:
      break;
  }
  return "";
}

Sections sections_of(const Picture& picture, const mission::Fleet& fleet,
                     const MissionOrigin& origin, const std::string& version, Instant now) {
  Sections all;
  for (std::size_t i = 0; i < kSectionCount; ++i) {
    all[i] = section_of(static_cast<Section>(i), picture, fleet, origin, version, now);
  }
  return all;
}

std::string path_json(VehicleId vehicle, const TimedPath& timed) {
  return codec::json_text(timed_json(vehicle, timed));
}

std::string series_of(const Picture& picture) {
  Json all = Json::array();
  for (const auto& [id, vehicle] : picture.vehicles()) {
    Json t = Json::array(), x = Json::array(), y = Json::array(), z = Json::array();
    Json speed = Json::array(), range = Json::array(), delay = Json::array();
    for (const auto& sample : vehicle.series) {
      t.push_back(number(to_seconds(sample.time), 2));
      x.push_back(number(sample.x_m, 1));
      y.push_back(number(sample.y_m, 1));
      z.push_back(number(sample.z_m, 1));
      speed.push_back(number(sample.groundspeed_mps, 2));
      range.push_back(number(sample.range_left_m, 0));
      delay.push_back(number(to_seconds(sample.delay) * 1e3, 0));
    }
    all.push_back({{"id", id.value},
                   {"t", std::move(t)},
                   {"x", std::move(x)},
                   {"y", std::move(y)},
                   {"z", std::move(z)},
                   {"speed", std::move(speed)},
                   {"range", std::move(range)},
                   {"delay", std::move(delay)}});
  }
  return codec::json_text(all);
}

std::string event_json(const mission::MissionEvent& event, std::uint64_t seq) {
  const bool warning = mission::is_warning(event.kind());
  Json fields = std::visit([](const auto& body) { return fields_of(body); }, event.body);
  return codec::json_text(
      {{"seq", seq},
       {"time_s", seconds(event.time)},
       {"vehicle", event.vehicle.value},
       {"kind", to_string(event.kind())},
       {"level", warning ? "warning" : "info"},
       {"site", event.task.site == SiteId{} ? Json(nullptr) : Json(event.task.site.value)},
       {"task", event.task.site == SiteId{} ? Json(nullptr) : Json(to_string(event.task))},
       {"coalition", event.round.number == 0 ? Json(nullptr) : Json(key_of(event.round.coalition))},
       {"fields", std::move(fields)},
       {"news", wording::news_of(event)},
       {"text", wording::text_of(event)}});
}

}  // namespace skein::console
