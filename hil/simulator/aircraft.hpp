// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "skein/base/random.hpp"
#include "skein/hal/flight_controller.hpp"
#include "skein/hil/team_simulator.hpp"
#include "skein/mission/concerns.hpp"
#include "skein/mission/newest_station.hpp"
#include "skein/mission/setup_filter.hpp"
#include "skein/mission/vehicle_node.hpp"

namespace skein::hil {

/// What is left of a battery where a vehicle had flown so far.
struct SimulatedBattery {
  double percent = 100.0;
  double at_m = 0.0;
};

/// One aircraft of the simulated team: its body under its flight controller, its clock, and the
/// node on board while its program runs. Times are true mission time but for what the node is given
/// and gives.
class Aircraft {
 public:
  /// `gusts` are a multirotor's own; all fixed wings fly in the mission's wind.
  Aircraft(const TeamMission& mission, const SimulatedVehicle& what, Random gusts);

  /// From its start, with a node on board.
  void take_off(Instant now);
  [[nodiscard]] bool flying() const { return body_ != nullptr; }

  /// The program ends. The flight controller holds: an orbit where a vehicle is that follows flight
  /// plans; one that follows a track comes to rest where that ends.
  void end_program(Instant now, const std::vector<Hazard>& hazards);
  /// The program ends, and no flight controller holds: it goes on by what it has for as long as
  /// anybody looks.
  void end_with_program() {
    node_.reset();
    piloted_ = false;
  }
  /// Is there an orbit here that is clear of the hazards? True of what comes to rest.
  [[nodiscard]] bool can_hold(const std::vector<Hazard>& hazards) const;
  /// A new node that remembers nothing, in what state the vehicle is.
  void start_program(const std::vector<Hazard>& hazards, Instant now);
  /// Its pilot keeps it there: in an orbit, or where its track comes to rest. What the node gives
  /// is not flown.
  void taken_by_pilot(Instant now, const std::vector<Hazard>& hazards);
  /// The node flies it again, where it does not already.
  void given_back(Instant now);
  [[nodiscard]] bool piloted() const { return piloted_; }
  /// At once no more than that is left of its battery.
  void battery_falls(double percent) {
    if (!battery_) return;
    battery_ = SimulatedBattery{std::min(percent, battery_percent()), state_.distance_flown_m};
  }
  [[nodiscard]] bool battery_fell() const { return battery_ && battery_->percent < 100.0; }
  /// A multirotor comes down where it is then; a plane orbits on.
  void sink(Instant from) {
    if (!is_plane()) sinks_from_ = from;
  }

  /// Is that message anything to it? `start` is of the ground station that says it. Precondition:
  /// running().
  [[nodiscard]] bool heeds(const mission::Message& message, VehicleId sender, InstanceId start,
                           Instant now) {
    if (sender == kGroundStation && !station_.heeds(start)) return false;
    return mission::concerns(message, what_.number()) && setup_filter_->heeds(message, local(now));
  }

  /// Does its node go by what that other vehicle tells of where it is, now? Otherwise telemetry
  /// does no more than wake it.
  [[nodiscard]] bool watches(const mission::Telemetry& other) const;

  /// The node is told the state of this moment, or, where it is quiet, not before something else
  /// comes: then nothing is to be polled, and this is false. Precondition: running().
  bool tell_state(Instant now);
  /// Nothing happens in the node but by what comes to it.
  [[nodiscard]] bool is_quiet(Instant now) const { return local(now) < quiet_until_; }
  /// Everything that the node had brought forth by now has been polled.
  void on_polled(Instant now) { quiet_until_ = node_->quiet_until(local(now)); }
  /// For whatever comes to it. Its times are of this vehicle's clock. Precondition: running().
  [[nodiscard]] mission::VehicleNode& node();
  [[nodiscard]] bool running() const { return node_.has_value(); }
  /// Its program runs, and it can be found a leader or member of a coalition.
  [[nodiscard]] bool in_coalitions() const { return running() && !what_.flies_formation; }
  /// And it works with the others.
  [[nodiscard]] bool takes_part() const {
    return in_coalitions() && node_->bar() == mission::Bar::none && !shares_number_;
  }
  /// As it has told.
  [[nodiscard]] bool shares_number() const { return shares_number_; }
  /// Precondition: running().
  [[nodiscard]] mission::Activity activity() const { return node_->agent().telemetry().activity; }
  /// Its program runs, and has brought it down.
  [[nodiscard]] bool landed() const { return running() && activity() == mission::Activity::landed; }
  /// Precondition: running().
  [[nodiscard]] mission::Telemetry telemetry() const { return node_->agent().telemetry(); }
  /// It has come to where its newest change of formation ends, or there is none.
  [[nodiscard]] bool in_place() const;
  [[nodiscard]] std::uint32_t life() const { return life_; }  ///< counts its nodes
  [[nodiscard]] Instant local(Instant now) const { return now + clock_; }
  /// An event of the node as it is seen from outside: with its times in true mission time.
  [[nodiscard]] mission::MissionEvent seen(mission::MissionEvent event) const;
  /// The node has told that.
  void on_event(const mission::MissionEvent& event);
  [[nodiscard]] VehicleState local_state() const;

  /// It follows flight plans, on its wings or in the air.
  [[nodiscard]] bool holds_orbit() const {
    return what_.body == Body::heading_dynamics || (!what_.flies_formation && plan() != nullptr);
  }

  /// Follows what the node gives from now on.
  void follow(const mission::Guidance& guidance);
  /// One control period; false while there is nothing to follow.
  bool control(Instant now);

  [[nodiscard]] const SimulatedVehicle& what() const { return what_; }
  [[nodiscard]] const VehicleSpec& spec() const { return what_.spec; }
  /// At the last control period. Precondition: flying().
  [[nodiscard]] const VehicleState& state() const { return state_; }
  /// The same, and at its start on the ground before.
  [[nodiscard]] Vec3 position() const;
  /// As it is recorded: in true time, with numbers that grow over all nodes. Null of a vehicle in a
  /// formation, and of a copter that has not come to its height yet.
  [[nodiscard]] const mission::FlightPlan* plan() const;
  /// There is something that it follows.
  [[nodiscard]] bool is_led() const { return guidance_.has_value(); }
  /// Where a multirotor should be, and how fast; nothing while it sinks.
  [[nodiscard]] std::optional<MotionTrack::Moment> reference(Instant now) const;
  /// How far it is from where it should be.
  [[nodiscard]] double off_m(Instant now) const;
  [[nodiscard]] std::uint8_t loads_left() const { return loads_left_; }

 private:
  [[nodiscard]] mission::VehicleNodeConfig config(const std::vector<Hazard>& hazards) const;
  [[nodiscard]] std::optional<double> hold_curvature(const std::vector<Hazard>& hazards) const;
  [[nodiscard]] bool is_plane() const { return what_.body == Body::heading_dynamics; }
  [[nodiscard]] bool sinks(Instant now) const { return sinks_from_ && now >= *sinks_from_; }
  [[nodiscard]] double battery_percent() const;
  void see_state(Instant now);
  void hold_orbit(Instant now, const std::vector<Hazard>& hazards);
  void sink_at(Instant now);
  void tell_notice(bool warning, const AutopilotNotice& what, Instant now);

  // Side by side what is looked at with every message: plans and tracks are kilobytes.
  const TeamMission& mission_;
  const SimulatedVehicle& what_;
  Duration clock_{};
  Instant quiet_until_ = Instant::min();  ///< by this vehicle's clock
  std::optional<mission::VehicleNode> node_;
  std::optional<mission::SetupFilter> setup_filter_;  ///< of the node
  mission::NewestStation station_;                    ///< that the node heeds
  bool piloted_ = false;
  bool shares_number_ = false;  ///< with another vehicle, as the node has told
  std::uint32_t life_ = 0;
  std::unique_ptr<hal::FlightController> body_;
  VehicleState state_;
  std::optional<SimulatedBattery> battery_;  ///< of one to whose battery something happens
  struct Untold {
    VehicleState state;
    Instant at;
  };
  std::optional<Untold> untold_;  ///< to the node, in this vehicle's time
  Random gusts_;
  std::optional<mission::HeldGuidance> guidance_;  ///< in this vehicle's time; the recorded number
  mission::FlightPlan recorded_;
  std::uint32_t numbers_before_ = 0;  ///< plans of earlier nodes and of the flight controller
  std::optional<Instant> sinks_from_;
  std::optional<Vec2> sinks_over_m_;
  std::uint8_t loads_left_ = 0;
};

}  // namespace skein::hil
