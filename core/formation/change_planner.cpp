// SPDX-License-Identifier: Apache-2.0
#include "skein/formation/change_planner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "skein/base/angles.hpp"

namespace skein::formation {
namespace {

/// From its least disc on: a larger one may be shorter in time, since tight turns are slow.
constexpr double kDiscGrowth = 1.03;
constexpr int kDiscsMax = 60;
/// Of a roundabout. Who comes down falls on nobody where there is one alone, so that each more is
/// to spare such a share of the time.
constexpr std::size_t kLevelsMax = 4;
constexpr double kSpared = 0.05;
/// Way of a climb by its height: it costs a hundredth of the speed.
constexpr double kClimb = 12.0;
/// Vehicles that waited for each other rest as near as they may, and start from there.
constexpr double kRounding_m = 1e-3;
/// With less reserve than the way of so long at full speed they would wait for each other for ever:
/// more than the error of clocks and a slot.
constexpr double kCreep_s = 0.1;
/// Ways out for who makes room: up, and so many to the side, in such parts of what is to be between
/// two.
constexpr int kRoomDirections = 16;
constexpr int kRoomSteps = 4;
constexpr int kRoomStepsMax = 5 * kRoomSteps;
/// Of what it starts from, who is led out of a keep-out keeps so much: of the points of a way, the
/// best of the directions passes some nearer than it starts, and to stay is worse.
constexpr double kNearerOnTheWayOut = 0.9;
/// Nearer than this share of what is to be between two it is right below another that may come
/// down, and the shortest way out is the best, whichever vertical it crosses.
constexpr double kBelow = 0.5;

using Pair = std::pair<std::size_t, std::size_t>;

/// What the pairs of a change are to each other.
struct Nearness {
  double least_m = std::numeric_limits<double>::infinity();
  Pair nearest{0, 0};
  std::vector<Pair> conflicts;  ///< nearer than asked
};

std::string metres(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f m", value);
  return text.data();
}

std::string name(VehicleId vehicle) { return "vehicle " + std::to_string(vehicle.value); }

/// Of a request whose change would not be valid(), in the order of what is likely.
Error why_not_valid(const ChangeRequest& request) {
  const MotionLimits& limits = request.limits;
  const auto good = [](double number) { return std::isfinite(number) && number > 0.0; };
  if (!good(limits.speed_mps) || !good(limits.acceleration_mps2) || !good(limits.jerk_mps3) ||
      !good(request.separation.horizontal_m) || !good(request.separation.vertical_m)) {
    return Error{"speed, acceleration, jerk and separation are to be numbers above 0"};
  }
  if (limits.speed_mps > kStopWithin_s * limits.acceleration_mps2) {
    return Error{metres(limits.speed_mps) + "/s cannot be braked in time by " +
                 metres(limits.acceleration_mps2) + "/s2; fly at " +
                 metres(kStopWithin_s * limits.acceleration_mps2) + "/s at most"};
  }
  std::set<VehicleId> seen;
  for (const Transfer& transfer : request.transfers) {
    if (!transfer.from.allFinite() || !transfer.to.allFinite()) {
      return Error{name(transfer.vehicle) + " starts or ends at what is no position"};
    }
    if (!seen.insert(transfer.vehicle).second) {
      return Error{name(transfer.vehicle) + " is named twice"};
    }
  }
  return Error{"a way is too long, or the jerk too small, for a change to end within a day"};
}

/// The transfers, and after them the keep-outs as vehicles that wait.
class Planner {
 public:
  explicit Planner(const ChangeRequest& request)
      : request_{request},
        count_{request.transfers.size()},
        apart_m_{request.separation.horizontal_m + request.reserve_m},
        height_factor_{height_factor(request.separation)} {}

  Result<PlannedChange> plan();
  [[nodiscard]] std::optional<PlannedChange> make_room(
      const std::function<bool(const Transfer&)>& allowed) const;

 private:
  /// The shortest way of any of them that leads it clear; the others stay.
  [[nodiscard]] std::optional<PlannedChange> lead_out(
      const Change& stays, const std::vector<std::size_t>& vehicles,
      const std::function<bool(const Transfer&)>& allowed) const;
  [[nodiscard]] double at_start_m(std::size_t a, std::size_t b) const {
    return stretched(request_.transfers[a].from - request_.transfers[b].from).norm();
  }
  /// Nobody there is late, so no reserve is needed; and who is nearer already may leave.
  [[nodiscard]] double keep_out_wanted_m(std::size_t vehicle, const KeepOut& keep_out) const {
    const double from_m = distance_m(request_.transfers[vehicle].from, keep_out, height_factor_);
    return std::min(request_.separation.horizontal_m, from_m - kRounding_m);
  }
  [[nodiscard]] std::set<VehicleId> right_above(std::size_t vehicle) const;
  [[nodiscard]] bool is_right_below(std::size_t vehicle, const KeepOut& column) const;
  [[nodiscard]] bool clear_of_keep_outs(const Change& change, std::size_t vehicle,
                                        const std::set<VehicleId>& above) const;
  [[nodiscard]] bool rests_too_near(std::size_t vehicle) const;
  [[nodiscard]] bool is_outside(const Vec3& place) const;
  [[nodiscard]] bool leads_clear(const Transfer& way, std::size_t vehicle) const;
  [[nodiscard]] Change straight() const;
  [[nodiscard]] Change layers(const std::vector<int>& layer) const;
  struct Turning {
    Vec2 centre;
    std::vector<bool> who;
  };
  [[nodiscard]] std::optional<Turning> who_turns(const Nearness& straight) const;
  bool give_levels(const Turning& turning, std::size_t levels, Change& change) const;
  [[nodiscard]] std::optional<PlannedChange> around(Turning turning, std::size_t levels,
                                                    Duration within) const;
  [[nodiscard]] std::optional<PlannedChange> around(const Nearness& straight) const;
  [[nodiscard]] std::vector<int> layers_for(const Nearness& straight) const;
  /// Of all pairs; where it need not be complete it ends with the first conflict.
  [[nodiscard]] Nearness nearness(const Change& change, bool complete) const;
  [[nodiscard]] double keep_out_distance(const ChangeMotion& motion, std::size_t mover,
                                         const KeepOut& keep_out, double enough_m) const;
  /// Two vehicles that start nearer than that cannot be led by one plan.
  [[nodiscard]] double least_at_start_m() const {
    const double least = request_.separation.horizontal_m + kCreep_s * request_.limits.speed_mps;
    return std::min(least, apart_m_);
  }
  /// Of two vehicles that start so far apart.
  [[nodiscard]] double wanted_m(double start_m) const {
    return std::clamp(start_m - kRounding_m, least_at_start_m(), apart_m_);
  }
  [[nodiscard]] PlannedChange planned(Change change, Way way, double least_m) const;
  [[nodiscard]] Error too_near(const Nearness& nearness) const;
  [[nodiscard]] Vec3 stretched(Vec3 v) const {
    v.z() *= height_factor_;
    return v;
  }

  const ChangeRequest& request_;
  std::size_t count_;
  double apart_m_;
  double height_factor_;
};

Change Planner::straight() const {
  Change change;
  change.limits = request_.limits;
  change.separation = request_.separation;
  for (const Transfer& transfer : request_.transfers) {
    change.movers.push_back({transfer.vehicle, {transfer.from, transfer.to}, 0});
  }
  return change;
}

double Planner::keep_out_distance(const ChangeMotion& motion, std::size_t mover,
                                  const KeepOut& keep_out, double enough_m) const {
  const double pace = motion.speed_max_mps(mover) * std::max(1.0, height_factor_);
  const double end_s = to_seconds(motion.duration());
  double least = std::numeric_limits<double>::infinity();
  for (double t = 0.0;;) {
    const double d = distance_m(motion.position(mover, from_seconds(t)), keep_out, height_factor_);
    least = std::min(least, d);
    if (t >= end_s || least < enough_m) return least;
    t = std::min(end_s, t + std::max(0.01, (d - enough_m) / std::max(pace, 1e-3)));
  }
}

Nearness Planner::nearness(const Change& change, bool complete) const {
  const ChangeMotion motion{change};
  Nearness result;
  const auto see = [&](double distance, double wanted, Pair pair) {
    if (distance < result.least_m) {
      result.least_m = distance;
      result.nearest = pair;
    }
    if (distance < wanted) result.conflicts.push_back(pair);
  };
  for (std::size_t a = 0; a < count_; ++a) {
    for (std::size_t b = a + 1; b < count_; ++b) {
      const double wanted = wanted_m(at_start_m(a, b));
      see(motion.least_distance_m(a, b, height_factor_, complete ? 0.0 : wanted), wanted, {a, b});
      if (!complete && !result.conflicts.empty()) return result;
    }
    for (std::size_t k = 0; k < request_.keep_outs.size(); ++k) {
      const KeepOut& keep_out = request_.keep_outs[k];
      const double wanted = keep_out_wanted_m(a, keep_out);
      const double d = keep_out_distance(motion, a, keep_out, wanted);
      if (d < wanted) see(d, wanted, {a, count_ + k});
      if (!complete && !result.conflicts.empty()) return result;
    }
  }
  return result;
}

/// Who is in a conflict, in the middle of all conflicts. Nothing where one is with a keep-out:
/// nobody can make that turn with the others.
std::optional<Planner::Turning> Planner::who_turns(const Nearness& straight_lines) const {
  Turning turning{{0.0, 0.0}, std::vector<bool>(count_, false)};
  for (const auto& [a, b] : straight_lines.conflicts) {
    if (b >= count_) return std::nullopt;
    // Where the two are nearest, both are the same share of their ways on.
    const Transfer& first = request_.transfers[a];
    const Transfer& second = request_.transfers[b];
    const Vec3 begin = stretched(first.from - second.from);
    const Vec3 way = stretched(first.to - second.to) - begin;
    const double squared = way.squaredNorm();
    const double share = squared > 0.0 ? std::clamp(-begin.dot(way) / squared, 0.0, 1.0) : 0.0;
    const Vec3 middle = 0.5 * (first.from + share * (first.to - first.from) + second.from +
                               share * (second.to - second.from));
    turning.centre += Vec2{middle.x(), middle.y()};
    turning.who[a] = turning.who[b] = true;
  }
  turning.centre /= static_cast<double>(straight_lines.conflicts.size());
  return turning;
}

/// Neighbours, as seen from the centre, on one level after the other. False above the ceiling.
bool Planner::give_levels(const Turning& turning, std::size_t levels, Change& change) const {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < count_; ++i) {
    if (!turning.who[i]) continue;
    const Vec2 from = request_.transfers[i].from.head<2>() - turning.centre;
    order.emplace_back(std::atan2(from.y(), from.x()), i);
  }
  std::sort(order.begin(), order.end());
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const std::size_t i = order[rank].second;
    const std::size_t level = rank % levels;
    const Transfer& transfer = request_.transfers[i];
    const double line_m = std::max(transfer.from.z(), transfer.to.z());
    const double over_m = static_cast<double>(level) * change.roundabout->level_m;
    if (level > 0 && line_m + over_m > request_.ceiling_m) return false;
    change.movers[i].level = static_cast<std::uint8_t>(1 + level);
  }
  return true;
}

/// Everybody who turns goes around one disc, on so many levels: the shortest of the discs that keep
/// all apart, if it takes no longer.
std::optional<PlannedChange> Planner::around(Turning turning, std::size_t levels,
                                             Duration within) const {
  const auto on_level = [&] {
    const auto all = std::count(turning.who.begin(), turning.who.end(), true);
    return std::ceil(static_cast<double>(all) / static_cast<double>(levels));
  };
  const double level_m = apart_m_ / height_factor_;
  Change change = straight();
  change.roundabout =
      Roundabout{turning.centre, apart_m_ / (2.0 * std::sin(kPi / std::max(2.0, on_level()))),
                 level_m, kClimb * static_cast<double>(levels - 1) * level_m};
  std::optional<PlannedChange> best;
  for (int disc = 0; disc < kDiscsMax; ++disc, change.roundabout->radius_m *= kDiscGrowth) {
    if (!give_levels(turning, levels, change)) break;
    if (!valid(change)) break;  // a start or a place lies inside the rim, or too near to it
    const Duration duration = ChangeMotion{change}.duration();
    if (best && duration >= best->duration) break;
    if (duration > within) continue;
    const Nearness found = nearness(change, false);
    if (found.conflicts.empty()) {
      best = planned(change, Way::roundabout, found.least_m);
      continue;
    }
    // Who was out of their way may be in it now.
    for (const std::size_t i : {found.conflicts[0].first, found.conflicts[0].second}) {
      if (i < count_) turning.who[i] = true;
    }
  }
  return best;
}

std::optional<PlannedChange> Planner::around(const Nearness& straight_lines) const {
  const auto turning = who_turns(straight_lines);
  if (!turning) return std::nullopt;
  std::optional<PlannedChange> best;
  Duration within = Duration::max();
  for (std::size_t levels = 1; levels <= kLevelsMax; ++levels) {
    auto found = around(*turning, levels, within);
    if (!found) continue;
    within = from_seconds((1.0 - kSpared) * to_seconds(found->duration));
    best = std::move(found);
  }
  return best;
}

/// The least number that no one in conflict has; greedy, in the order of the vehicles. 0 stays
/// below.
std::vector<int> Planner::layers_for(const Nearness& straight_lines) const {
  std::vector<std::vector<std::size_t>> others(count_);
  std::vector<int> layer(count_, 0);
  for (const auto& [a, b] : straight_lines.conflicts) {
    if (b < count_) {
      others[std::max(a, b)].push_back(std::min(a, b));
    } else {
      layer[a] = 1;  // at least, to pass over it
    }
  }
  for (std::size_t i = 0; i < count_; ++i) {
    const auto taken = [&](int number) {
      return std::any_of(others[i].begin(), others[i].end(),
                         [&](std::size_t other) { return layer[other] == number; });
    };
    while (taken(layer[i])) ++layer[i];
  }
  return layer;
}

Change Planner::layers(const std::vector<int>& layer) const {
  double highest = -std::numeric_limits<double>::infinity();
  for (const Transfer& transfer : request_.transfers) {
    highest = std::max({highest, transfer.from.z(), transfer.to.z()});
  }
  for (const KeepOut& keep_out : request_.keep_outs) {
    highest = std::max({highest, keep_out.from.z(), keep_out.to.z()});
  }
  const double step = apart_m_ / height_factor_;
  Change change = straight();
  change.stages = 3;
  for (std::size_t i = 0; i < count_; ++i) {
    const Transfer& transfer = request_.transfers[i];
    Vec3 up = transfer.from;
    Vec3 down = transfer.to;
    if (layer[i] > 0) up.z() = down.z() = highest + layer[i] * step;
    change.movers[i].points = {transfer.from, up, down, transfer.to};
  }
  return change;
}

PlannedChange Planner::planned(Change change, Way way, double least_m) const {
  PlannedChange result;
  result.duration = ChangeMotion{change}.duration();
  result.change = std::move(change);
  result.way = way;
  result.least_separation_m = least_m;
  return result;
}

Error Planner::too_near(const Nearness& nearness) const {
  const auto [a, b] = nearness.nearest;
  const double needed = b < count_ ? apart_m_ : request_.separation.horizontal_m;
  const std::string other = b < count_
                                ? name(request_.transfers[b].vehicle)
                                : name(request_.keep_outs[b - count_].vehicle) + ", which is lost,";
  return Error{name(request_.transfers[a].vehicle) + " and " + other + " would come within " +
               metres(nearness.least_m) + " of each other, and " + metres(needed) +
               " are needed; choose a larger spacing or another place"};
}

/// To another one, or in the column below one that is lost.
bool Planner::rests_too_near(std::size_t vehicle) const {
  if (!is_outside(request_.transfers[vehicle].from)) return true;
  for (std::size_t other = 0; other < count_; ++other) {
    if (other != vehicle && at_start_m(vehicle, other) - kRounding_m < least_at_start_m())
      return true;
  }
  return false;
}

/// Whoever may come down on it.
std::set<VehicleId> Planner::right_above(std::size_t vehicle) const {
  std::set<VehicleId> above;
  for (const KeepOut& keep_out : request_.keep_outs) {
    if (is_right_below(vehicle, keep_out)) above.insert(keep_out.vehicle);
  }
  return above;
}

bool Planner::is_right_below(std::size_t vehicle, const KeepOut& column) const {
  return column.from != column.to &&
         distance_m(request_.transfers[vehicle].from, column, height_factor_) <
             kBelow * request_.separation.horizontal_m;
}

/// Of who is led out; of a keep-out that it is not in, all that is to be kept.
bool Planner::clear_of_keep_outs(const Change& change, std::size_t vehicle,
                                 const std::set<VehicleId>& above) const {
  const ChangeMotion motion{change};
  const double all_m = request_.separation.horizontal_m - kRounding_m;
  return std::ranges::all_of(request_.keep_outs, [&](const KeepOut& keep_out) {
    if (is_right_below(vehicle, keep_out)) return true;
    const double from_m = distance_m(request_.transfers[vehicle].from, keep_out, height_factor_);
    const bool may_be_nearer = from_m < all_m || above.contains(keep_out.vehicle);
    const double wanted = may_be_nearer ? std::min(all_m, kNearerOnTheWayOut * from_m) : all_m;
    return keep_out_distance(motion, vehicle, keep_out, wanted) >= wanted;
  });
}

bool Planner::is_outside(const Vec3& place) const {
  return !is_near_any(place, request_.keep_outs, request_.separation.horizontal_m - kRounding_m,
                      height_factor_);
}

/// Of who moves alone: never nearer to anybody than at its start, and at its end far enough from
/// all.
bool Planner::leads_clear(const Transfer& way, std::size_t vehicle) const {
  if (!is_outside(way.to)) return false;
  const KeepOut flown{way.vehicle, way.from, way.to};
  for (std::size_t other = 0; other < count_; ++other) {
    if (other == vehicle) continue;
    const Vec3& there = request_.transfers[other].from;
    const double wanted = std::min(apart_m_, at_start_m(vehicle, other) - kRounding_m);
    if (distance_m(there, flown, height_factor_) < wanted) return false;
    if (stretched(way.to - there).norm() < apart_m_) return false;
  }
  return true;
}

std::optional<PlannedChange> Planner::make_room(
    const std::function<bool(const Transfer&)>& allowed) const {
  Change stays = straight();
  for (Mover& mover : stays.movers) mover.points.back() = mover.points.front();
  if (!valid(stays)) return std::nullopt;
  // Below one that is lost, and may come down, nobody waits for others.
  std::vector<std::size_t> below;
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < count_; ++i) {
    if (!is_outside(request_.transfers[i].from)) {
      below.push_back(i);
    } else if (rests_too_near(i)) {
      near.push_back(i);
    }
  }
  if (auto way_out = lead_out(stays, below, allowed)) return way_out;
  return lead_out(stays, near, allowed);
}

std::optional<PlannedChange> Planner::lead_out(
    const Change& stays, const std::vector<std::size_t>& vehicles,
    const std::function<bool(const Transfer&)>& allowed) const {
  const double step_m = apart_m_ / kRoomSteps;
  for (int steps = 1; steps <= kRoomStepsMax; ++steps) {
    for (const std::size_t vehicle : vehicles) {
      const std::set<VehicleId> above = right_above(vehicle);
      for (int direction = 0; direction <= kRoomDirections; ++direction) {
        Transfer way = request_.transfers[vehicle];
        way.to = way.from;
        if (direction == 0) {
          way.to.z() += steps * step_m / height_factor_;
          if (way.to.z() > std::max(request_.ceiling_m, way.from.z())) continue;
        } else {
          way.to.head<2>() += steps * step_m * unit_vector(2.0 * kPi * direction / kRoomDirections);
        }
        if (!leads_clear(way, vehicle) || !allowed(way)) continue;
        Change change = stays;
        change.movers[vehicle].points.back() = way.to;
        if (!clear_of_keep_outs(change, vehicle, above)) continue;
        const double least_m = nearness(change, true).least_m;
        return planned(std::move(change), Way::straight, least_m);
      }
    }
  }
  return std::nullopt;
}

Result<PlannedChange> Planner::plan() {
  if (count_ == 0) return Error{"there is no vehicle to move"};
  if (count_ > kMoversMax) {
    return Error{std::to_string(count_) + " vehicles are to move, and " +
                 std::to_string(kMoversMax) +
                 " are the most that a change can tell; fly them as several teams"};
  }
  Change change = straight();
  if (!valid(change)) return why_not_valid(request_);
  const Nearness direct = nearness(change, true);
  if (direct.conflicts.empty()) return planned(std::move(change), Way::straight, direct.least_m);
  if (auto found = around(direct)) return *std::move(found);

  // At one height vehicles may meet that passed over each other before: then they too differ.
  for (Nearness known = direct;;) {
    const Change layered = layers(layers_for(known));
    const auto over_ceiling = [&](const Mover& mover) {
      return mover.points[1].z() > std::max(request_.ceiling_m, mover.points[0].z());
    };
    const auto high = std::find_if(layered.movers.begin(), layered.movers.end(), over_ceiling);
    if (high != layered.movers.end()) {
      return Error{too_near(direct).message + "; passing over each other would take " +
                   metres(high->points[1].z()) + " of height, and the ceiling is " +
                   metres(request_.ceiling_m)};
    }
    const Nearness over = nearness(layered, true);
    if (over.conflicts.empty()) return planned(layered, Way::layers, over.least_m);
    const std::size_t before = known.conflicts.size();
    auto& all = known.conflicts;
    all.insert(all.end(), over.conflicts.begin(), over.conflicts.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    if (known.conflicts.size() == before) return too_near(over);
  }
}

}  // namespace

std::string_view to_string(Way way) {
  switch (way) {
    case Way::straight:
      return "straight";
    case Way::roundabout:
      return "roundabout";
    case Way::layers:
      return "layers";
    case Way::track:
      return "track";
    case Way::count:
      break;
  }
  return "?";
}

double distance_m(const Vec3& position, const KeepOut& keep_out, double height_factor) {
  const auto stretched = [height_factor](Vec3 v) {
    v.z() *= height_factor;
    return v;
  };
  const Vec3 at = stretched(position);
  const Vec3 from = stretched(keep_out.from);
  const Vec3 way = stretched(keep_out.to) - from;
  const double squared = way.squaredNorm();
  const double share = squared > 0.0 ? std::clamp((at - from).dot(way) / squared, 0.0, 1.0) : 0.0;
  return (from + share * way - at).norm();
}

bool is_near_any(const Vec3& position, const std::vector<KeepOut>& keep_outs, double within_m,
                 double height_factor) {
  return std::ranges::any_of(keep_outs, [&](const KeepOut& keep_out) {
    return distance_m(position, keep_out, height_factor) < within_m;
  });
}

Result<PlannedChange> plan_change(const ChangeRequest& request) { return Planner{request}.plan(); }

std::optional<PlannedChange> make_room(const ChangeRequest& request,
                                       const std::function<bool(const Transfer&)>& allowed) {
  return Planner{request}.make_room(allowed);
}

}  // namespace skein::formation
