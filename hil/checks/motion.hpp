// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/base/time.hpp"
#include "skein/checks/run_record.hpp"

/// The judges' own kinematics, apart from those that made the plans.
namespace skein::checks {

/// Distance from plan.start_time at its speed on each segment, or in its wind; 0 before.
[[nodiscard]] double plan_distance_m(const TimedPath& plan, Instant time);
[[nodiscard]] double plan_length_m(const TimedPath& plan);
/// Beyond the end along the hold.
[[nodiscard]] Pose2 plan_pose(const TimedPath& plan, double distance_m);
/// Calls `see` with points of the plan at most `step_m` apart, both ends included. It answers how
/// far along the plan nothing of interest can follow (0: look at the next point); points within
/// that are left out.
void walk_plan(const TimedPath& plan, double from_m, double to_m, double step_m,
               const std::function<double(double distance_m, const Vec2&)>& see);

/// What the vehicle was told to fly at that moment; null before its first plan.
[[nodiscard]] const recording::PlanRecord* plan_in_force(
    const std::vector<recording::PlanRecord>& plans, Instant time);

/// What of a track was flown: all before it stood on the ground for good. The second ends where its
/// flight controller took it down there, from where on no plan tells where it is.
[[nodiscard]] std::span<const recording::TrackPoint> flown_part(
    const std::vector<recording::TrackPoint>& track);
[[nodiscard]] std::span<const recording::TrackPoint> planned_part(
    const std::vector<recording::TrackPoint>& track);

/// Position of a track at a time, linear between its points; none outside it and in a gap.
struct TrackPosition {
  Vec2 horizontal{0.0, 0.0};
  double height_m = 0.0;
  double distance_flown_m = 0.0;
};
[[nodiscard]] std::optional<TrackPosition> track_at(const std::vector<recording::TrackPoint>& track,
                                                    Instant time, double gap_s);
/// Index of the first point at or after `time`; size() when there is none.
[[nodiscard]] std::size_t first_at(const std::vector<recording::TrackPoint>& track, Instant time);

/// Where a track comes nearest to a point, within Limits::delivery_window_s of a time; none where
/// it does not cover that.
struct Pass {
  Instant time{};
  double miss_m = 0.0;       ///< horizontal
  double heading_rad = 0.0;  ///< direction of travel
};
[[nodiscard]] std::optional<Pass> nearest_pass(const std::vector<recording::TrackPoint>& track,
                                               const Vec2& point, Instant expected,
                                               const Limits& limits);

[[nodiscard]] const VehicleSpec* spec_of(const RunRecord& record, VehicleId vehicle);
[[nodiscard]] const Site* site_of(const RunRecord& record, SiteId site);

/// A figure at its worst, and when it was that.
struct Worst {
  double value = 0.0;
  std::optional<Instant> at;
  /// Of those where more is worse.
  void raise(double to, Instant when) {
    if (at && to <= value) return;
    value = std::max(value, to);
    at = when;
  }
  /// Of those where less is.
  void lower(double to, Instant when) {
    if (at && to >= value) return;
    value = std::min(value, to);
    at = when;
  }
};

/// The later of the two.
inline void note_moment(std::optional<Instant>& newest, Instant when) {
  newest = std::max(newest.value_or(when), when);
}

/// Words of the sentences.
[[nodiscard]] std::string fixed(double value, int decimals);
[[nodiscard]] std::string vehicle_name(VehicleId vehicle);
[[nodiscard]] std::string at(Instant time);  ///< "at 12.34 s"

}  // namespace skein::checks
