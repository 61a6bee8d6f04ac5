// SPDX-License-Identifier: Apache-2.0
#include "aircraft.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "multirotor_body.hpp"
#include "skein/hal/simulated_flight_controller.hpp"
#include "skein/hal/simulated_multirotor.hpp"
#include "skein/onboard/node_config.hpp"

namespace skein::hil {
namespace {

/// An orbit in wind is flown some metres off its circle.
constexpr double kOrbitClearance_m = 15.0;
constexpr double kOrbitClearance_s = 2.0;  ///< by the wind's speed
constexpr double kSink_mps = 1.0;
/// A vehicle's height may change by that before it hears what is being said.
constexpr double kHeightOnTheWay_m = 1.0;
constexpr Duration kTelemetryPeriod = std::chrono::milliseconds{200};

/// A number for an instance that no other life of any vehicle has.
InstanceId instance(VehicleId vehicle, std::uint32_t life) {
  return {static_cast<std::uint64_t>(life) << 32U | vehicle.value};
}

std::unique_ptr<hal::FlightController> body_of(const TeamMission& mission,
                                               const SimulatedVehicle& what, const Random& gusts,
                                               Instant now) {
  if (what.body == Body::heading_dynamics) {
    return std::make_unique<hal::SimulatedFlightController>(what.spec, what.start, mission.wind,
                                                            now);
  }
  if (what.body == Body::multirotor) {
    return std::make_unique<MultirotorBody>(what.start, mission.gust_error_m, gusts, now);
  }
  hal::SimulatedMultirotorParams params;
  params.start = {what.start.x_m, what.start.y_m, 0.0};
  params.yaw_rad = what.start.heading_rad;
  params.wind_mps = mission.wind.steady_mps;
  params.gust_mps = mission.wind.gust_mps;
  params.seed = mission.seed + what.spec.id.value;
  return std::make_unique<hal::SimulatedMultirotor>(params);
}

}  // namespace

Aircraft::Aircraft(const TeamMission& mission, const SimulatedVehicle& what, Random gusts)
    : mission_{mission},
      what_{what},
      clock_{clock_offset(mission.faults, what.spec.id)},
      gusts_{gusts},
      loads_left_{what.spec.loads} {
  const auto is_its_battery = [&what](const Fault& fault) {
    const auto* falls = std::get_if<BatteryFalls>(&fault.what);
    return falls != nullptr && falls->vehicle == what.spec.id;
  };
  if (std::ranges::any_of(mission.faults, is_its_battery)) battery_ = SimulatedBattery{};
}

void Aircraft::take_off(Instant now) {
  body_ = body_of(mission_, what_, gusts_, now);
  see_state(now);
  start_program(hazards_known_at(mission_.hazards, now), now);
}

mission::VehicleNodeConfig Aircraft::config(const std::vector<Hazard>& hazards) const {
  configuration::VehicleConfig config;
  config.vehicle = what_.spec;
  config.vehicle.id = what_.number();
  config.vehicle.loads = loads_left_;
  config.search = what_.search;
  config.protocol = mission_.protocol;
  config.traffic = mission_.traffic;
  config.planning = mission_.planning;
  config.hazards = hazards;
  config.fence = mission_.fence;
  if (what_.flies_formation) config.formation = *mission_.formation;
  auto node = onboard::node_config(config, std::nullopt, instance(what_.spec.id, life_),
                                   "skein-hil simulate");
  if (auto* agent = std::get_if<mission::VehicleAgentConfig>(&node.agent)) {
    agent->heeds_wind = mission_.heeds_wind;
  }
  // As a node in the field paces it where the air has its price; else as ever.
  if (!mission_.radio.bytes_per_s) node.telemetry = {kTelemetryPeriod, kTelemetryPeriod};
  node.setup.common.clear();  // of one configuration: only clocks can differ
  return node;
}

void Aircraft::start_program(const std::vector<Hazard>& hazards, Instant now) {
  numbers_before_ = recorded_.number;
  const auto of_node = config(hazards);
  node_.emplace(of_node, local(now));
  setup_filter_.emplace(of_node.setup, what_.number());
  station_ = {};
  shares_number_ = false;
  quiet_until_ = Instant::min();
  untold_.reset();
  sinks_from_.reset();  // it is led again
  sinks_over_m_.reset();
}

bool Aircraft::watches(const mission::Telemetry& other) const {
  if (!running() || what_.flies_formation) return false;
  if (other.vehicle == what_.number()) return true;  // not its own: nobody hears himself
  const double apart_m = other.state.z_m - state_.z_m;
  const double above_m =
      std::copysign(std::max(0.0, std::abs(apart_m) - kHeightOnTheWay_m), apart_m);
  return node_->agent().watches_others() ||
         mission::SeparationWatch::concerns(mission_.protocol, above_m, other.activity);
}

bool Aircraft::tell_state(Instant now) {
  untold_.emplace(local_state(), local(now));
  if (is_quiet(now)) return false;
  (void)node();
  return true;
}

mission::VehicleNode& Aircraft::node() {
  if (untold_) node_->on_state(untold_->state, untold_->at);
  untold_.reset();
  return *node_;
}

bool Aircraft::in_place() const {
  if (!running()) return true;
  if (const auto* plane = dynamic_cast<const mission::TrackAgent*>(&node_->agent())) {
    return plane->in_place();
  }
  const auto* agent = dynamic_cast<const mission::FormationAgent*>(&node_->agent());
  return agent == nullptr || agent->execution() == nullptr || agent->execution()->finished();
}

std::optional<double> Aircraft::hold_curvature(const std::vector<Hazard>& hazards) const {
  const double radius = what_.spec.planning_radius_m();
  const double clearance_m =
      kOrbitClearance_m + kOrbitClearance_s * mission_.wind.steady_mps.norm();
  const Pose2 here = state_.pose_over_ground();
  for (const double side : {1.0, -1.0}) {
    const Vec2 centre = here.position() + side * radius * left_of(unit_vector(here.heading_rad));
    const bool clear = std::all_of(hazards.begin(), hazards.end(), [&](const Hazard& h) {
      return std::abs((h.centre - centre).norm() - radius) > h.radius_m + clearance_m;
    });
    if (clear) return side / radius;
  }
  return std::nullopt;
}

bool Aircraft::can_hold(const std::vector<Hazard>& hazards) const {
  return !holds_orbit() || hold_curvature(hazards).has_value();
}

void Aircraft::end_program(Instant now, const std::vector<Hazard>& hazards) {
  end_with_program();
  ++life_;
  if (holds_orbit()) hold_orbit(now, hazards);
}

void Aircraft::taken_by_pilot(Instant now, const std::vector<Hazard>& hazards) {
  piloted_ = true;
  if (holds_orbit()) {
    hold_orbit(now, hazards);
    ++numbers_before_;
  }
  tell_notice(true, {.news = AutopilotNews::mode_changed, .detail = "LOITER"}, now);
}

void Aircraft::given_back(Instant now) {
  if (!std::exchange(piloted_, false)) return;
  tell_notice(false, {.news = AutopilotNews::flying}, now);
}

/// With the state of that moment, as control tells it first.
void Aircraft::tell_notice(bool warning, const AutopilotNotice& what, Instant now) {
  untold_.emplace(local_state(), local(now));
  node().on_notice({local(now), warning, what}, local(now));
}

void Aircraft::hold_orbit(Instant now, const std::vector<Hazard>& hazards) {
  mission::FlightPlan orbit = recorded_;
  ++orbit.number;
  orbit.timed = {};
  orbit.height_from_m = orbit.height_to_m = mission::height_offset_m(recorded_, now);
  orbit.timed.start_time = local(now);
  orbit.timed.speed_mps = what_.spec.cruise_speed_mps;
  orbit.timed.path.start = state_.pose_over_ground();
  orbit.timed.tail_curvature_per_m =
      hold_curvature(hazards).value_or(1.0 / what_.spec.planning_radius_m());
  guidance_.emplace(orbit);
  recorded_ = orbit;
  recorded_.timed.start_time = now;
}

mission::MissionEvent Aircraft::seen(mission::MissionEvent event) const {
  event.vehicle = what_.spec.id;
  return shifted(std::move(event), -clock_);
}

void Aircraft::on_event(const mission::MissionEvent& event) {
  const auto* trouble = std::get_if<mission::event::VehicleTrouble>(&event.body);
  const bool shares = trouble != nullptr && trouble->trouble == mission::event::Trouble::id_in_use;
  shares_number_ = shares_number_ || shares;
  if (event.kind() == mission::EventKind::task_started && event.task.kind == TaskKind::deliver) {
    loads_left_ = loads_left_ > 0 ? loads_left_ - 1 : 0;
  }
}

VehicleState Aircraft::local_state() const {
  VehicleState state = state_;
  state.time += clock_;
  return state;
}

void Aircraft::follow(const mission::Guidance& guidance) {
  if (piloted_) return;
  mission::Guidance numbered = guidance;
  if (auto* const plan = std::get_if<mission::FlightPlan>(&numbered)) {
    plan->number += numbers_before_;
    recorded_ = *plan;
    recorded_.timed.start_time -= clock_;
    recorded_.height_since -= clock_;
  }
  guidance_.emplace(numbered);
}

/// As an autopilot lands: over one place, whatever gusts do.
void Aircraft::sink_at(Instant now) {
  if (!sinks_over_m_) sinks_over_m_ = state_.position().horizontal();
  PositionSetpoint down;
  down.x_m = sinks_over_m_->x();
  down.y_m = sinks_over_m_->y();
  down.z_m = state_.z_m;
  down.vz_mps = -kSink_mps;
  body_->command(down, now);
}

double Aircraft::battery_percent() const {
  const double share = (state_.distance_flown_m - battery_->at_m) / what_.spec.range_m;
  const double used = (100.0 - what_.spec.battery_reserve_percent) * share;
  return std::max(0.0, battery_->percent - used);
}

void Aircraft::see_state(Instant now) {
  state_ = *body_->state(now);
  if (battery_) state_.battery_percent = static_cast<std::uint8_t>(battery_percent());
  const bool is_of_coalition = !is_plane() && !what_.flies_formation;
  if (is_of_coalition && plan() != nullptr && state_.z_m <= MultirotorBody::kAirborne_m) {
    state_.phase = FlightPhase::disarmed;
  }
}

bool Aircraft::control(Instant now) {
  see_state(now);
  if (sinks(now)) {
    sink_at(now);
    return true;
  }
  if (!guidance_) return false;
  body_->command(mission::follow(*guidance_, {}, what_.spec, local_state(), local(now)), now);
  return true;
}

const mission::FlightPlan* Aircraft::plan() const {
  return recorded_.number > 0 ? &recorded_ : nullptr;
}

Vec3 Aircraft::position() const {
  return flying() ? state_.position().metres() : Vec3{what_.start.x_m, what_.start.y_m, 0.0};
}

double Aircraft::off_m(Instant now) const {
  if (is_plane()) {
    if (!flying() || plan() == nullptr) return 0.0;
    return (recorded_.timed.pose_at(now).position() - state_.position().horizontal()).norm();
  }
  const auto where = reference(now);
  return where ? (position() - where->position_m).norm() : 0.0;
}

std::optional<MotionTrack::Moment> Aircraft::reference(Instant now) const {
  if (sinks(now)) return std::nullopt;
  if (!guidance_) return MotionTrack::Moment{.position_m = {what_.start.x_m, what_.start.y_m, 0.0}};
  const auto* track = std::get_if<MotionTrack>(&guidance_->guidance);
  if (track == nullptr) return std::nullopt;
  return track->at(local(now));
}

}  // namespace skein::hil
