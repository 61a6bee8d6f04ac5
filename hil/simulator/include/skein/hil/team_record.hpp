// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>

#include "skein/checks/run_record.hpp"
#include "skein/hil/team_simulator.hpp"

namespace skein::hil {

/// Keeps in memory what the judges of a mission read: what the processes on the bench write to
/// files.
class TeamRecorder {
 public:
  /// `watcher` sees everything too; it must outlive the recorder.
  TeamRecorder(const TeamMission& mission, const TeamObserver& watcher);
  ~TeamRecorder() = default;
  TeamRecorder(const TeamRecorder&) = delete;
  TeamRecorder& operator=(const TeamRecorder&) = delete;

  /// For simulate_team(); refers to this recorder.
  [[nodiscard]] TeamObserver observer();
  /// After simulate_team(), with its result.
  [[nodiscard]] const checks::RunRecord& finish(const TeamResult& result);

 private:
  [[nodiscard]] recording::Recording& of(VehicleId vehicle);

  const TeamObserver& watcher_;
  std::optional<Instant> healing_;
  checks::RunRecord record_;
  std::map<VehicleId, std::size_t> index_;  ///< into record_.recordings
};

}  // namespace skein::hil
