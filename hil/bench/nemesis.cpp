// SPDX-License-Identifier: Apache-2.0
#include "nemesis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <utility>
#include <variant>

#include "second_station.hpp"
#include "skein/base/assert.hpp"

namespace skein::hil {
namespace {

std::string of(VehicleId node) { return "the program of " + name_of(node); }

}  // namespace

ChildProcess* Nemesis::running(VehicleId node) {
  const auto found = hands_.programs.find(node);
  if (found == hands_.programs.end() || is_down(node) || found->second.ended()) return nullptr;
  return &found->second;
}

bool Nemesis::begin(const Fault& fault, const std::vector<VehicleId>& who, Instant now) {
  if (std::holds_alternative<ProgramsEnd>(fault.what) && fault.lasts) {
    for (const VehicleId node : who) end(node, *fault.lasts, now);
  } else if (std::holds_alternative<ProgramsStall>(fault.what)) {
    for (const VehicleId node : who) stand_still(node, fault.lasts.value_or(Duration{}), now);
  } else if (const auto* slow = std::get_if<ProgramSlow>(&fault.what)) {
    const Instant until = fault.lasts ? now + *fault.lasts : Instant::max();
    slow_[slow->node] = {slow->stopped_share, now, until, now};
    spans_.push_back({slow->node, ProgramSpan::Kind::slow, now, until});
    hands_.say("fault: " + describe(fault));
  } else if (const auto* disk = std::get_if<DiskFull>(&fault.what)) {
    disk_full_[disk->node] = true;
    if (ChildProcess* const program = running(disk->node)) program->limit_files(kRoom_bytes);
    spans_.push_back({disk->node, ProgramSpan::Kind::disk_full, now, std::nullopt});
    hands_.say("fault: " + describe(fault));
  } else if (const auto* step = std::get_if<ClockStep>(&fault.what)) {
    clock_off_[step->vehicle] += step->by;
    hands_.say("fault: " + describe(fault));
  } else {
    return false;
  }
  return true;
}

void Nemesis::end(VehicleId node, Duration down_for, Instant now) {
  ChildProcess* const program = running(node);
  if (program == nullptr) return;
  program->signal(SIGKILL);
  start_at_[node] = now + down_for;
  stopped_.erase(node);
  if (still_until_.erase(node) > 0) span_of(node, ProgramSpan::Kind::still).until = now;
  spans_.push_back({node, ProgramSpan::Kind::down, now, std::nullopt});
  hands_.say(fmt::format("fault: {} is killed, for {:.1f} s", of(node), to_seconds(down_for)));
}

void Nemesis::stand_still(VehicleId node, Duration time, Instant now) {
  if (running(node) == nullptr) return;
  const auto [until, begins] = still_until_.emplace(node, now + time);
  until->second = std::max(until->second, now + time);
  // One stop after another is a longer one.
  if (begins) spans_.push_back({node, ProgramSpan::Kind::still, now, {}});
  span_of(node, ProgramSpan::Kind::still).until = until->second;
  set_running(node, false);
  hands_.say(fmt::format("fault: {} stands still for {:.1f} s", of(node), to_seconds(time)));
}

void Nemesis::note_gone(VehicleId node, Instant now) {
  start_at_.erase(node);
  spans_.push_back({node, ProgramSpan::Kind::gone, now, std::nullopt});
}

Result<void> Nemesis::step(Instant now) {
  for (auto at = start_at_.begin(); at != start_at_.end();) {
    const auto [node, due] = *at;
    if (now < due) {
      ++at;
      continue;
    }
    at = start_at_.erase(at);
    const auto file_bytes_max = disk_full_[node] ? std::optional{kRoom_bytes} : std::nullopt;
    if (auto up = hands_.start(node, file_bytes_max); !up) return up;
    span_of(node, ProgramSpan::Kind::down).until = now;
    hands_.say(of(node) + " starts anew");
  }
  std::erase_if(still_until_, [now](const auto& still) { return now >= still.second; });
  std::erase_if(slow_, [now](const auto& slow) { return now >= slow.second.until; });
  for (auto& [node, slow] : slow_) {
    if (stopped_[node]) slow.stopped += now - slow.seen_at;
    slow.seen_at = now;
  }
  for (const auto& [node, program] : hands_.programs) set_running(node, should_run(node, now));
  return {};
}

bool Nemesis::should_run(VehicleId node, Instant now) const {
  if (still_until_.contains(node)) return false;
  const auto found = slow_.find(node);
  if (found == slow_.end()) return true;
  const Slow& slow = found->second;
  return to_seconds(slow.stopped) >= slow.stopped_share * to_seconds(now - slow.from);
}

/// The last one of it, which has begun.
ProgramSpan& Nemesis::span_of(VehicleId node, ProgramSpan::Kind kind) {
  const auto found = std::ranges::find_if(spans_.rbegin(), spans_.rend(), [&](const auto& span) {
    return span.node == node && span.kind == kind;
  });
  SKEIN_ASSERT(found != spans_.rend());
  return *found;
}

void Nemesis::set_running(VehicleId node, bool runs) {
  ChildProcess* const program = running(node);
  if (program == nullptr) return;  // what is started anew runs
  bool& stopped = stopped_[node];
  if (stopped != runs) return;
  stopped = !runs;
  program->signal_group(runs ? SIGCONT : SIGSTOP);
}

void Nemesis::let_go() {
  slow_.clear();
  still_until_.clear();
  start_at_.clear();
  for (const auto& [node, program] : hands_.programs) set_running(node, true);
}

}  // namespace skein::hil
