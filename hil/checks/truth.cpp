// SPDX-License-Identifier: Apache-2.0
#include "skein/checks/truth.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "motion.hpp"
#include "skein/base/geometry.hpp"

namespace skein::checks {
namespace {

using recording::Recording;
using recording::TrackPoint;

/// Adds up to a Spread.
class Sum {
 public:
  void add(double value) {
    squares_ += value * value;
    most_ = std::max(most_, std::abs(value));
    ++count_;
  }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] Spread spread() const {
    if (count_ == 0) return {};
    return {std::sqrt(squares_ / static_cast<double>(count_)), most_};
  }

 private:
  double squares_ = 0.0;
  double most_ = 0.0;
  std::size_t count_ = 0;
};

/// Before its flight controller takes it down.
PlanErrors plan_errors(const std::vector<TrackPoint>& track,
                       const std::vector<recording::PlanRecord>& plans, double height_m,
                       Instant until) {
  Sum cross;
  Sum along;
  Sum height;
  bool joined = false;
  for (const TrackPoint& point : track) {
    const recording::PlanRecord* record = plan_in_force(plans, point.state.time);
    if (record == nullptr || point.state.time > until) continue;
    const TimedPath& plan = record->plan;
    const Pose2 pose = plan_pose(plan, plan_distance_m(plan, point.state.time));
    const Vec2 off = Vec2{point.state.x_m, point.state.y_m} - pose.position();
    joined = joined || off.norm() <= kJoined_m;
    if (!joined) continue;
    const Vec2 ahead = unit_vector(pose.heading_rad);
    along.add(off.dot(ahead));
    cross.add(ahead.x() * off.y() - ahead.y() * off.x());
    height.add(point.state.z_m - height_m);
  }
  return {cross.count(), cross.spread(), along.spread(), height.spread()};
}

/// Its plans are tracks of its place; how far it was from them is recorded.
std::optional<Spread> off_place(const Recording& believed) {
  if (!believed.plans.empty()) return std::nullopt;
  Sum sum;
  for (const TrackPoint& point : believed.track) {
    if (point.plan_number > 0) sum.add(point.cross_error_m);
  }
  if (sum.count() == 0) return std::nullopt;
  return sum.spread();
}

Spread apart(const std::vector<TrackPoint>& believed, const std::vector<TrackPoint>& truly,
             double gap_s) {
  Sum sum;
  for (const TrackPoint& point : truly) {
    const auto at = track_at(believed, point.state.time, gap_s);
    if (!at) continue;
    const Vec2 off = Vec2{point.state.x_m, point.state.y_m} - at->horizontal;
    sum.add(std::hypot(off.x(), off.y(), point.state.z_m - at->height_m));
  }
  return sum.spread();
}

}  // namespace

std::vector<FlownTruly> flown_truly(const RunRecord& record, const Limits& limits) {
  std::vector<FlownTruly> all;
  for (const Recording& truth : record.truths) {
    const Recording* believed = recording_of(record, truth.vehicle);
    const VehicleSpec* spec = spec_of(record, truth.vehicle);
    if (believed == nullptr || spec == nullptr) continue;
    const auto planned = planned_part(believed->track);
    const Instant until = planned.empty() ? Instant::max() : planned.back().state.time;
    all.push_back({truth.vehicle,
                   plan_errors(believed->track, believed->plans, spec->height_m, until),
                   plan_errors(truth.track, believed->plans, spec->height_m, until),
                   off_place(*believed), apart(believed->track, truth.track, limits.track_gap_s)});
  }
  return all;
}

std::vector<DeliveryTruly> deliveries_truly(const RunRecord& record, const Limits& limits) {
  // The same runs in the same order: only tracks differ.
  const auto believed = deliveries_flown(record, limits);
  const auto truly = deliveries_flown(record, record.truths, limits);
  std::vector<DeliveryTruly> all;
  for (std::size_t i = 0; i < believed.size(); ++i) {
    if (believed[i].seen && truly[i].seen) all.push_back({believed[i], truly[i]});
  }
  return all;
}

}  // namespace skein::checks
