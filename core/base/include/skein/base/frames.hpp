// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "skein/base/result.hpp"

namespace skein {

/// The frame of reference, as a tag of the types below.
struct MissionEnu;  ///< East, north, up in metres from the scenario's WGS84 origin.

/// A difference of two positions in one frame, in metres.
template <class Frame>
class Displacement {
 public:
  Displacement() = default;
  explicit Displacement(const Eigen::Vector3d& metres) : metres_{metres} {}
  [[nodiscard]] const Eigen::Vector3d& metres() const { return metres_; }
  [[nodiscard]] double norm() const { return metres_.norm(); }

 private:
  Eigen::Vector3d metres_ = Eigen::Vector3d::Zero();
};

/// A point in one frame. Two points of different frames cannot be mixed: the operators below exist
/// only within a frame. Positions do not add; their difference is a Displacement.
template <class Frame>
class Position {
 public:
  Position() = default;
  explicit Position(const Eigen::Vector3d& metres) : metres_{metres} {}
  Position(double x_m, double y_m, double z_m) : metres_{x_m, y_m, z_m} {}

  [[nodiscard]] double x() const { return metres_.x(); }
  [[nodiscard]] double y() const { return metres_.y(); }
  [[nodiscard]] double z() const { return metres_.z(); }
  [[nodiscard]] const Eigen::Vector3d& metres() const { return metres_; }
  /// The horizontal part (east, north).
  [[nodiscard]] Eigen::Vector2d horizontal() const { return metres_.head<2>(); }

  friend Displacement<Frame> operator-(const Position& a, const Position& b) {
    return Displacement<Frame>{a.metres_ - b.metres_};
  }
  friend Position operator+(const Position& a, const Displacement<Frame>& d) {
    return Position{Eigen::Vector3d{a.metres_ + d.metres()}};
  }

 private:
  Eigen::Vector3d metres_ = Eigen::Vector3d::Zero();
};

/// A vector east, north, up as aircraft models and autopilots have it: north, east, down; and back.
[[nodiscard]] inline Eigen::Vector3d ned_from_enu(const Eigen::Vector3d& enu) {
  return {enu.y(), enu.x(), -enu.z()};
}
[[nodiscard]] inline Eigen::Vector3d enu_from_ned(const Eigen::Vector3d& ned) {
  return {ned.y(), ned.x(), -ned.z()};
}

/// A geodetic position: WGS84 degrees, metres above the ellipsoid.
struct Wgs84 {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double height_m = 0.0;
};

/// The tie between the mission frame and the earth: a local tangent plane at `origin`.
/// Conversion by GeographicLib (Karney); exact to nanometres, the curvature of the earth included.
class MissionOrigin {
 public:
  /// Fails where the latitude is outside [-90, 90] or a number is not finite.
  [[nodiscard]] static Result<MissionOrigin> make(const Wgs84& origin);

  [[nodiscard]] const Wgs84& origin() const { return origin_; }
  [[nodiscard]] Position<MissionEnu> to_enu(const Wgs84& geodetic) const;
  [[nodiscard]] Wgs84 to_wgs84(const Position<MissionEnu>& position) const;

 private:
  explicit MissionOrigin(const Wgs84& origin) : origin_{origin} {}
  Wgs84 origin_;
};

}  // namespace skein
