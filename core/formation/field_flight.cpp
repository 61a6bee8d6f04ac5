// SPDX-License-Identifier: Apache-2.0
#include "skein/formation/field_flight.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/assert.hpp"
#include "skein/base/shortened.hpp"

namespace skein::formation {
namespace {

constexpr double kAtGoal_m = 0.02;
constexpr double kSlot_s = to_seconds(kSlot);
constexpr Duration kTooOldForAVelocity = std::chrono::seconds{1};

double way_m(const Mover& mover) { return (mover.points.back() - mover.points.front()).norm(); }

Vec3 braked(const Vec3& velocity_mps, const MotionLimits& limits) {
  return velocity_mps - shortened(velocity_mps, limits.acceleration_mps2 * kSlot_s);
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
      slot_{now.time_since_epoch() / kSlot} {
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
  decide();
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

void FieldFlight::decide() {
  const Vec3 now_mps = self_.velocity_mps;
  if (held_ || finished_ || slot_begin() < start_) {
    next_velocity_mps_ = braked(now_mps, limits_);
  } else if ((self_.goal_m - self_.position_m).norm() <= kAtGoal_m) {
    next_position_m_ = self_.goal_m;
    next_velocity_mps_ = Vec3::Zero();
    return;
  } else {
    neighbours_.clear();
    for (const Other& other : others_) {
      if (!other.heard) continue;
      neighbours_.push_back(other.last);
      neighbours_.back().age_s = std::max(0.0, to_seconds(slot_begin() - other.at));
    }
    next_velocity_mps_ = field_velocity(params_, limits_, self_, neighbours_, kSlot_s);
  }
  next_position_m_ = self_.position_m + 0.5 * kSlot_s * (now_mps + next_velocity_mps_);
}

void FieldFlight::step(Instant now) {
  for (const std::int64_t current = now.time_since_epoch() / kSlot; slot_ < current;) {
    self_.position_m = next_position_m_;
    self_.velocity_mps = next_velocity_mps_;
    finished_ = self_.position_m == self_.goal_m;
    ++slot_;
    decide();
  }
}

Progress FieldFlight::progress() const { return {.change = number_, .at = slot_begin()}; }

MotionTrack::Moment FieldFlight::reference(Instant now) const {
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
