// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "skein/groundstation/command_desk.hpp"
#include "skein/groundstation/formation_desk.hpp"
#include "skein/hil/team_simulator.hpp"
#include "skein/mission/ground_node.hpp"

namespace skein::hil {

/// A ground station of the simulated team, while its program runs: who decides about the sites, and
/// who commands the formation, where there is one; of several it does that while it has the
/// command. Times are true mission time, and so are those of its events.
class GroundStation {
 public:
  /// `number` is 0 where it is alone. The first of several takes the command where nobody has it.
  GroundStation(const TeamMission& mission, const TeamObserver& observer, std::uint16_t number);

  /// Of what was before it knows what the real one recalls from its recording, and the lines of the
  /// script that are done: the operator goes on with the next. Precondition: the script can be read
  /// (check_script()).
  void start(Instant now);
  void end();
  [[nodiscard]] bool running() const { return node_.has_value(); }
  /// Precondition: running().
  [[nodiscard]] const mission::GroundNode& node() const { return *node_; }
  [[nodiscard]] bool commands() const { return node_ && command_->is_commanding(); }
  /// As which start of the ground station it speaks. Precondition: running().
  [[nodiscard]] InstanceId start_number() const { return start_; }
  /// The operator does. False where the program does not run, or has the command.
  bool take_command(Instant now);

  /// The operator withdraws that site, or the newest that detectors have seen. False where nothing
  /// is known of it yet.
  bool withdraw(const std::optional<SiteId>& site, Instant now);

  /// The operator takes a grant back. False where there is none yet that long, or none any more.
  bool take_back(const GrantTakenBack& what, Instant now);

  /// The operator gives those routes. False where the ground station does not run, or refuses.
  bool give(const RoutesOrdered& order, Instant now);
  /// A plan was given, and nobody is told of it any more.
  [[nodiscard]] bool routes_over() const {
    return node_ && node_->routes().given() && node_->routes().given()->over;
  }

  // As of an agent.
  void on_message(const mission::Message& message, VehicleId sender, InstanceId start, Instant now);
  void on_timeout(Instant now);
  /// A receiver beside it hears that aircraft.
  void on_aircraft(mission::Aircraft aircraft, Instant now);
  /// Of the operator, who gives it while it has the command. False where it has not, or refuses.
  bool command(VehicleId vehicle, mission::CommandKind kind, Instant now) {
    return commands() && node_->command(vehicle, kind, now + clock_).ok();
  }
  [[nodiscard]] std::optional<mission::Message> poll_message(Instant now);
  [[nodiscard]] std::optional<mission::MissionEvent> poll_event();

 private:
  [[nodiscard]] InstanceId next_start() const;
  void take(Instant at);
  void keep_command(Instant at);
  void record(const mission::Message& message, VehicleId sender, Instant at);
  [[nodiscard]] bool is_told_elsewhere(const mission::MissionEvent& event) const;

  const TeamMission& mission_;
  const TeamObserver& observer_;
  std::vector<VehicleId> formation_;
  Duration clock_;
  std::optional<mission::GroundNode> node_;
  std::uint16_t number_;
  std::optional<groundstation::CommandDesk> command_;  ///< of the node
  InstanceId start_;
  std::optional<groundstation::FormationDesk> desk_;
  std::size_t script_done_ = 0;  ///< lines, of desks before this one
  struct Recorded {
    mission::Message message;
    VehicleId sender;
    Instant at{};
  };
  bool starts_anew_;  ///< some time, by a fault: otherwise nothing is recorded
  std::vector<Recorded> recorded_;
};

}  // namespace skein::hil
