// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "motion.hpp"
#include "skein/checks/checks.hpp"

namespace skein::checks {
namespace {

// Between two moments of the grid a track is taken as straight: a vehicle at 60 m/s that turns at
// 100 m radius leaves the chord by 0.05 m.
constexpr Duration kStep = std::chrono::milliseconds{100};
constexpr std::size_t kStepsPerSlice = 10;

struct Sample {
  bool known = false;
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
};

/// A track on the common grid.
struct Gridded {
  VehicleId vehicle;
  std::vector<Sample> samples;
};

std::vector<Sample> on_grid(std::span<const recording::TrackPoint> track, Instant begin,
                            std::size_t count, double gap_s) {
  std::vector<Sample> samples(count);
  std::size_t after = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Instant time = begin + kStep * static_cast<Duration::rep>(i);
    while (after < track.size() && track[after].state.time < time) ++after;
    if (after == track.size()) break;
    const VehicleState& b = track[after].state;
    if (b.time == time) {
      samples[i] = {true, b.x_m, b.y_m, b.z_m};
      continue;
    }
    if (after == 0) continue;
    const VehicleState& a = track[after - 1].state;
    const double span = to_seconds(b.time - a.time);
    if (span > gap_s) continue;
    const double share = to_seconds(time - a.time) / span;
    samples[i] = {true, a.x_m + share * (b.x_m - a.x_m), a.y_m + share * (b.y_m - a.y_m),
                  a.z_m + share * (b.z_m - a.z_m)};
  }
  return samples;
}

/// Where a track was during one slice.
struct Box {
  std::size_t track = 0;
  std::array<double, 3> low{1e12, 1e12, 1e12};
  std::array<double, 3> high{-1e12, -1e12, -1e12};

  [[nodiscard]] bool near(const Box& other, const std::array<double, 3>& margin) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (low[k] > other.high[k] + margin[k] || other.low[k] > high[k] + margin[k]) return false;
    }
    return true;
  }
};

Box box_of(const Gridded& track, std::size_t index, std::size_t from, std::size_t to) {
  Box box;
  box.track = index;
  for (std::size_t i = from; i <= to; ++i) {
    const Sample& s = track.samples[i];
    if (!s.known) continue;
    const std::array<double, 3> point{s.x, s.y, s.z};
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = std::min(box.low[k], point[k]);
      box.high[k] = std::max(box.high[k], point[k]);
    }
  }
  return box;
}

struct Approach {
  double horizontal_m = 1e12;
  double vertical_m = 0.0;
  double share = 0.0;  ///< of the step
};

/// The least horizontal distance in one step while vertically below the limit.
Approach closest(const Sample& a0, const Sample& a1, const Sample& b0, const Sample& b1,
                 double vertical_limit_m) {
  const double dx = b0.x - a0.x;
  const double dy = b0.y - a0.y;
  const double dz = b0.z - a0.z;
  const double vx = (b1.x - a1.x) - dx;
  const double vy = (b1.y - a1.y) - dy;
  const double vz = (b1.z - a1.z) - dz;
  double from = 0.0;
  double to = 1.0;
  if (std::abs(vz) < 1e-12) {
    if (std::abs(dz) >= vertical_limit_m) return {};
  } else {
    const double t1 = (-vertical_limit_m - dz) / vz;
    const double t2 = (vertical_limit_m - dz) / vz;
    from = std::max(from, std::min(t1, t2));
    to = std::min(to, std::max(t1, t2));
    if (from >= to) return {};
  }
  const double v2 = vx * vx + vy * vy;
  const double t = std::clamp(v2 > 0.0 ? -(dx * vx + dy * vy) / v2 : from, from, to);
  return {std::hypot(dx + t * vx, dy + t * vy), std::abs(dz + t * vz), t};
}

/// The tracks of a record on one grid of time.
struct Grid {
  Instant begin = Instant::max();
  std::size_t count = 0;
  std::vector<Gridded> tracks;
};

Grid grid_of(const RunRecord& record, const Limits& limits) {
  Grid grid;
  Instant end = Instant::min();
  for (const auto& recorded : record.recordings) {
    if (recorded.track.empty()) continue;
    grid.begin = std::min(grid.begin, recorded.track.front().state.time);
    end = std::max(end, recorded.track.back().state.time);
  }
  if (grid.begin >= end) return grid;
  grid.count = static_cast<std::size_t>((end - grid.begin) / kStep) + 1;
  for (const auto& recorded : record.recordings) {
    if (recorded.track.empty()) continue;
    grid.tracks.push_back({recorded.vehicle, on_grid(flown_part(recorded.track), grid.begin,
                                                     grid.count, limits.track_gap_s)});
  }
  return grid;
}

/// Looks at pairs of tracks, slice by slice; a pass below the limit is told once, at its nearest.
class Watch {
 public:
  Watch(const Grid& grid, const Limits& limits) : grid_{grid}, limits_{limits} {}

  void slice(std::size_t from, std::size_t to) {
    std::vector<Box> boxes;
    for (std::size_t k = 0; k < grid_.tracks.size(); ++k) {
      boxes.push_back(box_of(grid_.tracks[k], k, from, to));
    }
    std::sort(boxes.begin(), boxes.end(), [](const Box& a, const Box& b) {
      return std::pair{a.low[0], a.track} < std::pair{b.low[0], b.track};
    });
    // Wider than the limit so that the nearest pass is measured where it is legal too.
    const std::array<double, 3> margin{2.0 * limits_.separation_horizontal_m,
                                       2.0 * limits_.separation_horizontal_m,
                                       limits_.separation_vertical_m};
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (std::size_t j = i + 1; j < boxes.size(); ++j) {
        if (boxes[j].low[0] > boxes[i].high[0] + margin[0]) break;
        if (!boxes[i].near(boxes[j], margin)) continue;
        const auto [first, second] = std::minmax(boxes[i].track, boxes[j].track);
        for (std::size_t step = from; step < to; ++step) pass(first, second, step);
      }
    }
  }

  [[nodiscard]] const Worst& nearest_m() const { return nearest_m_; }
  [[nodiscard]] std::vector<Violation> take() { return std::move(violations_); }

 private:
  struct Episode {
    std::size_t last_step = 0;
    std::size_t violation = 0;
    double nearest_m = 0.0;
  };

  void pass(std::size_t first, std::size_t second, std::size_t step) {
    const auto& a = grid_.tracks[first].samples;
    const auto& b = grid_.tracks[second].samples;
    if (!a[step].known || !a[step + 1].known || !b[step].known || !b[step + 1].known) return;
    const Approach approach =
        closest(a[step], a[step + 1], b[step], b[step + 1], limits_.separation_vertical_m);
    // Where nobody is in one layer there is no approach.
    if (approach.horizontal_m < nearest_m_.value) {
      nearest_m_.lower(approach.horizontal_m, moment_of(step, approach));
    }
    if (approach.horizontal_m >= limits_.separation_horizontal_m) return;
    const auto [it, is_new] = episodes_.try_emplace({first, second});
    Episode& episode = it->second;
    if (is_new || step > episode.last_step + 1) {
      episode = {step, violations_.size(), approach.horizontal_m};
      violations_.push_back(violation(first, second, step, approach));
    } else if (approach.horizontal_m < episode.nearest_m) {
      episode.nearest_m = approach.horizontal_m;
      violations_[episode.violation] = violation(first, second, step, approach);
    }
    episode.last_step = step;
  }

  [[nodiscard]] Instant moment_of(std::size_t step, const Approach& approach) const {
    return grid_.begin + kStep * static_cast<Duration::rep>(step) +
           from_seconds(approach.share * to_seconds(kStep));
  }

  [[nodiscard]] Violation violation(std::size_t first, std::size_t second, std::size_t step,
                                    const Approach& approach) const {
    const Instant when = moment_of(step, approach);
    const VehicleId one = grid_.tracks[first].vehicle;
    return {one, when,
            vehicle_name(one) + " and " + vehicle_name(grid_.tracks[second].vehicle) + " came " +
                at(when) + " within " + fixed(approach.horizontal_m, 1) + " m horizontally and " +
                fixed(approach.vertical_m, 1) + " m vertically (limits " +
                fixed(limits_.separation_horizontal_m, 0) + " m and " +
                fixed(limits_.separation_vertical_m, 0) + " m)"};
  }

  const Grid& grid_;
  const Limits& limits_;
  std::map<std::pair<std::size_t, std::size_t>, Episode> episodes_;
  std::vector<Violation> violations_;
  Worst nearest_m_{.value = 1e12, .at = {}};
};

}  // namespace

CheckResult check_separation(const RunRecord& record, const Limits& limits) {
  CheckResult result{"separation",
                     "never below " + fixed(limits.separation_horizontal_m, 0) +
                         " m horizontally and " + fixed(limits.separation_vertical_m, 0) +
                         " m vertically at once",
                     0,
                     "pairs of vehicles",
                     "",
                     {}};
  const Grid grid = grid_of(record, limits);
  if (grid.count == 0) return result;
  result.judged = grid.tracks.size() * (grid.tracks.size() - 1) / 2;
  Watch watch{grid, limits};
  for (std::size_t from = 0; from + 1 < grid.count; from += kStepsPerSlice) {
    watch.slice(from, std::min(from + kStepsPerSlice, grid.count - 1));
  }
  result.violations = watch.take();
  result.moment = watch.nearest_m().at;
  result.measured = watch.nearest_m().at
                        ? "nearest in one layer " + fixed(watch.nearest_m().value, 1) + " m"
                        : "no pair came near";
  return result;
}

}  // namespace skein::checks
