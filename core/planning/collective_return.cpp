// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/collective_return.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "return_holds.hpp"
#include "return_track.hpp"
#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"
#include "skein/planning/dubins.hpp"

namespace skein::planning {
namespace {

/// Between two delays that are tried: in less a conflict seldom ends; and of long ones this share.
constexpr double kDelayStep_s = 2.0;
constexpr double kDelayStep = 0.02;
/// Detours, in turn radii: straight on first; a turn and some way on; over a point beside the
/// middle of the way.
constexpr std::array kStraightOn{2.0, 4.0, 7.0, 12.0};
constexpr std::array kTurnFirst_rad{-kPi, -0.5 * kPi, 0.5 * kPi, kPi};
constexpr std::array kBeside{-12.0, -6.0, -3.0, 3.0, 6.0, 12.0};
/// Around the orbits of others there is room for what stay_apart() refuses besides.
constexpr double kAround_m = 2.0;
/// Onto an orbit, besides the tangent.
constexpr int kEntries = 3;
constexpr double kSpeedMin_mps = 0.1;
constexpr double kRadiusMin_m = 0.1;
constexpr double kFar_m = 1e7;

/// A way to a vehicle's orbit; laps are flown where the first part ends.
struct Way {
  Path first;
  Path rest;
  double length_m = 0.0;
  double flown_s = 0.0;                ///< without laps
  std::vector<std::size_t> through{};  ///< whose places to wait it leads through
};

/// What does not depend on the order of priority.
struct Homecoming {
  std::optional<ReturnFailure> failure;
  ReturnHold hold;
  std::vector<Way> ways;      ///< the shortest that was found first
  std::optional<Ring> waits;  ///< where it can fly laps first, beside all others that do
  /// No place is looked for: it has its way, or none.
  [[nodiscard]] bool done(const ReturningVehicle& v) const { return failure || v.flies; }
};

/// One of a vehicle's ways, at one time.
struct Candidate {
  double arrival_s = 0.0;
  double length_m = 0.0;  ///< laps included
  std::size_t way = 0;
  double lap_side = 0.0;  ///< 0: none, slower instead
  double extra_m = 0.0;   ///< of laps
  [[nodiscard]] auto key() const { return std::tuple{arrival_s, length_m, way, lap_side}; }
};

/// A vehicle that has its way.
struct Placed {
  std::size_t index = 0;
  ReturnFlight flight;
  ReturnTrack track;
};

/// That are tried: none, then in steps that widen.
std::vector<double> delays_up_to(double most_s) {
  std::vector<double> all{0.0};
  while (true) {
    const double next_s = all.back() + std::max(kDelayStep_s, kDelayStep * all.back());
    if (next_s > most_s) return all;
    all.push_back(next_s);
  }
}

bool has_sense(const ReturningVehicle& v) {
  if (v.flies) {
    const TimedPath& timed = *v.flies;
    return timed.tail_curvature_per_m != 0.0 && timed.speed_mps >= kSpeedMin_mps &&
           timed.paces.empty() && timed.on_time_m == 0.0 &&
           std::isfinite(timed.wind_per_speed().norm()) && timed.path.length_m() <= kFar_m &&
           std::isfinite(v.height_m) && v.home.norm() <= kFar_m;
  }
  const bool finite = std::isfinite(v.start.heading_rad) && std::isfinite(v.height_m) &&
                      std::isfinite(v.arrival_heading_rad.value_or(0.0)) &&
                      std::isfinite(v.range_left_m) && std::isfinite(v.wind_mps.norm());
  // False for what is no number, too.
  return finite && v.start.position().norm() <= kFar_m && v.home.norm() <= kFar_m &&
         v.speed_mps >= kSpeedMin_mps && v.speed_mps <= kFar_m && v.speed_min_mps <= v.speed_mps &&
         v.turn_radius_m >= kRadiusMin_m && v.turn_radius_m <= kFar_m;
}

/// A path from its start on, as it flies.
TimedPath timed_of(const ReturningVehicle& v) {
  TimedPath timed;
  timed.start_time = v.start_time;
  timed.speed_mps = v.speed_mps;
  timed.set_wind(v.wind_mps);
  return timed;
}

double lap_m(const ReturningVehicle& v) { return kTwoPi * v.turn_radius_m; }

class Planner {
 public:
  Planner(const ReturnParams& params, std::span<const ReturningVehicle> vehicles,
          std::span<const Hazard> hazards)
      : params_{params}, vehicles_{vehicles}, hazards_{hazards}, homecomings_(vehicles.size()) {
    std::vector<bool> wanted(vehicles.size(), true);
    std::set<VehicleId> ids;
    for (std::size_t i = 0; i < vehicles.size(); ++i) {
      wanted[i] = has_sense(vehicles[i]) && ids.insert(vehicles[i].id).second;
      if (wanted[i]) {
        const auto& flies = vehicles[i].flies;
        const Instant start = flies ? flies->start_time : vehicles[i].start_time;
        epoch_ = epoch_ ? std::min(*epoch_, start) : start;
      } else {
        fail(i, ReturnObstacle::bad_request);
      }
    }
    const auto holds = assign_holds(params, vehicles, hazards, wanted);
    for (std::size_t i = 0; i < vehicles.size(); ++i) {
      if (holds[i]) homecomings_[i].hold = *holds[i];
      if (wanted[i] && !holds[i]) fail(i, ReturnObstacle::no_room_to_hold);
    }
    for (std::size_t i = 0; i < vehicles.size(); ++i) find_place_to_wait(i);
    for (std::size_t i = 0; i < vehicles.size(); ++i) {
      if (!homecomings_[i].done(vehicles[i])) find_ways(i);
    }
  }

  [[nodiscard]] CollectiveReturn in_order(std::span<const std::size_t> order) {
    std::vector<Placed> placed;
    std::vector<ReturnFailure> failures;
    for (std::size_t i = 0; i < vehicles_.size(); ++i) {
      if (homecomings_[i].failure || !vehicles_[i].flies) continue;
      const TimedPath& flies = *vehicles_[i].flies;
      placed.push_back({i, {vehicles_[i].id, flies, 0.0}, ReturnTrack{flies, epoch()}});
    }
    for (const std::size_t i : order) {
      if (homecomings_[i].done(vehicles_[i])) continue;
      if (auto failure = place(i, placed)) failures.push_back(*failure);
    }
    return collect(placed, failures);
  }

  [[nodiscard]] CollectiveReturn best() {
    CollectiveReturn best;
    CollectiveReturn found;
    std::vector<std::size_t> order;
    std::set<std::vector<std::size_t>> tried;
    for (std::size_t n = 0; n < std::max<std::size_t>(params_.orders, 1); ++n) {
      if (n > 0 && looked_at_ > params_.tries_all) break;
      order = n < kOrders ? first_order(n) : promoted(found, std::move(order));
      if (!tried.insert(order).second) {
        if (n < kOrders) continue;
        break;
      }
      found = in_order(order);
      if (tried.size() == 1 || worth(found) < worth(best)) best = found;
      const bool all = best.failures.size() == given_up();
      const bool soonest = best.length_m <= shortest_m() + 1e-6 && on_time(best);
      if (all && (soonest || n + 1 >= kOrders)) break;
    }
    return best;
  }

 private:
  static constexpr std::size_t kOrders = 3;

  void fail(std::size_t i, ReturnObstacle why, double short_m = 0.0) {
    homecomings_[i].failure = ReturnFailure{vehicles_[i].id, why, {}, short_m};
  }
  [[nodiscard]] Instant epoch() const { return epoch_.value_or(Instant{}); }
  [[nodiscard]] double start_s(std::size_t i) const {
    return to_seconds(vehicles_[i].start_time - epoch());
  }
  [[nodiscard]] double direct_s(std::size_t i) const {
    const auto& ways = homecomings_[i].ways;
    return start_s(i) + (ways.empty() ? 0.0 : ways.front().flown_s);
  }

  // --- ways ---

  void find_place_to_wait(std::size_t i) {
    if (homecomings_[i].done(vehicles_[i])) return;
    for (const double side : {1.0, -1.0}) {
      const Ring ring = ring_of(vehicles_[i].start, side / vehicles_[i].turn_radius_m);
      bool free = keeps_clear(ring);
      for (std::size_t j = 0; j < i && free; ++j) {
        const auto& other = homecomings_[j].waits;
        free = !other || apart_in_height(params_, vehicles_[i], vehicles_[j]) ||
               distance_m(ring, *other) >= params_.separation_horizontal_m;
      }
      if (!free) continue;
      homecomings_[i].waits = ring;
      return;
    }
  }
  [[nodiscard]] bool keeps_clear(const Ring& ring) const {
    return std::ranges::all_of(hazards_, [&](const Hazard& h) {
      return distance_m(ring, h.centre) >= params_.avoidance.safety_radius_m(h);
    });
  }
  /// A ring as a circle to fly around.
  [[nodiscard]] Hazard circle_of(const Ring& ring) const {
    return Hazard{{}, ring.centre, ring.radius_m + params_.separation_horizontal_m + kAround_m};
  }
  [[nodiscard]] bool concerns(std::size_t i, std::size_t j) const {
    return i != j && !homecomings_[j].failure &&
           !apart_in_height(params_, vehicles_[i], vehicles_[j]);
  }

  void find_ways(std::size_t i) {
    const ReturningVehicle& v = vehicles_[i];
    Homecoming& home = homecomings_[i];
    add_way(i, Path{v.start, {}}, hazards_);
    if (home.ways.empty()) return fail(i, ReturnObstacle::no_way);
    const double needs_m = home.ways.front().length_m + lap_m(v);
    if (needs_m > v.range_left_m) {
      return fail(i, ReturnObstacle::out_of_range, needs_m - v.range_left_m);
    }
    add_ways_around(i);
    for (const double radii : kStraightOn) {
      Path first{v.start, {}};
      if (first.append(Segment{0.0, radii * v.turn_radius_m})) add_way(i, first, hazards_);
    }
    for (const double turn_rad : kTurnFirst_rad) {
      Path first{v.start, {}};
      const double curvature = std::copysign(1.0 / v.turn_radius_m, turn_rad);
      if (first.append(Segment{curvature, std::abs(turn_rad) * v.turn_radius_m}) &&
          first.append(Segment{0.0, 3.0 * v.turn_radius_m})) {
        add_way(i, first, hazards_);
      }
    }
    const Vec2 along = entry_of(home.hold, v.start).position() - v.start.position();
    if (along.norm() < v.turn_radius_m) return;
    const double heading = std::atan2(along.y(), along.x());
    for (const double radii : kBeside) {
      const Vec2 over = v.start.position() + 0.5 * along +
                        radii * v.turn_radius_m * left_of(unit_vector(heading));
      auto first = shortest_clear_path(params_.avoidance, v.start, {over.x(), over.y(), heading},
                                       v.turn_radius_m, hazards_);
      if (first) add_way(i, *first, hazards_);
    }
  }

  /// Around where others hold in the end, and around where they may wait besides.
  void add_ways_around(std::size_t i) {
    std::vector<Hazard> circles;
    for (std::size_t j = 0; j < vehicles_.size(); ++j) {
      if (concerns(i, j)) circles.push_back(circle_of(homecomings_[j].hold.ring));
    }
    const Path direct = homecomings_[i].ways.front().rest;
    const Path none{vehicles_[i].start, {}};
    const auto add_around = [&](int entries) {
      if (is_clear(direct, circles)) return;
      std::vector<Hazard> all = circles;
      all.insert(all.end(), hazards_.begin(), hazards_.end());
      add_way(i, none, all, entries);
    };
    add_around(kEntries);
    const std::size_t holds = circles.size();
    for (std::size_t j = 0; j < vehicles_.size(); ++j) {
      const auto& waits = homecomings_[j].waits;
      if (concerns(i, j) && waits) circles.push_back(circle_of(*waits));
    }
    if (circles.size() > holds) add_around(0);
  }

  [[nodiscard]] std::vector<std::size_t> leads_through(std::size_t i, const Path& first,
                                                       const Path& rest) const {
    std::vector<std::size_t> through;
    for (std::size_t j = 0; j < vehicles_.size(); ++j) {
      const auto& waits = homecomings_[j].waits;
      if (!concerns(i, j) || !waits) continue;
      const double apart_m = waits->radius_m + params_.separation_horizontal_m;
      if (!keeps_off(first, waits->centre, apart_m) || !keeps_off(rest, waits->centre, apart_m)) {
        through.push_back(j);
      }
    }
    return through;
  }

  /// The shortest onto the orbit around those circles: along the tangent, else by that many other
  /// entries, where all that orbits beside it may leave only some sides open.
  [[nodiscard]] std::optional<Path> way_in(std::size_t i, const Pose2& from,
                                           std::span<const Hazard> circles, int entries) const {
    const ReturnHold& hold = homecomings_[i].hold;
    const Pose2 tangent = entry_of(hold, from);
    std::optional<Path> best;
    for (int k = 0; k <= (hold.entry ? 0 : entries); ++k) {
      const Pose2 to =
          k == 0 ? tangent : entry_at(hold, tangent.heading_rad + k * kTwoPi / (entries + 1));
      const auto way =
          shortest_clear_path(params_.avoidance, from, to, vehicles_[i].turn_radius_m, circles);
      const bool shorter = way && (!best || way->length_m() < best->length_m());
      if (shorter && is_clear(*way, hazards_)) best = *way;
      if (k == 0 && best) break;
    }
    return best;
  }

  /// From the end of `first` to the orbit, around those circles.
  void add_way(std::size_t i, const Path& first, std::span<const Hazard> circles, int entries = 0) {
    const ReturningVehicle& v = vehicles_[i];
    if (!is_clear(first, hazards_)) return;
    const auto rest = way_in(i, first.end(), circles, entries);
    if (!rest) return;
    // Laps are a piece, too.
    if (first.segments.size() + rest->segments.size() >= kPathSegmentsMax) return;
    const double length_m = first.length_m() + rest->length_m();
    if (length_m + lap_m(v) > v.range_left_m && !homecomings_[i].ways.empty()) return;
    const Vec2 straight = rest->end().position() - v.start.position();
    const double still_m = length_m - timed_of(v).wind_per_speed().dot(straight);
    homecomings_[i].ways.push_back(
        {first, *rest, length_m, still_m / v.speed_mps, leads_through(i, first, *rest)});
  }

  // --- one vehicle after those before it ---

  /// Why it cannot; nothing, and placed, where it can. First without leading through where others
  /// may wait for it, so that these find a way later.
  [[nodiscard]] std::optional<ReturnFailure> place(std::size_t i, std::vector<Placed>& placed) {
    std::map<std::size_t, std::size_t> blockers;  // how often who was in the way
    const std::vector<Candidate> all = candidates(i, placed, blockers);
    for (const bool considerate : {true, false}) {
      const auto found = first_free(i, all, considerate, placed, blockers);
      if (!found) continue;
      const double off_m = homecomings_[i].hold.off_home_m;
      const ReturnTrack track{*found, epoch()};
      placed.push_back({i, {vehicles_[i].id, *found, off_m}, track});
      return std::nullopt;
    }
    ReturnFailure failure{vehicles_[i].id, ReturnObstacle::others, {}, 0.0};
    std::size_t most = 0;
    for (const auto& [index, times] : blockers) {
      if (times <= most) continue;
      most = times;
      failure.other = vehicles_[index].id;
    }
    return failure;
  }

  [[nodiscard]] std::optional<TimedPath> first_free(std::size_t i, std::vector<Candidate> all,
                                                    bool considerate,
                                                    const std::vector<Placed>& placed,
                                                    std::map<std::size_t, std::size_t>& blockers) {
    std::vector<bool> waiting(vehicles_.size(), considerate);
    for (const Placed& other : placed) waiting[other.index] = false;
    const auto disturbs = [&](const Candidate& candidate) {
      const auto& through = homecomings_[i].ways[candidate.way].through;
      return std::ranges::any_of(through, [&](std::size_t j) { return waiting[j]; });
    };
    std::size_t last = 0;  // of `placed`: probably in the way again
    std::size_t tries = 0;
    // Few are looked at, mostly: they are taken out of a heap, not sorted.
    if (considerate) std::erase_if(all, disturbs);
    std::ranges::make_heap(all, std::greater{}, &Candidate::key);
    for (; !all.empty() && tries < params_.tries; all.pop_back(), ++tries) {
      std::ranges::pop_heap(all, std::greater{}, &Candidate::key);
      const Candidate& candidate = all.back();
      auto timed = timed_path(i, candidate);
      if (!timed) continue;
      ++looked_at_;
      const auto blocker = first_blocker(i, ReturnTrack{*timed, epoch()}, placed, last);
      if (!blocker) return timed;
      last = *blocker;
      ++blockers[placed[last].index];
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<std::size_t> first_blocker(std::size_t i, const ReturnTrack& track,
                                                         const std::vector<Placed>& placed,
                                                         std::size_t first) const {
    for (std::size_t n = 0; n < placed.size(); ++n) {
      const std::size_t k = n == 0 ? first : n <= first ? n - 1 : n;
      if (apart_in_height(params_, vehicles_[i], vehicles_[placed[k].index])) continue;
      if (!stay_apart(track, placed[k].track, params_.separation_horizontal_m)) return k;
    }
    return std::nullopt;
  }

  /// Its ways at all times, without those that come too soon before or after
  /// another at its runway.
  [[nodiscard]] std::vector<Candidate> candidates(
      std::size_t i, const std::vector<Placed>& placed,
      std::map<std::size_t, std::size_t>& blockers) const {
    const ReturningVehicle& v = vehicles_[i];
    std::vector<std::pair<double, std::size_t>> arrivals;
    for (const Placed& other : placed) {
      const double apart_m = (vehicles_[other.index].home - v.home).norm();
      if (apart_m <= params_.runway_m) arrivals.emplace_back(other.track.end_s(), other.index);
    }
    const double spacing_s = to_seconds(params_.arrival_spacing);
    const auto keeps_spacing = [&](double arrival_s) {
      const auto near = std::ranges::find_if(
          arrivals, [&](const auto& a) { return std::abs(a.first - arrival_s) < spacing_s; });
      if (near != arrivals.end()) ++blockers[near->second];
      return near == arrivals.end();
    };
    std::vector<Candidate> all;
    const auto& ways = homecomings_[i].ways;
    const auto delays = delays_up_to(to_seconds(params_.delay_max));
    for (std::size_t w = 0; w < ways.size(); ++w) {
      const double length_m = ways[w].length_m;
      const double slowest_s = length_m / std::max(v.speed_min_mps, kSpeedMin_mps);
      for (const double delay_s : delays) {
        const double flown_s = ways[w].flown_s + delay_s;
        const double extra_m = delay_s * v.speed_mps;
        const bool slower = delay_s == 0.0 || (v.speed_min_mps > 0.0 && flown_s <= slowest_s &&
                                               v.wind_mps == Vec2{0.0, 0.0});
        const double needs_m = length_m + (slower ? 0.0 : extra_m);
        if (needs_m + lap_m(v) > v.range_left_m) break;  // later ones need as much or more
        if (!slower && extra_m < lap_m(v)) continue;
        const double arrival_s = start_s(i) + flown_s;
        if (!keeps_spacing(arrival_s)) continue;
        if (slower) {
          all.push_back({arrival_s, needs_m, w, 0.0, 0.0});
        } else {
          for (const double side : {1.0, -1.0}) {
            all.push_back({arrival_s, needs_m, w, side, extra_m});
          }
        }
      }
    }
    return all;
  }

  /// Nothing where its laps would come too near a hazard.
  [[nodiscard]] std::optional<TimedPath> timed_path(std::size_t i, const Candidate& what) const {
    const ReturningVehicle& v = vehicles_[i];
    const Way& way = homecomings_[i].ways[what.way];
    TimedPath timed = timed_of(v);
    timed.tail_curvature_per_m = homecomings_[i].hold.curvature_per_m;
    timed.path = way.first;
    if (what.lap_side != 0.0) {
      // As few laps as are wide enough turn to exactly that length, and to where they began.
      const double laps = std::floor(what.extra_m / lap_m(v));
      const double curvature = what.lap_side * kTwoPi * laps / what.extra_m;
      if (!keeps_clear(ring_of(way.first.end(), curvature))) return std::nullopt;
      if (!timed.path.append(Segment{curvature, what.extra_m})) return std::nullopt;
    } else if (!timed.has_wind()) {
      const double flown_s = what.arrival_s - start_s(i);
      if (flown_s > 0.0) timed.speed_mps = std::min(v.speed_mps, way.length_m / flown_s);
      timed.speed_mps = std::max({timed.speed_mps, v.speed_min_mps, kSpeedMin_mps});
    }
    if (!timed.path.append(way.rest)) return std::nullopt;
    return timed;
  }

  // --- orders of priority ---

  [[nodiscard]] std::vector<std::size_t> first_order(std::size_t n) const {
    const auto key = [&](std::size_t i) {
      if (n == 0) return direct_s(i);
      if (n == 2) return -direct_s(i);
      const auto& ways = homecomings_[i].ways;
      return vehicles_[i].range_left_m - (ways.empty() ? 0.0 : ways.front().length_m);
    };
    std::vector<std::size_t> order(vehicles_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::erase_if(order, [&](std::size_t i) { return homecomings_[i].done(vehicles_[i]); });
    std::ranges::stable_sort(order, {}, key);
    return order;
  }

  /// Who has found no way goes first.
  [[nodiscard]] std::vector<std::size_t> promoted(const CollectiveReturn& found,
                                                  std::vector<std::size_t> order) const {
    std::stable_partition(order.begin(), order.end(), [&](std::size_t i) {
      return std::ranges::any_of(
          found.failures, [&](const ReturnFailure& f) { return f.vehicle == vehicles_[i].id; });
    });
    return order;
  }

  static std::tuple<std::size_t, Instant, double> worth(const CollectiveReturn& found) {
    return {found.failures.size(), found.last_arrival, found.length_m};
  }
  [[nodiscard]] std::size_t given_up() const {
    return static_cast<std::size_t>(std::ranges::count_if(
        homecomings_, [](const Homecoming& h) { return h.failure.has_value(); }));
  }
  [[nodiscard]] double shortest_m() const {
    double sum_m = 0.0;
    for (const Homecoming& h : homecomings_) {
      if (!h.ways.empty() && !h.failure) sum_m += h.ways.front().length_m;
    }
    return sum_m;
  }
  /// Nobody can be home sooner.
  [[nodiscard]] bool on_time(const CollectiveReturn& found) const {
    double last_s = 0.0;
    for (std::size_t i = 0; i < vehicles_.size(); ++i) {
      if (!homecomings_[i].done(vehicles_[i])) last_s = std::max(last_s, direct_s(i));
    }
    return to_seconds(found.last_arrival - epoch()) <= last_s + 1e-6;
  }

  [[nodiscard]] CollectiveReturn collect(const std::vector<Placed>& placed,
                                         const std::vector<ReturnFailure>& failures) const {
    CollectiveReturn all;
    for (std::size_t i = 0; i < vehicles_.size(); ++i) {
      if (vehicles_[i].flies && !homecomings_[i].failure) continue;
      const auto flight = std::ranges::find(placed, i, &Placed::index);
      if (flight != placed.end()) {
        const Instant end = flight->flight.timed.end_time();
        all.last_arrival = all.flights.empty() ? end : std::max(all.last_arrival, end);
        all.length_m += flight->flight.timed.path.length_m();
        all.flights.push_back(flight->flight);
      } else if (homecomings_[i].failure) {
        all.failures.push_back(*homecomings_[i].failure);
      } else {
        const auto failed = std::ranges::find(failures, vehicles_[i].id, &ReturnFailure::vehicle);
        SKEIN_ASSERT(failed != failures.end());
        all.failures.push_back(*failed);
      }
    }
    return all;
  }

  const ReturnParams& params_;
  std::span<const ReturningVehicle> vehicles_;
  std::span<const Hazard> hazards_;
  std::optional<Instant> epoch_;  ///< the first start
  std::vector<Homecoming> homecomings_;
  std::size_t looked_at_ = 0;  ///< ways, in all orders so far
};

}  // namespace

CollectiveReturn plan_return(const ReturnParams& params, std::span<const ReturningVehicle> vehicles,
                             std::span<const Hazard> hazards) {
  return Planner{params, vehicles, hazards}.best();
}

CollectiveReturn plan_return_in_order(const ReturnParams& params,
                                      std::span<const ReturningVehicle> vehicles,
                                      std::span<const Hazard> hazards,
                                      std::span<const std::size_t> order) {
  SKEIN_ASSERT(order.size() == vehicles.size());
  return Planner{params, vehicles, hazards}.in_order(order);
}

std::string reason_of(const ReturnFailure& failure) {
  switch (failure.why) {
    case ReturnObstacle::bad_request:
      return "tells of itself what cannot be, or twice; look at its telemetry";
    case ReturnObstacle::no_way:
      return "has no way home clear of hazards; withdraw a hazard or let it hold";
    case ReturnObstacle::no_room_to_hold:
      return "finds no room for an orbit near its home; give it a height of its own";
    case ReturnObstacle::out_of_range:
      return "lacks " + std::to_string(std::lround(failure.short_m)) +
             " m of range for the way home and an orbit there; recover it where it is";
    case ReturnObstacle::others:
      return "finds no time at which vehicle " + std::to_string(failure.other.value) +
             " is not in its way; give it a height of its own";
    case ReturnObstacle::count:
      break;
  }
  return "has no way home";
}

}  // namespace skein::planning
