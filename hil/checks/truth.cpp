// SPDX-License-Identifier: Apache-2.0
#include "skein/checks/truth.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "motion.hpp"
#include "skein/base/geometry.hpp"
#include "skein/checks/formation_changes.hpp"

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
  [[nodiscard]] std::optional<Spread> known() const {
    return count_ == 0 ? std::nullopt : std::optional{spread()};
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

/// Who is faster than that on the mean of a second moves.
constexpr double kMoves_mps = 0.25;
constexpr Duration kMeanHalf = std::chrono::milliseconds{500};
/// A motion goes on for that long before and after: it sets out slowly, overshoots and turns back.
constexpr Duration kAround = std::chrono::seconds{1};

/// Which points are within kAround of one where so much was moved, by a measure of two states.
template <class Measure>
std::vector<bool> moving(const std::vector<TrackPoint>& track, Measure moved_m) {
  std::vector<bool> moves(track.size(), false);
  std::size_t marked = 0;  // before it all is said
  for (const TrackPoint& point : track) {
    const Instant now = point.state.time;
    const VehicleState& from = track[first_at(track, now - kMeanHalf)].state;
    const VehicleState& to =
        track[std::min(first_at(track, now + kMeanHalf), track.size() - 1)].state;
    if (moved_m(from, to) <= kMoves_mps * to_seconds(to.time - from.time)) continue;
    const std::size_t end = first_at(track, now + kAround);
    for (marked = std::max(marked, first_at(track, now - kAround)); marked < end; ++marked) {
      moves[marked] = true;
    }
  }
  return moves;
}

bool holds(const std::vector<FormationChange>& changes, Instant time) {
  return std::ranges::any_of(changes, [time](const FormationChange& change) {
    return change.held && *change.held <= time && time < change.until;
  });
}

/// Its plans are tracks of its place; how far it was from them is recorded.
OffPlace off_place(const Recording& believed, const std::vector<FormationChange>& changes) {
  if (!believed.plans.empty()) return {};
  const auto climbs = moving(believed.track, [](const VehicleState& a, const VehicleState& b) {
    return std::abs(b.z_m - a.z_m);
  });
  const auto travels = moving(believed.track, [](const VehicleState& a, const VehicleState& b) {
    return std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
  });
  Sum in_place;
  Sum level;
  Sum climbing;
  const std::size_t flown = flown_part(believed.track).size();
  for (std::size_t i = 0; i < flown; ++i) {
    const TrackPoint& point = believed.track[i];
    if (point.plan_number == 0) continue;
    const bool stands = holds(changes, point.state.time) || (!climbs[i] && !travels[i]);
    (stands ? in_place : climbs[i] ? climbing : level).add(point.cross_error_m);
  }
  return {in_place.known(), level.known(), climbing.known()};
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
  const auto changes = formation_changes(record);
  std::vector<FlownTruly> all;
  for (const Recording& truth : record.truths) {
    const Recording* believed = recording_of(record, truth.vehicle);
    const VehicleSpec* spec = spec_of(record, truth.vehicle);
    if (believed == nullptr || spec == nullptr) continue;
    const auto planned = planned_part(believed->track);
    const Instant until = planned.empty() ? Instant::max() : planned.back().state.time;
    all.push_back(
        {truth.vehicle, plan_errors(believed->track, believed->plans, spec->height_m, until),
         plan_errors(truth.track, believed->plans, spec->height_m, until),
         off_place(*believed, changes), apart(believed->track, truth.track, limits.track_gap_s)});
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
