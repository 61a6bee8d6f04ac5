// SPDX-License-Identifier: Apache-2.0
#include "skein/checks/task_runs.hpp"

#include <algorithm>
#include <tuple>

namespace skein::checks {
namespace {

using mission::EventKind;
using mission::MissionEvent;

/// A survey is told as a survey and as a task.
constexpr Duration kToldTwice = std::chrono::seconds{1};

bool is_start(EventKind kind) {
  return kind == EventKind::task_started || kind == EventKind::survey_started;
}
bool is_done(EventKind kind) {
  return kind == EventKind::task_done || kind == EventKind::survey_done;
}

TaskId task_of(const MissionEvent& event) {
  const bool survey =
      event.kind() == EventKind::survey_started || event.kind() == EventKind::survey_done;
  return survey ? TaskId{event.task.site, TaskKind::survey, 0} : event.task;
}

/// When what was done was to begin, or be done: of a task, and of a survey that it tells apart.
Instant planned_of(const MissionEvent& event) {
  if (const auto* done = std::get_if<mission::event::TaskDone>(&event.body)) return done->planned;
  const auto* survey = std::get_if<mission::event::SurveyDone>(&event.body);
  return survey == nullptr ? Instant{} : survey->begun;
}

/// One vehicle's events in order of time; others' that it may have noted are not its own.
std::vector<MissionEvent> own_events(const recording::Recording& recorded) {
  std::vector<MissionEvent> events;
  std::copy_if(recorded.events.begin(), recorded.events.end(), std::back_inserter(events),
               [&](const MissionEvent& e) { return e.vehicle == recorded.vehicle; });
  std::stable_sort(events.begin(), events.end(),
                   [](const MissionEvent& a, const MissionEvent& b) { return a.time < b.time; });
  return events;
}

void add_to_runs(const MissionEvent& event, std::vector<TaskRun>& runs) {
  const bool done = is_done(event.kind());
  const bool unleased =
      event.kind() == EventKind::lease_ended && event.task.kind == TaskKind::assess;
  if (!is_start(event.kind()) && !done && !unleased && event.kind() != EventKind::task_failed)
    return;
  const TaskId task = task_of(event);
  const auto last = std::find_if(runs.rbegin(), runs.rend(),
                                 [&](const TaskRun& run) { return run.task == task; });
  // Who loses the lease within an arc may fly it to its end or leave it; a new start tells.
  if (is_start(event.kind()) && last != runs.rend() && last->lease_lost && !last->done)
    last->failed = true;
  // Who is told to hold leaves its survey, and begins it anew afterwards.
  if (event.kind() == EventKind::survey_started && last != runs.rend() && last->started &&
      event.time - *last->started >= kToldTwice && !last->done)
    last->failed = true;
  const bool open = last != runs.rend() && !last->done && !last->failed && !last->cut_off;
  const bool told_again = !open && last != runs.rend() && task.kind == TaskKind::survey &&
                          last->done && event.time - *last->done < kToldTwice;
  if (!open && !told_again) {
    if (unleased || event.kind() == EventKind::task_failed) return;  // given up before it began
    runs.push_back({task, event.vehicle, event.round, {}, {}, false, {}, false, false});
  }
  TaskRun& run = open || told_again ? *last : runs.back();
  if (event.kind() == EventKind::task_failed) run.failed = true;
  if (unleased) run.lease_lost = !run.done;
  if (is_start(event.kind()) && !run.started) run.started = event.time;
  if (done && !run.done) run.done = event.time;
  const auto planned = planned_of(event);
  if (planned > Instant{}) run.planned = planned;
}

void cut_off(std::vector<TaskRun>& runs) {
  for (TaskRun& run : runs) run.cut_off = run.cut_off || (!run.done && !run.failed);
}

void clip(std::vector<Lease>& leases, Instant end) {
  for (Lease& lease : leases) lease.until = std::min(lease.until, end);
}

std::vector<AgentEnd> ends_of(const RunRecord& record, VehicleId vehicle) {
  std::vector<AgentEnd> ends;
  std::copy_if(record.agent_ends.begin(), record.agent_ends.end(), std::back_inserter(ends),
               [vehicle](const AgentEnd& e) { return e.vehicle == vehicle; });
  return ends;
}

void add_to_leases(const MissionEvent& event, std::vector<Lease>& leases) {
  const auto* granted = std::get_if<mission::event::LeaseGranted>(&event.body);
  const bool over = event.kind() == EventKind::lease_ended ||
                    event.kind() == EventKind::task_done || event.kind() == EventKind::task_failed;
  if (granted == nullptr && !over) return;
  const auto running = [&](const Lease& lease) {
    return lease.task == event.task && lease.until > event.time &&
           lease.coalition == event.round.coalition;
  };
  if (over) {
    for (Lease& lease : leases) {
      if (running(lease)) lease.until = event.time;
    }
    return;
  }
  const Instant until = granted->until;
  const auto renewed = std::find_if(leases.begin(), leases.end(), running);
  if (renewed != leases.end()) {
    renewed->until = until;
  } else {
    leases.push_back({event.vehicle, event.task, event.round.coalition, event.time, until});
  }
}

}  // namespace

std::vector<TaskRun> task_runs(const RunRecord& record) {
  std::vector<TaskRun> all;
  for (const recording::Recording& recorded : record.recordings) {
    std::vector<TaskRun> runs;
    const auto ends = ends_of(record, recorded.vehicle);
    auto end = ends.begin();
    for (const MissionEvent& event : own_events(recorded)) {
      for (; end != ends.end() && event.time > end->at; ++end) cut_off(runs);
      add_to_runs(event, runs);
    }
    if (end != ends.end()) cut_off(runs);
    all.insert(all.end(), runs.begin(), runs.end());
  }
  std::stable_sort(all.begin(), all.end(), [](const TaskRun& a, const TaskRun& b) {
    return std::tuple{a.begin(), a.vehicle} < std::tuple{b.begin(), b.vehicle};
  });
  return all;
}

std::vector<Lease> leases(const RunRecord& record) {
  std::vector<Lease> all;
  for (const recording::Recording& recorded : record.recordings) {
    std::vector<Lease> own;
    const auto ends = ends_of(record, recorded.vehicle);
    auto end = ends.begin();
    const auto clip_until = [&](Instant time) {
      for (; end != ends.end() && time > end->at; ++end) {
        if (end->restarted_at) clip(own, *end->restarted_at);
      }
    };
    for (const MissionEvent& event : own_events(recorded)) {
      clip_until(event.time);
      add_to_leases(event, own);
    }
    clip_until(Instant::max());
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

}  // namespace skein::checks
