// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "skein/autopilot/plane_autopilot.hpp"
#include "skein/base/angles.hpp"

namespace skein::autopilot {
namespace {

// ArduPlane leaves a circle to a height so.
constexpr double kAtHeight_m = 5.0;
constexpr double kHeadsFor_rad = 0.1;
constexpr double kTouched_m = 0.25;
constexpr double kBounced_m = 1.5;
constexpr double kTouchdownSink_mps = 0.7;
constexpr double kFlareTime_s = 2.5;
constexpr double kFlareGain = 1.0;

Vec2 place(const MissionItem& item) { return {item.north_m, item.east_m}; }

}  // namespace

void PlaneAutopilot::begin_item() {
  leg_from_m_ = estimate_.position_m.head<2>();
  takeoff_course_rad_ = euler_angles(estimate_.attitude).yaw_rad;
  landing_ = Landing::approach;
  if (mission_[item_].kind == MissionItem::Kind::vtol_land) height_m_ = estimate_.height_m();
}

void PlaneAutopilot::end_item() {
  const MissionItem& item = mission_[item_];
  const Vec2 from =
      item.kind == MissionItem::Kind::waypoint ? place(item) : Vec2{estimate_.position_m.head<2>()};
  if (item_ + 1 < mission_.size()) {
    ++item_;
    begin_item();
    leg_from_m_ = from;
    return;
  }
  item_ = 0;
  say(Severity::info, "Mission complete, changing mode to RTL");
  (void)change(PlaneEvent::mission_ended);
}

SurfaceCommand PlaneAutopilot::fly_mission(const Estimate& estimate, double seconds) {
  const MissionItem item = mission_[item_];
  const double gain = params_.tuning.heading_gain_per_s;
  const Vec2 goal = place(item);
  status_.goal_m = goal;
  switch (item.kind) {
    case MissionItem::Kind::takeoff:
      if (flying_ && estimate.height_m() >= item.height_m - 5.0) {
        end_item();
        break;
      }
      return take_off(estimate, item.height_m, seconds);
    case MissionItem::Kind::waypoint: {
      const bool leg = (goal - leg_from_m_).norm() > 1.0;
      const double distance = (goal - estimate.position_m.head<2>()).norm();
      if (flying_ && (!leg || distance < params_.waypoint_radius_m ||
                      progress_on_line(estimate, leg_from_m_, goal) >= 1.0)) {
        end_item();
        break;
      }
      const double lateral = leg ? steer_to_line(estimate, leg_from_m_, goal, gain) : 0.0;
      return cruise(estimate, lateral, item.height_m, airspeed_mps_, seconds);
    }
    case MissionItem::Kind::loiter_to_height:
      if (may_leave(estimate, item)) {
        end_item();
        break;
      }
      [[fallthrough]];
    case MissionItem::Kind::loiter: {
      const double radius = item.radius_m == 0.0 ? params_.loiter_radius_m : item.radius_m;
      return orbit(estimate,
                   {.centre_m = goal, .radius_m = std::abs(radius), .clockwise = radius > 0.0},
                   item.height_m, seconds);
    }
    case MissionItem::Kind::mark:
      end_item();
      break;
    case MissionItem::Kind::land:
      return land(estimate, item, seconds);
    case MissionItem::Kind::vtol_land:
      return set_down(estimate, goal, item.height_m, seconds);
    case MissionItem::Kind::return_home:
      (void)change(PlaneEvent::mission_ended);
      break;
    case MissionItem::Kind::change_speed:
      airspeed_mps_ = item.airspeed_mps;
      end_item();
      break;
  }
  // The item has just ended: this period goes straight on.
  return cruise(estimate, 0.0, estimate.height_m(), airspeed_mps_, seconds);
}

bool PlaneAutopilot::may_leave(const Estimate& estimate, const MissionItem& circle) const {
  if (std::abs(estimate.height_m() - circle.height_m) > kAtHeight_m) return false;
  if (item_ + 1 >= mission_.size()) return true;
  const Vec2 way = place(mission_[item_ + 1]) - Vec2{estimate.position_m.head<2>()};
  const double off_rad = wrap_pi(std::atan2(way.y(), way.x()) - estimate.course_rad());
  return std::abs(off_rad) < kHeadsFor_rad;
}

SurfaceCommand PlaneAutopilot::land(const Estimate& estimate, const MissionItem& item,
                                    double seconds) {
  const FixedWingTuning& t = params_.tuning;
  const Vec2 goal = place(item);
  const Vec2 leg = goal - leg_from_m_;
  const double above_m = estimate.height_m() - item.height_m;
  const double line =
      leg.norm() > 1.0 ? steer_to_line(estimate, leg_from_m_, goal, t.heading_gain_per_s) : 0.0;
  if (landing_ == Landing::approach) {
    if (above_m < params_.flare_height_m) {
      landing_ = Landing::flare;
      takeoff_course_rad_ = leg.norm() > 1.0 ? std::atan2(leg.y(), leg.x()) : estimate.course_rad();
    } else {
      const double to_go_m =
          leg.norm() > 1.0 ? leg.norm() * (1.0 - progress_on_line(estimate, leg_from_m_, goal))
                           : 0.0;
      // The slope meets the ground at the point; it is followed with the lag of the height loop.
      const double slope_m = to_go_m * std::tan(params_.glide_slope_rad);
      const double sink = estimate.groundspeed_mps() * std::tan(params_.glide_slope_rad);
      const bool on_slope = estimate.height_m() > item.height_m + slope_m - sink;
      const double height_m =
          on_slope ? item.height_m + slope_m - sink * t.height_time_s : estimate.height_m();
      return cruise(estimate, line, height_m, params_.approach_airspeed_mps, seconds);
    }
  }
  // Wheels on the ground, or back in the air after a bounce.
  if (above_m < kTouched_m) landing_ = Landing::rollout;
  if (above_m > kBounced_m) landing_ = Landing::flare;
  if (landing_ == Landing::flare) {
    // The sink rate goes down with the height, so the path bends to the ground like an exponential.
    const double airspeed = std::max(estimate.airspeed_mps, 0.5 * t.airspeed_min_mps);
    const double climb = -std::max(kTouchdownSink_mps, above_m / kFlareTime_s);
    const double slower = t.reference_airspeed_mps / airspeed;
    const double pitch = t.alpha_zero_lift_rad + t.alpha_per_load_rad * slower * slower +
                         (climb + kFlareGain * (climb - estimate.climb_mps())) / airspeed;
    const double roll = std::clamp(loops_.bank_for(line), -0.1, 0.1);
    return loops_.hold_attitude(estimate, roll, pitch, params_.flare_throttle, seconds);
  }
  SurfaceCommand command = loops_.hold_attitude(estimate, 0.0, 0.0, 0.0, seconds);
  command.rudder_rad = ground_steering_rad(estimate, takeoff_course_rad_, t.surface_max_rad);
  if (estimate.groundspeed_mps() < 1.5) {
    flying_ = false;
    say(Severity::info, "Landed");
    (void)disarm(false);
  }
  return command;
}

}  // namespace skein::autopilot
