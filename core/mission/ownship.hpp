// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "flight.hpp"
#include "landing.hpp"
#include "skein/base/angles.hpp"
#include "skein/mission/events.hpp"
#include "skein/mission/guidance.hpp"
#include "skein/mission/range_budget.hpp"
#include "skein/mission/vehicle_agent.hpp"
#include "take_off.hpp"
#include "turn_room.hpp"

namespace skein::mission {

/// The agent's own vehicle, as its parts share it: what it is, where it is, what it follows, which
/// hazards it knows, and what is left of its range and loads.
class Ownship {
 public:
  explicit Ownship(const VehicleAgentConfig& config);

  /// The first state at its height starts the route, where the vehicle is there, else the search.
  /// False where its configuration has a route and it is elsewhere.
  bool on_state(const VehicleState& state, Instant now);
  /// Of every state, before on_state(): true where what is left of the range is another than by
  /// flying on.
  bool measures_range(const VehicleState& state) { return range_.on_state(state); }
  /// Of every state, before on_state(): true where what is planned from now on is of wider or
  /// tighter turns, or of another wind.
  bool measures_wind(const VehicleState& state);
  /// False where it is no news.
  bool on_hazard(const HazardReport& report);
  void use_load();

  [[nodiscard]] const VehicleAgentConfig& config() const { return config_; }
  [[nodiscard]] const VehicleSpec& spec() const { return config_.vehicle; }
  [[nodiscard]] const VehicleState& state() const { return state_; }
  [[nodiscard]] const std::vector<Hazard>& hazards() const { return hazards_.all(); }
  [[nodiscard]] std::uint8_t loads() const { return loads_; }
  /// Of the turns that are planned now: the vehicle's, or wider where the wind takes that.
  [[nodiscard]] double planning_radius_m() const { return turn_room_.radius_m(); }
  [[nodiscard]] bool lacks_turn_room() const { return turn_room_.lacks_room(); }
  [[nodiscard]] Flight& flight() { return flight_; }
  [[nodiscard]] const Flight& flight() const { return flight_; }

  /// It has been seen by its flight controller, and is not at its height yet.
  [[nodiscard]] bool takes_off() const {
    return spec().is_copter() && ground_m_ && !flight_.started();
  }
  /// Told over the air, before the flight has started: flown as the configuration's would be.
  void give_route(const TimedPath& route);
  /// It is not flown, where it has not been begun.
  void take_route_back();

  [[nodiscard]] std::optional<Guidance> poll_guidance();

  /// The plan is where the vehicle is, and straight on: others have flown it. Precondition:
  /// flight().started().
  void begin_here(Instant now) {
    descent_.reset();
    flight_.begin_at(begins_at(state_), now);
  }

  // Flight, around the known hazards. Precondition: flight().started().
  void search(Instant now) {
    descent_.reset();
    flight_.search(hazards(), range_to_spend(now), now);
  }
  void stand_by(SiteId site, const std::optional<Vec2>& place, Instant now) {
    flight_.stand_by(site, place, hazards(), range_to_spend(now), now);
  }
  void hold(Instant now) {
    descent_.reset();
    flight_.hold(hazards(), now);
  }
  void fly_home(Instant now) {
    descent_.reset();
    flight_.fly_home(hazards(), now);
  }
  /// A search, an orbit or a way home, from now on. False, and nothing changed, where others count
  /// with what it flies.
  bool plans_anew(Instant now);
  /// The same for the wind there is by now; who is nearly home goes around no more than it must.
  bool plans_for_wind(Instant now);
  /// Is it in its orbit at home, where the plan has it?
  [[nodiscard]] bool at_home(Instant now) const;
  /// Is it in the orbit to which its plan leads?
  [[nodiscard]] bool in_orbit(Instant now) const;
  /// From its orbit it comes down, at home or in whichever direction from here is open. False, and
  /// nothing changed, where a hazard bars that.
  bool land(Instant now);
  /// The height at which an approach to land begins, and up to which a copter is beside its place.
  [[nodiscard]] double approach_m() const {
    return ground_m_.value_or(0.0) + spec().landing.approach_height_m;
  }
  /// Comes down, or has.
  [[nodiscard]] bool landing() const { return descent_.has_value() || flight_.landing(); }
  /// Leaves its own way home for that one, where it is one that it can fly. Else false.
  bool return_along(const TimedPath& way, Instant now);
  /// Home where it is recovered there, an orbit where it is recovered anywhere.
  void come_home(Instant now);
  /// Does the plan keep clear of the hazards, if need be after a search or a way home was planned
  /// anew?
  [[nodiscard]] bool keeps_clear(Instant now);
  /// What is left of the plan, its orbit excepted, touches no hazard, though it may come near; nor
  /// need what comes after it. Of one that has just become known it keeps as far as it may be flown
  /// off in wind: what was planned around the others has that room.
  [[nodiscard]] bool way_is_open(Instant now, std::optional<HazardId> news = {}) const;
  /// Keeps that fence from now on. False, and nothing changed, where its home is outside.
  bool keep_fence(const Fence& fence);
  /// What it flies stays in its fence, if need be after a search or a way home was planned anew?
  [[nodiscard]] bool keeps_in(Instant now);
  [[nodiscard]] bool in_fence(const Vec2& point) const {
    return !config_.fence.exists() || config_.fence.inside_m(point) > 0.0;
  }
  /// Does neither that way come nearer to the fence than an aircraft is flown off its path, or than
  /// the way begins, nor a lap of the orbit at its end? Curvature 0: no orbit.
  [[nodiscard]] bool stays_in_fence(const Path& way, double orbit_curvature_per_m = 0.0) const;
  /// It is outside of its fence, or what it flies leads there within seconds.
  [[nodiscard]] bool leaves_fence(Instant now) const;
  /// Its flight controller has told where it was then, or not long before. Else nobody knows.
  [[nodiscard]] bool was_located(Instant at) const {
    return state_.time + kFlightControllerSilence >= at;
  }
  /// Of a task that was over then, and is not flown as far as anybody knows.
  [[nodiscard]] event::TaskFailed off_path(Instant over, Instant planned) const;
  /// Is it where that path has it? Then a task on it counts as flown, if it was located.
  [[nodiscard]] bool on_track(const TimedPath& timed) const;
  /// How far it is ahead of where its flight has it by now; negative where it is behind.
  [[nodiscard]] double along_m() const;
  /// Is it as far from there as an arc of that radius is flown, give or take a tenth? Nearer or
  /// farther it does not count as flown.
  [[nodiscard]] bool on_arc(const Vec2& centre, double radius_m) const;

  /// Has it what that task takes, on board and by its kind?
  [[nodiscard]] bool can(const TaskId& task) const;
  [[nodiscard]] bool comes_home() const { return spec().recovery == Recovery::home; }
  [[nodiscard]] double range_left(Instant at) const;
  /// Of an orbit.
  [[nodiscard]] double lap_m() const { return kTwoPi * planning_radius_m(); }
  /// Without the lap that is kept until it lands.
  [[nodiscard]] double range_to_spend(Instant at) const;
  /// What a task at that site may use up, so that it can come home from any end of it.
  [[nodiscard]] double range_for(const Site& site, Instant at) const;
  /// What it may use to the end of that route and on the way to it.
  [[nodiscard]] double range_for_route(const TimedPath& route, Instant at) const;
  /// What is left of its range beyond the way home, a lap and a second's flight; 0 or less: it must
  /// turn for home now.
  [[nodiscard]] double spare_m(Instant now) const;
  /// For how long that lasts, wherever it flies and however its nose points then.
  [[nodiscard]] double lasts_s(double spare_m) const;
  /// What is told when it must.
  [[nodiscard]] event::RangeSpent range_spent(Instant now) const;

  /// For the planner: the vehicle as it will be at that pose and time.
  [[nodiscard]] planning::Candidate candidate(const Pose2& pose, Instant at) const;
  /// The mean over the ground of a way between two places that takes so long and is flown at cruise
  /// speed through the air, in the wind there is (TimedPath).
  [[nodiscard]] double even_speed_mps(const Vec2& from, const Vec2& to, double seconds) const;
  /// Its times are those that are flown: in the wind there is, on time at the site, or where an arc
  /// around it begins.
  [[nodiscard]] Result<planning::TaskPlan> plan_task(const planning::Candidate& self, Instant start,
                                                     const Site& site,
                                                     const TaskAssignment& assignment) const;
  /// As a path is flown that need not be anywhere on time.
  [[nodiscard]] TimedPath in_wind(TimedPath timed) const;
  /// That the final approach of a delivery takes at most.
  [[nodiscard]] Duration approach_time() const;
  /// All but its activity.
  [[nodiscard]] Telemetry telemetry() const;

 private:
  [[nodiscard]] bool is_at_route() const;
  [[nodiscard]] Pose2 begins_at(const VehicleState& state) const;
  bool come_down(const Landing& landing);

  VehicleAgentConfig config_;
  VehicleState state_;
  RangeBudget range_;
  TurnRoom turn_room_;
  TakeOff take_off_;
  std::optional<Descent> descent_;  ///< of a copter
  std::optional<double> ground_m_;  ///< where it stood before its first flight
  Flight flight_;
  KnownHazards hazards_;
  std::uint8_t loads_;
  bool told_route_ = false;  ///< config_.route came over the air
};

}  // namespace skein::mission
