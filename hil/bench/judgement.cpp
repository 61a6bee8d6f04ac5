// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/judgement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "second_station.hpp"
#include "session_record.hpp"
#include "skein/checks/flown.hpp"
#include "skein/hil/team_mission.hpp"
#include "skein/recording/reader.hpp"
#include "truth_recorder.hpp"

namespace skein::hil {

using checks::CheckResult;
using mission::EventKind;
using mission::MissionEvent;

namespace {

bool clocks_differ(const BenchOutcome& outcome) {
  return std::ranges::any_of(outcome.clocks_off,
                             [](const auto& off) { return off.second != Duration{}; });
}

}  // namespace

Result<checks::RunRecord> read_record(const configuration::Scenario& scenario,
                                      const std::filesystem::path& run_folder,
                                      const BenchOutcome& outcome) {
  checks::RunRecord record;
  for (const auto& end : configuration::route_ends(scenario)) {
    record.route_ends.push_back(
        {end.vehicle, scenario.routes.site, end.heading_rad, end.planned, end.offset});
  }
  record.sites = scenario.sites;
  record.hazards = scenario.hazards;
  record.fence = scenario.fence;
  for (const auto& v : scenario.vehicles) record.vehicles.push_back(v.spec);
  record.lost = outcome.killed;
  auto recordings = recording::read_run(run_folder);
  if (!recordings) return recordings.error();
  for (auto& r : *recordings) {
    if (!outcome.spans.empty() || clocks_differ(outcome))
      r = whole_recording(run_folder, r.vehicle, outcome);
    if (r.vehicle == kGroundStation) {
      record.ground_events = std::move(r.events);
      record.places = std::move(r.places);
    } else {
      record.recordings.push_back(std::move(r));
    }
  }
  // What the operator of a second ground station has decided counts as much.
  if (const auto second = run_folder / log_name(SecondStation::kNode);
      std::filesystem::exists(second)) {
    auto read = recording::read(second, kGroundStation);
    if (!read) return read.error();
    auto& events = record.ground_events;
    events.insert(events.end(), read->events.begin(), read->events.end());
    std::ranges::stable_sort(events, {}, &mission::MissionEvent::time);
  }
  const auto truths = run_folder / kTruthFolder;
  if (std::filesystem::exists(truths)) {
    auto read = recording::read_run(truths);
    if (!read) return read.error();
    record.truths = std::move(read).value();
  }
  if (!outcome.heard.empty()) add_faults_done(record, outcome);
  return record;
}

namespace {

/// The events of all vehicles, in the order of time.
std::vector<MissionEvent> events_of(const checks::RunRecord& record) {
  std::vector<MissionEvent> all;
  for (const auto& r : record.recordings) all.insert(all.end(), r.events.begin(), r.events.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const MissionEvent& a, const MissionEvent& b) { return a.time < b.time; });
  return all;
}

CheckResult bench_check(std::string name, std::string requirement, std::size_t judged,
                        std::string judged_what, std::string measured, bool held,
                        std::string sentence) {
  CheckResult result{std::move(name),        std::move(requirement), judged,
                     std::move(judged_what), std::move(measured),    {}};
  if (!held) result.violations.push_back({kGroundStation, Instant{}, std::move(sentence)});
  return result;
}

/// Without a recording a vehicle is not judged.
CheckResult collected(const BenchOutcome& outcome) {
  std::string why;
  for (const auto& one : outcome.not_collected) why += (why.empty() ? "" : "; ") + one;
  return bench_check("collected", "what external vehicles recorded is here, and judged",
                     outcome.external, "vehicles", "", outcome.not_collected.empty(), why);
}

/// Of a formation that flies by one.
CheckResult script_flown(const configuration::Scenario& scenario, const BenchOutcome& outcome) {
  const bool left_alone = std::find(outcome.killed.begin(), outcome.killed.end(), kGroundStation) !=
                          outcome.killed.end();
  return bench_check("script",
                     left_alone ? "what was ordered before the ground station's end is flown"
                                : "every order is flown",
                     scenario.formation.script.size(), "orders", "", outcome.finished,
                     "the script was not done when the run ended");
}

}  // namespace

std::vector<CheckResult> judge_run(const configuration::Scenario& scenario,
                                   const checks::RunRecord& record, const BenchOutcome& outcome) {
  checks::Limits limits = limits_of(scenario.expect);
  if (clocks_differ(outcome)) allow_for_clocks(limits, scenario.protocol);
  auto results = scenario.formation.planes    ? checks::judge_tracks(record, limits)
                 : scenario.flies_formation() ? checks::judge_formation(record, limits)
                 : scenario.sites.empty()     ? checks::judge_routes(record, limits)
                                              : checks::judge(record, limits);
  if (scenario.flies_routes() && !scenario.sites.empty()) {
    results.push_back(checks::check_routes(record, limits));
  }

  const std::size_t vehicles = scenario.vehicles.size();
  const double found = outcome.all_heard_s.value_or(0.0);
  results.push_back(bench_check(
      "discovery", "every vehicle is heard within 15 s of the start", vehicles, "vehicles",
      outcome.all_heard_s ? fmt::format("{:.1f} s", found) : "not all",
      outcome.all_heard_s && found <= 15.0,
      outcome.all_heard_s ? fmt::format("the last vehicle was heard only after {:.1f} s", found)
                          : "not every vehicle was heard"));
  // Who stands still, or has ended, loses some.
  if (outcome.spans.empty())
    results.push_back(bench_check(
        "messages", "no message is dropped for want of time or room", vehicles, "vehicles",
        fmt::format("{} dropped", outcome.messages_dropped), outcome.messages_dropped == 0,
        fmt::format("{} messages were dropped", outcome.messages_dropped)));
  std::string deaths;
  for (const auto& death : outcome.deaths) deaths += (deaths.empty() ? "" : "; ") + death;
  results.push_back(
      bench_check("processes", "none ends unasked, all end cleanly when asked", vehicles + 1,
                  "processes", "", outcome.deaths.empty() && outcome.stopped_cleanly,
                  deaths.empty() ? "a process did not end cleanly when it was asked to" : deaths));

  if (outcome.external > 0) results.push_back(collected(outcome));

  if (scenario.flies_formation()) {
    if (scenario.formation.script.empty()) return results;  // an operator gave the orders
    results.push_back(script_flown(scenario, outcome));
    return results;
  }
  if (scenario.sites.empty() || outcome.healed_at) return results;
  std::set<SiteId> formed;
  std::set<SiteId> waited;
  for (const auto& event : events_of(record)) {
    if (event.kind() == EventKind::coalition_formed) formed.insert(event.task.site);
    if (event.kind() == EventKind::monitoring && !formed.contains(event.task.site))
      waited.insert(event.task.site);
  }
  const auto expected = static_cast<std::size_t>(scenario.expect.coalitions);
  results.push_back(
      bench_check("coalitions", fmt::format("{} coalitions form", expected), formed.size(),
                  "coalitions", "", formed.size() == expected,
                  fmt::format("{} coalitions formed instead of {}", formed.size(), expected)));
  if (scenario.expect.copters_fly != Capabilities{}) {
    results.push_back(checks::check_copters(record, limits));
  }
  for (const SiteId site : scenario.expect.first_attempt_fails) {
    results.push_back(
        bench_check(fmt::format("site {} waits", site.value),
                    "its first attempt fails, and its leader monitors until one succeeds", 1,
                    "sites", "", waited.contains(site) && formed.contains(site),
                    fmt::format("site {}: {}", site.value,
                                formed.contains(site) ? "the first attempt succeeded"
                                                      : "no coalition formed")));
  }
  return results;
}

std::vector<SiteFigures> site_figures(const checks::RunRecord& record,
                                      const checks::Limits& limits) {
  std::vector<SiteFigures> all;
  const auto events = events_of(record);
  const auto deliveries = checks::deliveries_flown(record, limits);
  for (const auto& site : record.sites) {
    SiteFigures f;
    f.site = site.id;
    for (const auto& e : events) {
      if (e.task.site != site.id) continue;
      const double t = to_seconds(e.time);
      switch (e.kind()) {
        case EventKind::site_detected:
          if (!f.found_by) f.found_by = e.vehicle;
          break;
        case EventKind::survey_done:
          f.survey_done_s = t;
          break;
        case EventKind::monitoring:
          if (!f.formed_s) ++f.attempts_failed;
          break;
        case EventKind::coalition_formed:
          f.formed_s = t;
          f.coalition_size = std::get<mission::event::CoalitionFormed>(e.body).vehicles;
          break;
        case EventKind::allocation_done:
          f.allocation_time_s = to_seconds(std::get<mission::event::AllocationDone>(e.body).took);
          break;
        case EventKind::task_done:
          if (e.task.kind == TaskKind::assess)
            f.assessment_done_s = std::max(f.assessment_done_s.value_or(t), t);
          break;
        default:
          break;
      }
    }
    for (const auto& d : deliveries) {
      if (d.run.task.site == site.id && d.seen) f.delivery_times_s.push_back(to_seconds(d.time));
    }
    std::sort(f.delivery_times_s.begin(), f.delivery_times_s.end());
    all.push_back(f);
  }
  return all;
}

std::vector<report::ComparisonRow> compare(
    const std::vector<SiteFigures>& figures,
    const std::vector<configuration::ReferenceSite>& reference) {
  const auto seconds = [](const std::optional<double>& s, int digits = 2) {
    return s ? fmt::format("{:.{}f} s", *s, digits) : std::string{"-"};
  };
  const auto number = [](const std::optional<int>& n) {
    return n ? std::to_string(*n) : std::string{"-"};
  };
  const auto vehicle = [](const std::optional<VehicleId>& v) {
    return v ? fmt::format("U{}", v->value) : std::string{"-"};
  };
  const auto times = [](const std::vector<double>& t) {
    if (t.empty()) return std::string{"-"};
    const bool one = t.back() - t.front() < 1.0;
    return one ? fmt::format("{} at {:.2f} s", t.size(), t.front())
               : fmt::format("{} from {:.2f} to {:.2f} s", t.size(), t.front(), t.back());
  };
  std::vector<report::ComparisonRow> rows;
  for (const auto& f : figures) {
    const auto published = std::find_if(reference.begin(), reference.end(),
                                        [&](const auto& r) { return r.site == f.site; });
    const configuration::ReferenceSite r =
        published != reference.end() ? *published : configuration::ReferenceSite{};
    rows.push_back({f.site, "found by", vehicle(f.found_by), vehicle(r.found_by)});
    rows.push_back({f.site, "survey done", seconds(f.survey_done_s), seconds(r.survey_done_s)});
    rows.push_back({f.site, "failed attempts", std::to_string(f.attempts_failed), "-"});
    rows.push_back({f.site, "coalition formed", seconds(f.formed_s), seconds(r.formed_s)});
    rows.push_back({f.site, "vehicles in it", number(f.coalition_size), number(r.coalition_size)});
    rows.push_back(
        {f.site, "allocation took", seconds(f.allocation_time_s, 4), seconds(r.allocation_time_s)});
    rows.push_back({f.site, "deliveries", times(f.delivery_times_s), times(r.delivery_times_s)});
    rows.push_back(
        {f.site, "assessments done", seconds(f.assessment_done_s), seconds(r.assessment_done_s)});
  }
  return rows;
}

}  // namespace skein::hil
