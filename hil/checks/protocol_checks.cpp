// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "motion.hpp"
#include "skein/checks/checks.hpp"
#include "skein/checks/task_runs.hpp"

namespace skein::checks {
namespace {

using mission::CommandKind;
using mission::EventKind;
using mission::MissionEvent;
namespace event = mission::event;

std::string round_name(const coalition::Round& round) {
  return "coalition " + std::to_string(round.coalition.number) + " of " +
         vehicle_name(round.coalition.leader) + ", round " + std::to_string(round.number);
}

std::string run_name(const TaskRun& run) {
  return to_string(run.task) + " by " + vehicle_name(run.vehicle);
}

/// One must be over before the other begins.
struct Order {
  const TaskRun& before;
  const TaskRun& after;
  Duration wait{};
};

void judge_order(const Order& order, const Limits& limits, CheckResult& result) {
  const std::string rule =
      order.wait > Duration{} ? " (wait " + fixed(to_seconds(order.wait), 1) + " s)" : "";
  ++result.judged;
  note_moment(result.moment, order.after.begin());
  if (order.before.cut_off) {  // nobody can know when it ended, or whether; but when it began
    if (order.after.begin() >= order.before.begin()) return;
    result.violations.push_back({order.after.vehicle, order.after.begin(),
                                 run_name(order.after) + " began " + at(order.after.begin()) +
                                     ", before " + run_name(order.before) + " did, " +
                                     at(order.before.begin())});
    return;
  }
  if (!order.before.done ||
      order.after.begin() + from_seconds(limits.arrival_s) < *order.before.done + order.wait) {
    result.violations.push_back(
        {order.after.vehicle, order.after.begin(),
         run_name(order.after) + " began " + at(order.after.begin()) + ", but " +
             run_name(order.before) +
             (order.before.done ? " ended only " + at(*order.before.done) : " never ended") +
             rule});
    return;
  }
  const bool both_planned = order.before.planned && order.after.planned;
  if (both_planned && order.before.task.kind == TaskKind::deliver &&
      *order.after.planned + from_seconds(limits.planned_time_s) <
          *order.before.planned + order.wait) {
    result.violations.push_back({order.after.vehicle, order.after.begin(),
                                 run_name(order.after) + " was planned " +
                                     at(*order.after.planned) + " and " + run_name(order.before) +
                                     " " + at(*order.before.planned) + rule});
  }
}

std::vector<const TaskRun*> of_kind(const std::vector<TaskRun>& runs, SiteId site, TaskKind kind) {
  std::vector<const TaskRun*> found;
  for (const TaskRun& run : runs) {
    if (run.flown() && run.task.site == site && run.task.kind == kind) found.push_back(&run);
  }
  return found;
}

/// The one that ended first; where none did, the one that began first.
const TaskRun& first_done(const std::vector<const TaskRun*>& runs) {
  return **std::min_element(runs.begin(), runs.end(), [](const TaskRun* a, const TaskRun* b) {
    return a->done.value_or(Instant::max()) < b->done.value_or(Instant::max());
  });
}

/// An operator's no stands for the rest of the mission, whatever another ground station grants that
/// has not heard of it.
bool refused(const RunRecord& record, SiteId site) {
  return std::ranges::any_of(record.ground_events, [site](const MissionEvent& event) {
    const bool is_no = event.kind() == EventKind::authorisation_refused ||
                       event.kind() == EventKind::authorisation_withdrawn;
    return is_no && event.task.site == site;
  });
}

/// The operator was told before the assessment that the delivery may have been flown: what follows
/// it goes on, whether it is flown later, in another coalition, or not.
bool counts_as_flown(const RunRecord& record, const TaskRun& delivery, const TaskRun& assessment) {
  const Instant by = assessment.begin();
  if (delivery.begin() <= by || delivery.round.coalition == assessment.round.coalition) {
    return false;
  }
  return std::ranges::any_of(record.recordings, [&](const recording::Recording& recorded) {
    return std::ranges::any_of(recorded.events, [&](const MissionEvent& event) {
      return event.kind() == EventKind::task_unknown && event.task == delivery.task &&
             event.time <= by;
    });
  });
}

}  // namespace

CheckResult check_precedence(const RunRecord& record, const Limits& limits) {
  CheckResult result{"precedence",
                     "survey before deliveries before assessments, with the wait",
                     0,
                     "pairs of tasks",
                     "",
                     {}};
  const std::vector<TaskRun> runs = task_runs(record);
  for (const Site& site : record.sites) {
    const auto surveys = of_kind(runs, site.id, TaskKind::survey);
    const auto deliveries = of_kind(runs, site.id, TaskKind::deliver);
    const auto assessments = of_kind(runs, site.id, TaskKind::assess);
    for (const auto& later : {deliveries, assessments}) {
      for (const TaskRun* run : later) {
        if (surveys.empty()) {
          ++result.judged;
          note_moment(result.moment, run->begin());
          result.violations.push_back({run->vehicle, run->begin(),
                                       run_name(*run) + " began " + at(run->begin()) +
                                           " at a site that was never surveyed"});
        } else {
          judge_order({first_done(surveys), *run}, limits, result);
        }
      }
    }
    for (const TaskRun* delivery : deliveries) {
      for (const TaskRun* assessment : assessments) {
        if (counts_as_flown(record, *delivery, *assessment)) continue;
        judge_order({*delivery, *assessment, site.assess_wait}, limits, result);
      }
    }
  }
  return result;
}

CheckResult check_capabilities(const RunRecord& record, const Limits& /*limits*/) {
  CheckResult result{"capabilities",
                     "tasks go only to vehicles that can do their kind",
                     0,
                     "leases and tasks",
                     "",
                     {}};
  const auto judge_one = [&](VehicleId vehicle, const TaskId& task, Instant when,
                             const std::string& what) {
    ++result.judged;
    note_moment(result.moment, when);
    const VehicleSpec* spec = spec_of(record, vehicle);
    if (spec != nullptr && spec->capabilities.has(task.kind)) return;
    result.violations.push_back(
        {vehicle, when,
         vehicle_name(vehicle) + what + to_string(task) + " " + at(when) +
             (spec == nullptr ? ", but is not of this mission"
                              : ", but cannot " + std::string{to_string(task.kind)})});
  };
  for (const Lease& lease : leases(record)) {
    judge_one(lease.vehicle, lease.task, lease.from, " took a lease on ");
  }
  for (const TaskRun& run : task_runs(record)) {
    judge_one(run.vehicle, run.task, run.begin(), " began ");
  }
  return result;
}

CheckResult check_loads(const RunRecord& record, const Limits& /*limits*/) {
  CheckResult result{"loads", "no vehicle delivers more than it carries", 0, "vehicles", "", {}};
  std::map<VehicleId, std::size_t> flown;
  std::size_t total = 0;
  const std::vector<TaskRun> runs = task_runs(record);
  for (const VehicleSpec& vehicle : record.vehicles) {
    ++result.judged;
    std::size_t used = 0;
    for (const TaskRun& run : runs) {
      if (run.vehicle != vehicle.id || run.task.kind != TaskKind::deliver || !run.flown()) continue;
      ++total;
      note_moment(result.moment, run.begin());
      if (++used != vehicle.loads + std::size_t{1}) continue;
      result.violations.push_back({vehicle.id, run.begin(),
                                   vehicle_name(vehicle.id) + " began " + to_string(run.task) +
                                       " " + at(run.begin()) + ", its delivery number " +
                                       std::to_string(used) + " (carried " +
                                       std::to_string(vehicle.loads) + ")"});
    }
  }
  result.measured = std::to_string(total) + " loads used";
  return result;
}

CheckResult check_leases(const RunRecord& record, const Limits& /*limits*/) {
  CheckResult result{
      "leases", "one unexpired lease a task; a vehicle under one leader", 0, "leases", "", {}};
  const std::vector<Lease> all = leases(record);
  result.judged = all.size();
  for (std::size_t i = 0; i < all.size(); ++i) {
    note_moment(result.moment, all[i].from);
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      const Lease& a = all[i].from <= all[j].from ? all[i] : all[j];
      const Lease& b = all[i].from <= all[j].from ? all[j] : all[i];
      const Instant until = std::min(a.until, b.until);
      if (b.from >= until) continue;
      const std::string span =
          " from " + fixed(to_seconds(b.from), 2) + " s to " + fixed(to_seconds(until), 2) + " s";
      if (a.task == b.task && a.vehicle != b.vehicle) {
        result.violations.push_back({b.vehicle, b.from,
                                     to_string(a.task) + " was leased to " +
                                         vehicle_name(a.vehicle) + " and " +
                                         vehicle_name(b.vehicle) + " at once" + span});
      }
      const auto leader = [](const Lease& lease) {
        return std::tuple{lease.coalition.leader, lease.coalition.instance};
      };
      if (a.vehicle == b.vehicle && leader(a) != leader(b)) {
        result.violations.push_back(
            {b.vehicle, b.from,
             vehicle_name(a.vehicle) + " held leases from two leaders at once" + span + ": " +
                 to_string(a.task) + " from " + vehicle_name(a.coalition.leader) + ", " +
                 to_string(b.task) + " from " + vehicle_name(b.coalition.leader)});
      }
    }
  }
  return result;
}

CheckResult check_authorisation(const RunRecord& record, const Limits& /*limits*/) {
  CheckResult result{
      "authorisation", "every delivery is authorised before it starts", 0, "deliveries", "", {}};
  // The first decision for a round and site, as one side told it.
  const auto decided = [](const std::vector<MissionEvent>& events, VehicleId teller,
                          const TaskRun& run, EventKind kind) {
    std::optional<Instant> first;
    for (const MissionEvent& event : events) {
      if (event.vehicle == teller && event.kind() == kind && event.round == run.round &&
          event.task.site == run.task.site && (!first || event.time < *first)) {
        first = event.time;
      }
    }
    return first;
  };
  for (const TaskRun& run : task_runs(record)) {
    if (run.task.kind != TaskKind::deliver) continue;
    ++result.judged;
    note_moment(result.moment, run.begin());
    const auto granted = decided(record.ground_events, kGroundStation, run, EventKind::authorised);
    const auto refusal =
        decided(record.ground_events, kGroundStation, run, EventKind::authorisation_refused);
    const auto* recorded = recording_of(record, run.vehicle);
    const auto heard = decided(recorded->events, run.vehicle, run, EventKind::authorised);
    std::string why;
    if (refusal && *refusal <= run.begin()) {
      why = "the operator had refused it " + at(*refusal);
    } else if (!granted) {
      why = "the operator never authorised it";
    } else if (*granted > run.begin()) {
      why = "it was authorised only " + at(*granted);
    } else if (!heard) {
      why = "the vehicle never heard of the authorisation";
    } else if (*heard > run.begin()) {
      why = "the vehicle heard of the authorisation only " + at(*heard);
    }
    if (!why.empty()) {
      result.violations.push_back({run.vehicle, run.begin(),
                                   run_name(run) + " (" + round_name(run.round) + ") began " +
                                       at(run.begin()) + ", but " + why});
    }
  }
  return result;
}

namespace {

/// When a vehicle first heard that the operator does not want the site's deliveries flown: by the
/// network, and by its own word.
std::map<std::pair<VehicleId, SiteId>, Instant> refusals_heard(const RunRecord& record) {
  std::map<std::pair<VehicleId, SiteId>, Instant> first;
  const auto note = [&first](VehicleId vehicle, SiteId site, Instant at) {
    const auto [known, is_new] = first.emplace(std::pair{vehicle, site}, at);
    if (!is_new) known->second = std::min(known->second, at);
  };
  for (const RefusalHeard& heard : record.refusals) note(heard.vehicle, heard.site, heard.at);
  for (const recording::Recording& recorded : record.recordings) {
    for (const MissionEvent& event : recorded.events) {
      if (event.kind() != EventKind::authorisation_withdrawn) continue;
      note(recorded.vehicle, event.task.site, event.time);
    }
  }
  return first;
}

}  // namespace

std::optional<CheckResult> check_taken_back(const RunRecord& record) {
  CheckResult result{"taken back",
                     "no delivery begins once its vehicle has heard that it is not to be flown",
                     0,
                     "vehicles told",
                     "",
                     {}};
  const auto heard = refusals_heard(record);
  if (heard.empty()) return std::nullopt;
  result.judged = heard.size();
  std::size_t flown_on = 0;
  for (const TaskRun& run : task_runs(record)) {
    if (run.task.kind != TaskKind::deliver) continue;
    const auto told = heard.find({run.vehicle, run.task.site});
    if (told == heard.end()) continue;
    if (run.begin() <= told->second) {
      flown_on += run.done.value_or(Instant::max()) > told->second ? 1 : 0;
      continue;
    }
    result.violations.push_back({run.vehicle, run.begin(),
                                 run_name(run) + " (" + round_name(run.round) + ") began " +
                                     at(run.begin()) + ", but the vehicle had heard " +
                                     at(told->second) + " that it is not to be flown"});
  }
  result.measured = std::to_string(flown_on) + " deliveries had begun";
  return result;
}

namespace {

/// What was begun before may be flown to its end.
bool takes_up_something(EventKind kind) {
  return kind == EventKind::survey_started || kind == EventKind::announced ||
         kind == EventKind::bid_sent || kind == EventKind::confirmed ||
         kind == EventKind::lease_granted || kind == EventKind::relief_begun;
}

}  // namespace

CheckResult check_standing_orders(const RunRecord& record, const Limits& /*limits*/) {
  CheckResult result{"standing orders",
                     "who was told to hold or to come home takes up nothing",
                     0,
                     "orders",
                     "",
                     {}};
  for (const recording::Recording& recorded : record.recordings) {
    std::optional<Instant> held_since;
    for (const MissionEvent& event : recorded.events) {
      const auto* commanded = std::get_if<event::Commanded>(&event.body);
      const auto* told = std::get_if<event::OrdersKnown>(&event.body);
      if (commanded != nullptr) {
        ++result.judged;
        note_moment(result.moment, event.time);
        const bool goes_on = commanded->command == CommandKind::resume;
        if (goes_on) held_since.reset();
        if (!goes_on && commanded->command != CommandKind::give_back) held_since = event.time;
      } else if (told != nullptr && told->told_by != kGroundStation) {
        // It starts anew; unless they have told it of the order, those whom it hears know of none.
        if (held_since.value_or(event.time) < event.time) held_since.reset();
      } else if (held_since && takes_up_something(event.kind())) {
        result.violations.push_back(
            {event.vehicle, event.time,
             vehicle_name(event.vehicle) + ": " + std::string{to_string(event.kind())} + " " +
                 at(event.time) + ", but it was told to hold or to come home " + at(*held_since)});
      }
    }
  }
  return result;
}

CheckResult check_single_delivery(const RunRecord& record, const Limits& /*limits*/) {
  CheckResult result{"single delivery", "no delivery is flown twice", 0, "deliveries", "", {}};
  std::map<TaskId, TaskRun> first;
  for (const TaskRun& run : task_runs(record)) {
    if (run.task.kind != TaskKind::deliver || !run.flown()) continue;
    ++result.judged;
    note_moment(result.moment, run.begin());
    const auto [earlier, is_new] = first.emplace(run.task, run);
    if (is_new) continue;
    result.violations.push_back({run.vehicle, run.begin(),
                                 to_string(run.task) + " was flown by " +
                                     vehicle_name(earlier->second.vehicle) + " " +
                                     at(earlier->second.begin()) + " and again by " +
                                     vehicle_name(run.vehicle) + " " + at(run.begin())});
  }
  return result;
}

CheckResult check_completion(const RunRecord& record, const Limits& /*limits*/) {
  CheckResult result{"completion", "every task of every site is done", 0, "tasks", "", {}};
  std::set<TaskId> done;
  std::set<TaskId> begun;
  for (const TaskRun& run : task_runs(record)) {
    begun.insert(run.task);
    note_moment(result.moment, run.done.value_or(run.begin()));
    if (run.done && !run.failed) done.insert(run.task);
  }
  std::size_t refusals = 0;
  std::map<std::string, std::size_t> excuses;
  for (const Site& site : record.sites) {
    std::vector<TaskId> tasks = tasks_after_survey(site);
    tasks.insert(tasks.begin(), TaskId{site.id, TaskKind::survey, 0});
    const bool no = refused(record, site.id);
    for (const TaskId& task : tasks) {
      ++result.judged;
      if (done.contains(task)) continue;
      if (no && task.kind != TaskKind::survey) {
        ++refusals;
        continue;
      }
      const auto excuse = std::find_if(record.excused.begin(), record.excused.end(),
                                       [&](const Excuse& e) { return e.task == task; });
      if (excuse != record.excused.end()) {
        ++excuses[excuse->why];
        continue;
      }
      result.violations.push_back(
          {VehicleId{}, Instant{},
           to_string(task) +
               (begun.contains(task) ? " was begun and never done" : " was never begun")});
    }
  }
  result.measured =
      std::to_string(done.size()) + " done" +
      (refusals > 0 ? ", " + std::to_string(refusals) + " refused by the operator" : "");
  for (const auto& [why, count] : excuses) {
    result.measured += ", " + std::to_string(count) + " " + why;
  }
  return result;
}

}  // namespace skein::checks
