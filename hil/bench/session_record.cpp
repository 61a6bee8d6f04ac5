// SPDX-License-Identifier: Apache-2.0
#include "session_record.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <set>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "site_reports.hpp"
#include "skein/base/contains.hpp"
#include "skein/hil/excuses.hpp"
#include "skein/hil/fault.hpp"
#include "skein/recording/log.hpp"
#include "skein/recording/reader.hpp"

namespace skein::hil {
namespace {

using recording::Recording;
using recording::TrackPoint;
using Kind = ProgramSpan::Kind;

/// Without a point of its own for so long, a track is what the aircraft's simulator says.
constexpr Duration kOwnGap = std::chrono::milliseconds{250};
/// A program that stands still for less flies on as if it had not.
constexpr Duration kBorne = std::chrono::seconds{1};

bool leaves_less(const ProgramSpan& span) {
  return span.kind == Kind::down || span.kind == Kind::gone || span.kind == Kind::disk_full;
}

/// Of how many programs of the node the start was before that.
std::size_t session_at(const BenchOutcome& outcome, VehicleId node, Instant time) {
  return static_cast<std::size_t>(std::ranges::count_if(outcome.spans, [&](const auto& span) {
    return span.node == node && span.kind == Kind::down && span.until && *span.until <= time;
  }));
}

void add_session(const recording::SessionRecording& session, Duration clock_off, Recording& whole) {
  const std::uint32_t numbers_before = whole.plans.empty() ? 0 : whole.plans.back().number;
  for (const auto& event : session.recording.events) {
    whole.events.push_back(shifted(event, -clock_off));
  }
  for (recording::PlanRecord plan : session.recording.plans) {
    plan.number += numbers_before;
    plan.since -= clock_off;
    plan.plan.start_time -= clock_off;
    whole.plans.push_back(plan);
  }
  for (TrackPoint point : session.recording.track) {
    point.state.time -= clock_off;
    point.plan_number += numbers_before;
    whole.track.push_back(point);
  }
  whole.damaged_parts += session.recording.damaged_parts;
  whole.places.insert(whole.places.end(), session.recording.places.begin(),
                      session.recording.places.end());
}

/// Adds points of `truth` where `track` has none.
void fill(std::vector<TrackPoint>& track, const std::vector<TrackPoint>& truth) {
  if (track.empty()) return;
  std::vector<TrackPoint> filled;
  auto there = truth.begin();
  const auto add_until = [&](Instant end) {
    for (; there != truth.end() && there->state.time < end; ++there) {
      if (filled.empty() || there->state.time <= filled.back().state.time) continue;
      TrackPoint point = *there;
      point.plan_number = filled.back().plan_number;
      point.state.airspeed_mps = filled.back().state.airspeed_mps;
      point.state.distance_flown_m = filled.back().state.distance_flown_m;
      filled.push_back(point);
    }
  };
  for (const TrackPoint& point : track) {
    const bool first = filled.empty();
    if (!first && point.state.time <= filled.back().state.time) continue;  // of a clock set back
    if (!first && point.state.time - filled.back().state.time > kOwnGap) {
      add_until(point.state.time);
    }
    filled.push_back(point);
  }
  add_until(Instant::max());
  track = std::move(filled);
}

/// A ground station has no record of what it has granted since its disk is full; vehicles have, and
/// fly by none that it has not signed.
void add_grants_heard(checks::RunRecord& record, Instant full_since) {
  for (const Recording& recorded : record.recordings) {
    for (mission::MissionEvent event : recorded.events) {
      if (event.kind() != mission::EventKind::authorised || event.time < full_since) continue;
      event.vehicle = kGroundStation;
      record.ground_events.push_back(std::move(event));
    }
  }
  std::ranges::stable_sort(record.ground_events, {}, &mission::MissionEvent::time);
}

}  // namespace

Recording whole_recording(const std::filesystem::path& run_folder, VehicleId node,
                          const BenchOutcome& outcome) {
  Recording whole;
  whole.vehicle = node;
  std::vector<Duration> clock_off;
  std::set<std::vector<std::uint8_t>> recorded;
  for (const auto& session :
       recording::read_sessions(run_folder / recording::folder_name(node), node)) {
    clock_off.emplace_back(outcome.epoch_unix_ns - session.session.epoch_unix_ns);
    for (const auto& event : session.recording.events) {
      recorded.insert(recording::bytes_of(event));
    }
    add_session(session, clock_off.back(), whole);
  }
  for (const auto& heard : outcome.heard) {
    if (heard.event.vehicle != node || !recorded.insert(recording::bytes_of(heard.event)).second) {
      continue;
    }
    const std::size_t session = session_at(outcome, node, heard.at);
    const Duration off =
        clock_off.empty() ? Duration{} : clock_off[std::min(session, clock_off.size() - 1)];
    whole.events.push_back(shifted(heard.event, -off));
  }
  std::ranges::stable_sort(whole.events, {}, &mission::MissionEvent::time);
  const auto of_node = [&](const ProgramSpan& span) {
    return span.node == node && leaves_less(span);
  };
  if (std::ranges::any_of(outcome.spans, of_node)) whole.damaged_parts = 0;
  return whole;
}

void add_faults_done(checks::RunRecord& record, const BenchOutcome& outcome) {
  for (const ProgramSpan& span : outcome.spans) {
    if (span.node == kGroundStation) continue;
    if (span.kind == Kind::down || span.kind == Kind::gone) {
      record.agent_ends.push_back({span.node, span.from, span.until});
    }
    // Short stops, and being slow, are what a program must bear.
    const bool is_short = span.until && *span.until - span.from < kBorne;
    if (span.kind != Kind::disk_full && span.kind != Kind::slow && !is_short) {
      const checks::LeftAlone alone{span.node, span.from,
                                    span.until.value_or(outcome.ended_at + std::chrono::hours{1})};
      record.left_alone.push_back(alone);
      if (span.kind == Kind::still) record.stood_still.push_back(alone);
    }
  }
  std::ranges::stable_sort(record.agent_ends, {}, &checks::AgentEnd::at);
  const auto full = std::ranges::find_if(outcome.spans, [](const ProgramSpan& span) {
    return span.node == kGroundStation && span.kind == Kind::disk_full;
  });
  if (full != outcome.spans.end()) add_grants_heard(record, full->from);
  for (Recording& recorded : record.recordings) {
    const auto of_it = [&](const ProgramSpan& span) { return span.node == recorded.vehicle; };
    if (std::ranges::none_of(outcome.spans, of_it)) continue;
    const auto* truth = checks::recording_of(record.truths, recorded.vehicle);
    if (truth != nullptr) fill(recorded.track, truth->track);
  }
  if (!outcome.healed_at) return;
  std::vector<VehicleEnd> ends;
  for (const VehicleSpec& vehicle : record.vehicles) {
    VehicleEnd end;
    end.vehicle = vehicle.id;
    end.gone = contains(outcome.killed, vehicle.id);
    const auto last = outcome.last.find(vehicle.id);
    if (last != outcome.last.end()) {
      end.barred = is_barred(last->second);
      end.loads = last->second.loads;
    }
    ends.push_back(end);
  }
  record.excused = excuses(record, ends);
}

}  // namespace skein::hil
