// SPDX-License-Identifier: Apache-2.0
#include "skein/formation/change.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"

namespace skein::formation {
namespace {

/// Where a least distance is searched for.
constexpr double kExact_m = 5e-3;

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
    bool bends = false;
    for (const Mover& mover : change.movers) {
      legs_.push_back(leg_between(mover.points[s], mover.points[s + 1], mover.around));
      longest = std::max(longest, legs_.back().length_m);
      bends = bends || legs_.back().bent;
    }
    MotionLimits limits = change.limits;
    if (bends) {
      // Turning takes its share of the acceleration, where nobody speeds up any more.
      limits.speed_mps = std::min(
          limits.speed_mps, std::sqrt(limits.acceleration_mps2 * change.roundabout->radius_m));
    }
    stages_.push_back({duration_, MotionProfile{longest, limits}});
    duration_ += from_seconds(stages_.back().profile.duration_s());
    for (std::size_t i = 0; i < movers_ && longest > 0.0; ++i) {
      const double share = leg(i, s).length_m / longest;
      speed_max_[i] = std::max(speed_max_[i], share * stages_.back().profile.speed_max_mps());
    }
  }
}

ChangeMotion::Leg ChangeMotion::leg_between(const Vec3& from, const Vec3& to, bool around) const {
  Leg leg{.from = from, .to = to, .length_m = (to - from).norm()};
  if (!around || !roundabout_) return leg;
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
  leg.flat_m = leg.in_m + leg.arc_m + std::sqrt(std::max(0.0, out.squaredNorm() - radius * radius));
  leg.length_m = std::hypot(leg.flat_m, to.z() - from.z());
  return leg;
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
  return {where.x(), where.y(), leg.from.z() + share * (leg.to.z() - leg.from.z())};
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
  const double climb = (way.to.z() - way.from.z()) / way.length_m;
  const double flat_speed = level * speed;
  const double inward = on_rim ? flat_speed * flat_speed / roundabout_->radius_m : 0.0;
  const Vec2 gained = level * gain * along + inward * left_of(along);
  point.velocity_mps = {flat_speed * along.x(), flat_speed * along.y(), speed * climb};
  point.acceleration_mps2 = {gained.x(), gained.y(), gain * climb};
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
  // Up to where neither changes from line to rim or back.
  const auto onward = [&](double from) {
    double to = 1.0;
    for (const Leg* leg : {&first, &second}) {
      if (!leg->bent) continue;
      for (const double metres : {leg->in_m, leg->in_m + leg->arc_m}) {
        const double share = metres / leg->flat_m;
        if (share > from) to = std::min(to, share);
      }
    }
    return to;
  };
  double least = std::numeric_limits<double>::infinity();
  for (double from = 0.0; from < 1.0 && least >= enough;) {
    const double to = onward(from);
    least = std::min(least, least_between(first, second, from, to, height_factor, enough));
    from = to;
  }
  return least;
}

double ChangeMotion::least_between(const Leg& first, const Leg& second, double from, double to,
                                   double height_factor, double enough) const {
  const auto apart = [&](double share) {
    return stretched(on_leg(first, share) - on_leg(second, share), height_factor);
  };
  const auto on_rim = [&](const Leg& leg) {
    const double middle = 0.5 * (from + to) * leg.flat_m;
    return leg.bent && middle > leg.in_m && middle < leg.in_m + leg.arc_m;
  };
  const Vec3 begin = apart(from);
  if (!on_rim(first) && !on_rim(second)) {
    // Both go the same share of their ways at the same time: the one sees the other go straight.
    const Vec3 way = apart(to) - begin;
    const double squared = way.squaredNorm();
    const double share = squared > 0.0 ? std::clamp(-begin.dot(way) / squared, 0.0, 1.0) : 0.0;
    return (begin + share * way).norm();
  }
  const auto angle_between = [&](double share) {
    return first.rim_rad - second.rim_rad +
           (share * (first.flat_m - second.flat_m) - first.in_m + second.in_m) /
               roundabout_->radius_m;
  };
  if (on_rim(first) && on_rim(second) && begin.z() == 0.0 && apart(to).z() == 0.0 &&
      std::floor(angle_between(from) / kPi) == std::floor(angle_between(to) / kPi)) {
    // The angle between them grows or falls evenly, and neither meets nor passes the other.
    return std::min(begin.norm(), apart(to).norm());
  }
  // No way's share passes faster than its length, heights stretched: from a distance d it takes
  // (d - least) / pace to come below the least one so far.
  const auto pace_of = [height_factor](const Leg& l) {
    const double climb = height_factor * std::abs(l.to.z() - l.from.z());
    return std::sqrt(l.length_m * l.length_m + climb * climb);
  };
  const double pace = pace_of(first) + pace_of(second);
  double least = apart(to).norm();
  for (double share = from; share < to && least >= enough;) {
    const double d = apart(share).norm();
    least = std::min(least, d);
    share += (d - least + kExact_m) / pace;
  }
  return std::max(0.0, least - kExact_m);
}

namespace {

/// Nothing takes so long, and what does cannot be counted in grains.
constexpr double kLongestLeg_s = 1e5;
constexpr double kJerkMin_mps3 = 1e-2;

bool flown_in_time(const Change& change, const Mover& mover) {
  double speed_mps = change.limits.speed_mps;
  double detour_m = 0.0;
  if (change.roundabout) {  // whoever goes around it slows the others too
    const double radius_m = change.roundabout->radius_m;
    speed_mps = std::min(speed_mps, std::sqrt(change.limits.acceleration_mps2 * radius_m));
    detour_m = 4.0 * kPi * radius_m;
  }
  for (std::size_t i = 0; i + 1 < mover.points.size(); ++i) {
    const double way_m = (mover.points[i + 1] - mover.points[i]).norm() + detour_m;
    if (way_m > kLongestLeg_s * speed_mps) return false;
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
  if (change.roundabout &&
      (!good(change.roundabout->radius_m) || !change.roundabout->centre.allFinite())) {
    return false;
  }
  std::set<VehicleId> seen;
  for (const Mover& mover : change.movers) {
    if (!seen.insert(mover.vehicle).second || mover.points.size() != change.stages + 1)
      return false;
    for (const Vec3& point : mover.points) {
      if (!point.allFinite()) return false;
      if (mover.around && change.roundabout &&
          (flat(point) - change.roundabout->centre).norm() < change.roundabout->radius_m) {
        return false;
      }
    }
    if (!flown_in_time(change, mover)) return false;
  }
  return true;
}

}  // namespace skein::formation
