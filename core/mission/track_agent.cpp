// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/track_agent.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "flight.hpp"
#include "return_way.hpp"
#include "skein/base/angles.hpp"
#include "skein/planning/fence_check.hpp"

namespace skein::mission {
namespace {

constexpr Duration kPeriod = std::chrono::milliseconds{50};
constexpr Duration kRangePeriod = std::chrono::seconds{1};
/// A flight that comes later than it begins is flown yet: so little lies between the two plans.
constexpr Duration kLate = std::chrono::seconds{1};
/// It begins where the plan has the vehicle that it follows, to this.
constexpr double kSamePlace_m = 1.0;
constexpr double kSameHeading_rad = 0.05;

/// Less, or more, gives no time that can be counted.
constexpr double kSpeedMin_mps = 0.1;
constexpr double kLengthMax_m = 1e7;

/// Can it be flown at all, whatever it leads to? What is asked is checked where it is planned; this
/// keeps out what was never planned.
bool flyable(const TimedPath& timed, const VehicleSpec& vehicle) {
  const double tightest = 1.0 / vehicle.turn_radius_m + 1e-9;
  const double tail = std::abs(timed.tail_curvature_per_m);
  return timed.speed_mps >= kSpeedMin_mps && timed.path.length_m() <= kLengthMax_m && tail > 0.0 &&
         tail <= tightest && timed.path.curvature_max_per_m() <= tightest &&
         !timed.path.segments.empty() && timed.paces.size() == timed.path.segments.size() + 1;
}

/// What is left of it, or a lap of the orbit at its end.
bool leads_out(const Fence& fence, const TimedPath& timed, Instant now) {
  const double begin_m = timed.distance_at(now);
  const double lap_m = kTwoPi / std::abs(timed.tail_curvature_per_m);
  const auto ahead = timed.piece(begin_m, std::max(begin_m, timed.path.length_m()) + lap_m);
  return !ahead || planning::first_outside(fence, *ahead);
}

}  // namespace

TrackAgent::TrackAgent(const TrackAgentConfig& config, Instant now)
    : config_{config},
      range_{config.vehicle},
      flight_{std::make_unique<Flight>(config.vehicle, config.avoidance, std::vector<Vec2>{})},
      hazards_{config.hazards},
      now_{now},
      next_{now},
      next_status_{now},
      next_range_{now} {
  flight_->set_fence(config.fence);
}
TrackAgent::~TrackAgent() = default;

void TrackAgent::on_state(const VehicleState& state, Instant now) {
  state_ = state;
  if (range_.on_state(state)) next_range_ = std::min(next_range_, now);
  if (!flight_->started()) flight_->start(state.pose(), hazards_.all(), range_left_m(), now);
  on_timeout(now);
}

void TrackAgent::on_message(const Message& message, VehicleId /*sender*/, Instant now) {
  if (const auto* flight = std::get_if<TrackFlight>(&message)) {
    if (flight->vehicle == config_.vehicle.id) on_flight(*flight, now);
  } else if (const auto* command = std::get_if<Command>(&message)) {
    on_command(*command, now);
  } else if (const auto* hazard = std::get_if<HazardReport>(&message)) {
    on_hazard(*hazard, now);
  } else if (const auto* way = std::get_if<ReturnFlight>(&message)) {
    if (way->vehicle == config_.vehicle.id) on_return_flight(*way, now);
  }
}

void TrackAgent::on_return_flight(const ReturnFlight& message, Instant now) {
  if (message.plan <= return_plan_ || !ordered_) return;
  const double lap_m = kTwoPi * config_.vehicle.planning_radius_m();
  const bool takes = is_way_home(message.timed, config_.vehicle, *flight_, hazards_.all(),
                                 range_left_m() - lap_m, now) &&
                     !planning::first_outside(config_.fence, message.timed);
  if (takes && flight_->return_along(message.timed, now)) return_plan_ = message.plan;
}

void TrackAgent::on_flight(const TrackFlight& flight, Instant now) {
  if (flight.number <= number_ || !flight_->started()) return;
  if (!flyable(flight.plan.timed, config_.vehicle)) {
    ++bad_flights_;
    return;
  }
  if (const auto why = why_not(flight, now)) {
    // It is sent again, and may fit then.
    if (flight.number == std::exchange(refused_, flight.number)) return;
    report(event::ChangeRefused{flight.number, *why}, now);
    return;
  }
  number_ = flight.number;
  next_flight_ = flight;
  report(event::ChangeTakenUp{flight.number}, now);
  step(now);
  say_status(now);
}

std::optional<event::ChangeRefusal> TrackAgent::why_not(const TrackFlight& flight,
                                                        Instant now) const {
  using enum event::ChangeRefusal;
  const TimedPath& timed = flight.plan.timed;
  if (bar_ != Bar::none) return setup_differs;
  if (ordered_ || range_spent_ || piloted_) return obeys_others;
  double fastest = 0.0;
  for (const double pace : timed.paces) fastest = std::max(fastest, pace * timed.speed_mps);
  if (fastest > config_.vehicle.speed_max_mps) return too_fast;
  const Pose2 here = flight_->pose_at(timed.start_time);
  const Pose2& there = timed.path.start;
  const bool elsewhere = (here.position() - there.position()).norm() > kSamePlace_m ||
                         std::abs(wrap_pi(here.heading_rad - there.heading_rad)) > kSameHeading_rad;
  if (elsewhere || now > timed.start_time + kLate) return begins_elsewhere;
  return std::nullopt;
}

void TrackAgent::begin(Instant now) {
  if (!next_flight_ || now < next_flight_->plan.timed.start_time) return;
  flown_ = *std::exchange(next_flight_, {});
  flight_->fly(flown_->plan.timed);
  arrived_ = false;
  keep_clear(now);  // of what was told since it was taken up
}

void TrackAgent::leave() {
  next_flight_.reset();
  flown_.reset();
}

void TrackAgent::on_command(const Command& command, Instant now) {
  if (!flight_->started() || !commands_.take(command, config_.vehicle.id)) return;
  // It lands by its pilot (GroundNode::command()).
  if (command.kind == CommandKind::give_back || command.kind == CommandKind::land) return;
  ordered_ = command.kind != CommandKind::resume;
  if (command.kind == CommandKind::hold) flight_->hold(hazards_.all(), now);
  if (command.kind == CommandKind::return_home) flight_->fly_home(hazards_.all(), now);
  if (ordered_) leave();
  report(event::Commanded{command.kind}, now);
}

/// It leaves the formation, and orbits until it is given a place again.
void TrackAgent::on_bar(Bar bar, Instant now) {
  bar_ = bar;
  if (bar == Bar::none || !(flown_ || next_flight_) || ordered_ || range_spent_) return;
  flight_->hold(hazards_.all(), now);
  leave();
}

/// What was flown before is nowhere near: who is given back goes on from where it is.
void TrackAgent::on_piloted(bool piloted, Instant now) {
  if (std::exchange(piloted_, piloted) == piloted || !flight_->started()) return;
  leave();
  const bool homes = flight_->homing();
  if (!piloted) flight_->begin_at(state_->pose(), now);
  if (homes) {
    flight_->fly_home(hazards_.all(), now);
  } else {
    flight_->hold(hazards_.all(), now);
  }
  step(now);
}

void TrackAgent::on_hazard(const HazardReport& told, Instant now) {
  const Hazard& hazard = told.hazard;
  if (told.withdrawn) {
    if (hazards_.withdraw(hazard.id)) report(event::HazardWithdrawn{hazard.id}, now);
    return;
  }
  if (!hazards_.add(hazard)) return;
  report(event::HazardKnown{hazard.id, hazard.radius_m}, now);
  if (flight_->started()) keep_clear(now);
}

void TrackAgent::keep_clear(Instant now) {
  if (flight_->keeps_clear(hazards_.all(), now)) return;
  leave();
  if (flight_->homing()) {
    flight_->fly_home(hazards_.all(), now);
  } else {
    flight_->hold(hazards_.all(), now);
  }
}

/// Only where nothing that it flies leads out of that one: what is flown was given by the ground
/// station, which has to give something else first.
std::string TrackAgent::keep_fence(const Fence& fence, Instant now) {
  if (config_.vehicle.height_m >= fence.height_max_m) return "its layer of height is above it";
  if (flight_->started() && leads_out(fence, flight_->plan().timed, now)) {
    return "what it flies leads out of it";
  }
  if (next_flight_ && planning::first_outside(fence, next_flight_->plan.timed)) {
    return "what it is to fly next leads out of it";
  }
  config_.fence = fence;
  flight_->set_fence(fence);
  return {};
}

void TrackAgent::on_timeout(Instant now) {
  now_ = now;
  if (now >= next_) step(now);
}

void TrackAgent::step(Instant now) {
  next_ = next_multiple(now, kPeriod);
  if (!flight_->started()) return;
  begin(now);
  if (flown_ && !arrived_ && now >= flown_->joined && off_m(now) <= config_.place_tolerance_m) {
    arrived_ = true;
    report(event::PlaceReached{flown_->number}, now);
  }
  watch_range(now);
  if (now >= next_status_) say_status(now);
}

/// What is left is for the way home, or for nothing.
void TrackAgent::watch_range(Instant now) {
  if (range_spent_ || piloted_ || now < next_range_) return;
  next_range_ = next_multiple(now, kRangePeriod);
  const double home_m = flight_->way_home_m(flight_->pose_at(now), hazards_.all());
  const double left_m = range_left_m() - home_m;
  if (left_m > config_.vehicle.cruise_speed_mps * 2.0 * to_seconds(kRangePeriod)) return;
  range_spent_ = true;
  leave();
  const bool comes_home = config_.vehicle.recovery == Recovery::home;
  if (!comes_home && !ordered_) flight_->hold(hazards_.all(), now);
  if (comes_home && !flight_->homing()) flight_->fly_home(hazards_.all(), now);
  report(event::RangeSpent{range_left_m(), comes_home, comes_home ? home_m : -1.0,
                           range_.battery_decides()},
         now);
}

double TrackAgent::off_m(Instant now) const {
  // Where it was when the state was measured.
  const Instant then = std::min(now, std::max(state_->time, now - kPeriod));
  return (flight_->pose_at(then).position() - Vec2{state_->x_m, state_->y_m}).norm();
}

bool TrackAgent::forming(Instant now) const {
  return next_flight_ || (flown_ && now < flown_->plan.timed.end_time());
}

void TrackAgent::say_status(Instant now) {
  next_status_ = next_multiple(now, config_.status_period);
  FormationStatus status;
  status.vehicle = config_.vehicle.id;
  status.position_m = {state_->x_m, state_->y_m, state_->z_m};
  const Pose2 reference = flight_->pose_at(now);
  status.reference_m = {reference.x_m, reference.y_m, config_.vehicle.height_m};
  status.progress.change = number_;
  status.progress.at = now;
  status.progress.off_m = off_m(now);
  status.at_rest = !forming(now);
  messages_.push(status);
}

std::optional<Guidance> TrackAgent::poll_guidance() {
  auto plan = flight_->poll_plan();
  if (!plan) return std::nullopt;
  return Guidance{*std::move(plan)};
}

Telemetry TrackAgent::telemetry() const {
  Telemetry telemetry;
  telemetry.capabilities = {};  // it takes no part in the work at sites
  telemetry.vehicle = config_.vehicle.id;
  telemetry.instance = config_.instance;
  if (state_) telemetry.state = *state_;
  telemetry.activity = forming(now_) ? Activity::forming : Activity::holding;
  telemetry.detail = detail();
  telemetry.range_left_m = range_left_m();
  telemetry.loads = config_.vehicle.loads;
  telemetry.plan_number = flight_->started() ? flight_->plan().number : 0;
  return telemetry;
}

ActivityDetail TrackAgent::detail() const {
  if (piloted_) return ActivityDetail::piloted;
  if (state_ && state_->on_ground()) return ActivityDetail::on_ground;
  if (!flight_->started()) return ActivityDetail::not_begun;
  if (flight_->at_home(now_)) return ActivityDetail::at_home;
  if (ordered_) return flight_->homing() ? ActivityDetail::returning : ActivityDetail::ordered;
  if (range_spent_) return ActivityDetail::range_reserve;
  return bar_ == Bar::none ? ActivityDetail::none : ActivityDetail::barred;
}

Counters TrackAgent::counters() const {
  Counters all;
  all.bad_messages = bad_flights_;
  all.messages_dropped = messages_.dropped();
  all.events_dropped = events_.dropped();
  return all;
}

void TrackAgent::report(EventBody body, Instant now) {
  MissionEvent event{config_.vehicle.id, now, {}, {}, std::move(body)};
  events_.push(event);
  messages_.push(std::move(event));
}

}  // namespace skein::mission
