// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/range_budget.hpp"

#include <algorithm>
#include <cmath>

namespace skein::mission {
namespace {

constexpr double kForgotten_percent = 10.0;  ///< the mean's constant
/// More, up or down at once, is not flown: another battery, another count, a gauge that was wrong.
constexpr double kJump_percent = 5.0;
constexpr Duration kBelieved = std::chrono::seconds{3};
constexpr double kStill_mps = 1.0;
/// That many times the configuration's metres, either way, are the gauge's fault.
constexpr double kWild = 5.0;

}  // namespace

bool RangeBudget::on_state(const VehicleState& state) {
  flown_m_ = state.distance_flown_m;
  if (state.battery_percent > kBatteryFull_percent) return false;  // not told: as it was
  const double percent = static_cast<double>(state.battery_percent) - told_too_much_;
  if (!percent_) {
    percent_ = percent;
    stepped_at_m_ = flown_m_;
    return true;
  }
  if (jumps(percent, state.time)) return false;
  if (percent > *percent_) return rises(percent, state);
  if (percent == *percent_) return false;
  learn(percent, state);
  percent_ = percent;
  stepped_at_m_ = flown_m_;
  step_ = {state.time, flown_m_};
  return true;
}

/// As one broken message would have it.
bool RangeBudget::jumps(double percent, Instant now) {
  if (std::abs(percent - *percent_) <= kJump_percent) {
    jumps_since_.reset();
    return false;
  }
  if (!jumps_since_) jumps_since_ = now;
  if (now - *jumps_since_ < kBelieved) return true;
  jumps_since_.reset();
  return false;
}

/// A battery does not charge in flight: a little more is noise, much more an autopilot that has
/// restarted and counts from full; on the ground it is another battery.
bool RangeBudget::rises(double percent, const VehicleState& state) {
  if (percent - *percent_ <= kJump_percent) return false;
  step_.reset();
  if (state.groundspeed_mps >= kStill_mps) {
    told_too_much_ += percent - *percent_;
    return false;
  }
  told_too_much_ = 0.0;
  percent_ = static_cast<double>(state.battery_percent);
  stepped_at_m_ = flown_m_;
  metres_per_percent_ = configured();
  return true;
}

void RangeBudget::learn(double percent, const VehicleState& state) {
  const double used = *percent_ - percent;
  if (!step_ || used > kJump_percent) return;
  const double metres = flown_m_ - step_->flown_m;
  if (metres < flies_from_mps_ * to_seconds(state.time - step_->at)) return;
  const double measured = std::clamp(metres / used, configured() / kWild, configured() * kWild);
  metres_per_percent_ +=
      (1.0 - std::exp(-used / kForgotten_percent)) * (measured - metres_per_percent_);
}

std::optional<double> RangeBudget::battery_left_m() const {
  if (!percent_) return std::nullopt;
  // Of the percent that is being used up: at most one, which the next step counts.
  const double since_m = std::clamp(flown_m_ - stepped_at_m_, 0.0, metres_per_percent_);
  return (*percent_ - reserve_percent_) * metres_per_percent_ - since_m;
}

double RangeBudget::left_m() const {
  const double configured = range_m_ - flown_m_;
  return std::min(configured, battery_left_m().value_or(configured));
}

bool RangeBudget::battery_decides() const { return left_m() < range_m_ - flown_m_; }

}  // namespace skein::mission
