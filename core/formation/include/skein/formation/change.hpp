// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "skein/base/attitude.hpp"
#include "skein/base/geometry.hpp"
#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/formation/limits.hpp"
#include "skein/formation/motion_profile.hpp"
#include "skein/idl/formation.hpp"

namespace skein::formation {

/// Which of the movers the vehicle is.
[[nodiscard]] std::optional<std::size_t> mover_of(const Change& change, VehicleId vehicle);

/// The motion of a change, in plan time: 0 at its start, no vehicle ahead of the others or behind.
/// Immutable; position() allocates nothing.
class ChangeMotion {
 public:
  ChangeMotion() = default;
  /// Precondition: valid(change).
  explicit ChangeMotion(const Change& change);

  [[nodiscard]] Duration duration() const { return duration_; }
  [[nodiscard]] std::size_t movers() const { return movers_; }
  [[nodiscard]] Vec3 position(std::size_t mover, Duration plan_time) const;
  struct Point {
    Vec3 position_m{0.0, 0.0, 0.0};
    Vec3 velocity_mps{0.0, 0.0, 0.0};       ///< by plan time
    Vec3 acceleration_mps2{0.0, 0.0, 0.0};  ///< by plan time
  };
  [[nodiscard]] Point at(std::size_t mover, Duration plan_time) const;
  /// The mover's greatest speed in the whole change.
  [[nodiscard]] double speed_max_mps(std::size_t mover) const { return speed_max_[mover]; }

  /// The least distance of two movers over the whole change, heights stretched by `height_factor`;
  /// correct to 5 mm, and never above the truth. Stops early, with a smaller value than the
  /// truth's, once it is below `enough`.
  [[nodiscard]] double least_distance_m(std::size_t a, std::size_t b, double height_factor,
                                        double enough = 0.0) const;

 private:
  /// Straight, or straight to a rim, along it and straight on; heights in proportion to the way,
  /// and what its level adds. Nobody is faster on it than on a straight line of its length.
  struct Leg {
    Vec3 from{0.0, 0.0, 0.0};
    Vec3 to{0.0, 0.0, 0.0};
    double length_m = 0.0;
    bool bent = false;
    double flat_m = 0.0;   ///< without height, of a bent one
    double in_m = 0.0;     ///< to the rim
    double arc_m = 0.0;    ///< along it
    double rim_rad = 0.0;  ///< where the rim is reached, as seen from its centre
    double over_m = 0.0;   ///< height of its level above the line
    double climb_m = 0.0;  ///< to that height, and down again
  };
  /// How far it is up on a leg's level, and how steeply it rises there, and how that grows.
  struct Climb {
    double height_m = 0.0;
    double slope = 0.0;
    double bend_per_m = 0.0;
  };
  struct Stage {
    Duration begin{};
    MotionProfile profile;
  };
  [[nodiscard]] Leg leg_between(const Vec3& from, const Vec3& to, std::uint8_t level) const;
  [[nodiscard]] static double rise_m(const Leg& leg);
  [[nodiscard]] static Climb climb_at(const Leg& leg, double along_m);
  [[nodiscard]] const Leg& leg(std::size_t mover, std::size_t stage) const {
    return legs_[stage * movers_ + mover];
  }
  [[nodiscard]] std::size_t stage_at(Duration plan_time) const;
  [[nodiscard]] Vec3 on_leg(const Leg& leg, double share) const;
  [[nodiscard]] double least_on_stage(std::size_t stage, std::size_t a, std::size_t b,
                                      double height_factor, double enough) const;

  [[nodiscard]] Vec3 apart(const Leg& first, const Leg& second, double share,
                           double height_factor) const;
  struct Known {
    double least = std::numeric_limits<double>::infinity();
    double enough = 0.0;  ///< below it the search ends
    bool exact = true;    ///< else it may be less by what is looked over
  };
  /// The least distance at both ends, where one of the two goes around, is known already.
  void look_between(const Leg& first, const Leg& second, double from, double to,
                    double height_factor, Known& known) const;

  std::size_t movers_ = 0;
  std::optional<Roundabout> roundabout_;
  std::vector<Stage> stages_;
  std::vector<Leg> legs_;
  std::vector<double> speed_max_;
  Duration duration_{};
};

/// From full speed at the full acceleration: what a MotionTrack has room for.
inline constexpr double kStopWithin_s = 6.0;

/// That a change from outside can be flown at all: finite numbers, points for every stage, legs
/// that go around start and end outside the rim, and far enough for their level, limits above 0
/// that stop within kStopWithin_s, no vehicle twice, at most kStagesMax stages.
[[nodiscard]] bool valid(const Change& change);

}  // namespace skein::formation
