// SPDX-License-Identifier: Apache-2.0
#include "area_lanes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "skein/base/angles.hpp"

namespace skein::planning {
namespace {

constexpr double kCellsMax = 20'000.0;
constexpr double kCellsPerRadius = 5.0;
constexpr double kTouch_m = 1e-6;
constexpr double kLaneStep_m = 4.0;  ///< from one place of a lane that is looked at to the next
constexpr std::size_t kMoreLanesMax = 48;
constexpr std::size_t kLookedAt = 6;  ///< unseen cells, before a lane is added for one

/// The part of a polygon between two heights, in the frame of the lanes.
struct Trapezoid {
  double low = 0.0, high = 0.0;
  double west_low = 0.0, west_high = 0.0, east_low = 0.0, east_high = 0.0;
};

struct Edge {
  Vec2 low, high;
  [[nodiscard]] double east_at(double y) const {
    return low.x() + (y - low.y()) / (high.y() - low.y()) * (high.x() - low.x());
  }
};

std::vector<Vec2> turned(std::span<const Vec2> corners, double by_rad) {
  std::vector<Vec2> all;
  const Vec2 along = unit_vector(by_rad);
  for (const Vec2& corner : corners)
    all.emplace_back(along.dot(corner), left_of(along).dot(corner));
  return all;
}

std::vector<Edge> edges_of(const std::vector<Vec2>& corners) {
  std::vector<Edge> edges;
  Vec2 a = corners.back();
  for (const Vec2& b : corners) {
    if (a.y() != b.y()) edges.push_back(a.y() < b.y() ? Edge{a, b} : Edge{b, a});
    a = b;
  }
  return edges;
}

/// Of what lies between two heights between which there is no corner.
void add_trapezoids(const std::vector<Edge>& edges, double low, double high,
                    std::vector<Trapezoid>& into) {
  const double middle = 0.5 * (low + high);
  std::vector<const Edge*> crossed;
  for (const Edge& edge : edges) {
    if (edge.low.y() <= middle && edge.high.y() > middle) crossed.push_back(&edge);
  }
  std::ranges::sort(crossed, {}, [middle](const Edge* e) { return e->east_at(middle); });
  for (std::size_t i = 0; i + 1 < crossed.size(); i += 2) {
    into.push_back({low, high, crossed[i]->east_at(low), crossed[i]->east_at(high),
                    crossed[i + 1]->east_at(low), crossed[i + 1]->east_at(high)});
  }
}

/// What of a slab hangs together.
struct Component {
  std::vector<Trapezoid> parts;
};

bool meet(double west_a, double east_a, double west_b, double east_b) {
  return std::min(east_a, east_b) > std::max(west_a, west_b) + kTouch_m;
}

/// Does one end where the other begins?
bool adjoin(const Trapezoid& below, const Trapezoid& above) {
  return std::abs(below.high - above.low) < kTouch_m &&
         meet(below.west_high, below.east_high, above.west_low, above.east_low);
}

std::vector<Component> components_of(const std::vector<Edge>& edges,
                                     const std::vector<Vec2>& corners, double low, double high) {
  std::vector<double> heights{low, high};
  for (const Vec2& corner : corners) {
    if (corner.y() > low && corner.y() < high) heights.push_back(corner.y());
  }
  std::ranges::sort(heights);
  std::vector<Trapezoid> parts;
  for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
    if (heights[i + 1] - heights[i] > kTouch_m) {
      add_trapezoids(edges, heights[i], heights[i + 1], parts);
    }
  }
  std::vector<std::size_t> group(parts.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t j = 0; j < parts.size(); ++j) {
      if (!adjoin(parts[i], parts[j]) || group[i] == group[j]) continue;
      const std::size_t from = std::max(group[i], group[j]);
      const std::size_t to = std::min(group[i], group[j]);
      std::ranges::replace(group, from, to);
    }
  }
  std::map<std::size_t, Component> by_group;
  for (std::size_t i = 0; i < parts.size(); ++i) by_group[group[i]].parts.push_back(parts[i]);
  std::vector<Component> all;
  for (auto& [number, component] : by_group) all.push_back(std::move(component));
  return all;
}

bool neighbours(const Component& below, const Component& above) {
  return std::ranges::any_of(below.parts, [&above](const Trapezoid& a) {
    return std::ranges::any_of(above.parts, [&a](const Trapezoid& b) { return adjoin(a, b); });
  });
}

/// The shortest lane at that height from which all of the component is seen: what its circle
/// reaches ahead is convex, so corners decide.
Lane lane_over(const Component& component, double y, double radius, double direction_rad) {
  double first = std::numeric_limits<double>::infinity();
  double last = -first;
  const auto take = [&](double x, double at_y) {
    const double reach = std::sqrt(std::max(0.0, radius * radius - (at_y - y) * (at_y - y)));
    first = std::min(first, x + reach);
    last = std::max(last, x - reach);
  };
  for (const Trapezoid& part : component.parts) {
    take(part.west_low, part.low);
    take(part.east_low, part.low);
    take(part.west_high, part.high);
    take(part.east_high, part.high);
  }
  if (first > last) first = last = 0.5 * (first + last);
  const Vec2 along = unit_vector(direction_rad);
  const Vec2 start = first * along + y * left_of(along);
  return {{start.x(), start.y(), direction_rad}, last - first};
}

struct Slabs {
  std::vector<Vec2> corners;
  std::vector<Edge> edges;
  double low = 0.0;
  double width = 0.0;  ///< of each
  std::size_t count = 0;
};

Slabs slabs_of(const AreaProblem& problem, double direction_rad) {
  Slabs slabs;
  slabs.corners = turned(problem.corners, direction_rad);
  slabs.edges = edges_of(slabs.corners);
  const auto [low, high] =
      std::ranges::minmax(slabs.corners, {}, [](const Vec2& corner) { return corner.y(); });
  slabs.low = low.y();
  const double width = high.y() - low.y();
  slabs.count =
      static_cast<std::size_t>(std::max(1.0, std::ceil(width / problem.spacing_m - kTouch_m)));
  slabs.width = width / static_cast<double>(slabs.count);
  return slabs;
}

}  // namespace

Lane Lane::reversed() const {
  const Pose2 last = end();
  return {{last.x_m, last.y_m, wrap_pi(last.heading_rad + kPi)}, length_m};
}

std::optional<std::string> why_no_area(std::span<const Vec2> corners) {
  if (corners.size() < 3 || corners.size() > kAreaCornersMax) {
    return "an area has 3 to " + std::to_string(kAreaCornersMax) + " corners, not " +
           std::to_string(corners.size());
  }
  const bool finite = std::ranges::all_of(corners, [](const Vec2& c) { return c.allFinite(); });
  if (!finite) return "a corner of the area is no place";
  if (!is_simple_polygon({corners.begin(), corners.end()})) {
    return "the outline crosses or touches itself; give its corners in their order around it";
  }
  return std::nullopt;
}

double area_m2(std::span<const Vec2> corners) {
  double twice = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    // About the first corner: far from the origin little is lost.
    twice += cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
  }
  return 0.5 * std::abs(twice);
}

// --- room ---

AreaRoom::AreaRoom(const AreaProblem& problem) : problem_{&problem} {
  for (const Searcher& searcher : problem.searchers) {
    radius_m_ = std::max(radius_m_, searcher.radius_m);
  }
}

bool AreaRoom::is_open(const Vec2& point) const {
  const bool clear = std::ranges::none_of(problem_->hazards, [&](const Hazard& hazard) {
    return (point - hazard.centre).norm() < problem_->avoidance.safety_radius_m(hazard);
  });
  const Fence& fence = problem_->fence;
  return clear && (!fence.exists() || fence.inside_m(point) >= kAreaFenceRoom_m);
}

bool AreaRoom::is_open(const Lane& lane) const {
  const int steps = 1 + static_cast<int>(lane.length_m / kLaneStep_m);
  for (int i = 0; i <= steps; ++i) {
    if (!is_open(advance(lane.start, 0.0, lane.length_m * i / steps).position())) return false;
  }
  return true;
}

bool AreaRoom::can_turn_at(const Pose2& pose) const {
  const Fence& fence = problem_->fence;
  for (const double side : {1.0, -1.0}) {
    const Vec2 centre = pose.position() + side * radius_m_ * left_of(unit_vector(pose.heading_rad));
    const bool clear = std::ranges::none_of(problem_->hazards, [&](const Hazard& hazard) {
      return (centre - hazard.centre).norm() <
             problem_->avoidance.safety_radius_m(hazard) + radius_m_;
    });
    if (clear && (!fence.exists() || fence.inside_m(centre) >= radius_m_ + kAreaFenceRoom_m)) {
      return true;
    }
  }
  return false;
}

std::vector<Lane> AreaRoom::open_parts(const Lane& lane) const {
  if (!bounds()) return {lane};
  const int steps = 1 + static_cast<int>(lane.length_m / kLaneStep_m);
  const auto at = [&](int i) { return advance(lane.start, 0.0, lane.length_m * i / steps); };
  std::vector<Lane> parts;
  for (int i = 0; i <= steps;) {
    if (!is_open(at(i).position())) {
      ++i;
      continue;
    }
    int first = i;
    while (i <= steps && is_open(at(i).position())) ++i;
    int last = i - 1;
    const auto enters = [&](int k) { return can_turn_at(Lane{at(k), 0.0}.reversed().start); };
    while (first <= last && !enters(first)) ++first;
    while (last > first && !can_turn_at(at(last))) --last;
    if (first <= last && can_turn_at(at(last))) {
      parts.push_back({at(first), lane.length_m * (last - first) / steps});
    }
  }
  return parts;
}

// --- lanes ---

std::size_t count_of_lanes(const AreaProblem& problem, double direction_rad) {
  return slabs_of(problem, direction_rad).count;
}

std::vector<AreaCell> lanes_of(const AreaProblem& problem, const AreaRoom& room,
                               double direction_rad) {
  const Slabs slabs = slabs_of(problem, direction_rad);
  std::vector<AreaCell> cells;
  std::vector<std::pair<Component, std::size_t>> before;  ///< of the slab below, and its cell
  for (std::size_t i = 0; i < slabs.count; ++i) {
    const double low = slabs.low + slabs.width * static_cast<double>(i);
    auto here = components_of(slabs.edges, slabs.corners, low, low + slabs.width);
    std::vector<std::pair<Component, std::size_t>> now;
    for (Component& component : here) {
      const auto below = [&](const auto& one) { return neighbours(one.first, component); };
      const auto found = std::ranges::find_if(before, below);
      const bool one_below = std::ranges::count_if(before, below) == 1;
      // It goes on with the cell below where neither of them has another neighbour.
      const bool goes_on =
          one_below && std::ranges::count_if(here, [&](const Component& other) {
                         return !other.parts.empty() && neighbours(found->first, other);
                       }) == 1;
      std::size_t cell = cells.size();
      if (goes_on)
        cell = found->second;
      else
        cells.emplace_back();
      const Lane lane =
          lane_over(component, low + 0.5 * slabs.width, problem.sensor_radius_m, direction_rad);
      for (const Lane& part : room.open_parts(lane)) cells[cell].push_back(part);
      now.emplace_back(component, cell);
    }
    before = std::move(now);
  }
  std::erase_if(cells, [](const AreaCell& cell) { return cell.empty(); });
  return cells;
}

std::vector<Lane> lanes_for_rest(const AreaProblem& problem, const AreaRoom& room, AreaCells& cells,
                                 double direction_rad) {
  const double radius = problem.sensor_radius_m;
  std::vector<Lane> added;
  std::vector<Vec2> rest = cells.unseen();
  const auto gain = [&rest, radius](const Lane& lane) {
    const Vec2 from = lane.start.position();
    const Vec2 to = lane.end().position();
    return std::ranges::count_if(
        rest, [&](const Vec2& point) { return distance_to_segment(point, from, to) <= radius; });
  };
  while (!rest.empty() && added.size() < kMoreLanesMax) {
    std::optional<Lane> best;
    double best_worth = 0.0;
    const auto look = [&](const Vec2& middle, double heading_rad) {
      for (const double half : {0.0, 0.5 * radius, radius, 2.0 * radius}) {
        const Vec2 from = middle - half * unit_vector(heading_rad);
        const Lane lane{{from.x(), from.y(), heading_rad}, 2.0 * half};
        if (!room.is_open(lane) || !room.can_turn_at(lane.end()) ||
            !room.can_turn_at(lane.reversed().end())) {
          continue;
        }
        const double worth =
            static_cast<double>(gain(lane)) / (lane.length_m + kPi * room.radius_m() + radius);
        if (worth <= best_worth) continue;
        best_worth = worth;
        best = lane;
      }
    };
    const std::size_t step = 1 + rest.size() / kLookedAt;
    for (std::size_t i = 0; i < rest.size(); i += step) {
      for (const double away : {0.0, 0.3, 0.6, 0.9}) {
        for (int k = 0; k < (away == 0.0 ? 1 : 12); ++k) {
          const Vec2 at = rest[i] + away * radius * unit_vector(kTwoPi * k / 12.0);
          if (!room.is_open(at)) continue;
          for (int turn = 0; turn < 6; ++turn) look(at, direction_rad + kPi * turn / 6.0);
        }
      }
    }
    if (!best) {  // none of those is seen from anywhere
      std::vector<Vec2> others;
      for (std::size_t i = 0; i < rest.size(); ++i) {
        if (i % step != 0) others.push_back(rest[i]);
      }
      rest = std::move(others);
      continue;
    }
    added.push_back(*best);
    const Vec2 from = best->start.position();
    const Vec2 to = best->end().position();
    cells.see(from, to);
    std::erase_if(
        rest, [&](const Vec2& point) { return distance_to_segment(point, from, to) <= radius; });
  }
  return added;
}

// --- cells ---

AreaCells::AreaCells(std::span<const Vec2> corners, double sensor_radius_m,
                     std::span<const Hazard> hazards)
    : sensor_radius_m_{sensor_radius_m} {
  fineness_m_ =
      std::max(sensor_radius_m / kCellsPerRadius, std::sqrt(area_m2(corners) / kCellsMax));
  const std::vector<Vec2> outline{corners.begin(), corners.end()};
  const std::vector<Edge> edges = edges_of(outline);
  const auto [low, high] = std::ranges::minmax(outline, {}, [](const Vec2& c) { return c.y(); });
  const auto rows = static_cast<int>(std::ceil((high.y() - low.y()) / fineness_m_));
  for (int row = 0; row < rows; ++row) {
    const double y = low.y() + (row + 0.5) * (high.y() - low.y()) / rows;
    std::vector<double> crossings;
    for (const Edge& edge : edges) {
      if (edge.low.y() <= y && edge.high.y() > y) crossings.push_back(edge.east_at(y));
    }
    std::ranges::sort(crossings);
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const double length = crossings[i + 1] - crossings[i];
      const auto count = static_cast<int>(std::ceil(length / fineness_m_));
      for (int k = 0; k < count; ++k) {
        const Vec2 at{crossings[i] + (k + 0.5) * length / count, y};
        const bool barred = std::ranges::any_of(hazards, [&at](const Hazard& hazard) {
          return (at - hazard.centre).norm() < hazard.radius_m;
        });
        if (!barred) cells_.push_back({at});
      }
    }
  }
}

void AreaCells::see(const Vec2& from, const Vec2& to) {
  const double low = std::min(from.y(), to.y()) - sensor_radius_m_;
  const double high = std::max(from.y(), to.y()) + sensor_radius_m_;
  auto cell = std::ranges::lower_bound(cells_, low, {}, [](const Cell& c) { return c.middle.y(); });
  for (; cell != cells_.end() && cell->middle.y() <= high; ++cell) {
    if (cell->seen || distance_to_segment(cell->middle, from, to) > sensor_radius_m_) continue;
    cell->seen = true;
    ++seen_;
  }
}

double AreaCells::share() const {
  return cells_.empty() ? 1.0 : static_cast<double>(seen_) / static_cast<double>(cells_.size());
}

std::vector<Vec2> AreaCells::unseen() const {
  std::vector<Vec2> all;
  for (const Cell& cell : cells_) {
    if (!cell.seen) all.push_back(cell.middle);
  }
  return all;
}

std::vector<Lane> lanes_left(std::span<const Lane> lanes, const AreaCells& cells) {
  struct Part {
    double first = std::numeric_limits<double>::infinity();
    double last = -std::numeric_limits<double>::infinity();
  };
  std::vector<Part> parts(lanes.size());
  const double radius = cells.sensor_radius_m();
  for (const Vec2& cell : cells.unseen()) {
    std::size_t nearest = lanes.size();
    double nearest_m = radius;
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      const double away_m =
          distance_to_segment(cell, lanes[i].start.position(), lanes[i].end().position());
      if (away_m > nearest_m) continue;
      nearest_m = away_m;
      nearest = i;
    }
    if (nearest == lanes.size()) continue;
    const Vec2 along = unit_vector(lanes[nearest].start.heading_rad);
    const Vec2 from_start = cell - lanes[nearest].start.position();
    const double across = cross(along, from_start);
    // A little less, since the cell is more than its middle.
    const double reach =
        std::sqrt(std::max(0.0, radius * radius - across * across)) - cells.fineness_m();
    Part& part = parts[nearest];
    part.first = std::min(part.first, along.dot(from_start) + reach);
    part.last = std::max(part.last, along.dot(from_start) - reach);
  }
  std::vector<Lane> left;
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    auto [first, last] = parts[i];
    if (!std::isfinite(first)) continue;
    if (first > last) first = last = 0.5 * (first + last);
    first = std::clamp(first, 0.0, lanes[i].length_m);
    last = std::clamp(last, 0.0, lanes[i].length_m);
    left.push_back({advance(lanes[i].start, 0.0, first), last - first});
  }
  return left;
}

}  // namespace skein::planning
