// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/domain/path.hpp"

namespace skein::planning {

/// The circle that a vehicle orbits on. It is anywhere on it.
struct Ring {
  Vec2 centre{0.0, 0.0};
  double radius_m = 0.0;
};
[[nodiscard]] double distance_m(const Ring& ring, const Vec2& point);
/// 0 where they cross, or one lies within the other: who is inside would be shut in.
[[nodiscard]] double distance_m(const Ring& a, const Ring& b);
/// Precondition: the curvature is not 0.
[[nodiscard]] Ring ring_of(const Pose2& at, double curvature_per_m);

/// A way home as it is compared with others: where its pieces begin is worked out once. Times are
/// seconds since `epoch`. Of one speed over the ground or, with a wind, through the air from its
/// begin on.
class ReturnTrack {
 public:
  ReturnTrack(const TimedPath& timed, Instant epoch);
  [[nodiscard]] double begin_s() const { return begin_s_; }
  [[nodiscard]] double end_s() const { return end_s_; }
  /// The most over the ground.
  [[nodiscard]] double speed_max_mps() const { return speed_mps_ / (1.0 - wind_share_.norm()); }
  [[nodiscard]] const Ring& ring() const { return ring_; }
  /// Precondition: within [begin_s(), end_s()].
  [[nodiscard]] Vec2 position_at(double time_s) const;

 private:
  struct Piece {
    double begin_m = 0.0;
    double curvature_per_m = 0.0;
    Vec2 origin{0.0, 0.0};  ///< of a line its begin, of an arc its centre
    Vec2 vector{0.0, 0.0};  ///< the direction of a line; from the centre to the begin of an arc
  };
  [[nodiscard]] Vec2 position_at_distance(double distance_m) const;

  double begin_s_;
  double end_s_ = 0.0;
  double speed_mps_;
  Vec2 wind_share_;  ///< TimedPath::wind_per_speed()
  double length_m_ = 0.0;
  std::vector<Piece> pieces_;
  Ring ring_;
};

/// Does the path never come nearer to that point than that? As is_clear(), but fast for what is
/// far.
[[nodiscard]] bool keeps_off(const Path& path, const Vec2& point, double apart_m);

/// Are they never nearer than that from when both have begun? Who has arrived is anywhere on its
/// ring. By conservative advancement: a distance cannot shrink faster than both together fly. It
/// refuses what comes within a metre more.
[[nodiscard]] bool stay_apart(const ReturnTrack& a, const ReturnTrack& b, double apart_m);

}  // namespace skein::planning
