// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/separation_watch.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "skein/base/angles.hpp"
#include "skein/mission/guidance.hpp"
#include "skein/mission/shown_state.hpp"

namespace skein::mission {
namespace {

/// What is not known of where a vehicle will be grows by so much: it may turn, and climb.
constexpr double kMargin_mps = 1.0;
constexpr double kHeightMargin_mps = 0.5;
constexpr double kHeightMarginMost_m = 1.0;
/// A conflict ends only beyond these.
constexpr double kClearFactor = 1.5;
constexpr double kClearHeight_m = 1.0;
/// A clock that differs by more tells nothing of the delay.
constexpr Duration kDelayMost = std::chrono::seconds{1};
/// Less apart in height, the numbers decide who goes up.
constexpr double kLevel_m = 0.5;
/// Whose height has moved away by that has begun to give way.
constexpr double kBegun_m = 1.0;
/// A climb is begun so much later than it is asked for.
constexpr double kClimbLag_s = 3.0;
/// When they are closest is known to so much.
constexpr double kAround_s = 2.0;
constexpr Duration kChosenFor = std::chrono::seconds{2};
/// While something is wrong, others are looked at that are as far away in height.
constexpr double kOthersWithin_m = 40.0;
constexpr std::size_t kEventsMax = 64;

/// Who climbs or sinks faster towards this one comes to it.
constexpr double kComes_mps = 0.7;
/// Beyond the vertical minimum: between two that give way to the same aircraft.
constexpr double kLayerRoom_m = 3.0;
/// To pass through another's layer takes so long.
constexpr double kCross_s = 8.0;
/// Who comes down sinks by as much (planes by some 5 m/s, copters by 1.5), and flies as tight a
/// turn.
constexpr double kSinksLeast_mps = 1.5;
constexpr double kSinksMost_mps = 6.0;
constexpr double kTurns_mps2 = 5.0;
/// Whoever comes down looks at heights so far below.
constexpr double kBelow_m = 50.0;
constexpr double kBelowStep_s = 0.25;
/// Who is warned so far ahead of one that comes down has given way by then.
constexpr double kGivesWayIn_s = 9.0;
constexpr double kLandsStep_s = 0.5;
constexpr double kTurnMemory_s = 0.5;
constexpr Duration kWayPeriod = std::chrono::seconds{1};
/// Who climbs back waits so long for all who may come while it passes; then for those who may come
/// before the end of that.
constexpr Duration kPatientFor = std::chrono::seconds{60};
constexpr double kCrossLeast_s = 5.0;
/// So near to it, it is back in its layer.
constexpr double kBack_m = 2.0;

Vec2 position_at(const VehicleState& state, double seconds) {
  return Vec2{state.x_m, state.y_m} + seconds * Vec2{state.velocity_mps().head<2>()};
}

/// In a turn at that rate.
Vec2 turned_at(const VehicleState& state, double radps, double seconds) {
  const double half_rad = 0.5 * radps * seconds;
  if (std::abs(half_rad) < 1e-6) return position_at(state, seconds);
  const double chord_m = state.groundspeed_mps * seconds * std::sin(half_rad) / half_rad;
  return Vec2{state.x_m, state.y_m} + chord_m * unit_vector(state.course_rad + half_rad);
}

/// The rate at which it turns over the ground, after another state; gusts turn it a little, too.
double turned_since(double radps, const VehicleState& from, const VehicleState& to) {
  const double s = to_seconds(to.time - from.time);
  if (s <= 0.0) return radps;
  const double share = std::min(1.0, s / kTurnMemory_s);
  return radps + share * (wrap_pi(to.course_rad - from.course_rad) / s - radps);
}

/// Moved on for each of those whose height it may not have, until it is free of all.
template <class Known, class Beyond>
double beyond_all(const Known& known, double height_m, const Beyond& beyond) {
  for (bool moved = true; moved;) {
    moved = false;
    for (const auto& [id, other] : known) {
      const std::optional<double> next_m = beyond(other, height_m);
      if (!next_m) continue;
      height_m = *next_m;
      moved = true;
    }
  }
  return height_m;
}

}  // namespace

SeparationWatch::SeparationWatch(const coalition::ProtocolParams& params, VehicleId self,
                                 InstanceId instance, double layer_m)
    : params_{params},
      self_{self},
      instance_{instance},
      layer_m_{layer_m},
      asked_m_{layer_m},
      base_m_{layer_m},
      way_m_{layer_m} {}

/// Lower, a vehicle takes off, or has not yet: planes wait side by side on the ground.
bool SeparationWatch::has_taken_off(const VehicleState& own) const {
  return own.z_m > 0.5 * layer_m_ || off_layer_;
}

/// Between where this one is and where it is to fly, or near to one of these.
bool SeparationWatch::on_the_way(const VehicleState& own, const VehicleState& other) const {
  const double below_m = own.z_m - other.z_m;
  if (looks_below_ && below_m > 0.0 && below_m < kBelow_m) return true;
  if (!off_layer_) return false;
  const auto [low_m, high_m] = std::minmax({own.z_m, base_m_, layer_m_});
  const double within_m = params_.separation_vertical_m + kWaits_m + kRoom_m;
  return other.z_m > low_m - within_m && other.z_m < high_m + within_m;
}

void SeparationWatch::on_telemetry(const Telemetry& other, const VehicleState& own, Instant now) {
  if (params_.separation_look_ahead == Duration{}) return;
  if (other.vehicle == self_ && other.instance == instance_) return;
  if (!has_taken_off(own)) return;
  const double apart_m = other.state.z_m - own.z_m;
  const auto found = known_.find(other.vehicle);
  if (found == known_.end()) {
    const bool near = on_the_way(own, other.state) ||
                      (any_conflict() ? std::abs(apart_m) < kOthersWithin_m
                                      : concerns(params_, apart_m, other.activity));
    if (!near || known_.size() >= kVehiclesMax) return;
  }
  Other& known = known_[other.vehicle];
  const double since_s = to_seconds(other.state.time - known.state.time);
  if (since_s > 0.0) {
    const bool is_first = found == known_.end();
    known.climb_mps = is_first ? 0.0 : (other.state.z_m - known.state.z_m) / since_s;
    known.turn_radps = is_first ? 0.0 : turned_since(known.turn_radps, known.state, other.state);
  }
  const ActivityDetail in_detail = other.detail;
  known.gives_way_too = in_detail == ActivityDetail::avoiding_traffic;
  known.piloted = is_piloted(other);
  known.instance = other.instance;
  known.state = other.state;
  known.activity = other.activity;
  known.heard = now;
  known.delay = std::clamp(now - other.state.time, Duration{}, kDelayMost);
}

bool SeparationWatch::any_conflict() const {
  return std::ranges::any_of(known_, [](const auto& entry) { return entry.second.conflict; });
}

std::optional<SeparationConflict> SeparationWatch::conflict() const {
  for (const auto& [id, other] : known_) {
    if (other.conflict) return SeparationConflict{id, other.gives_way};
  }
  return std::nullopt;
}

std::optional<EventBody> SeparationWatch::poll_event() {
  if (events_.empty()) return std::nullopt;
  EventBody first = std::move(events_.front());
  events_.pop_front();
  return first;
}

void SeparationWatch::step(const Self& self, Instant now) {
  if (last_) turn_radps_ = turned_since(turn_radps_, *last_, self.state);
  last_ = self.state;
  if (!has_taken_off(self.state)) {  // it has landed
    known_.clear();
    target_.reset();
    return;
  }
  const double wanted_m = self.height_m.value_or(layer_m_);
  if (wanted_m != asked_m_) {
    next_way_ = now;
    base_m_ = asked_m_ = wanted_m;
  }
  room_ = self.room;
  const bool is_back = std::abs(self.state.z_m - layer_m_) < kBack_m;
  off_layer_ = self.height_m || (off_layer_ && !is_back && self.activity != Activity::landing);
  climbs_back_ = climbs_back_ && off_layer_ && !self.height_m;
  look_along_way(self, now);
  for (auto& [id, other] : known_) look(id, other, self, now);
  const bool wrong = any_conflict();
  std::erase_if(known_, [&](const auto& entry) {
    const Other& other = entry.second;
    if (other.conflict) return false;
    if (now - other.heard > kForgotten) return true;
    const double apart_m = other.state.z_m - self.state.z_m;
    const bool was_told = other.told_at != Instant::min() && now - other.told_at < kToldEvery;
    return !wrong && !was_told && !concerns(params_, apart_m, other.activity) &&
           !on_the_way(self.state, other.state);
  });
  const bool yields =
      std::ranges::any_of(known_, [](const auto& entry) { return entry.second.yields; });
  if (!yields) {
    target_.reset();
  } else {
    keep_free(self, now);
  }
  go_on(self, now);
}

/// Where it is to fly, and beyond that a layer for each that is to come after it: who gives way to
/// the same aircraft is on one side of it, and would else be at one height with all others.
double SeparationWatch::with_room_for_others(const Self& self) const {
  if (!self.height_m || *self.height_m == layer_m_) return base_m_;
  const double side = *self.height_m > layer_m_ ? 1.0 : -1.0;
  const double apart_m = params_.separation_vertical_m + kLayerRoom_m;
  const double low_m = std::max(params_.separation_floor_m, room_.low_m);
  const double high_m = std::min(params_.separation_ceiling_m, room_.high_m);
  int behind = 0;
  int before = 0;
  for (const auto& [id, other] : known_) {
    if (!other.gives_way_too) continue;
    const double behind_m = side * (self.state.z_m - other.state.z_m);
    const bool is_behind = std::abs(behind_m) < kLevel_m ? id > self_ : behind_m > 0.0;
    ++(is_behind ? behind : before);
  }
  const auto beyond = [&](const Other& other, double at_m) -> std::optional<double> {
    if (other.gives_way_too || std::abs(other.state.z_m - at_m) >= apart_m - kLevel_m)
      return std::nullopt;
    return other.state.z_m + side * apart_m;
  };
  double height_m = beyond_all(known_, *self.height_m + side * behind * apart_m, beyond);
  const double end_m = side > 0.0 ? high_m : low_m;
  // Without room for all of them they stand in their order at its end.
  if (side * (height_m - end_m) > 0.0) height_m = end_m - side * before * apart_m;
  return side > 0.0 ? std::max(layer_m_, height_m) : std::min(layer_m_, height_m);
}

/// Whether it may be beside this one within that, however it turns.
bool SeparationWatch::may_come(const Self& self, const Other& other, double within_s,
                               Instant now) const {
  const double age_s = to_seconds(now - other.heard + other.delay);
  const Vec2 apart = position_at(other.state, age_s) - Vec2{self.state.x_m, self.state.y_m};
  const double speed_mps = self.state.groundspeed_mps + other.state.groundspeed_mps;
  return apart.norm() < params_.separation_horizontal_m + within_s * speed_mps;
}

bool SeparationWatch::may_be_near(const Self& self, const Other& other, Instant now) const {
  if (passes_near(approach(self, other, now))) return true;
  // Others may circle near by for good.
  const bool is_patient = !climbs_back_ || now < climbs_since_ + kPatientFor;
  return may_come(self, other, is_patient ? kCross_s : kCrossLeast_s, now);
}

/// Who came down through the heights of others does not wait in one of them.
double SeparationWatch::below_all(const Self& self, double height_m, Instant now) const {
  const double within_m = params_.separation_vertical_m + kClearHeight_m;
  const auto below = [&](const Other& other, double at_m) -> std::optional<double> {
    const bool is_off = std::abs(other.state.z_m - at_m) >= within_m;
    if (is_off || !may_be_near(self, other, now)) return std::nullopt;
    return other.state.z_m - params_.separation_vertical_m - kRoom_m;
  };
  return std::max(beyond_all(known_, height_m, below), params_.separation_floor_m);
}

/// To where it is to fly, as far as nobody passes near on the way: where it comes down, or back up,
/// through the layers of others, that costs nobody his.
void SeparationWatch::go_on(const Self& self, Instant now) {
  if (!off_layer_) {
    way_m_ = layer_m_;
    return;
  }
  if (now < next_way_) return;
  next_way_ = now + kWayPeriod;
  base_m_ = with_room_for_others(self);
  const double from_m = self.state.z_m;
  const double side = base_m_ > from_m ? 1.0 : -1.0;
  double way_m = base_m_;
  for (const auto& [id, other] : known_) {
    const bool comes = side * other.climb_mps < -kComes_mps;
    const double apart_m = params_.separation_vertical_m + (comes ? kWaits_m : kRoom_m);
    const double ahead_m = side * (other.state.z_m - from_m);
    const double beyond_m = side * (other.state.z_m - base_m_);
    if (ahead_m < 0.0 || beyond_m >= apart_m) continue;
    if (!may_be_near(self, other, now)) continue;
    const double waits_m = other.state.z_m - side * apart_m;
    const double stop_m = side * (waits_m - from_m) < 0.0 && !climbs_back_ ? from_m : waits_m;
    if (side * (stop_m - way_m) < 0.0) way_m = stop_m;
  }
  if (climbs_back_ && way_m < base_m_) way_m = below_all(self, way_m, now);
  // What it flies is not changed by the tenths of metres that it is off.
  if (way_m == base_m_ || std::abs(way_m - way_m_) >= kClearHeight_m) way_m_ = way_m;
}

bool SeparationWatch::climb_back(const VehicleState& own, double least_m, Instant now) {
  if (params_.separation_look_ahead == Duration{}) return false;
  off_layer_ = climbs_back_ = true;
  climbs_since_ = now;
  target_.reset();
  for (auto& [id, other] : known_) other.yields = false;
  way_m_ = std::min(layer_m_, std::max({own.z_m, least_m, params_.separation_floor_m}));
  next_way_ = now + kWayPeriod;  // it has heard those between by then
  return true;
}

bool SeparationWatch::is_free_below(const VehicleState& own, Turns turns, Instant now) const {
  return std::ranges::none_of(
      known_, [&](const auto& entry) { return can_be_below(own, entry.second, turns, now); });
}

bool SeparationWatch::can_be_below(const VehicleState& own, const Other& other, Turns turns,
                                   Instant now) const {
  const double below_m = own.z_m - other.state.z_m;
  // Who comes down already stays as much above or below it, or nearly.
  const bool lands = other.activity == Activity::landing && std::abs(below_m) < kBelow_m;
  if ((below_m <= 0.0 && !lands) || now - other.heard > kForgotten) return false;
  const double age_s = to_seconds(now - other.heard + other.delay);
  double look_s = to_seconds(params_.separation_look_ahead);
  if (turns == Turns::soon) look_s = std::min(look_s, kGivesWayIn_s);
  const double from_s =
      lands ? 0.0 : std::max(0.0, below_m - params_.separation_vertical_m) / kSinksMost_mps;
  const double to_s =
      lands ? look_s
            : std::min(look_s, (below_m + params_.separation_vertical_m) / kSinksLeast_mps);
  const auto near = [&](double s) {
    const double other_s = age_s + s;
    if (turns != Turns::whatever) {
      const Vec2 apart =
          turned_at(other.state, other.turn_radps, other_s) - turned_at(own, turn_radps_, s);
      return apart.norm() < kClearFactor * params_.separation_horizontal_m + kMargin_mps * other_s;
    }
    const double turned_m = 0.5 * kTurns_mps2 * (s * s + other_s * other_s);
    const Vec2 apart = position_at(other.state, other_s) - position_at(own, s);
    return apart.norm() < params_.separation_horizontal_m + turned_m;
  };
  for (int step = 0; from_s + step * kBelowStep_s <= to_s; ++step) {
    if (near(from_s + step * kBelowStep_s)) return true;
  }
  return false;
}

/// Where it will be at each step of those that nearest_s() looks at: along what it flies, where
/// that is known.
void SeparationWatch::look_along_way(const Self& self, Instant now) {
  own_ahead_.clear();
  const auto lands = [](const auto& entry) { return entry.second.activity == Activity::landing; };
  if (std::ranges::none_of(known_, lands)) return;
  const double age_s = std::clamp(to_seconds(now - self.state.time), 0.0, 1.0);
  const Vec2 here = position_at(self.state, age_s);
  const double begin_m = self.way != nullptr ? self.way->distance_at(now) : 0.0;
  const Vec2 begin = self.way != nullptr ? self.way->pose_at(now).position() : Vec2{0.0, 0.0};
  const auto at = [&](double s) -> Vec2 {
    if (self.way == nullptr) return turned_at(self.state, turn_radps_, age_s + s);
    const double flown_m = begin_m + s * self.state.groundspeed_mps;
    return here + self.way->pose_at_distance(flown_m).position() - begin;
  };
  const double look_s = to_seconds(params_.separation_look_ahead);
  for (int step = 0; step * kLandsStep_s <= look_s; ++step) {
    own_ahead_.push_back(at(step * kLandsStep_s));
  }
}

const Vec2& SeparationWatch::own_at(double seconds) const {
  const auto step = static_cast<std::size_t>(std::lround(seconds / kLandsStep_s));
  return own_ahead_[std::min(step, own_ahead_.size() - 1)];
}

SeparationWatch::Approach SeparationWatch::approach(const Self& self, const Other& other,
                                                    Instant now) const {
  const double age_s = to_seconds(now - other.heard + other.delay);
  const double own_age_s = std::clamp(to_seconds(now - self.state.time), 0.0, 1.0);
  const bool lands = other.activity == Activity::landing;
  const auto apart_at = [&](double s) -> Vec2 {
    if (!lands) {
      return position_at(other.state, age_s + s) - position_at(self.state, own_age_s + s);
    }
    return turned_at(other.state, other.turn_radps, age_s + s) - own_at(s);
  };
  // Others stay at their height, or give way; who lands comes down all the while.
  const double sinks_mps = lands ? std::max(0.0, -other.climb_mps) : 0.0;
  const auto height_at = [&](double s) { return other.state.z_m - sinks_mps * (age_s + s); };
  Approach a;
  a.in_s = lands ? nearest_s(apart_at, [&](double s) { return height_at(s) - self.state.z_m; })
                 : closest_s(self, other, apart_at(0.0));
  a.horizontal_m = apart_at(a.in_s).norm();
  a.height_m = height_at(a.in_s);
  a.around_m = sinks_mps * kAround_s;
  a.vertical_m = std::max(0.0, std::abs(a.height_m - self.state.z_m) - a.around_m);
  a.margin_m = kMargin_mps * (age_s + a.in_s);
  a.height_margin_m = std::min(kHeightMarginMost_m, kHeightMargin_mps * age_s);
  return a;
}

/// When two that fly straight on are closest.
double SeparationWatch::closest_s(const Self& self, const Other& other, const Vec2& apart) const {
  const Vec2 closing =
      Vec2{other.state.velocity_mps().head<2>()} - Vec2{self.state.velocity_mps().head<2>()};
  const double speed2 = closing.squaredNorm();
  if (speed2 <= 0.0) return 0.0;
  return std::clamp(-apart.dot(closing) / speed2, 0.0, to_seconds(params_.separation_look_ahead));
}

/// When they are nearest by their minima, as both turn and the other one comes down.
template <class Apart, class Above>
double SeparationWatch::nearest_s(const Apart& apart_at, const Above& above_at) const {
  double nearest = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (int step = 0; step * kLandsStep_s <= to_seconds(params_.separation_look_ahead); ++step) {
    const double s = step * kLandsStep_s;
    const double minima = std::max(apart_at(s).norm() / params_.separation_horizontal_m,
                                   std::abs(above_at(s)) / params_.separation_vertical_m);
    if (minima >= least) continue;
    least = minima;
    nearest = s;
  }
  return nearest;
}

bool SeparationWatch::breaks(const Approach& a) const {
  return a.horizontal_m < params_.separation_horizontal_m + a.margin_m &&
         a.vertical_m < params_.separation_vertical_m + a.height_margin_m;
}

/// Who gives way looks at all heights from its layer to where it has gone: it is to come back. Who
/// lands comes down to them.
bool SeparationWatch::still_breaks(const Approach& a, const Self& self, const Other& other) const {
  if (a.horizontal_m >= kClearFactor * params_.separation_horizontal_m + a.margin_m) return false;
  const double within_m = params_.separation_vertical_m + kClearHeight_m;
  if (!other.yields) return a.vertical_m < within_m;
  const auto [low, high] = std::minmax({base_m_, self.state.z_m, target_.value_or(base_m_)});
  const double comes_to_m = std::min(other.state.z_m, a.height_m - a.around_m);
  return other.state.z_m > low - within_m && comes_to_m < high + within_m;
}

bool SeparationWatch::passes_near(const Approach& a) const {
  return a.horizontal_m < kClearFactor * params_.separation_horizontal_m + a.margin_m;
}

void SeparationWatch::look(VehicleId id, Other& other, const Self& self, Instant now) {
  const Approach a = approach(self, other, now);
  const bool heard = now - other.heard <= (other.conflict ? kForgottenInConflict : kForgotten);
  if (!other.conflict && heard && breaks(a)) begin(other, a, now);
  if (!other.conflict) return;
  end_when_clear(id, other, heard && still_breaks(a, self, other), now);
  if (!other.conflict) return;
  decide(id, other, self, a, now);
  tell(id, other, a, now);
}

void SeparationWatch::begin(Other& other, const Approach& a, Instant now) {
  other.conflict = true;
  other.yields = other.told = false;
  other.gives_way = {};
  other.since = other.clear_since = now;
  other.apart_m = a.vertical_m;
}

void SeparationWatch::end_when_clear(VehicleId id, Other& other, bool breaks, Instant now) {
  if (breaks) {
    other.clear_since = now;
  } else if (now - other.clear_since >= kClear) {
    other.conflict = other.yields = false;
    if (std::exchange(other.told, false)) events_.emplace_back(event::SeparationRestored{id});
  }
}

void SeparationWatch::decide(VehicleId id, Other& other, const Self& self, const Approach& a,
                             Instant now) {
  if (other.yields) return;
  if (self.piloted) {
    other.gives_way = other.piloted ? VehicleId{} : id;
    return;
  }
  const bool unmoved =
      now - other.since >= kPatience && a.vertical_m < other.apart_m + kBegun_m && breaks(a);
  if (!must_yield(id, other, self, now) && !unmoved) {
    other.gives_way = id;
    return;
  }
  const auto height_m = height_for(id, other, self, now);
  // Where the other one was to, the operator is told anew, once.
  if (height_m && other.told) other.told_at = Instant::min();
  if (height_m) other.told = false;
  other.yields = height_m.has_value();
  other.gives_way = height_m ? self_ : VehicleId{};
  if (!height_m) return;
  target_ = height_m;
  chosen_at_ = now;
}

bool SeparationWatch::must_yield(VehicleId id, const Other& other, const Self& self,
                                 Instant now) const {
  const bool keeps = other.piloted || now - other.heard > kSilent ||
                     other.activity == Activity::forming || other.activity == Activity::landing;
  if (keeps) return true;
  if (self.activity == Activity::landing) return false;  // its autopilot flies it down
  const bool own_task = self.activity == Activity::executing;
  const bool other_task = other.activity == Activity::executing;
  if (own_task != other_task) return other_task;
  return std::pair{self_, instance_} > std::pair{id, other.instance};
}

void SeparationWatch::tell(VehicleId id, Other& other, const Approach& a, Instant now) {
  const bool too_soon = other.told_at != Instant::min() && now - other.told_at < kToldEvery;
  if (other.told || too_soon || events_.size() >= kEventsMax) return;
  other.told = true;
  other.told_at = now;
  events_.emplace_back(event::SeparationWarning{id, a.horizontal_m, a.vertical_m,
                                                from_seconds(a.in_s), other.gives_way});
}

/// Away from the other one; through its height only where there is no other way, and time for it.
std::optional<double> SeparationWatch::height_for(VehicleId id, const Other& other,
                                                  const Self& self, Instant now) const {
  // Who lands is not passed upwards, whatever its height will be by then.
  const bool lands = other.activity == Activity::landing;
  const Approach a = approach(self, other, now);
  const double above_m = self.state.z_m - (lands ? other.state.z_m : a.height_m);
  const bool level = std::abs(above_m) < kLevel_m;
  const bool up = level ? self_ > id : above_m > 0.0;
  if (const auto away = free_height(other, up, self, now)) return away;
  const auto through = free_height(other, !up, self, now);
  // There is no room below, and it will have come past.
  if (lands && through && self.state.z_m > a.height_m) return through;
  if (!through || level) return through;
  const double takes_s = std::abs(*through - self.state.z_m) / kHeightRate_mps + kClimbLag_s;
  return takes_s < a.in_s ? through : std::nullopt;
}

/// The nearest height on that side of the other one at which nobody else passes near.
std::optional<double> SeparationWatch::free_height(const Other& other, bool up, const Self& self,
                                                   Instant now) const {
  const double side = up ? 1.0 : -1.0;
  const double room_m = params_.separation_vertical_m + kRoom_m;
  const Approach a = approach(self, other, now);
  const auto beyond = [&](const Other& third, double at_m) -> std::optional<double> {
    const Approach its = approach(self, third, now);
    const double apart_m = params_.separation_vertical_m + its.around_m;
    if (std::abs(its.height_m - at_m) >= apart_m || !passes_near(its)) return std::nullopt;
    return its.height_m + side * (room_m + its.around_m);
  };
  const double height_m = beyond_all(known_, a.height_m + side * (room_m + a.around_m), beyond);
  const bool allowed = up ? height_m <= std::min(params_.separation_ceiling_m, room_.high_m)
                          : height_m >= std::max(params_.separation_floor_m, room_.low_m);
  return allowed ? std::optional{height_m} : std::nullopt;
}

/// Others may have come near, or changed their heights, since it was chosen.
void SeparationWatch::keep_free(const Self& self, Instant now) {
  if (now - chosen_at_ < kChosenFor || !target_) return;
  const auto bars = [&](const Other& other) {
    const Approach a = approach(self, other, now);
    return std::abs(a.height_m - *target_) < params_.separation_vertical_m + a.around_m &&
           passes_near(a);
  };
  if (std::ranges::none_of(known_, [&](const auto& entry) { return bars(entry.second); })) return;
  for (const auto& [id, other] : known_) {
    if (!other.yields) continue;
    const auto height_m = height_for(id, other, self, now);
    if (!height_m) continue;
    target_ = height_m;
    chosen_at_ = now;
    return;
  }
}

}  // namespace skein::mission
