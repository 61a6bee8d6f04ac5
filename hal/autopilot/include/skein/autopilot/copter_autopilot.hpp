// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "skein/autopilot/command.hpp"
#include "skein/autopilot/hexarotor_loops.hpp"
#include "skein/autopilot/modes.hpp"
#include "skein/autopilot/sticks.hpp"
#include "skein/base/bounded_queue.hpp"

namespace skein::autopilot {

struct CopterParams {
  HexarotorTuning tuning{};
  double speed_mps = 10.0;          ///< horizontal, towards positions
  double rtl_height_m = 15.0;       ///< above home; it does not descend to it
  double land_speed_mps = 0.5;      ///< below land_slow_m
  double descent_mps = 1.5;         ///< above it
  double land_slow_m = 8.0;         ///< above home
  bool companion_failsafe = false;  ///< FS_GCS_ENABLE
  Duration companion_timeout = std::chrono::seconds{5};
  Duration setpoint_timeout = std::chrono::seconds{3};  ///< of velocities and attitudes
};

/// A setpoint; NED, from the mission's origin. With a position alone the vehicle goes there and
/// stays; with a velocity it follows the moving point until the setpoint is too old.
struct PositionTarget {
  std::optional<Vec3> position_m{};
  std::optional<Vec3> velocity_mps{};
  std::optional<Vec3> acceleration_mps2{};
  std::optional<double> yaw_rad{};
  std::optional<double> yaw_rate_radps{};
};

struct CopterAttitudeTarget {
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  std::optional<double> yaw_rad{};
  double yaw_rate_radps = 0.0;
  double climb = 0.5;  ///< [0, 1]: 0.5 holds the height, 1 climbs as fast as it may
};

/// For reports.
struct CopterStatus {
  bool flying = false;
  Vec3 goal_m = Vec3::Zero();
  double yaw_rad = 0.0;
  double thrust = 0.0;  ///< mean share
};

/// A multirotor's autopilot: its modes and commands as ArduPilot's Copter 4.6 has them, as far as a
/// companion sees them, over HexarotorLoops. Pure: time is an argument and never decreases.
///
/// In GUIDED it stays on the ground until take_off(). A velocity that is not renewed is flown for
/// setpoint_timeout; then the vehicle brakes and holds its place. RTL climbs, flies home, and
/// lands; on the ground the motors stop by themselves.
class CopterAutopilot {
 public:
  explicit CopterAutopilot(const CopterParams& params);

  CommandResult select_mode(CopterMode mode);
  CommandResult arm();
  CommandResult disarm(bool force);
  /// Failed unless armed and in GUIDED. Height above the mission's origin.
  CommandResult take_off(double height_m);
  /// Failed outside GUIDED, temporarily rejected on the ground.
  CommandResult position_target(const PositionTarget& target, Instant now);
  CommandResult attitude_target(const CopterAttitudeTarget& target, Instant now);
  /// To a place, at params.speed_mps unless given. Enters GUIDED where asked to.
  CommandResult reposition(const Vec3& position_m, std::optional<double> speed_mps,
                           bool change_mode);
  /// Horizontal, for the position that is being flown to; the next one starts with the default.
  CommandResult change_speed(double speed_mps);

  void set_sticks(const Sticks& sticks) { sticks_ = sticks; }
  void set_health(const Health& health) { health_ = health; }
  void companion_heard(Instant now) { companion_.heard(now); }

  /// One period of control, 1 to 20 ms after the last.
  RotorCommand step(const Estimate& estimate, Instant now);

  [[nodiscard]] CopterMode mode() const { return machine_.mode(); }
  [[nodiscard]] bool armed() const { return armed_; }
  [[nodiscard]] const CopterStatus& status() const { return status_; }
  [[nodiscard]] const CopterParams& params() const { return params_; }
  [[nodiscard]] std::optional<Notice> poll_notice() { return notices_.pop(); }

 private:
  enum class Guided : std::uint8_t { hold, take_off, motion, brake, attitude };
  enum class Return : std::uint8_t { climb, home, land };

  [[nodiscard]] ModeFacts facts() const { return {.position = health_.position}; }
  void say(Severity severity, std::string text);
  bool change(CopterEvent event);
  void enter();
  void hold_here();
  void stop_motors();
  void watch_landing(double seconds);

  RotorCommand fly_mode(Instant now, double seconds);
  RotorCommand fly_sticks(double seconds);
  RotorCommand fly_guided(Instant now, double seconds);
  RotorCommand fly_home(double seconds);
  RotorCommand descend(double seconds);
  RotorCommand follow(const MotionDemand& demand, double seconds);
  RotorCommand climb_level(double roll_rad, double pitch_rad, double climb_mps, double seconds);

  CopterParams params_;
  HexarotorLoops loops_;
  ModeMachine<CopterMode, CopterEvent> machine_{kCopterModes, CopterMode::stabilize};
  CompanionWatch companion_;
  BoundedQueue<Notice> notices_{32};
  Sticks sticks_;
  Estimate estimate_;
  CopterStatus status_;
  std::optional<Instant> last_step_;
  double resting_s_ = 0.0;  ///< how long it has looked landed
  double climb_mps_ = 0.0;  ///< filtered
  double sink_wanted_mps_ = 0.0;
  double lifted_s_ = 0.0;  ///< how long it has looked flying
  Vec3 home_m_ = Vec3::Zero();

  MotionDemand motion_;
  Instant motion_until_{};
  CopterAttitudeTarget attitude_;
  double takeoff_height_m_ = 0.0;
  double return_down_m_ = 0.0;
  Health health_;
  bool armed_ = false;
  bool flying_ = false;
  bool motion_ends_ = false;  ///< it has a velocity, which grows old
  Guided guided_ = Guided::hold;
  Return return_ = Return::climb;
};

}  // namespace skein::autopilot
