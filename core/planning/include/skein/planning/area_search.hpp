// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/domain/fence.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/path.hpp"
#include "skein/planning/avoidance.hpp"

/// An area shared out among vehicles that search it, lane by lane. Mission frame, SI units.
namespace skein::planning {

inline constexpr std::size_t kAreaCornersMax = 32;
inline constexpr std::size_t kAreaSearchersMax = 64;
/// Of one area: more are refused.
inline constexpr std::size_t kAreaLanesMax = 256;
/// Of what lanes, turns and their ends keep from the fence.
inline constexpr double kAreaFenceRoom_m = 10.0;

/// A straight way along which a sensor sweeps.
struct Lane {
  Pose2 start;
  double length_m = 0.0;  ///< >= 0; at 0 the pose itself is passed

  [[nodiscard]] Pose2 end() const { return advance(start, 0.0, length_m); }
  [[nodiscard]] Lane reversed() const;
};

/// Who takes part.
struct Searcher {
  VehicleId id;
  Pose2 from;                ///< where its way begins
  double speed_mps = 0.0;    ///< over the ground
  double radius_m = 0.0;     ///< that it turns with
  double range_m = 0.0;      ///< for all of it, the way home included
  std::optional<Vec2> home;  ///< none: it is recovered anywhere
};

struct AreaProblem {
  std::vector<Vec2> corners;  ///< of a polygon without crossings, in either sense
  double sensor_radius_m = 0.0;
  double spacing_m = 0.0;  ///< of the lanes, at most; above 0, at most two sensor radii
  std::vector<Searcher> searchers;
  std::vector<Hazard> hazards;
  Fence fence;
  AvoidanceParams avoidance;
};

/// What one vehicle flies: to each lane and along it.
struct SearchRoute {
  VehicleId vehicle;
  std::vector<Lane> lanes;  ///< in their order, as they are flown
  std::vector<Path> legs;   ///< to the lane and along it; each begins where the one before ends
  double length_m = 0.0;
  double home_m = 0.0;  ///< from the end, straight and once around; 0 without a home
  double time_s = 0.0;
};

struct AreaPlan {
  std::vector<SearchRoute> routes;  ///< of those that have one
  std::vector<Lane> left_out;       ///< that nobody has the range or the room for
  double covered = 0.0;  ///< share of what lies outside of hazards, to the fineness of its samples
  double time_s = 0.0;   ///< until the last has flown its route
  double bound_s = 0.0;  ///< area_bound_s()
};

/// What is wrong with the outline, as a sentence.
[[nodiscard]] std::optional<std::string> why_no_area(std::span<const Vec2> corners);
[[nodiscard]] double area_m2(std::span<const Vec2> corners);

/// How long it takes at least: all sweep new ground two sensor radii wide, without any turn, from
/// when they can be at the area on.
[[nodiscard]] double area_bound_s(const AreaProblem& problem);

/// Shares the area out so that the last ends soonest, as far as it finds: lanes along the edge that
/// gives the best plan, in cells without a notch, split evenly; where hazards or the fence leave
/// corners that no lane sees, short lanes are added. Routes never enter a hazard, leave the fence,
/// turn tighter than they may, or are longer than the range leaves; what has no room then is left
/// out. Fails for what is no polygon, nobody to fly, and more than kAreaLanesMax lanes.
/// Cost: up to some hundred milliseconds.
[[nodiscard]] Result<AreaPlan> plan_area(const AreaProblem& problem);

/// The same with lanes that are known, in an order in which one could fly them all: what is left of
/// an area. `covered` is not told.
[[nodiscard]] AreaPlan share_lanes(const AreaProblem& problem, std::span<const Lane> lanes);

/// One vehicle over the first of those lanes in their order, from its pose: as many as have room in
/// `segments_max` segments and its range, and none that no way leads to.
[[nodiscard]] SearchRoute route_over(const AreaProblem& problem, const Searcher& searcher,
                                     std::span<const Lane> lanes, std::size_t segments_max);

/// From there to where it can fly two radii straight on and hold on a circle to the left: no way at
/// all where it is there already. None where there is no room near.
[[nodiscard]] std::optional<Path> way_to_hold(const AreaProblem& problem, const Searcher& searcher,
                                              const Pose2& from);

/// Where an area was seen: cells of even size, whose middles are looked at.
class AreaCells {
 public:
  /// Those in the polygon and outside of every hazard.
  AreaCells(std::span<const Vec2> corners, double sensor_radius_m, std::span<const Hazard> hazards);

  /// All within the sensor's radius of the straight way between the two points are seen.
  void see(const Vec2& from, const Vec2& to);
  [[nodiscard]] std::size_t size() const { return cells_.size(); }
  [[nodiscard]] std::size_t seen() const { return seen_; }
  /// 1 where there is none.
  [[nodiscard]] double share() const;
  [[nodiscard]] std::vector<Vec2> unseen() const;
  [[nodiscard]] double fineness_m() const { return fineness_m_; }
  [[nodiscard]] double sensor_radius_m() const { return sensor_radius_m_; }

 private:
  struct Cell {
    Vec2 middle;
    bool seen = false;
  };
  std::vector<Cell> cells_;  ///< by rows, from west to east
  double sensor_radius_m_;
  double fineness_m_ = 0.0;
  std::size_t seen_ = 0;
};

/// What of the lanes still has to be flown so that the cells are seen: shortened, or gone.
[[nodiscard]] std::vector<Lane> lanes_left(std::span<const Lane> lanes, const AreaCells& cells);

}  // namespace skein::planning
