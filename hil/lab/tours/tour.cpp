// SPDX-License-Identifier: Apache-2.0
#include "skein/tours/tour.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "skein/base/angles.hpp"
#include "skein/planning/dubins.hpp"

namespace skein::planning {
namespace {

constexpr std::size_t kSamples = 16;     ///< poses along a way between two stops
constexpr std::size_t kNearEdges = 6;    ///< ways into which a stop is tried
constexpr std::size_t kTakenOutMax = 5;  ///< stops in one step
constexpr int kHalvings = 7;             ///< of the steps in which a pose is moved
constexpr int kFineHalvings = 16;        ///< of the best way
constexpr double kHot = 0.1;             ///< accepted at first, as a share of the mean way
constexpr double kCold = 1e-4;           ///< and at last
constexpr std::uint64_t kCycle = 500;    ///< steps from hot to cold, then hot again from the best
constexpr double kTurns = 0.1;           ///< of the steps, in which a part is turned round
constexpr double kTurnNoise = 0.2;
constexpr double kNoise = 0.1;  ///< by which a place looks better or worse than it is

/// Of an open way the first visit is no stop, but where the vehicle is.
constexpr std::size_t kStart = std::numeric_limits<std::size_t>::max();

/// A way from one visit to the next, and what it passes.
struct Edge {
  double length_m = 0.0;
  std::array<Pose2, kSamples> passes{};
};

/// The visits in a ring; of an open way the edge behind the last is none.
struct Way {
  std::vector<TourVisit> visits;
  std::vector<Edge> edges;  ///< i: from visit i to the one behind it
  double length_m = 0.0;
};

class Search {
 public:
  Search(const TourProblem& problem, Random& random, const PlanningBudget& budget)
      : problem_{problem}, random_{random}, budget_{budget} {}

  Tour run();

 private:
  using Index = std::size_t;

  [[nodiscard]] bool is_open() const { return problem_.start.has_value(); }
  [[nodiscard]] double length(const Pose2& from, const Pose2& to) const {
    return shortest_dubins_length(from, to, problem_.turn_radius_m);
  }
  [[nodiscard]] Index after(const Way& way, Index i) const {
    return i + 1 == way.visits.size() ? 0 : i + 1;
  }
  [[nodiscard]] Index before(const Way& way, Index i) const {
    return i == 0 ? way.visits.size() - 1 : i - 1;
  }
  /// Of an open way visit 0 is the start, and nothing follows the last.
  [[nodiscard]] bool has_edge(const Way& way, Index i) const {
    return !is_open() || i + 1 < way.visits.size();
  }

  void measure(Way& way, Index i) const;
  void measure_all(Way& way) const;
  static void add_up(Way& way);
  [[nodiscard]] Vec2 into(std::size_t stop, const Vec2& place) const;
  [[nodiscard]] double around(const Way& way, Index i, const Pose2& at) const;
  bool settle(Way& way, Index i, int halvings = kHalvings) const;
  void settle_all(Way& way) const;
  void take_out(Way& way, std::vector<std::size_t>& out);
  void remove(Way& way, Index i) const;
  void put_in(Way& way, std::size_t stop, double noise);
  bool turn_round(Way& way);
  [[nodiscard]] Way first(double noise);

  const TourProblem& problem_;
  Random& random_;
  const PlanningBudget& budget_;
};

void Search::measure(Way& way, Index i) const {
  Edge& edge = way.edges[i];
  if (!has_edge(way, i)) {
    edge = {};
    return;
  }
  const DubinsPath path =
      shortest_dubins(way.visits[i].at, way.visits[after(way, i)].at, problem_.turn_radius_m);
  edge.length_m = path.length_m();
  const Path pieces = path.to_path();
  for (std::size_t k = 0; k < kSamples; ++k) {
    const double share = static_cast<double>(k + 1) / static_cast<double>(kSamples + 1);
    edge.passes[k] = pieces.pose_at(share * edge.length_m);
  }
}

void Search::add_up(Way& way) {
  way.length_m = std::accumulate(way.edges.begin(), way.edges.end(), 0.0,
                                 [](double sum, const Edge& e) { return sum + e.length_m; });
}

void Search::measure_all(Way& way) const {
  way.edges.resize(way.visits.size());
  for (Index i = 0; i < way.visits.size(); ++i) measure(way, i);
  add_up(way);
}

/// The place of the circle that is nearest.
Vec2 Search::into(std::size_t stop, const Vec2& place) const {
  const TourStop& circle = problem_.stops[stop];
  const Vec2 off = place - circle.centre;
  const double distance = off.norm();
  if (distance <= circle.radius_m) return place;
  return circle.centre + circle.radius_m / distance * off;
}

/// What is flown to that visit and on from it, if it is there.
double Search::around(const Way& way, Index i, const Pose2& at) const {
  const double in = length(way.visits[before(way, i)].at, at);
  return has_edge(way, i) ? in + length(at, way.visits[after(way, i)].at) : in;
}

/// Moves a visit downhill, its neighbours staying; says whether that was worth it.
bool Search::settle(Way& way, Index i, int halvings) const {
  if (is_open() && i == 0) return false;
  TourVisit& visit = way.visits[i];
  const double radius = problem_.stops[visit.stop].radius_m;
  const Pose2 was = visit.at;
  double cost = around(way, i, was);
  const double cost_before = cost;
  double reach_m = std::max(radius / 2.0, 0.0);
  double turn_rad = 0.4;
  const auto try_at = [&](const Vec2& place, double heading) {
    const Vec2 inside = into(visit.stop, place);
    const Pose2 there{inside.x(), inside.y(), wrap_pi(heading)};
    const double then = around(way, i, there);
    if (then >= cost - 1e-12) return false;
    cost = then;
    visit.at = there;
    return true;
  };
  for (int k = 0; k < halvings;) {
    bool better = false;
    const Vec2 forward = unit_vector(visit.at.heading_rad);
    for (const double sign : {1.0, -1.0}) {
      better |= try_at(visit.at.position(), visit.at.heading_rad + sign * turn_rad);
    }
    if (radius > 0.0) {
      for (const Vec2& along : {forward, left_of(forward)}) {
        for (const double sign : {1.0, -1.0}) {
          better |= try_at(visit.at.position() + sign * reach_m * along, visit.at.heading_rad);
        }
      }
    }
    ++k;
    if (better) continue;
    reach_m /= 2.0;
    turn_rad /= 2.0;
  }
  if (cost >= cost_before - 1e-9) {
    visit.at = was;
    return false;
  }
  measure(way, before(way, i));
  measure(way, i);
  return true;
}

void Search::settle_all(Way& way) const {
  for (int sweep = 0; sweep < 50; ++sweep) {
    bool better = false;
    for (Index i = 0; i < way.visits.size(); ++i) better |= settle(way, i, kFineHalvings);
    if (!better) break;
  }
  add_up(way);
}

void Search::remove(Way& way, Index i) const {
  way.visits.erase(way.visits.begin() + static_cast<std::ptrdiff_t>(i));
  way.edges.erase(way.edges.begin() + static_cast<std::ptrdiff_t>(i));
  if (way.visits.empty()) return;
  measure(way, i == 0 ? way.visits.size() - 1 : i - 1);
}

/// Neighbours in the way, or near each other, or any.
void Search::take_out(Way& way, std::vector<std::size_t>& out) {
  const Index fixed = is_open() ? 1 : 0;
  const std::size_t free = way.visits.size() - fixed;
  const std::size_t most = std::min(kTakenOutMax, free - (is_open() ? 0 : 1));
  if (most == 0) return;
  const std::size_t count = 1 + random_.index(most);
  const double kind = random_.uniform();
  const std::size_t seed = way.visits[fixed + random_.index(free)].stop;
  for (std::size_t k = 0; k < count; ++k) {
    Index chosen = fixed;
    const std::size_t left = way.visits.size() - fixed;
    if (kind < 0.4) {  // what follows the seed
      const auto at = std::ranges::find(way.visits, seed, &TourVisit::stop);
      chosen = at == way.visits.end() ? fixed + random_.index(left)
                                      : static_cast<Index>(at - way.visits.begin());
      if (k + 1 < count) chosen = std::max(fixed, after(way, chosen));
    } else if (kind < 0.8) {  // nearest to the seed
      double nearest = std::numeric_limits<double>::infinity();
      for (Index i = fixed; i < way.visits.size(); ++i) {
        const Vec2 off = problem_.stops[way.visits[i].stop].centre - problem_.stops[seed].centre;
        const double far = off.norm() * (1.0 + 0.5 * random_.uniform());
        if (far < nearest) {
          nearest = far;
          chosen = i;
        }
      }
    } else {
      chosen = fixed + random_.index(left);
    }
    out.push_back(way.visits[chosen].stop);
    remove(way, chosen);
  }
}

void Search::put_in(Way& way, std::size_t stop, double noise) {
  const TourStop& circle = problem_.stops[stop];
  // The ways that pass nearest, and where.
  struct Near {
    Index edge = 0;
    double off_m = std::numeric_limits<double>::infinity();
    Pose2 pass;
  };
  std::array<Near, kNearEdges> nearest{};
  for (Index i = 0; i < way.visits.size(); ++i) {
    Near near{i, std::numeric_limits<double>::infinity(), way.visits[i].at};
    const auto look = [&](const Pose2& pass) {
      const double off = (pass.position() - circle.centre).norm();
      if (off < near.off_m) near = {i, off, pass};
    };
    look(way.visits[i].at);
    if (has_edge(way, i)) {
      for (const Pose2& pass : way.edges[i].passes) look(pass);
    }
    if (near.off_m >= nearest.back().off_m) continue;
    nearest.back() = near;
    for (std::size_t k = kNearEdges - 1; k > 0 && nearest[k].off_m < nearest[k - 1].off_m; --k) {
      std::swap(nearest[k], nearest[k - 1]);
    }
  }
  double least = std::numeric_limits<double>::infinity();
  Index behind = 0;
  Pose2 at;
  for (const Near& near : nearest) {
    if (std::isinf(near.off_m)) break;
    const Pose2& from = way.visits[near.edge].at;
    const bool ends = !has_edge(way, near.edge);
    const Pose2& to = ends ? from : way.visits[after(way, near.edge)].at;
    const Vec2 place = into(stop, near.pass.position());
    const Vec2 there = place - from.position();
    const Vec2 on = ends ? there : Vec2{to.position() - place};
    const std::array<double, 4> headings{
        near.pass.heading_rad, std::atan2(there.y(), there.x()), std::atan2(on.y(), on.x()),
        near.pass.heading_rad + wrap_pi(std::atan2(on.y(), on.x()) - near.pass.heading_rad) / 2.0};
    for (const double heading : headings) {
      const Pose2 pose{place.x(), place.y(), heading};
      double more = length(from, pose) - (ends ? 0.0 : way.edges[near.edge].length_m);
      if (!ends) more += length(pose, to);
      more *= 1.0 + noise * random_.uniform();
      if (more >= least) continue;
      least = more;
      behind = near.edge;
      at = pose;
    }
  }
  const Index i = behind + 1;
  way.visits.insert(way.visits.begin() + static_cast<std::ptrdiff_t>(i), TourVisit{stop, at});
  way.edges.insert(way.edges.begin() + static_cast<std::ptrdiff_t>(i), Edge{});
  measure(way, behind);
  measure(way, i);
  if (least < 1e-6 * problem_.turn_radius_m) return;  // it is passed anyway
  settle(way, i);
  settle(way, before(way, i));
  settle(way, after(way, i));
}

/// A part of the way is flown backwards: only where it is joined to the rest its length changes.
bool Search::turn_round(Way& way) {
  const std::size_t n = way.visits.size();
  if (n < 4) return false;
  const auto reversed = [](const Pose2& pose) {
    return Pose2{pose.x_m, pose.y_m, wrap_pi(pose.heading_rad + kPi)};
  };
  double least = std::numeric_limits<double>::infinity();
  std::pair<Index, Index> part;
  for (Index i = 0; i + 2 < n; ++i) {
    for (Index j = i + 2; j < n; ++j) {  // i+1 .. j is turned
      if (!is_open() && i == 0 && j + 1 == n) continue;
      double more = length(way.visits[i].at, reversed(way.visits[j].at)) - way.edges[i].length_m;
      if (has_edge(way, j)) {
        more += length(reversed(way.visits[i + 1].at), way.visits[after(way, j)].at) -
                way.edges[j].length_m;
      }
      more += kTurnNoise * random_.uniform() * way.edges[i].length_m;
      if (more < least) {
        least = more;
        part = {i, j};
      }
    }
  }
  const auto [i, j] = part;
  std::reverse(way.visits.begin() + static_cast<std::ptrdiff_t>(i) + 1,
               way.visits.begin() + static_cast<std::ptrdiff_t>(j) + 1);
  for (Index k = i + 1; k <= j; ++k) way.visits[k].at = reversed(way.visits[k].at);
  for (Index k = i; k <= j; ++k) measure(way, k);
  for (const Index k : {i, i + 1, j, after(way, j)}) settle(way, k);
  return true;
}

/// Each stop where it costs least, the farthest first.
Way Search::first(double noise) {
  Way way;
  Vec2 middle{0.0, 0.0};
  for (const TourStop& stop : problem_.stops) middle += stop.centre;
  middle /= static_cast<double>(problem_.stops.size());
  if (is_open()) {
    way.visits.push_back({kStart, *problem_.start});
    measure_all(way);
    middle = problem_.start->position();
  }
  std::vector<std::size_t> order(problem_.stops.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater{}, [&](std::size_t stop) {
    return (problem_.stops[stop].centre - middle).norm();
  });
  if (noise > 0.0) {
    for (std::size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[random_.index(k)]);
  }
  for (const std::size_t stop : order) {
    if (!way.visits.empty()) {
      put_in(way, stop, noise);
      continue;
    }
    const Vec2 place = into(stop, middle);
    way.visits.push_back({stop, {place.x(), place.y(), 0.0}});
    measure_all(way);
  }
  add_up(way);
  return way;
}

Tour Search::run() {
  Way best = first(0.0);
  settle_all(best);
  Way present = best;
  std::vector<std::size_t> out;
  std::uint64_t step = 0;
  const auto ways = static_cast<double>(problem_.stops.size());
  for (; !budget_.is_spent(step); ++step) {
    const double cooled = static_cast<double>(step % kCycle) / static_cast<double>(kCycle);
    if (step % kCycle == 0) present = (step / kCycle) % 2 == 1 ? first(kNoise) : best;
    const double share = kHot * std::pow(kCold / kHot, cooled);
    const double accepted_m = share * best.length_m / ways * -std::log(1.0 - random_.uniform());
    Way next = present;
    out.clear();
    if (random_.chance(kTurns) && turn_round(next)) {
      // that is the change
    } else {
      take_out(next, out);
    }
    for (std::size_t k = out.size(); k > 1; --k) std::swap(out[k - 1], out[random_.index(k)]);
    for (const std::size_t stop : out) put_in(next, stop, kNoise);
    add_up(next);
    if (next.length_m >= present.length_m + accepted_m) continue;
    present = std::move(next);
    if (present.length_m < best.length_m - 1e-9) {
      settle_all(present);
      best = present;
    }
  }
  settle_all(best);
  Tour tour;
  for (Index i = is_open() ? 1 : 0; i < best.visits.size(); ++i) {
    tour.visits.push_back(best.visits[i]);
  }
  tour.length_m = best.length_m;
  tour.steps = step;
  return tour;
}

}  // namespace

Result<Tour> plan_tour(const TourProblem& problem, Random& random, const PlanningBudget& budget) {
  if (problem.stops.empty()) return Error{"a tour has one stop at least"};
  if (problem.stops.size() > kTourStopsMax) {
    return Error{"a tour has " + std::to_string(kTourStopsMax) + " stops at most"};
  }
  if (!std::isfinite(problem.turn_radius_m) || problem.turn_radius_m <= 0.0) {
    return Error{"the turn radius of a tour is above 0 m"};
  }
  for (const TourStop& stop : problem.stops) {
    if (!stop.centre.allFinite() || !std::isfinite(stop.radius_m) || stop.radius_m < 0.0) {
      return Error{"a stop of a tour has a place, and a radius of 0 m at least"};
    }
  }
  return Search{problem, random, budget}.run();
}

}  // namespace skein::planning
