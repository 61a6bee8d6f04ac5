// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>

#include "skein/base/time.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/mission/messages.hpp"

namespace skein::hil {

/// Whoever watches a run wants to be told.
[[nodiscard]] bool is_news(mission::EventKind kind);

/// How far a mission is, by what is heard of it.
class MissionWatch {
 public:
  explicit MissionWatch(const configuration::Scenario& scenario);

  /// True where it brings the mission further.
  bool on_event(const mission::MissionEvent& event);
  void on_telemetry(const mission::Telemetry& telemetry);
  /// Its programs are ended on purpose; id 0: those of the ground station.
  void on_killed(VehicleId node) { killed_.insert(node); }

  [[nodiscard]] std::size_t sites_done() const { return sites_done_.size(); }
  /// The sites, the routes and the formation's script.
  [[nodiscard]] bool work_done(Instant now) const;
  /// Nobody whose program runs is in the air any more.
  [[nodiscard]] bool all_landed() const;
  /// The work, and the landing where the scenario ends on the ground; or nobody flies any more.
  [[nodiscard]] bool over(Instant now) const;

 private:
  const configuration::Scenario& scenario_;
  Instant routes_end_ = Instant::min();  ///< the last planned one
  std::set<SiteId> sites_done_;
  bool script_done_ = false;  ///< of a formation
  bool changes_begun_ = false;
  std::set<VehicleId> moving_;  ///< in a change of the formation
  std::set<VehicleId> landed_;
  std::set<VehicleId> killed_;
};

}  // namespace skein::hil
