// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/formation_agent.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "skein/domain/set_down.hpp"

namespace skein::mission {
namespace {

using formation::Change;

/// Places no higher than that are on the ground.
constexpr double kGround_m = 0.05;

Vec3 here(const VehicleState& state) { return {state.x_m, state.y_m, state.z_m}; }

/// Who waits for longer says so.
constexpr Duration kLongWait = std::chrono::seconds{3};

/// So far from its reference, one that flies the same change does not follow it.
constexpr double kFollowsWithin_m = 2.0;
/// Who stopped before another waits until that has moved by so much.
constexpr double kStirs_m = 0.3;

/// Lower than this it stands, where its flight controller does not say.
constexpr double kStands_m = 1.0;
/// Off a vertical by less, a way is one.
constexpr double kVertical_m = 0.5;

bool stands(const VehicleState& state) {
  return state.phase == FlightPhase::not_told ? state.z_m < kStands_m : state.on_ground();
}

/// Its way there is straight up from the ground, or straight down to it; else nothing.
ActivityDetail vertical(const formation::Mover& mover) {
  const Vec3 way = mover.points.back() - mover.points.front();
  if (way.head<2>().norm() > kVertical_m) return ActivityDetail::none;
  if (way.z() > 0.0 && mover.points.front().z() < kStands_m) return ActivityDetail::taking_off;
  if (way.z() < 0.0 && mover.points.back().z() < kStands_m) return ActivityDetail::setting_down;
  return ActivityDetail::none;
}

/// As far as its range goes.
VehicleSpec spec_of(const FormationAgentConfig& config) {
  VehicleSpec vehicle;
  vehicle.cruise_speed_mps = config.limits.speed_mps;
  vehicle.range_m = config.range_m;
  vehicle.battery_reserve_percent = config.battery_reserve_percent;
  return vehicle;
}

}  // namespace

FormationAgent::FormationAgent(const FormationAgentConfig& config, Instant now)
    : config_{config}, range_{spec_of(config)}, next_slot_{now}, next_status_{now} {}

void FormationAgent::on_state(const VehicleState& state, Instant now) {
  state_ = state;
  (void)range_.on_state(state);
  on_timeout(now);
}

void FormationAgent::on_message(const Message& message, VehicleId sender, Instant now) {
  if (const auto* change = std::get_if<Change>(&message)) {
    if (sender == kGroundStation) on_change(*change, now);
  } else if (const auto* status = std::get_if<FormationStatus>(&message)) {
    if (status->vehicle != sender) return;
    look_out_for(*status);
    on_status(*status, now);
  } else if (const auto* command = std::get_if<Command>(&message)) {
    if (sender == kGroundStation) on_command(*command, now);
  }
}

void FormationAgent::on_change(const Change& change, Instant now) {
  if (change.number <= number_ || !state_) return;
  if (!valid(change)) {
    ++bad_messages_;
    return;
  }
  const auto self = formation::mover_of(change, config_.vehicle);
  if (!self) return;
  if (const auto why = why_not(change, *self)) {
    // It is sent again, and may fit then.
    if (change.number == std::exchange(refused_, change.number)) return;
    report(event::ChangeRefused{change.number, *why}, now);
    return;
  }
  change_ = change;
  number_ = change.number;
  rests_at_.reset();
  stray_ahead_.reset();
  if (config_.avoidance == formation::Avoidance::field) {
    execution_ = std::make_unique<formation::FieldFlight>(change, *self, config_.field, now);
  } else {
    execution_ = std::make_unique<formation::Passage>(change, *self, config_.passage, now);
  }
  not_begun_.clear();
  for (const formation::Mover& mover : change.movers) {
    if (mover.vehicle != config_.vehicle) not_begun_.insert(mover.vehicle);
  }
  arrived_ = false;
  waits_since_.reset();
  report(event::ChangeTakenUp{change.number}, now);
  step(now);
}

std::optional<event::ChangeRefusal> FormationAgent::why_not(const Change& change,
                                                            std::size_t self) const {
  using enum event::ChangeRefusal;
  if (bar_ != Bar::none) return setup_differs;
  if (piloted_) return obeys_others;
  if (change_ && !execution_->at_rest()) return another_is_flown;
  const auto& limits = change.limits;
  if (limits.speed_mps > config_.limits.speed_mps ||
      limits.acceleration_mps2 > config_.limits.acceleration_mps2 ||
      limits.jerk_mps3 > config_.limits.jerk_mps3) {
    return too_fast;
  }
  const Vec3 apart = reference(next_slot_) - change.movers[self].points.front();
  if (apart.norm() > config_.start_tolerance_m) return begins_elsewhere;
  return std::nullopt;
}

void FormationAgent::on_status(const FormationStatus& status, Instant now) {
  if (!change_) return;
  const auto mover = formation::mover_of(*change_, status.vehicle);
  if (!mover) return;
  if (status.progress.change == change_->number) {
    not_begun_.erase(status.vehicle);
    execution_->on_progress(*mover, status.progress, status.reference_m);
  } else if (status.progress.change < change_->number) {
    // It has not taken up the change, and stays where it is: perhaps not where the change begins.
    const Vec3 from = change_->movers[*mover].points.front();
    execution_->on_progress(*mover,
                            {.change = change_->number,
                             .at = now,
                             .off_m = (status.reference_m - from).norm() + status.progress.off_m},
                            status.reference_m);
  }
}

/// Who is where nobody expects it is kept clear of by where it is, until it flies what this vehicle
/// flies. Of who does, Passage knows how far it is off, and who goes first; it does not reckon with
/// one that is flown by others.
void FormationAgent::look_out_for(const FormationStatus& status) {
  const bool flies_the_same = status.progress.change == number_;
  const double allowed_m = flies_the_same ? kFollowsWithin_m : config_.passage.tolerance_m;
  const bool is_known = !strays_.empty() && strays_.contains(status.vehicle);
  if (status.progress.off_m > allowed_m || (is_known && !flies_the_same)) {
    strays_[status.vehicle] = status.position_m;
  } else if (is_known && status.progress.off_m <= config_.passage.tolerance_m) {
    strays_.erase(status.vehicle);
  }
}

/// To whom of them what it flies now, should it brake, leads too near, and nearer than it is. What
/// the vehicle itself may be off is allowed for, what the other is off is known; and no more than
/// changes keep of who does not move (FormationGround).
std::optional<FormationAgent::Stray> FormationAgent::nears() const {
  if (config_.avoidance != formation::Avoidance::passage) return std::nullopt;
  const formation::Separation& apart = change_->separation;
  const double until_next_m = change_->limits.speed_mps * to_seconds(2 * formation::kSlot);
  const double least_m =
      std::min(apart.horizontal_m, apart.horizontal_m - config_.passage.tolerance_m + until_next_m);
  const double factor = height_factor(apart);
  const auto near = std::ranges::find_if(strays_, [&](const auto& stray) {
    const auto distance_m = [&](const MotionTrack::Point& point) {
      Vec3 between = Vec3{point.position_m.data()} - stray.second;
      between.z() *= factor;
      return between.norm();
    };
    const auto points = std::span{track_->points}.first(track_->count);
    const double now_m = distance_m(points.front());
    return std::ranges::any_of(points, [&](const MotionTrack::Point& point) {
      const double then_m = distance_m(point);
      return then_m < least_m && then_m < now_m;
    });
  });
  if (near == strays_.end()) return std::nullopt;
  return Stray{near->first, near->second};
}

bool FormationAgent::is_there_yet(const Stray& stray) const {
  const auto found = strays_.find(stray.vehicle);
  return found != strays_.end() && (found->second - stray.place).norm() < kStirs_m;
}

void FormationAgent::on_command(const Command& command, Instant now) {
  if (!commands_.take(command, config_.vehicle)) return;
  // What else there is, is not for it: it knows no way home (GroundAgent::command()).
  const bool holds = command.kind == CommandKind::hold;
  if (!holds && command.kind != CommandKind::resume) return;
  held_ = holds;
  report(event::Commanded{command.kind}, now);
}

void FormationAgent::on_bar(Bar bar, Instant /*now*/) { bar_ = bar; }

void FormationAgent::on_piloted(bool piloted, Instant now) {
  if (std::exchange(piloted_, piloted) == piloted || !state_) return;
  if (piloted) {
    if (!change_ && !rests_at_) rests_at_ = here(*state_);
  } else {
    rests_at_ = here(*state_);
    change_.reset();
    execution_.reset();
    not_begun_.clear();
    stray_ahead_.reset();
    track_ = MotionTrack::standing_at(*rests_at_, now);
  }
  step(now);
}

void FormationAgent::on_timeout(Instant now) {
  if (now >= next_slot_) step(now);
}

Vec3 FormationAgent::reference(Instant now) const {
  if (change_) return execution_->reference(now).position_m;
  return rests_at_.value_or(here(*state_));
}

double FormationAgent::off_m(Instant now) const {
  if (!state_) return 0.0;
  // Where it was when the state was measured.
  const Instant then = std::min(now, std::max(state_->time, now - formation::kSlot));
  Vec3 place = reference(then);
  const auto self = change_ ? formation::mover_of(*change_, config_.vehicle) : std::nullopt;
  if (self && change_->movers[*self].points.back().z() <= kGround_m) {
    // On its way down: as its autopilot leads it, or as its place sinks.
    const double led_m = led_down({.height_m = place.z()}).height_m;
    place.z() = std::clamp(state_->z_m, place.z(), std::max(place.z(), led_m));
  }
  return (here(*state_) - place).norm();
}

void FormationAgent::step(Instant now) {
  next_slot_ = next_multiple(now, formation::kSlot);
  const double off = off_m(now);
  if (change_) {
    execution_->set_off(off);
    execution_->hold(waits());
    execution_->step(now);
    track_ = execution_->track();
    if (!stray_ahead_ || !is_there_yet(*stray_ahead_)) stray_ahead_ = nears();
    if (!arrived_ && execution_->finished()) {
      arrived_ = true;
      report(event::PlaceReached{change_->number}, now);
    }
    tell_of_wait(now);
  }
  if (!state_ || now < next_status_) return;
  next_status_ = next_multiple(now, config_.status_period);
  FormationStatus status;
  status.vehicle = config_.vehicle;
  status.position_m = here(*state_);
  status.reference_m = reference(now);
  if (change_) {
    status.progress = execution_->progress();
    status.at_rest = execution_->at_rest();
  }
  status.progress.off_m = off;
  messages_.push(status);
}

void FormationAgent::tell_of_wait(Instant now) {
  const bool rests = !execution_->finished() && execution_->at_rest() && now >= change_->start;
  const bool waits = rests && !piloted_;
  if (!waits) {
    waits_since_.reset();
    return;
  }
  if (!waits_since_) waits_since_ = now;
  if (now - *waits_since_ < kLongWait) return;
  waits_since_ = Instant::max();  // it is said once
  event::Waiting waiting{change_->number};
  if (!not_begun_.empty()) {
    waiting.what = event::WaitsFor::beginning;
    waiting.vehicle = *not_begun_.begin();
  } else if (stray_ahead_) {
    waiting.what = event::WaitsFor::passing;
    waiting.vehicle = stray_ahead_->vehicle;
  } else if (const auto other = execution_->waits_for()) {
    waiting.what = event::WaitsFor::passing;
    waiting.vehicle = change_->movers[*other].vehicle;
  }
  report(waiting, now);
}

std::optional<Guidance> FormationAgent::poll_guidance() {
  if (!track_) return std::nullopt;  // what is not there is kilobytes to copy, too
  return std::exchange(track_, {});
}

Telemetry FormationAgent::telemetry() const {
  Telemetry telemetry;
  telemetry.capabilities = {};  // it takes no part in the work at sites
  telemetry.vehicle = config_.vehicle;
  telemetry.instance = config_.instance;
  if (state_) telemetry.state = *state_;
  telemetry.range_left_m = range_.left_m();
  const bool moving = change_ && !piloted_ && !execution_->finished();
  telemetry.activity = moving ? Activity::forming : Activity::holding;
  telemetry.detail = detail(moving);
  telemetry.plan_number = change_ ? change_->number : 0;
  return telemetry;
}

ActivityDetail FormationAgent::detail(bool moving) const {
  if (piloted_) return ActivityDetail::piloted;
  if (!moving && state_ && stands(*state_)) return ActivityDetail::on_ground;
  if (held_) return ActivityDetail::ordered;
  if (bar_ != Bar::none) return ActivityDetail::barred;
  if (!moving) return ActivityDetail::none;
  return vertical(change_->movers[*formation::mover_of(*change_, config_.vehicle)]);
}

Counters FormationAgent::counters() const {
  Counters all;
  all.bad_messages = bad_messages_;
  all.messages_dropped = messages_.dropped();
  all.events_dropped = events_.dropped();
  return all;
}

void FormationAgent::report(EventBody body, Instant now) {
  MissionEvent event{config_.vehicle, now, {}, {}, std::move(body)};
  events_.push(event);
  messages_.push(std::move(event));
}

}  // namespace skein::mission
