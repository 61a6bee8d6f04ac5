// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "skein/planning/area_search.hpp"

namespace skein::planning {

/// A part of an area without a notch: its lanes side by side.
using AreaCell = std::vector<Lane>;

/// What lanes and turns keep clear of, for the widest of the turn radii.
class AreaRoom {
 public:
  explicit AreaRoom(const AreaProblem& problem);

  /// Outside of every safety circle, and inside of the fence by kAreaFenceRoom_m.
  [[nodiscard]] bool is_open(const Vec2& point) const;
  [[nodiscard]] bool is_open(const Lane& lane) const;
  /// Can a vehicle turn there, to one side at least?
  [[nodiscard]] bool can_turn_at(const Pose2& pose) const;
  /// What of the lane is open, with room to turn at both ends.
  [[nodiscard]] std::vector<Lane> open_parts(const Lane& lane) const;
  [[nodiscard]] bool bounds() const {
    return problem_->fence.exists() || !problem_->hazards.empty();
  }
  [[nodiscard]] double radius_m() const { return radius_m_; }

 private:
  const AreaProblem* problem_;
  double radius_m_ = 0.0;
};

/// How many lanes that direction takes, were there nothing in the way.
[[nodiscard]] std::size_t count_of_lanes(const AreaProblem& problem, double direction_rad);
/// The lanes in that direction, by cells. Without hazards and fence every point of the area is
/// within the sensor's radius of one.
[[nodiscard]] std::vector<AreaCell> lanes_of(const AreaProblem& problem, const AreaRoom& room,
                                             double direction_rad);
/// Short lanes from which cells are seen that those have not seen; marks them.
[[nodiscard]] std::vector<Lane> lanes_for_rest(const AreaProblem& problem, const AreaRoom& room,
                                               AreaCells& cells, double direction_rad);

}  // namespace skein::planning
