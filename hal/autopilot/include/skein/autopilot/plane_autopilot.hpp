// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "skein/autopilot/command.hpp"
#include "skein/autopilot/fixed_wing_loops.hpp"
#include "skein/autopilot/guidance.hpp"
#include "skein/autopilot/modes.hpp"
#include "skein/autopilot/sticks.hpp"
#include "skein/autopilot/vtol_flight.hpp"
#include "skein/base/bounded_queue.hpp"
#include "skein/base/static_vector.hpp"

namespace skein::autopilot {

struct PlaneParams {
  FixedWingTuning tuning{};
  double loiter_radius_m = 165.0;
  double waypoint_radius_m = 80.0;  ///< a waypoint counts as reached within it
  double rtl_height_m = 100.0;
  double takeoff_height_m = 60.0;
  double takeoff_pitch_rad = 0.2;
  double rotate_airspeed_mps = 38.0;
  double approach_airspeed_mps = 42.0;
  double glide_slope_rad = 0.07;
  double flare_height_m = 8.0;
  double flare_throttle = 0.35;     ///< its propeller brakes hard at less
  bool companion_failsafe = false;  ///< FS_GCS_ENABL
  Duration companion_timeout = std::chrono::seconds{5};
  Duration setpoint_timeout = std::chrono::seconds{3};  ///< of attitude targets
  std::optional<VtolParams> vtol = {};                  ///< of a quadplane
};

/// Heights are above the mission's origin, as everywhere in this module.
struct MissionItem {
  enum class Kind : std::uint8_t {
    takeoff,
    waypoint,
    loiter,
    loiter_to_height,  ///< until it is at that height and heads for the next item
    land,
    vtol_land,  ///< on rotors
    return_home,
    change_speed,
    mark,  ///< nothing is flown: home, DO_LAND_START
  };
  Kind kind = Kind::waypoint;
  double north_m = 0.0;
  double east_m = 0.0;
  double height_m = 0.0;
  double radius_m = 0.0;      ///< of a loiter: negative is counter-clockwise, 0 the default
  double airspeed_mps = 0.0;  ///< of change_speed
};

enum class HeadingKind : std::uint8_t { course = 0, heading = 1 };

struct Reposition {
  Vec2 centre_m{0.0, 0.0};  ///< north, east
  std::optional<double> height_m{};
  double radius_m = 0.0;  ///< 0 for the default
  bool clockwise = true;
  std::optional<double> airspeed_mps{};
  bool change_mode = false;  ///< to GUIDED, where it is not there yet
};

/// What is not given is flown by the autopilot.
struct AttitudeTarget {
  std::optional<double> roll_rad{};
  std::optional<double> pitch_rad{};
  std::optional<double> throttle{};
};

/// For reports; what the loops aim at now.
struct PlaneStatus {
  bool flying = false;
  Vec2 goal_m{0.0, 0.0};  ///< north, east: the waypoint, or the centre of the orbit
  double distance_m = 0.0;
  double height_m = 0.0;
  double airspeed_mps = 0.0;
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  std::size_t mission_item = 0;
};

/// A fixed wing's autopilot: its modes and commands as ArduPilot's Plane 4.6 has them, as far as a
/// companion sees them, over FixedWingLoops. Pure: time is an argument and never decreases.
///
/// In GUIDED it orbits the point at which it entered or that reposition() gave. guided_heading(),
/// guided_speed() and guided_height() outrank reposition(), change_speed() and change_height(),
/// which are accepted but wait, until GUIDED is entered anew: so does ArduPilot, and a companion
/// has to cope with it. An attitude target is flown for setpoint_timeout.
class PlaneAutopilot {
 public:
  explicit PlaneAutopilot(const PlaneParams& params);

  CommandResult select_mode(PlaneMode mode);
  CommandResult arm();
  /// Why it would not arm in its mode: not in RTL, where the failsafe puts an aircraft on the
  /// ground, too.
  [[nodiscard]] std::optional<std::string_view> mode_refusal() const;
  CommandResult disarm(bool force);

  CommandResult reposition(const Reposition& target);
  /// Of a quadplane, armed and in GUIDED: straight up so far, where it hovers until it is given
  /// another place or mode.
  CommandResult lift_off(double up_m);
  /// Failed outside GUIDED. `lateral_mps2` limits the turn; 0 for what the bank limit gives.
  CommandResult guided_heading(HeadingKind kind, double from_north_rad, double lateral_mps2);
  /// Failed outside GUIDED, denied outside the airspeed limits. Slews at `acceleration_mps2`; 0 for
  /// at once.
  CommandResult guided_speed(double airspeed_mps, double acceleration_mps2);
  CommandResult guided_height(double height_m, double rate_mps);
  CommandResult change_speed(double airspeed_mps);
  CommandResult change_height(double height_m);
  CommandResult attitude_target(const AttitudeTarget& target, Instant now);

  /// At most kMissionMax items, at least one.
  static constexpr std::size_t kMissionMax = 128;
  CommandResult load_mission(std::span<const MissionItem> items);
  CommandResult set_mission_item(std::size_t index);

  void set_sticks(const Sticks& sticks) { sticks_ = sticks; }
  void set_health(const Health& health) { health_ = health; }
  void companion_heard(Instant now) { companion_.heard(now); }

  /// One period of control, 2 to 100 ms after the last.
  SurfaceCommand step(const Estimate& estimate, Instant now);

  /// What the rotors of a quadplane give, as shares; none where it has none.
  [[nodiscard]] std::array<double, VtolFlight::kRotors> rotors() const {
    return vtol_ ? vtol_->rotors() : std::array<double, VtolFlight::kRotors>{};
  }

  /// Nothing of a plane without rotors.
  [[nodiscard]] std::optional<VtolFlight::Carried> carried() const {
    return vtol_ ? std::optional{vtol_->carried()} : std::nullopt;
  }
  [[nodiscard]] PlaneMode mode() const { return machine_.mode(); }
  [[nodiscard]] bool armed() const { return armed_; }
  [[nodiscard]] const PlaneStatus& status() const { return status_; }
  [[nodiscard]] const PlaneParams& params() const { return params_; }
  /// For poll_notice(), too.
  void say(Severity severity, std::string text);
  [[nodiscard]] std::optional<Notice> poll_notice() { return notices_.pop(); }

 private:
  struct Slew {
    double goal = 0.0;
    double rate = 0.0;  ///< 0 for at once
  };
  struct Heading {
    HeadingKind kind = HeadingKind::course;
    double from_north_rad = 0.0;
    double lateral_mps2 = 0.0;
  };
  enum class Landing : std::uint8_t { approach, flare, rollout };

  [[nodiscard]] ModeFacts facts() const;
  /// Fires the event and prepares the new mode. False where the table has no way.
  bool change(PlaneEvent event);
  void enter();
  void watch_flight(const Estimate& estimate);
  void begin_item();
  void end_item();
  [[nodiscard]] bool valid_airspeed(double airspeed_mps) const;

  SurfaceCommand fly_mode(const Estimate& estimate, Instant now, double seconds);
  SurfaceCommand fly_sticks(const Estimate& estimate, double seconds);
  SurfaceCommand fly_guided(const Estimate& estimate, Instant now, double seconds);
  SurfaceCommand fly_mission(const Estimate& estimate, double seconds);
  SurfaceCommand take_off(const Estimate& estimate, double height_m, double seconds);
  [[nodiscard]] bool may_leave(const Estimate& estimate, const MissionItem& circle) const;
  SurfaceCommand land(const Estimate& estimate, const MissionItem& item, double seconds);
  /// On its wings to where it can stop, then on its rotors to the place and down.
  SurfaceCommand set_down(const Estimate& estimate, const Vec2& place_m, double ground_m,
                          double seconds);
  void enter_vtol();
  SurfaceCommand orbit(const Estimate& estimate, const Orbit& orbit, double height_m,
                       double seconds);
  SurfaceCommand cruise(const Estimate& estimate, double lateral_mps2, double height_m,
                        double airspeed_mps, double seconds);

  PlaneParams params_;
  FixedWingLoops loops_;
  ModeMachine<PlaneMode, PlaneEvent> machine_{kPlaneModes, PlaneMode::manual};
  CompanionWatch companion_;
  BoundedQueue<Notice> notices_{32};
  Sticks sticks_;
  Estimate estimate_;
  PlaneStatus status_;
  std::optional<Instant> last_step_;
  Vec2 home_m_{0.0, 0.0};
  double home_height_m_ = 0.0;
  double airspeed_mps_ = 0.0;  ///< asked for, where nothing outranks it

  Orbit orbit_;            ///< of LOITER and GUIDED
  double height_m_ = 0.0;  ///< likewise
  std::optional<Heading> heading_;
  std::optional<Slew> speed_slew_;
  std::optional<Slew> height_slew_;
  double slewed_airspeed_mps_ = 0.0;
  double slewed_height_m_ = 0.0;
  std::optional<AttitudeTarget> attitude_;
  Instant attitude_until_{};

  StaticVector<MissionItem, kMissionMax> mission_;
  std::size_t item_ = 0;
  Vec2 leg_from_m_{0.0, 0.0};
  double takeoff_course_rad_ = 0.0;
  Health health_;
  bool armed_ = false;
  bool flying_ = false;
  Landing landing_ = Landing::approach;
  std::optional<VtolFlight> vtol_;
};

}  // namespace skein::autopilot
