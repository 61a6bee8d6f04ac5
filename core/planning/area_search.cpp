// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/area_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "area_lanes.hpp"
#include "skein/base/angles.hpp"
#include "skein/planning/dubins.hpp"
#include "skein/planning/fence_check.hpp"

namespace skein::planning {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kSameDirection_rad = 0.02;
/// So many pieces a vehicle are shared out: the finer, the more evenly.
constexpr std::size_t kPiecesEach = 24;
constexpr double kPieceMin_m = 20.0;
constexpr std::size_t kExchangedMax = 8;  ///< vehicles, of which all pairs are tried
constexpr int kHalvings = 16;
constexpr std::size_t kBestKept = 4;    ///< tours that are shared out, and planned to the last turn
constexpr std::size_t kFirstCells = 6;  ///< that tours begin with
constexpr double kAsMuch = 0.002;       ///< of an area that is seen
constexpr double kWayHomeFactor = 1.2;

double way_m(const Pose2& from, const Lane& to, double radius_m) {
  return shortest_dubins_length(from, to.start, radius_m);
}

double home_m(const Searcher& searcher, const Pose2& end) {
  if (!searcher.home) return 0.0;
  return kWayHomeFactor * (*searcher.home - end.position()).norm() +
         2.0 * kTwoPi * searcher.radius_m;
}

double widest_radius_m(const AreaProblem& problem) {
  double radius = 0.0;
  for (const Searcher& s : problem.searchers) radius = std::max(radius, s.radius_m);
  return radius;
}

// --- the order ---

/// Side by side, or with some left between so that turns need not swing out: there with jumps of
/// `skip`, and back in between, block by block.
std::vector<Lane> with_skips(const AreaCell& cell, std::size_t skip) {
  if (skip < 2) return cell;
  std::vector<Lane> order;
  for (std::size_t block = 0; block < cell.size(); block += 2 * skip) {
    for (std::size_t i = 0; i < skip; ++i) {
      for (const std::size_t at : {block + i, block + i + skip}) {
        if (at < cell.size()) order.push_back(cell[at]);
      }
    }
  }
  return order;
}

/// Each lane in the sense that makes all turns together shortest.
void set_senses(std::vector<Lane>& lanes, double radius_m) {
  if (lanes.empty()) return;
  std::vector<std::array<bool, 2>> from(lanes.size());
  std::array<double, 2> cost{};
  const auto sensed = [&lanes](std::size_t i, bool back) {
    return back ? lanes[i].reversed() : lanes[i];
  };
  for (std::size_t i = 1; i < lanes.size(); ++i) {
    std::array<double, 2> next{kInf, kInf};
    for (const bool back : {false, true}) {
      for (const bool before : {false, true}) {
        const double sum =
            cost[before ? 1 : 0] + way_m(sensed(i - 1, before).end(), sensed(i, back), radius_m);
        if (sum >= next[back ? 1 : 0]) continue;
        next[back ? 1 : 0] = sum;
        from[i][back ? 1 : 0] = before;
      }
    }
    cost = next;
  }
  bool back = cost[1] < cost[0];
  for (std::size_t i = lanes.size(); i-- > 0;) {
    const bool before = from[i][back ? 1 : 0];
    if (back) lanes[i] = lanes[i].reversed();
    back = before;
  }
}

/// All cells, each time the one that begins or ends nearest; from that one on.
std::vector<Lane> tour_from(std::size_t first, const std::vector<AreaCell>& cells,
                            std::size_t skip) {
  std::vector<bool> done(cells.size());
  std::vector<Lane> tour;
  std::size_t next = first;
  bool backwards = false;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    done[next] = true;
    AreaCell cell = cells[next];
    if (backwards) std::ranges::reverse(cell);
    for (const Lane& lane : with_skips(cell, skip)) tour.push_back(lane);
    const Vec2 at = tour.back().end().position();
    double nearest = kInf;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if (done[k]) continue;
      for (const bool from_back : {false, true}) {
        const Lane& lane = from_back ? cells[k].back() : cells[k].front();
        const double away = distance_to_segment(at, lane.start.position(), lane.end().position());
        if (away >= nearest) continue;
        nearest = away;
        next = k;
        backwards = from_back;
      }
    }
  }
  return tour;
}

// --- sharing out ---

/// A tour cut into pieces, and how far it is along it.
struct Tour {
  std::vector<Lane> pieces;
  std::vector<double> begins_m;  ///< of each piece, along the tour
  double length_m = 0.0;
  [[nodiscard]] double ends_m(std::size_t i) const { return begins_m[i] + pieces[i].length_m; }
};

Tour cut(std::span<const Lane> lanes, const AreaProblem& problem) {
  const std::size_t vehicles = problem.searchers.size();
  const double radius_m = widest_radius_m(problem);
  Tour tour;
  double all_m = 0.0;
  for (const Lane& lane : lanes) all_m += lane.length_m;
  const double piece_m = std::max(kPieceMin_m, all_m / static_cast<double>(kPiecesEach * vehicles));
  for (const Lane& lane : lanes) {
    const auto count =
        vehicles == 1 ? 1 : std::max(1, static_cast<int>(std::floor(lane.length_m / piece_m)));
    for (int k = 0; k < count; ++k) {
      tour.pieces.push_back(
          {advance(lane.start, 0.0, lane.length_m * k / count), lane.length_m / count});
    }
  }
  for (std::size_t i = 0; i < tour.pieces.size(); ++i) {
    if (i > 0) tour.length_m += way_m(tour.pieces[i - 1].end(), tour.pieces[i], radius_m);
    tour.begins_m.push_back(tour.length_m);
    tour.length_m += tour.pieces[i].length_m;
  }
  return tour;
}

struct Split {
  std::vector<std::size_t> ends;  ///< of each vehicle's pieces, in the order of vehicles
  std::size_t reached = 0;
  double time_s = kInf;
};

using Order = std::vector<const Searcher*>;

/// Each in turn takes as many as it can in that time.
Split split_within(const Tour& tour, const Order& order, double time_s) {
  Split split;
  split.time_s = 0.0;
  std::size_t next = 0;
  for (const Searcher* searcher : order) {
    std::size_t end = next;
    if (next < tour.pieces.size()) {
      const double way = way_m(searcher->from, tour.pieces[next], searcher->radius_m);
      const double most_m = std::min(time_s * searcher->speed_mps, searcher->range_m);
      double flown_m = 0.0;
      for (; end < tour.pieces.size(); ++end) {
        const double sum_m = way + tour.ends_m(end) - tour.begins_m[next];
        if (sum_m > most_m ||
            sum_m + home_m(*searcher, tour.pieces[end].end()) > searcher->range_m) {
          break;
        }
        flown_m = sum_m;
      }
      split.time_s = std::max(split.time_s, flown_m / searcher->speed_mps);
    }
    split.ends.push_back(end);
    next = end;
  }
  split.reached = next;
  return split;
}

Split best_split(const Tour& tour, const Order& order) {
  double high_s = 0.0;
  for (const Searcher* s : order) high_s = std::max(high_s, s->range_m / s->speed_mps);
  high_s = std::min(high_s, 1e7);
  Split best = split_within(tour, order, high_s);
  double low_s = 0.0;
  high_s = best.time_s;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle_s = 0.5 * (low_s + high_s);
    Split split = split_within(tour, order, middle_s);
    if (split.reached >= best.reached) {
      high_s = std::min(middle_s, split.time_s);
      best = std::move(split);
    } else {
      low_s = middle_s;
    }
  }
  return best;
}

bool better(const Split& a, const Split& b) {
  return a.reached != b.reached ? a.reached > b.reached : a.time_s < b.time_s;
}

/// By where along the tour each is nearest, then by exchanges of neighbours.
std::pair<Order, Split> best_order(const Tour& tour, std::span<const Searcher> searchers) {
  std::vector<std::pair<double, const Searcher*>> along;
  for (const Searcher& searcher : searchers) {
    double nearest = kInf;
    double at_m = 0.0;
    for (std::size_t i = 0; i < tour.pieces.size(); ++i) {
      const double away = (tour.pieces[i].start.position() - searcher.from.position()).norm();
      if (away < nearest) {
        nearest = away;
        at_m = tour.begins_m[i];
      }
    }
    along.emplace_back(at_m, &searcher);
  }
  std::ranges::stable_sort(along, {}, &std::pair<double, const Searcher*>::first);
  Order order;
  for (const auto& [at_m, searcher] : along) order.push_back(searcher);
  Split best = best_split(tour, order);
  if (order.size() <= kExchangedMax) {
    for (std::size_t i = 0; i < order.size(); ++i) {
      for (std::size_t k = i + 1; k < order.size(); ++k) {
        std::swap(order[i], order[k]);
        Split split = best_split(tour, order);
        if (better(split, best))
          best = std::move(split);
        else
          std::swap(order[i], order[k]);
      }
    }
  }
  return {order, best};
}

struct Shared {
  Tour tour;
  Order order;
  Split split;
};

Shared shared_out(const AreaProblem& problem, std::span<const Lane> lanes) {
  Shared shared;
  shared.tour = cut(lanes, problem);
  auto [order, split] = best_order(shared.tour, problem.searchers);
  shared.order = std::move(order);
  shared.split = std::move(split);
  return shared;
}

/// Pieces of one lane that follow each other are one again.
std::vector<Lane> joined(std::span<const Lane> pieces) {
  std::vector<Lane> lanes;
  for (const Lane& piece : pieces) {
    if (!lanes.empty()) {
      const Pose2 end = lanes.back().end();
      const bool goes_on = (end.position() - piece.start.position()).norm() < 1e-6 &&
                           std::abs(wrap_pi(end.heading_rad - piece.start.heading_rad)) < 1e-9;
      if (goes_on) {
        lanes.back().length_m += piece.length_m;
        continue;
      }
    }
    lanes.push_back(piece);
  }
  return lanes;
}

/// Turns stretches of the order round where that is shorter (2-opt: a Dubins way is as long back).
void shorten(const Searcher& searcher, std::vector<Lane>& lanes) {
  const double radius = searcher.radius_m;
  const std::size_t n = lanes.size();
  if (n > 80) return;
  bool any = true;
  for (int round = 0; any && round < 6; ++round) {
    any = false;
    for (std::size_t i = 0; i < n; ++i) {
      const Pose2 before = i == 0 ? searcher.from : lanes[i - 1].end();
      for (std::size_t k = i; k < n; ++k) {
        double now_m = way_m(before, lanes[i], radius);
        double then_m = way_m(before, lanes[k].reversed(), radius);
        if (k + 1 < n) {
          now_m += way_m(lanes[k].end(), lanes[k + 1], radius);
          then_m += way_m(lanes[i].reversed().end(), lanes[k + 1], radius);
        }
        if (then_m > now_m - 0.01) continue;
        std::reverse(lanes.begin() + static_cast<std::ptrdiff_t>(i),
                     lanes.begin() + static_cast<std::ptrdiff_t>(k) + 1);
        for (std::size_t j = i; j <= k; ++j) lanes[j] = lanes[j].reversed();
        any = true;
      }
    }
  }
}

// --- the last turn ---

bool stays_in(const Fence& fence, const Path& path) {
  return !first_outside(fence, path).has_value() &&
         (!fence.exists() || fence.inside_m(path.end().position()) >= 0.0);
}

/// The shortest of the words between the poses that hazards and the fence leave; and by a turn on
/// the spot before or after it.
std::optional<Path> open_dubins(const AreaProblem& problem, const Pose2& from, const Pose2& to,
                                double radius_m) {
  std::optional<Path> best;
  for (std::size_t w = 0; w < static_cast<std::size_t>(DubinsWord::count); ++w) {
    const auto found = dubins_word(static_cast<DubinsWord>(w), from, to, radius_m, radius_m);
    if (!found || (best && found->length_m() >= best->length_m())) continue;
    const Path path = found->to_path();
    if (is_clear(path, problem.hazards) && stays_in(problem.fence, path)) best = path;
  }
  return best;
}

std::optional<Path> way(const AreaProblem& problem, const Searcher& searcher, const Pose2& from,
                        const Pose2& to) {
  const auto clear =
      shortest_clear_path(problem.avoidance, from, to, searcher.radius_m, problem.hazards);
  if (clear && is_clear(*clear, problem.hazards) && stays_in(problem.fence, *clear)) return *clear;
  if (auto path = open_dubins(problem, from, to, searcher.radius_m)) return path;
  // Over another place: along the way there and beside it.
  std::optional<Path> best;
  const Vec2 straight = to.position() - from.position();
  for (const double along : {0.0, 0.5, 1.0}) {
    for (const double aside : {0.0, 2.5, -2.5, 6.0, -6.0}) {
      for (int k = 0; k < 8; ++k) {
        const double heading = from.heading_rad + kTwoPi * k / 8.0;
        const Vec2 at = from.position() + along * straight +
                        aside * searcher.radius_m *
                            left_of(straight.norm() > 1.0 ? Vec2{straight.normalized()}
                                                          : unit_vector(from.heading_rad));
        if (problem.fence.exists() && problem.fence.inside_m(at) < kAreaFenceRoom_m) continue;
        const Pose2 over{at.x(), at.y(), heading};
        const double least = shortest_dubins_length(from, over, searcher.radius_m) +
                             shortest_dubins_length(over, to, searcher.radius_m);
        if (best && least >= best->length_m()) continue;
        auto first = open_dubins(problem, from, over, searcher.radius_m);
        const auto second =
            first ? open_dubins(problem, over, to, searcher.radius_m) : std::nullopt;
        if (!second || !first->append(*second)) continue;
        if (!best || first->length_m() < best->length_m()) best = first;
      }
    }
  }
  return best;
}

AreaPlan planned(const AreaProblem& problem, const Shared& shared) {
  const auto& [tour, order, split] = shared;
  AreaPlan plan;
  std::size_t next = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::span<const Lane> mine{tour.pieces.data() + next, split.ends[i] - next};
    next = split.ends[i];
    if (mine.empty()) continue;
    std::vector<Lane> lanes = joined(mine);
    shorten(*order[i], lanes);
    SearchRoute route = route_over(problem, *order[i], lanes, SIZE_MAX);
    for (const Lane& lane : lanes) {
      const bool flown = std::ranges::any_of(route.lanes, [&lane](const Lane& other) {
        return (other.start.position() - lane.start.position()).norm() < 1e-9 &&
               other.length_m == lane.length_m;
      });
      if (!flown) plan.left_out.push_back(lane);
    }
    plan.time_s = std::max(plan.time_s, route.time_s);
    if (!route.lanes.empty()) plan.routes.push_back(std::move(route));
  }
  const std::span<const Lane> rest{tour.pieces.data() + next, tour.pieces.size() - next};
  for (const Lane& lane : joined(rest)) plan.left_out.push_back(lane);
  plan.bound_s = area_bound_s(problem);
  return plan;
}

/// One way to fly all lanes.
struct Candidate {
  std::vector<Lane> lanes;
  double length_m = 0.0;
  double direction_rad = 0.0;
};

/// At the end of the lane that it is beside.
void insert(const Lane& lane, std::vector<Lane>& lanes) {
  std::size_t at = lanes.size();
  double least = kInf;
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    const double away = distance_to_segment(lane.start.position(), lanes[i].start.position(),
                                            lanes[i].end().position());
    if (away >= least) continue;
    least = away;
    at = i + 1;
  }
  lanes.insert(lanes.begin() + static_cast<std::ptrdiff_t>(at), lane);
}

/// Several orders of the cells.
void add_tours(const AreaProblem& problem, const std::vector<AreaCell>& cells,
               std::span<const Lane> more, double direction_rad, std::vector<Candidate>& into) {
  const double radius = widest_radius_m(problem);
  const auto apart = static_cast<std::size_t>(std::ceil(2.0 * radius / problem.spacing_m));
  std::vector<std::size_t> skips{1};
  if (apart > 1) skips.insert(skips.end(), {apart, apart + 1});
  for (const std::size_t skip : skips) {
    for (std::size_t first = 0; first < std::min(cells.size(), kFirstCells); ++first) {
      std::vector<Lane> lanes = tour_from(first, cells, skip);
      for (const Lane& lane : more) insert(lane, lanes);
      set_senses(lanes, radius);
      double length_m = lanes[0].length_m;
      for (std::size_t i = 1; i < lanes.size(); ++i) {
        length_m += way_m(lanes[i - 1].end(), lanes[i], radius) + lanes[i].length_m;
      }
      into.push_back({std::move(lanes), length_m, direction_rad});
    }
  }
}

void keep_shortest(std::vector<Candidate>& candidates, std::size_t count) {
  std::ranges::stable_sort(candidates, {}, &Candidate::length_m);
  if (candidates.size() > count) candidates.resize(count);
}

/// Shared out, either way round.
AreaPlan best_plan(const AreaProblem& problem, const Candidate& candidate) {
  std::optional<Shared> best;
  std::vector<Lane> lanes = candidate.lanes;
  for (const bool backwards : {false, true}) {
    if (backwards) {
      std::ranges::reverse(lanes);
      for (Lane& lane : lanes) lane = lane.reversed();
    }
    Shared shared = shared_out(problem, lanes);
    if (!best || better(shared.split, best->split)) best = std::move(shared);
  }
  return planned(problem, *best);
}

std::vector<double> directions_of(const AreaProblem& problem) {
  std::vector<double> directions;
  for (std::size_t i = 0; i < problem.corners.size(); ++i) {
    const Vec2 edge = problem.corners[(i + 1) % problem.corners.size()] - problem.corners[i];
    for (const double quarter : {0.0, kPi / 2.0}) {
      double direction = std::atan2(edge.y(), edge.x()) + quarter;
      direction -= kPi * std::floor(direction / kPi);
      const bool known = std::ranges::any_of(directions, [direction](double other) {
        const double off = std::abs(direction - other);
        return std::min(off, kPi - off) < kSameDirection_rad;
      });
      if (!known) directions.push_back(direction);
    }
  }
  return directions;
}

std::optional<std::string> why_not(const AreaProblem& problem) {
  if (auto why = why_no_area(problem.corners)) return why;
  if (problem.searchers.empty()) return "there is nobody to search the area";
  if (problem.searchers.size() > kAreaSearchersMax) {
    return "an area is shared out among " + std::to_string(kAreaSearchersMax) +
           " vehicles at most; name some of them";
  }
  if (!(problem.spacing_m > 0.0) || problem.spacing_m > 2.0 * problem.sensor_radius_m) {
    return "lanes lie at most two sensor radii apart";
  }
  return std::nullopt;
}

AreaPlan with_coverage(const AreaProblem& problem, AreaPlan plan) {
  AreaCells cells{problem.corners, problem.sensor_radius_m, problem.hazards};
  for (const SearchRoute& route : plan.routes) {
    for (const Lane& lane : route.lanes) cells.see(lane.start.position(), lane.end().position());
  }
  plan.covered = cells.share();
  return plan;
}

}  // namespace

double area_bound_s(const AreaProblem& problem) {
  const Fence outline{problem.corners, 0.0};
  std::vector<std::pair<double, double>> begins;  ///< when each can begin, and its speed
  for (const Searcher& s : problem.searchers) {
    const double away_m = -outline.inside_m(s.from.position()) - problem.sensor_radius_m;
    begins.emplace_back(std::max(0.0, away_m) / s.speed_mps, s.speed_mps);
  }
  std::ranges::sort(begins);
  const double ground_m = area_m2(problem.corners) / (2.0 * problem.sensor_radius_m);
  double speeds = 0.0;
  double lost_m = 0.0;
  double bound_s = kInf;
  for (const auto& [begin_s, speed_mps] : begins) {
    speeds += speed_mps;
    lost_m += begin_s * speed_mps;
    bound_s = std::min(bound_s, (ground_m + lost_m) / speeds);
  }
  return bound_s;
}

SearchRoute route_over(const AreaProblem& problem, const Searcher& searcher,
                       std::span<const Lane> lanes, std::size_t segments_max) {
  SearchRoute route;
  route.vehicle = searcher.id;
  Pose2 at = searcher.from;
  std::size_t segments = 0;
  for (const Lane& lane : lanes) {
    auto leg = way(problem, searcher, at, lane.start);
    if (!leg) continue;
    if (lane.length_m > 0.0 && !leg->append(Segment{0.0, lane.length_m})) continue;
    if (segments + leg->segments.size() > segments_max) break;
    const double home = home_m(searcher, leg->end());
    if (route.length_m + leg->length_m() + home > searcher.range_m) break;
    segments += leg->segments.size();
    route.length_m += leg->length_m();
    route.home_m = home;
    at = leg->end();
    route.lanes.push_back(lane);
    route.legs.push_back(*std::move(leg));
  }
  route.time_s = route.length_m / searcher.speed_mps;
  return route;
}

std::optional<Path> way_to_hold(const AreaProblem& problem, const Searcher& searcher,
                                const Pose2& from) {
  const double radius = searcher.radius_m;
  const auto holds = [&](const Pose2& at) {
    Path orbit;
    orbit.start = at;
    return orbit.append(Segment{0.0, 2.0 * radius}) &&
           orbit.append(Segment{1.0 / radius, kTwoPi * radius}) &&
           is_clear(orbit, problem.hazards) && stays_in(problem.fence, orbit);
  };
  Path none;
  none.start = from;
  if (holds(from)) return none;
  std::optional<Path> best;
  for (const double away : {2.0, 4.0, 8.0, 16.0}) {
    for (int k = 0; k < 12; ++k) {
      const Vec2 at = from.position() + away * radius * unit_vector(kTwoPi * k / 12.0);
      for (int turn = 0; turn < 8; ++turn) {
        const Pose2 to{at.x(), at.y(), kTwoPi * turn / 8.0};
        if (best && shortest_dubins_length(from, to, radius) >= best->length_m()) continue;
        if (!holds(to)) continue;
        auto path = open_dubins(problem, from, to, radius);
        if (path && (!best || path->length_m() < best->length_m())) best = path;
      }
    }
    if (best) break;
  }
  return best;
}

AreaPlan share_lanes(const AreaProblem& problem, std::span<const Lane> lanes) {
  Candidate candidate{{lanes.begin(), lanes.end()}};
  set_senses(candidate.lanes, widest_radius_m(problem));
  return best_plan(problem, candidate);
}

Result<AreaPlan> plan_area(const AreaProblem& problem) {
  if (auto why = why_not(problem)) return Error{*std::move(why)};
  const AreaRoom room{problem};
  std::vector<Candidate> candidates;
  std::size_t fewest = SIZE_MAX;
  for (const double direction : directions_of(problem)) {
    const std::size_t count = count_of_lanes(problem, direction);
    fewest = std::min(fewest, count);
    if (count > kAreaLanesMax) continue;
    const auto cells = lanes_of(problem, room, direction);
    if (cells.empty()) continue;
    std::vector<Candidate> tours;
    add_tours(problem, cells, {}, direction, tours);
    keep_shortest(tours, 2);
    candidates.insert(candidates.end(), tours.begin(), tours.end());
  }
  if (candidates.empty()) {
    if (fewest <= kAreaLanesMax) {
      return Error{"hazards and the fence leave no room for a lane with turns at its ends"};
    }
    return Error{"the area takes " + std::to_string(fewest) + " lanes, and " +
                 std::to_string(kAreaLanesMax) +
                 " are the most; draw it smaller, or give a wider spacing"};
  }
  keep_shortest(candidates, kBestKept);
  if (room.bounds()) {
    std::vector<Candidate> complete;
    for (const Candidate& candidate : candidates) {
      AreaCells cells{problem.corners, problem.sensor_radius_m, problem.hazards};
      for (const Lane& lane : candidate.lanes) {
        cells.see(lane.start.position(), lane.end().position());
      }
      const auto more = lanes_for_rest(problem, room, cells, candidate.direction_rad);
      add_tours(problem, lanes_of(problem, room, candidate.direction_rad), more,
                candidate.direction_rad, complete);
    }
    keep_shortest(complete, kBestKept);
    candidates = std::move(complete);
  }
  std::optional<AreaPlan> best;
  for (const Candidate& candidate : candidates) {
    AreaPlan plan = with_coverage(problem, best_plan(problem, candidate));
    const bool more_seen = !best || plan.covered > best->covered + kAsMuch;
    const bool as_much = best && plan.covered > best->covered - kAsMuch;
    if (more_seen || (as_much && plan.time_s < best->time_s)) best = std::move(plan);
  }
  return *std::move(best);
}

}  // namespace skein::planning
