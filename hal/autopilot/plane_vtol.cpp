// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "skein/autopilot/plane_autopilot.hpp"

/// What a quadplane's autopilot does besides a plane's.
namespace skein::autopilot {

void PlaneAutopilot::enter_vtol() {
  if (!flying_ || mode() == PlaneMode::manual) return vtol_->stop();
  if (mode() == PlaneMode::q_loiter) {
    vtol_->hover(estimate_, {}, estimate_.height_m());
  } else if (mode() == PlaneMode::q_land) {
    vtol_->set_down(estimate_, {}, home_height_m_);
  } else {
    vtol_->fly_on_wings(estimate_);
  }
}

CommandResult PlaneAutopilot::lift_off(double up_m) {
  const bool may = vtol_ && armed_ && !flying_ && mode() == PlaneMode::guided;
  if (!may || !(up_m > 0.0) || !std::isfinite(up_m)) return CommandResult::failed;
  vtol_->hover(estimate_, estimate_.position_m.head<2>(), estimate_.height_m() + up_m);
  return CommandResult::accepted;
}

SurfaceCommand PlaneAutopilot::set_down(const Estimate& estimate, const Vec2& place_m,
                                        double ground_m, double seconds) {
  const Vec2 way = place_m - estimate.position_m.head<2>();
  status_.goal_m = place_m;
  if (way.norm() <= vtol_->stopping_m(estimate.groundspeed_mps())) {
    vtol_->set_down(estimate, place_m, ground_m);
    return vtol_->step(estimate, loops_, seconds);
  }
  const double course_rad = std::atan2(way.y(), way.x());
  return cruise(estimate, steer_to_course(estimate, course_rad, params_.tuning.heading_gain_per_s),
                height_m_, params_.approach_airspeed_mps, seconds);
}

}  // namespace skein::autopilot
