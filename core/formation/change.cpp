// SPDX-License-Identifier: Apache-2.0
#include "skein/formation/change.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"

namespace skein::formation {
namespace {

/// Where a least distance is searched for.
constexpr double kExact_m = 5e-3;
/// What rounding makes of equal heights.
constexpr double kLevel_m = 1e-9;
/// Of a smooth climb (3 x^2 - 2 x^3): its slope half way up, and how it bends at its ends, as
/// height / way and height / way^2.
constexpr double kSteepest = 1.5;
constexpr double kSharpest = 6.0;

Vec2 flat(const Vec3& v) { return {v.x(), v.y()}; }

Vec3 stretched(Vec3 v, double height_factor) {
  v.z() *= height_factor;
  return v;
}

/// In [0, 2 pi); what rounding has made of no turn stays none.
double full_turn(double angle_rad) {
  constexpr double kNone = 1e-9;
  const double wrapped = wrap_pi(angle_rad);
  return wrapped < -kNone ? wrapped + 2.0 * kPi : std::max(0.0, wrapped);
}

}  // namespace

std::optional<std::size_t> mover_of(const Change& change, VehicleId vehicle) {
  const auto& movers = change.movers;
  const auto found = std::find_if(movers.begin(), movers.end(),
                                  [vehicle](const Mover& m) { return m.vehicle == vehicle; });
  if (found == movers.end()) return std::nullopt;
  return static_cast<std::size_t>(found - movers.begin());
}

ChangeMotion::ChangeMotion(const Change& change)
    : movers_{change.movers.size()}, roundabout_{change.roundabout}, speed_max_(movers_, 0.0) {
  SKEIN_ASSERT(valid(change));
  legs_.reserve(change.stages * movers_);
  for (std::size_t s = 0; s < change.stages; ++s) {
    double longest = 0.0;
    double bend_per_m = 0.0;  // the sharpest
    for (const Mover& mover : change.movers) {
      legs_.push_back(leg_between(mover.points[s], mover.points[s + 1], mover.level));
      longest = std::max(longest, legs_.back().length_m);
      const Leg& leg = legs_.back();
      if (leg.bent) bend_per_m = std::max(bend_per_m, 1.0 / change.roundabout->radius_m);
      if (leg.over_m > 0.0) {
        bend_per_m = std::max(bend_per_m, kSharpest * leg.over_m / (leg.climb_m * leg.climb_m));
      }
    }
    MotionLimits limits = change.limits;
    if (bend_per_m > 0.0) {
      // Turning takes its share of the acceleration, where nobody speeds up any more.
      limits.speed_mps =
          std::min(limits.speed_mps, std::sqrt(limits.acceleration_mps2 / bend_per_m));
    }
    stages_.push_back({duration_, MotionProfile{longest, limits}});
    duration_ += from_seconds(stages_.back().profile.duration_s());
    for (std::size_t i = 0; i < movers_ && longest > 0.0; ++i) {
      const double share = leg(i, s).length_m / longest;
      speed_max_[i] = std::max(speed_max_[i], share * stages_.back().profile.speed_max_mps());
    }
  }
}

ChangeMotion::Leg ChangeMotion::leg_between(const Vec3& from, const Vec3& to,
                                            std::uint8_t level) const {
  Leg leg{.from = from, .to = to, .length_m = (to - from).norm()};
  if (level == 0 || !roundabout_) return leg;
  const Vec2& centre = roundabout_->centre;
  const double radius = roundabout_->radius_m;
  if (distance_to_segment(centre, flat(from), flat(to)) >= radius) return leg;
  const Vec2 in = flat(from) - centre;
  const Vec2 out = flat(to) - centre;
  const double before = std::acos(std::min(1.0, radius / in.norm()));
  const double after = std::acos(std::min(1.0, radius / out.norm()));
  leg.bent = true;
  leg.in_m = std::sqrt(std::max(0.0, in.squaredNorm() - radius * radius));
  leg.rim_rad = std::atan2(in.y(), in.x()) + before;
  leg.arc_m = radius * full_turn(std::atan2(out.y(), out.x()) - after - leg.rim_rad);
  const double out_m = std::sqrt(std::max(0.0, out.squaredNorm() - radius * radius));
  leg.flat_m = leg.in_m + leg.arc_m + out_m;
  leg.over_m = (level - 1) * roundabout_->level_m;
  if (leg.over_m > 0.0) leg.climb_m = std::min({roundabout_->climb_m, leg.in_m, out_m});
  leg.length_m = std::hypot(leg.flat_m, rise_m(leg));
  return leg;
}

/// By share of the leg, at most.
double ChangeMotion::rise_m(const Leg& leg) {
  const double straight_m = std::abs(leg.to.z() - leg.from.z());
  if (leg.over_m == 0.0) return straight_m;
  return straight_m + kSteepest * leg.over_m * leg.flat_m / leg.climb_m;
}

ChangeMotion::Climb ChangeMotion::climb_at(const Leg& leg, double along_m) {
  if (leg.over_m == 0.0) return {};
  const double left_m = leg.flat_m - along_m;
  const double x = std::min(along_m, left_m) / leg.climb_m;
  if (x >= 1.0) return {.height_m = leg.over_m};
  const double mean = leg.over_m / leg.climb_m;
  return {.height_m = leg.over_m * x * x * (3.0 - 2.0 * x),
          .slope = (along_m < left_m ? 6.0 : -6.0) * mean * x * (1.0 - x),
          .bend_per_m = kSharpest * mean / leg.climb_m * (1.0 - 2.0 * x)};
}

std::size_t ChangeMotion::stage_at(Duration plan_time) const {
  std::size_t stage = 0;
  while (stage + 1 < stages_.size() && plan_time >= stages_[stage + 1].begin) ++stage;
  return stage;
}

Vec3 ChangeMotion::on_leg(const Leg& leg, double share) const {
  if (!leg.bent) return leg.from + share * (leg.to - leg.from);
  const double along = share * leg.flat_m;
  const double radius = roundabout_->radius_m;
  const auto rim = [&](double angle) -> Vec2 {
    return roundabout_->centre + radius * unit_vector(angle);
  };
  Vec2 where;
  if (along < leg.in_m) {
    where = flat(leg.from) + along / leg.in_m * (rim(leg.rim_rad) - flat(leg.from));
  } else if (along <= leg.in_m + leg.arc_m) {
    where = rim(leg.rim_rad + (along - leg.in_m) / radius);
  } else {
    const Vec2 last = rim(leg.rim_rad + leg.arc_m / radius);
    const double out_m = leg.flat_m - leg.in_m - leg.arc_m;
    where = last + (along - leg.in_m - leg.arc_m) / out_m * (flat(leg.to) - last);
  }
  const double line_m = leg.from.z() + share * (leg.to.z() - leg.from.z());
  return {where.x(), where.y(), line_m + climb_at(leg, along).height_m};
}

Vec3 ChangeMotion::position(std::size_t mover, Duration plan_time) const {
  const std::size_t s = stage_at(plan_time);
  const MotionProfile& profile = stages_[s].profile;
  if (profile.length_m() == 0.0) return leg(mover, s).from;
  const double way = profile.at(to_seconds(plan_time - stages_[s].begin)).distance_m;
  return on_leg(leg(mover, s), way / profile.length_m());
}

ChangeMotion::Point ChangeMotion::at(std::size_t mover, Duration plan_time) const {
  const std::size_t s = stage_at(plan_time);
  const Leg& way = leg(mover, s);
  const MotionProfile& profile = stages_[s].profile;
  if (profile.length_m() == 0.0 || way.length_m == 0.0) return {.position_m = way.from};
  const auto motion = profile.at(to_seconds(plan_time - stages_[s].begin));
  const double share = motion.distance_m / profile.length_m();
  const double pace = way.length_m / profile.length_m();
  const double speed = pace * motion.speed_mps;
  const double gain = pace * motion.acceleration_mps2;
  Point point{.position_m = on_leg(way, share)};
  if (!way.bent) {
    const Vec3 along = (way.to - way.from) / way.length_m;
    point.velocity_mps = speed * along;
    point.acceleration_mps2 = gain * along;
    return point;
  }
  const double along_m = share * way.flat_m;
  const double turned = std::clamp(along_m - way.in_m, 0.0, way.arc_m) / roundabout_->radius_m;
  const Vec2 along = left_of(unit_vector(way.rim_rad + turned));
  const bool on_rim = along_m > way.in_m && along_m < way.in_m + way.arc_m;
  const double level = way.flat_m / way.length_m;  // share of the speed that does not climb
  const Climb up = climb_at(way, along_m);
  const double climb = (way.to.z() - way.from.z()) / way.length_m + level * up.slope;
  const double flat_speed = level * speed;
  const double inward = on_rim ? flat_speed * flat_speed / roundabout_->radius_m : 0.0;
  const Vec2 gained = level * gain * along + inward * left_of(along);
  point.velocity_mps = {flat_speed * along.x(), flat_speed * along.y(), speed * climb};
  point.acceleration_mps2 = {gained.x(), gained.y(),
                             gain * climb + up.bend_per_m * flat_speed * flat_speed};
  return point;
}

double ChangeMotion::least_distance_m(std::size_t a, std::size_t b, double height_factor,
                                      double enough) const {
  double least = stretched(leg(a, 0).from - leg(b, 0).from, height_factor).norm();
  for (std::size_t s = 0; s < stages_.size() && least >= enough; ++s) {
    least = std::min(least, least_on_stage(s, a, b, height_factor, enough));
  }
  return least;
}

double ChangeMotion::least_on_stage(std::size_t stage, std::size_t a, std::size_t b,
                                    double height_factor, double enough) const {
  const Leg& first = leg(a, stage);
  const Leg& second = leg(b, stage);
  Known known{.enough = enough};
  if (!first.bent && !second.bent) {
    look_between(first, second, 0.0, 1.0, height_factor, known);
    return known.least;
  }
  // Where one of them changes from line to rim or back, or reaches its level or leaves it.
  std::array<double, 10> shares{0.0, 1.0};
  std::size_t count = 2;
  for (const Leg* leg : {&first, &second}) {
    if (!leg->bent) continue;
    for (const double metres :
         {leg->in_m, leg->in_m + leg->arc_m, leg->climb_m, leg->flat_m - leg->climb_m}) {
      shares.at(count++) = std::min(1.0, metres / leg->flat_m);
    }
  }
  const auto end = shares.begin() + static_cast<std::ptrdiff_t>(count);
  std::sort(shares.begin(), end);
  for (auto share = shares.begin(); share != end; ++share) {
    known.least = std::min(known.least, apart(first, second, *share, height_factor).norm());
  }
  for (auto to = shares.begin() + 1; to != end && known.least >= enough; ++to) {
    if (*(to - 1) == *to) continue;
    look_between(first, second, *(to - 1), *to, height_factor, known);
  }
  return known.exact ? known.least : std::max(0.0, known.least - kExact_m);
}

Vec3 ChangeMotion::apart(const Leg& first, const Leg& second, double share,
                         double height_factor) const {
  return stretched(on_leg(first, share) - on_leg(second, share), height_factor);
}

void ChangeMotion::look_between(const Leg& first, const Leg& second, double from, double to,
                                double height_factor, Known& known) const {
  const auto on_rim = [&](const Leg& leg) {
    const double middle = 0.5 * (from + to) * leg.flat_m;
    return leg.bent && middle > leg.in_m && middle < leg.in_m + leg.arc_m;
  };
  const auto climbs = [&](const Leg& leg) {
    const double middle = 0.5 * (from + to) * leg.flat_m;
    return leg.over_m > 0.0 && std::min(middle, leg.flat_m - middle) < leg.climb_m;
  };
  const Vec3 begin = apart(first, second, from, height_factor);
  const Vec3 end = apart(first, second, to, height_factor);
  const bool straight = !on_rim(first) && !on_rim(second);
  const bool turning = on_rim(first) && on_rim(second);
  const bool smooth = climbs(first) || climbs(second);
  if (straight && !smooth) {
    // Both go the same share of their ways at the same time: the one sees the other go straight.
    const Vec3 way = end - begin;
    const double squared = way.squaredNorm();
    const double share = squared > 0.0 ? std::clamp(-begin.dot(way) / squared, 0.0, 1.0) : 0.0;
    known.least = std::min(known.least, (begin + share * way).norm());
    return;
  }
  const auto angle_between = [&](double share) {
    return first.rim_rad - second.rim_rad +
           (share * (first.flat_m - second.flat_m) - first.in_m + second.in_m) /
               roundabout_->radius_m;
  };
  if (turning && !smooth && std::abs(begin.z() - end.z()) < kLevel_m &&
      std::floor(angle_between(from) / kPi) == std::floor(angle_between(to) / kPi)) {
    // The angle between them grows or falls evenly, and neither meets nor passes the other: the
    // least is at an end, and known.
    return;
  }
  // From a distance d it takes (d - least) / pace to come below the least one so far, where no
  // distance changes faster by share: of two straight ways evenly but for their heights, of two on
  // the rim by the angle between them, of others by both lengths.
  const double share = to - from;
  const double up = smooth ? height_factor * (rise_m(first) + rise_m(second))
                           : std::abs(end.z() - begin.z()) / share;
  double flat_pace = first.length_m + second.length_m;
  if (straight) flat_pace = (end - begin).head<2>().norm() / share;
  if (turning) flat_pace = std::abs(first.flat_m - second.flat_m);
  const double pace = std::hypot(flat_pace, up);
  if (begin.norm() + end.norm() - pace * (to - from) >= 2.0 * known.least) return;
  known.exact = false;
  for (double at = from; at < to && known.least >= known.enough;) {
    const double d = apart(first, second, at, height_factor).norm();
    known.least = std::min(known.least, d);
    at += (d - known.least + kExact_m) / pace;
  }
}

namespace {

/// Nothing takes so long, and what does cannot be counted in grains.
constexpr double kLongestLeg_s = 1e5;
constexpr double kJerkMin_mps3 = 1e-2;

bool valid(const Roundabout& roundabout) {
  const auto counts = [](double number) { return std::isfinite(number) && number >= 0.0; };
  return counts(roundabout.radius_m) && roundabout.radius_m > 0.0 &&
         roundabout.centre.allFinite() && counts(roundabout.level_m) && counts(roundabout.climb_m);
}

double over_m(const Roundabout& roundabout, const Mover& mover) {
  return (mover.level - 1) * roundabout.level_m;
}

/// From a point to where its level is reached; negative inside the rim.
double climb_m(const Roundabout& roundabout, const Vec3& point) {
  const double squared =
      (flat(point) - roundabout.centre).squaredNorm() - roundabout.radius_m * roundabout.radius_m;
  return squared < 0.0 ? -1.0 : std::min(roundabout.climb_m, std::sqrt(squared));
}

/// Outside the rim, and from there as far to it as it is up to its level.
bool has_room(const Roundabout& roundabout, const Mover& mover, const Vec3& point) {
  return climb_m(roundabout, point) >= over_m(roundabout, mover);
}

/// What turns and climbs let be flown.
double speed_around_mps(const Change& change, const Mover& mover) {
  const double acceleration_mps2 = change.limits.acceleration_mps2;
  const double speed_mps =
      std::min(change.limits.speed_mps, std::sqrt(acceleration_mps2 * change.roundabout->radius_m));
  if (mover.level < 2 || change.roundabout->level_m == 0.0) return speed_mps;
  double shortest_m = change.roundabout->climb_m;
  for (const Vec3& point : mover.points) {
    shortest_m = std::min(shortest_m, climb_m(*change.roundabout, point));
  }
  const double sharp_m = kSharpest * over_m(*change.roundabout, mover);
  return std::min(speed_mps, shortest_m * std::sqrt(acceleration_mps2 / sharp_m));
}

bool flown_in_time(const Change& change, const Mover& mover) {
  double speed_mps = change.limits.speed_mps;
  double detour_m = 0.0;
  if (change.roundabout) {  // whoever goes around it slows the others too
    speed_mps = speed_around_mps(change, mover);
    detour_m = 4.0 * kPi * change.roundabout->radius_m;
  }
  // By has_room() no climb is steeper.
  const double steepness = mover.level > 1 ? 1.0 + kSteepest : 1.0;
  for (std::size_t i = 0; i + 1 < mover.points.size(); ++i) {
    const double way_m = steepness * ((mover.points[i + 1] - mover.points[i]).norm() + detour_m);
    if (!(way_m <= kLongestLeg_s * speed_mps)) return false;
  }
  return true;
}

}  // namespace

bool valid(const Change& change) {
  const auto good = [](double number) { return std::isfinite(number) && number > 0.0; };
  if (change.stages == 0 || change.stages > kStagesMax || change.movers.empty()) return false;
  if (!good(change.limits.speed_mps) || !good(change.limits.acceleration_mps2) ||
      !good(change.limits.jerk_mps3) || !good(change.separation.horizontal_m) ||
      !good(change.separation.vertical_m)) {
    return false;
  }
  if (change.limits.speed_mps > kStopWithin_s * change.limits.acceleration_mps2) return false;
  if (change.limits.jerk_mps3 < kJerkMin_mps3) return false;
  if (change.roundabout && !valid(*change.roundabout)) return false;
  std::set<VehicleId> seen;
  for (const Mover& mover : change.movers) {
    if (!seen.insert(mover.vehicle).second || mover.points.size() != change.stages + 1)
      return false;
    for (const Vec3& point : mover.points) {
      if (!point.allFinite()) return false;
      if (mover.level > 0 && change.roundabout && !has_room(*change.roundabout, mover, point)) {
        return false;
      }
    }
    if (!flown_in_time(change, mover)) return false;
  }
  return true;
}

}  // namespace skein::formation
