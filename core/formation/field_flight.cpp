// SPDX-License-Identifier: Apache-2.0
#include "skein/formation/field_flight.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/assert.hpp"
#include "skein/base/shortened.hpp"

namespace skein::formation {
namespace {

constexpr double kAtGoal_m = 0.02;
/// Nearer than that to its place it heeds nobody: pushed and pulled, it would circle it for ever.
constexpr double kAlmost_m = 0.25;
constexpr double kLanded_m = 1e-9;
constexpr double kSlot_s = to_seconds(kSlot);
constexpr Duration kTooOldForAVelocity = std::chrono::seconds{1};

/// Also of times before mission time 0.
std::int64_t slot_of(Instant t) {
  const Duration since = t.time_since_epoch();
  const std::int64_t slot = since / kSlot;
  return since < slot * kSlot ? slot - 1 : slot;
}

double way_m(const Mover& mover) { return (mover.points.back() - mover.points.front()).norm(); }

Vec3 braked(const Vec3& velocity_mps, const MotionLimits& limits) {
  return velocity_mps - shortened(velocity_mps, limits.acceleration_mps2 * kSlot_s);
}

/// The field pulls a vehicle with neighbours through its goal faster than it could stop there.
/// Towards the goal it flies as fast as half its deceleration lets it stop, and at most half the
/// way in a slot.
Vec3 slow_enough(const FieldSelf& self, const Vec3& wanted_mps, const MotionLimits& limits) {
  const Vec3 way_m = self.goal_m - self.position_m;
  const double distance_m = way_m.norm();
  if (distance_m <= 0.0) return wanted_mps;
  const Vec3 ahead = way_m / distance_m;
  const double fast_mps =
      wanted_mps.dot(ahead) -
      std::min(std::sqrt(limits.acceleration_mps2 * distance_m), 0.5 * distance_m / kSlot_s);
  if (fast_mps <= 0.0) return wanted_mps;
  const Vec3 change_mps = wanted_mps - fast_mps * ahead - self.velocity_mps;
  return self.velocity_mps + shortened(change_mps, limits.acceleration_mps2 * kSlot_s);
}

}  // namespace

FieldFlight::FieldFlight(const Change& change, std::size_t self, const FieldParams& params,
                         Instant now)
    : number_{change.number},
      params_{params},
      limits_{change.limits},
      start_{change.start},
      self_index_{self},
      next_position_m_{change.movers.at(self).points.front()},
      others_(change.movers.size()),
      slot_{slot_of(now)} {
  SKEIN_ASSERT(valid(change));
  double longest_m = 0.0;
  for (std::size_t i = 0; i < others_.size(); ++i) {
    const Mover& mover = change.movers[i];
    others_[i].last.id = mover.vehicle;
    others_[i].goal_m = mover.points.back();
    longest_m = std::max(longest_m, way_m(mover));
  }
  const Mover& own = change.movers[self];
  self_.id = own.vehicle;
  self_.position_m = own.points.front();
  self_.goal_m = own.points.back();
  self_.arrival_share = longest_m > 0.0 ? std::max(1e-3, way_m(own) / longest_m) : 1.0;
  neighbours_.reserve(others_.size());
  plan_slot(wanted_velocity());
}

void FieldFlight::on_progress(std::size_t mover, const Progress& progress,
                              const Vec3& reference_m) {
  if (mover >= others_.size() || mover == self_index_ || progress.change != number_) return;
  Other& other = others_[mover];
  if (other.heard && progress.at <= other.at) return;
  const Duration since = progress.at - other.at;
  other.last.velocity_mps = other.heard && since <= kTooOldForAVelocity
                                ? Vec3{(reference_m - other.last.position_m) / to_seconds(since)}
                                : Vec3::Zero();
  other.last.position_m = reference_m;
  other.last.at_goal = (reference_m - other.goal_m).norm() <= kAtGoal_m;
  other.at = progress.at;
  other.heard = true;
}

Vec3 FieldFlight::wanted_velocity() {
  if (held_ || finished_ || slot_begin() < start_) return braked(self_.velocity_mps, limits_);
  if (const auto landing_mps = landing_velocity()) return *landing_mps;
  const Vec3 way_m = self_.goal_m - self_.position_m;
  neighbours_.clear();
  for (const Other& other : others_) {
    if (!other.heard || way_m.norm() <= kAlmost_m) continue;
    neighbours_.push_back(other.last);
    neighbours_.back().age_s = std::max(0.0, to_seconds(slot_begin() - other.at));
  }
  return slow_enough(self_, field_velocity(params_, limits_, self_, neighbours_, kSlot_s), limits_);
}

void FieldFlight::plan_slot(const Vec3& next_velocity_mps) {
  next_velocity_mps_ = next_velocity_mps;
  next_position_m_ = self_.position_m + 0.5 * kSlot_s * (self_.velocity_mps + next_velocity_mps_);
  const bool lands =
      next_velocity_mps_.isZero(0.0) && (self_.goal_m - next_position_m_).norm() <= kLanded_m;
  if (lands) next_position_m_ = self_.goal_m;
}

/// The velocity at the end of this slot from which it is at rest in its place at the end of the
/// next one; zero where it comes to rest there in this one. None where that is beyond its limits.
std::optional<Vec3> FieldFlight::landing_velocity() const {
  const Vec3 way_m = self_.goal_m - self_.position_m;
  if (way_m.norm() > kAtGoal_m) return std::nullopt;
  const Vec3& now_mps = self_.velocity_mps;
  const double change_mps = limits_.acceleration_mps2 * kSlot_s;
  if (now_mps.norm() <= change_mps && (way_m - 0.5 * kSlot_s * now_mps).norm() <= kLanded_m) {
    return Vec3::Zero();
  }
  Vec3 next_mps = way_m / kSlot_s - 0.5 * now_mps;
  if (next_mps.norm() > change_mps || (next_mps - now_mps).norm() > change_mps) return std::nullopt;
  return next_mps;
}

void FieldFlight::step(Instant now) {
  for (const std::int64_t current = slot_of(now); slot_ < current;) {
    self_.position_m = next_position_m_;
    self_.velocity_mps = next_velocity_mps_;
    finished_ = self_.position_m == self_.goal_m;
    ++slot_;
    // In a slot that is over what was told last has braked.
    plan_slot(slot_ == current ? wanted_velocity() : braked(self_.velocity_mps, limits_));
  }
}

Progress FieldFlight::progress() const { return {.change = number_, .at = slot_begin()}; }

MotionTrack::Moment FieldFlight::reference(Instant now) const {
  if (now > slot_begin() + kSlot) return track().at(now);
  const double t = std::clamp(to_seconds(now - slot_begin()), 0.0, kSlot_s);
  const Vec3 acceleration = (next_velocity_mps_ - self_.velocity_mps) / kSlot_s;
  return {self_.position_m + t * self_.velocity_mps + 0.5 * t * t * acceleration,
          self_.velocity_mps + t * acceleration, acceleration};
}

MotionTrack FieldFlight::track() const {
  MotionTrack track;
  track.number = number_;
  track.start = slot_begin();
  Vec3 position_m = self_.position_m;
  Vec3 velocity_mps = self_.velocity_mps;
  Vec3 next_mps = next_velocity_mps_;
  while (true) {
    auto& out = track.points.at(track.count++);
    for (int axis = 0; axis < 3; ++axis) {
      out.position_m.at(static_cast<std::size_t>(axis)) = position_m[axis];
      out.velocity_mps.at(static_cast<std::size_t>(axis)) = velocity_mps[axis];
    }
    const bool rests = velocity_mps.isZero(0.0) && next_mps.isZero(0.0);
    if (rests || track.count == MotionTrack::kPointsMax) return track;
    position_m += 0.5 * kSlot_s * (velocity_mps + next_mps);
    velocity_mps = next_mps;
    next_mps = braked(next_mps, limits_);
  }
}

bool FieldFlight::at_rest() const {
  return finished_ || (self_.velocity_mps.isZero(0.0) && next_velocity_mps_.isZero(0.0));
}

}  // namespace skein::formation
