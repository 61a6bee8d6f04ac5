// SPDX-License-Identifier: Apache-2.0
#include "free_start.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"
#include "skein/planning/dubins_batch.hpp"

namespace skein::planning {
namespace {

constexpr double kFar_radii = 4.0;  ///< poses so far apart are joined by CSC words
constexpr int kStarts = 24;         ///< that bisection begins with
constexpr int kHalvingsMax = 40;

/// Counter-clockwise, the centre at the origin.
class Circle {
 public:
  Circle(const Pose2& from, double radius_m, double circle_radius_m)
      : from_{from}, r_m_{radius_m}, circle_m_{circle_radius_m} {
    from_batch_.push_back(from);
  }

  [[nodiscard]] FreeStart shortest();

 private:
  /// The starts from `begin` to `end`; the length is that to `end`.
  struct Arc {
    double begin_rad = 0.0;
    double end_rad = 0.0;
    double length_m = 0.0;

    [[nodiscard]] double middle_rad() const { return (begin_rad + end_rad) / 2.0; }
  };

  void aim(double first_turn);
  void measure();
  void bisect();

  Pose2 from_;
  double r_m_;
  double circle_m_;
  PoseBatch from_batch_;
  PoseBatch entries_;
  std::vector<double> starts_rad_;
  std::vector<double> lengths_m_;
  FreeStart best_{0.0, INFINITY, INFINITY};
};

/// The starts after a line that aims at the centre, by a turn away from it or around it.
void Circle::aim(double first_turn) {
  const Vec2 turning =
      from_.position() + first_turn * r_m_ * left_of(unit_vector(from_.heading_rad));
  const double distance_m = turning.norm();
  if (distance_m <= r_m_) return;
  const double course =
      std::atan2(-turning.y(), -turning.x()) + first_turn * std::asin(r_m_ / distance_m);
  const double outer_m = circle_m_ + r_m_;
  starts_rad_.push_back(course + kPi + std::asin(r_m_ / outer_m));
  const double inner_m = circle_m_ - r_m_;
  if (inner_m < r_m_ || inner_m == 0.0) return;
  starts_rad_.push_back(course + std::asin(r_m_ / inner_m));
  starts_rad_.push_back(course + kPi - std::asin(r_m_ / inner_m));
}

void Circle::measure() {
  if (starts_rad_.empty()) return;
  entries_.clear();
  for (const double start : starts_rad_) {
    entries_.push_back(
        {circle_m_ * std::cos(start), circle_m_ * std::sin(start), wrap_pi(start + kPi / 2.0)});
  }
  lengths_m_.resize(starts_rad_.size());
  shortest_dubins_lengths(from_batch_.columns(), entries_.columns(), r_m_, lengths_m_);
  const auto least = std::min_element(lengths_m_.begin(), lengths_m_.end());
  if (*least >= best_.length_m) return;
  best_ = {starts_rad_[static_cast<std::size_t>(least - lengths_m_.begin())], *least, *least};
}

void Circle::bisect() {
  starts_rad_.clear();
  for (int i = 0; i < kStarts; ++i) starts_rad_.push_back(i * kTwoPi / kStarts);
  measure();
  std::vector<Arc> open;
  for (std::size_t i = 0; i < starts_rad_.size(); ++i) {
    open.push_back({starts_rad_[i] - kTwoPi / kStarts, starts_rad_[i], lengths_m_[i]});
  }
  std::vector<Arc> halves;
  for (int k = 0; k < kHalvingsMax && !open.empty(); ++k) {
    std::erase_if(open, [&](const Arc& arc) {
      const double least_m = arc.length_m - circle_m_ * (arc.end_rad - arc.begin_rad);
      return least_m >= best_.length_m - kFreeStartSlack_m;
    });
    starts_rad_.clear();
    for (const Arc& arc : open) starts_rad_.push_back(arc.middle_rad());
    measure();
    halves.clear();
    for (std::size_t i = 0; i < open.size(); ++i) {
      halves.push_back({open[i].begin_rad, starts_rad_[i], lengths_m_[i]});
      halves.push_back({starts_rad_[i], open[i].end_rad, open[i].length_m});
    }
    std::swap(open, halves);
  }
  best_.least_m = best_.length_m - kFreeStartSlack_m;
}

FreeStart Circle::shortest() {
  aim(1.0);
  aim(-1.0);
  measure();
  if (from_.position().norm() < circle_m_ + kFar_radii * r_m_) bisect();
  return best_;
}

}  // namespace

FreeStart shortest_to_circle(const Pose2& from, double radius_m, const Vec2& centre,
                             double circle_radius_m, int turn) {
  SKEIN_ASSERT(radius_m > 0.0 && circle_radius_m >= radius_m);
  // Clockwise is counter-clockwise in a mirror.
  const double side = turn > 0 ? 1.0 : -1.0;
  const Vec2 offset = from.position() - centre;
  FreeStart best =
      Circle{{offset.x(), side * offset.y(), side * from.heading_rad}, radius_m, circle_radius_m}
          .shortest();
  best.start_rad = wrap_pi(side * best.start_rad);
  return best;
}

}  // namespace skein::planning
