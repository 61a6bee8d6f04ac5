// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "skein/base/geometry.hpp"
#include "skein/base/static_vector.hpp"
#include "skein/base/time.hpp"
#include "skein/idl/domain.hpp"

namespace skein {

/// A planar path of lines and arcs, continuous in position and heading. Trivially copyable.
struct Path {
  Pose2 start;
  StaticVector<Segment, kPathSegmentsMax> segments;

  [[nodiscard]] double length_m() const;
  /// The pose after `distance_m`, clamped to [0, length].
  [[nodiscard]] Pose2 pose_at(double distance_m) const;
  [[nodiscard]] double curvature_at(double distance_m) const;
  [[nodiscard]] Pose2 end() const { return pose_at(length_m()); }
  /// The largest |curvature| of a segment of positive length, 1/m.
  [[nodiscard]] double curvature_max_per_m() const;
  /// False, and nothing added, when there is no room. A piece of no length is skipped.
  [[nodiscard]] bool append(const Segment& segment);
  [[nodiscard]] bool append(const Path& next);
};

/// A path flown from a start time at a ground speed that is constant, or constant on each of its
/// segments; or, in a wind that is known, at an airspeed that is. It never ends: after its last
/// segment the vehicle orbits (`tail_curvature_per_m`), which is the hold pattern. So whoever
/// follows it always knows what to do, also when nothing new ever arrives.
struct TimedPath {
  Instant start_time{};
  double speed_mps = 0.0;             ///< > 0, over the ground
  double tail_curvature_per_m = 0.0;  ///< of the hold; 0 flies straight on
  Path path;
  /// The speed on each segment, and last on the tail, as a share of speed_mps; > 0. Empty: 1.
  StaticVector<double, kPacesMax> paces{};
  /// The wind that its times count with, where that is known; with paces those of the hold alone.
  /// At a constant airspeed v an infinitesimal way t ds, |t| = 1, takes ds / (v + w.t) or, to first
  /// order in w/v, ds / v - w.(t ds) / v^2: so a way takes s / v - w.d / v^2, d being the straight
  /// way that it leads to.
  double wind_east_mps = 0.0;
  double wind_north_mps = 0.0;
  /// As far as there speed_mps is the mean over the ground, so that it is there on time: v is what
  /// the wind leaves of it along the straight way there, S - w.d / s, and times are stretched by
  /// what the first order leaves out. Beyond it, speed_mps is v.
  double on_time_m = 0.0;

  static constexpr double kWindShare = 0.3;  ///< of v: a stronger wind counts as that
  /// Adds what is flown at that share of speed_mps. False where there is no room for it. All pieces
  /// are added so, and last the pace of the tail.
  [[nodiscard]] bool append(const Segment& segment, double pace);
  [[nodiscard]] bool append(const Path& next, double pace);
  /// The wind as a share of speed_mps, kWindShare at most.
  [[nodiscard]] Vec2 wind_per_speed() const;
  [[nodiscard]] Vec2 wind_mps() const { return {wind_east_mps, wind_north_mps}; }
  void set_wind(const Vec2& mps) {
    wind_east_mps = mps.x();
    wind_north_mps = mps.y();
  }
  [[nodiscard]] bool has_wind() const { return wind_east_mps != 0.0 || wind_north_mps != 0.0; }
  /// Distance flown at `t`; grows without limit in the hold. 0 before start_time.
  [[nodiscard]] double distance_at(Instant t) const;
  [[nodiscard]] Instant time_at(double distance_m) const;
  [[nodiscard]] double speed_at_distance(double distance_m) const;
  [[nodiscard]] Pose2 pose_at(Instant t) const { return pose_at_distance(distance_at(t)); }
  /// As Path::pose_at, but beyond the end along the tail.
  [[nodiscard]] Pose2 pose_at_distance(double distance_m) const;
  [[nodiscard]] double curvature_at_distance(double distance_m) const;
  [[nodiscard]] Instant end_time() const;
  /// What is flown between two distances, tail included; nothing when it has too many pieces.
  [[nodiscard]] std::optional<Path> piece(double from_m, double to_m) const;

 private:
  /// A stretch of the plan on which times count in one way.
  struct Airing {
    Vec2 from_m;                ///< where it begins
    Vec2 wind_share{0.0, 0.0};  ///< of v
    double even_mps = 0.0;      ///< over the ground, where the wind is abeam
  };
  static constexpr double kLeastShare = 0.5;  ///< of speed_mps, that v is at least
  [[nodiscard]] Vec2 wind_per(double airspeed_mps) const;
  [[nodiscard]] Airing airing(bool is_timed) const;
  [[nodiscard]] double helped_m(const Airing& airing, double distance_m) const;
  [[nodiscard]] double in_wind_m(const Airing& airing, double even_m) const;
  [[nodiscard]] double pace(std::size_t piece) const {
    return piece < paces.size() ? paces[piece] : 1.0;
  }
};

}  // namespace skein
