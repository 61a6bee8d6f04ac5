// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "names.hpp"
#include "skein/base/angles.hpp"

namespace skein::mission {
namespace {

/// Of a route: beside them a vehicle needs some for its way to it.
constexpr std::size_t kSegmentsEach = 44;
constexpr double kSegmentsALane = 4.0;
/// From one position that was heard to the next, between which it flew straight on.
constexpr Duration kHeardAgain = std::chrono::seconds{3};
/// To answer, be told, and hear of it again where a message is lost.
constexpr double kTelling_s = 8.0;
/// From the end of one route to the begin of the next, about.
constexpr double kBetweenParts_s = 30.0;

bool has_task(const Telemetry& telemetry) {
  return telemetry.task.site != SiteId{} || telemetry.activity == Activity::surveying ||
         telemetry.activity == Activity::leading || telemetry.activity == Activity::executing ||
         telemetry.activity == Activity::monitoring;
}

bool is_up(const Telemetry& telemetry) {
  const ActivityDetail in_detail = telemetry.detail;
  return in_detail != ActivityDetail::on_ground && in_detail != ActivityDetail::taking_off &&
         !telemetry.state.on_ground();
}

/// The share of the area when all shares are flown.
double seen_in_the_end(planning::AreaCells cells, const AreaSearch& area) {
  for (const auto& [id, share] : area.shares) {
    for (const auto& lane : share.lanes) cells.see(lane.start.position(), lane.end().position());
  }
  return cells.share();
}

bool goes_home(const Telemetry& telemetry) {
  const ActivityDetail in_detail = telemetry.detail;
  return in_detail == ActivityDetail::returning || in_detail == ActivityDetail::at_home ||
         in_detail == ActivityDetail::range_reserve || telemetry.activity == Activity::landing ||
         telemetry.activity == Activity::landed;
}

/// All legs as one way; shorter at its front by what is flown until it begins.
std::optional<Path> joined(const planning::SearchRoute& route, double first_m) {
  Path path;
  path.start = route.legs.front().start;
  for (const Path& leg : route.legs) {
    if (!path.append(leg)) return std::nullopt;
  }
  if (first_m <= 0.0) return path;
  Path rest;
  rest.start = path.pose_at(first_m);
  double begun_m = 0.0;
  for (const Segment& segment : path.segments) {
    const double ends_m = begun_m + segment.length_m;
    const double left_m = ends_m - std::max(first_m, begun_m);
    if (left_m > 0.0 && !rest.append(Segment{segment.curvature_per_m, left_m})) return std::nullopt;
    begun_m = ends_m;
  }
  return rest;
}

void leave(SearchShare& share, std::string why, Instant now) {
  share.state = SearchShare::State::left;
  share.why = std::move(why);
  share.left_at = now;
}

/// How long a vehicle has before its route begins: told, and turned round once.
double lead_s(const planning::Searcher& searcher) {
  return kTelling_s + kTwoPi * searcher.radius_m / searcher.speed_mps;
}

}  // namespace

std::string_view to_string(SearchShare::State state) {
  static constexpr std::array<std::string_view, 4> kNames{"waits", "flies", "done", "left"};
  static_assert(kNames.size() == static_cast<std::size_t>(SearchShare::State::count));
  return kNames.at(static_cast<std::size_t>(state));
}

std::string_view to_string(AreaSearch::State state) {
  static constexpr std::array<std::string_view, 4> kNames{"previewed", "flown", "over",
                                                          "called_off"};
  static_assert(kNames.size() == static_cast<std::size_t>(AreaSearch::State::count));
  return kNames.at(static_cast<std::size_t>(state));
}

GroundSearch::GroundSearch(GroundSearchConfig config) : config_{std::move(config)} {}

// --- who can ---

std::optional<std::string> GroundSearch::why_not(VehicleId id, const Fleet& fleet,
                                                 bool asked) const {
  const auto entry = fleet.vehicles().find(id);
  if (entry == fleet.vehicles().end() || !entry->second.expected) return "it is not in the fleet";
  const auto spec =
      std::ranges::find_if(config_.vehicles, [id](const VehicleSpec& v) { return v.id == id; });
  if (spec == config_.vehicles.end()) {
    return "the ground station does not know what it can do: 'planes' of its configuration";
  }
  if (spec->is_copter()) return "it is a copter, and routes are flown by planes";
  if (spec->sensor_radius_m <= 0.0) return "it has no sensor";
  if (auto why = fleet.why_not_with(id)) return why;
  if (!entry->second.telemetry || entry->second.silent) return "it is not heard";
  const Telemetry& telemetry = *entry->second.telemetry;
  if (!is_up(telemetry)) return "it is not in the air";
  if (goes_home(telemetry)) return "it flies home, or is there";
  if (telemetry.activity == Activity::holding) return "it holds; let it resume before";
  if (telemetry.activity == Activity::forming) return "it flies in a formation";
  if (!asked && has_task(telemetry)) return "it has a task";
  return std::nullopt;
}

planning::Searcher GroundSearch::searcher(VehicleId id, const Telemetry& telemetry) const {
  const auto spec =
      std::ranges::find_if(config_.vehicles, [id](const VehicleSpec& v) { return v.id == id; });
  planning::Searcher one;
  one.id = id;
  one.from = telemetry.state.pose_over_ground();
  one.speed_mps = spec->cruise_speed_mps;
  one.radius_m = spec->planning_radius_m();
  // What a vehicle itself keeps, and the way to where its route begins.
  one.range_m = telemetry.range_left_m - kTwoPi * one.radius_m - lead_s(one) * one.speed_mps;
  if (spec->recovery == Recovery::home) {
    const auto known = known_.find(id);
    const Vec2 heard = known == known_.end() ? one.from.position() : known->second.home;
    one.home = Vec2{spec->landing.x_m.value_or(heard.x()), spec->landing.y_m.value_or(heard.y())};
  }
  return one;
}

Result<planning::AreaProblem> GroundSearch::problem_of(AreaSearch& area, const SearchWishes& wishes,
                                                       const Fleet& fleet,
                                                       const Fence& fence) const {
  planning::AreaProblem problem;
  problem.corners = area.corners;
  problem.hazards = area.hazards;
  problem.fence = fence;
  problem.avoidance = config_.avoidance;
  double sensor_m = area.sensor_radius_m;  // of what is left: as it was
  const auto join = [&](VehicleId id) {
    const auto spec =
        std::ranges::find_if(config_.vehicles, [id](const VehicleSpec& v) { return v.id == id; });
    if (area.lanes.empty() && (sensor_m == 0.0 || spec->sensor_radius_m < sensor_m)) {
      sensor_m = spec->sensor_radius_m;
    }
    problem.searchers.push_back(searcher(id, *fleet.vehicles().at(id).telemetry));
  };
  for (const VehicleId id : std::set<VehicleId>{wishes.vehicles.begin(), wishes.vehicles.end()}) {
    if (auto why = why_not(id, fleet, true)) return Error{name_of(id) + ": " + *why};
    join(id);
  }
  if (wishes.vehicles.empty()) {
    for (const auto& [id, entry] : fleet.vehicles()) {
      if (!entry.expected) continue;
      if (auto why = why_not(id, fleet, false))
        area.without[id] = *why;
      else
        join(id);
    }
  }
  if (problem.searchers.empty()) {
    std::string why = "nobody can search the area";
    for (const auto& [id, reason] : area.without) why += "; " + name_of(id) + ": " + reason;
    return Error{why};
  }
  problem.sensor_radius_m = area.sensor_radius_m = sensor_m;
  if (area.lanes.empty()) area.spacing_m = wishes.spacing_m.value_or(kSearchSpacing * sensor_m);
  problem.spacing_m = area.spacing_m;
  if (area.spacing_m > 2.0 * sensor_m) {
    return Error{"lanes lie two sensor radii apart at most: " +
                 std::to_string(std::lround(2.0 * sensor_m)) + " m"};
  }
  return problem;
}

// --- planning ---

Result<AreaSearch> GroundSearch::preview(const SearchWishes& wishes,
                                         const std::vector<Hazard>& hazards, const Fleet& fleet,
                                         const GroundRoutes& routes, Instant now) const {
  const bool is_rest = wishes.corners.empty();
  AreaSearch area;
  if (is_rest) {
    if (!area_ || !cells_) return Error{"no area was searched yet: give its corners"};
    area = *area_;
    area.lanes = planning::lanes_left(area_->lanes, *cells_);
    if (area.lanes.empty()) return Error{"nothing of the area is left to be seen"};
    area.shares.clear();
    area.without.clear();
    area.why.clear();
  } else {
    if (auto why = planning::why_no_area(wishes.corners)) return Error{*why};
    area.corners = wishes.corners;
  }
  area.hazards = hazards;
  area.state = AreaSearch::State::previewed;
  const auto problem = problem_of(area, wishes, fleet, routes.fence());
  if (!problem) return problem.error();
  Result<planning::AreaPlan> plan =
      is_rest ? Result<planning::AreaPlan>{planning::share_lanes(*problem, area.lanes)}
              : planning::plan_area(*problem);
  if (!plan) return plan.error();
  if (plan->routes.empty()) {
    return Error{"no vehicle has the range for any of it, with its way home, or a way there"};
  }
  double in_s = wishes.in_s.value_or(0.0);
  std::size_t segments = 0;
  for (const planning::SearchRoute& route : plan->routes) {
    SearchShare& share = area.shares[route.vehicle];
    share.lanes = route.lanes;
    share.all = route.lanes.size();
    share.length_m = route.length_m;
    share.time_s = route.time_s;
    std::size_t own = 0;
    for (const Path& leg : route.legs) own += leg.segments.size();
    segments = std::max(segments, own);
    const auto one = std::ranges::find_if(
        problem->searchers, [&route](const auto& s) { return s.id == route.vehicle; });
    if (!wishes.in_s) in_s = std::max(in_s, lead_s(*one));
  }
  for (const planning::Searcher& s : problem->searchers) {
    if (!area.shares.contains(s.id))
      area.without[s.id] = "others are sooner done, or its range is too short";
  }
  if (!is_rest) {
    for (const auto& [id, share] : area.shares) {
      area.lanes.insert(area.lanes.end(), share.lanes.begin(), share.lanes.end());
    }
    area.lanes.insert(area.lanes.end(), plan->left_out.begin(), plan->left_out.end());
  } else {
    area.lanes = area_->lanes;
  }
  area.planned = plan->covered;
  area.bound_s = plan->bound_s;
  if (is_rest) area.planned = seen_in_the_end(*cells_, area);
  area.parts = 1 + segments / kSegmentsEach;
  area.begins = std::max(now, Instant{}) + from_seconds(in_s);
  area.ends = area.begins + from_seconds(plan->time_s);
  // Whoever has flown one route is told the next, and turns round meanwhile.
  area.ends += static_cast<std::int64_t>(area.parts - 1) * from_seconds(in_s + kTelling_s);
  const auto part = next_part(area, fleet, routes.fence(), area.begins, now);
  if (part.empty()) return Error{"no vehicle has a way to its share"};
  if (auto good = routes.check(part, hazards, fleet, now); !good) return good.error();
  return area;
}

GroundRoutes::Routes GroundSearch::next_part(AreaSearch& area, const Fleet& fleet,
                                             const Fence& fence, Instant begins,
                                             Instant now) const {
  GroundRoutes::Routes routes;
  planning::AreaProblem problem;
  problem.corners = area.corners;
  problem.sensor_radius_m = area.sensor_radius_m;
  problem.spacing_m = area.spacing_m;
  problem.hazards = area.hazards;
  problem.fence = fence;
  problem.avoidance = config_.avoidance;
  double parts_left = 1.0;
  for (const auto& [id, share] : area.shares) {
    if (share.state == SearchShare::State::left) continue;
    const double segments = kSegmentsALane * static_cast<double>(share.lanes.size());
    parts_left = std::max(parts_left, std::ceil(segments / static_cast<double>(kSegmentsEach)));
  }
  for (auto& [id, share] : area.shares) {
    if (share.state == SearchShare::State::left) continue;
    share.given = 0;
    if (share.lanes.empty()) continue;
    if (auto why = why_not(id, fleet, false)) {
      leave(share, *std::move(why), now);
      continue;
    }
    const planning::Searcher one = searcher(id, *fleet.vehicles().at(id).telemetry);
    const auto count =
        static_cast<std::size_t>(std::ceil(static_cast<double>(share.lanes.size()) / parts_left));
    const std::span<const planning::Lane> lanes{share.lanes.data(), count};
    const auto route = planning::route_over(problem, one, lanes, kSegmentsEach);
    if (route.lanes.empty()) {
      leave(share, "it has no way to the rest of its share, or not the range for it", now);
      continue;
    }
    // What it flies before the route begins; not into the first lane.
    const double until_s = to_seconds(begins - now) - lead_s(one);
    const double to_lane_m = route.legs.front().length_m() - route.lanes.front().length_m;
    const double first_m = std::clamp(until_s * one.speed_mps, 0.0, std::max(0.0, to_lane_m));
    auto path = joined(route, first_m);
    const auto hold = path ? planning::way_to_hold(problem, one, path->end()) : std::nullopt;
    if (!hold || !path->append(*hold)) {
      leave(share, "there is no room for its turn at the end", now);
      continue;
    }
    share.given = route.lanes.size();
    // Those on the way that no way leads to are left to the rest.
    const planning::Lane& last = route.lanes.back();
    const auto is_last = [&last](const planning::Lane& lane) {
      return lane.start.position() == last.start.position() && lane.length_m == last.length_m;
    };
    const auto found = std::ranges::find_if(share.lanes, is_last);
    share.given = static_cast<std::size_t>(found - share.lanes.begin()) + 1;
    TimedPath timed;
    timed.start_time = begins;
    timed.speed_mps = one.speed_mps;
    timed.tail_curvature_per_m = 1.0 / one.radius_m;
    timed.path = *path;
    share.route = timed;
    share.route_lanes.clear();
    double flown_m = -first_m;
    for (std::size_t i = 0; i < route.legs.size(); ++i) {
      flown_m += route.legs[i].length_m();
      share.route_lanes.push_back({flown_m, route.lanes[i].length_m});
    }
    routes.emplace(id, timed);
  }
  return routes;
}

Result<AreaSearch> GroundSearch::give(const SearchWishes& wishes,
                                      const std::vector<Hazard>& hazards, const Fleet& fleet,
                                      GroundRoutes& routes, Instant now) {
  auto planned = preview(wishes, hazards, fleet, routes, now);
  if (!planned) return planned;
  AreaSearch area = *std::move(planned);
  const auto part = next_part(area, fleet, routes.fence(), area.begins, now);
  const auto plan = routes.give(part, hazards, fleet, now, RouteBond::each_alone);
  if (!plan) return plan.error();
  area.plan = *plan;
  area.state = AreaSearch::State::flown;
  for (auto& [id, share] : area.shares) {
    if (share.given > 0) share.state = SearchShare::State::flies;
  }
  if (!wishes.corners.empty()) cells_.emplace(area.corners, area.sensor_radius_m, hazards);
  area_ = std::move(area);
  found_.clear();
  released_.clear();
  rest_ = false;
  return *area_;
}

// --- what becomes of it ---

void GroundSearch::on_message(const Message& message, Instant now) {
  if (const auto* telemetry = std::get_if<Telemetry>(&message)) {
    const Vec2 at{telemetry->state.x_m, telemetry->state.y_m};
    const auto [known, is_new] = known_.try_emplace(telemetry->vehicle, Known{at, at, now});
    if (cells_ && area_->shares.contains(telemetry->vehicle)) {
      const bool goes_on = !is_new && now - known->second.heard_at < kHeardAgain;
      cells_->see(goes_on ? known->second.at : at, at);
    }
    known->second.at = at;
    known->second.heard_at = now;
  }
  const auto* event = std::get_if<MissionEvent>(&message);
  if (event == nullptr || !area_ || event->kind() != EventKind::site_detected) return;
  const auto share = area_->shares.find(event->vehicle);
  if (share == area_->shares.end() || share->second.state != SearchShare::State::flies) return;
  found_.insert(event->vehicle);
}

void GroundSearch::take_answers(const GivenRoutes& given, Instant now) {
  for (const auto& [id, route] : given.routes) {
    const auto known = area_->shares.find(id);
    if (known == area_->shares.end() || known->second.state != SearchShare::State::flies) continue;
    SearchShare& share = known->second;
    share.has_found = released_.contains(id);
    if (share.has_found) {
      leave(share, "it has found a site, and surveys it", now);
    } else if (route.released) {
      leave(share, route.answer ? "it has not begun its route" : "it has not answered", now);
    } else if (route.answer == RouteState::left || route.answer == RouteState::refused) {
      leave(share,
            route.why == RouteObstacle::has_task ? "it has a task"
            : route.why == RouteObstacle::obeys_others
                ? "it holds or comes home, or its range is spent"
            : route.why == RouteObstacle::into_hazard ? "a hazard or the fence is in its way"
                                                      : "it does not fly its route",
            now);
    }
  }
}

void GroundSearch::end_part(const GivenRoutes& given, Instant now) {
  for (auto& [id, share] : area_->shares) {
    const auto route = given.routes.find(id);
    if (share.state != SearchShare::State::flies || route == given.routes.end()) continue;
    if (route->second.answer == RouteState::flown) {
      const auto flown = share.lanes.begin() + static_cast<std::ptrdiff_t>(share.given);
      share.lanes.erase(share.lanes.begin(), flown);
      share.state = share.lanes.empty() ? SearchShare::State::done : SearchShare::State::waits;
    } else {
      leave(share, "it was not heard to have flown its route", now);
    }
    share.given = 0;
  }
}

void GroundSearch::stop(std::string why, Instant now) {
  area_->state = AreaSearch::State::called_off;
  area_->why = std::move(why);
  area_->called_off_at = now;
  for (auto& [id, share] : area_->shares) {
    if (share.state == SearchShare::State::done || share.state == SearchShare::State::left)
      continue;
    leave(share, "the search is called off", now);
  }
  look_for_rest();
}

void GroundSearch::on_timeout(const std::vector<Hazard>& hazards, const Fleet& fleet,
                              GroundRoutes& routes, Instant now) {
  const auto& given = routes.given();
  if (!area_ || area_->state != AreaSearch::State::flown || !given) return;
  if (given->plan != area_->plan) return stop("other routes were given", now);
  if (given->begun) {
    for (auto one = found_.begin(); one != found_.end();) {
      if (routes.release(*one, now)) released_.insert(*one);
      one = found_.erase(one);
    }
  }
  take_answers(*given, now);
  if (given->step == RouteStep::call_off) {
    area_->by_operator = given->by_operator;
    std::string why = given->by_operator ? "by the operator" : "nobody flies it";
    for (const auto& [id, share] : area_->shares) {
      const bool is_left = !given->by_operator && share.state == SearchShare::State::left;
      if (is_left) why += "; " + name_of(id) + ": " + share.why;
    }
    return stop(std::move(why), now);
  }
  if (!given->over) return;
  end_part(*given, now);
  double in_s = 0.0;
  for (const auto& [id, share] : area_->shares) {
    if (share.state != SearchShare::State::waits) continue;
    const auto entry = fleet.vehicles().find(id);
    if (entry != fleet.vehicles().end() && entry->second.telemetry) {
      in_s = std::max(in_s, lead_s(searcher(id, *entry->second.telemetry)));
    }
  }
  area_->hazards = hazards;
  auto part = next_part(*area_, fleet, routes.fence(), now + from_seconds(in_s), now);
  // Who cannot keeps nobody else from the next one.
  std::erase_if(part, [&](const auto& one) {
    const auto good = routes.check({one}, hazards, fleet, now);
    if (!good) leave(area_->shares[one.first], good.error().message, now);
    return !good;
  });
  if (part.empty()) {
    area_->state = AreaSearch::State::over;
    return look_for_rest();
  }
  const auto plan = routes.give(part, hazards, fleet, now, RouteBond::each_alone);
  if (!plan) return stop(plan.error().message, now);
  area_->plan = *plan;
  for (const auto& [id, timed] : part) {
    area_->shares[id].state = SearchShare::State::flies;
  }
}

std::vector<VehicleId> GroundSearch::searching() const {
  std::vector<VehicleId> all;
  if (!area_ || area_->state != AreaSearch::State::flown) return all;
  for (const auto& [id, share] : area_->shares) {
    const bool is_in =
        share.state == SearchShare::State::flies || share.state == SearchShare::State::waits;
    if (is_in) all.push_back(id);
  }
  return all;
}

std::vector<VehicleId> GroundSearch::barred_by(const std::vector<Hazard>& hazards,
                                               Instant now) const {
  std::vector<VehicleId> all = searching();
  std::erase_if(all, [&](VehicleId id) {
    const SearchShare& share = area_->shares.at(id);
    if (share.state != SearchShare::State::flies) return true;  // its next route goes around them
    const double end_m = share.route.path.length_m();
    const double flown_m = std::clamp(share.route.distance_at(now), 0.0, end_m);
    const auto rest = share.route.piece(flown_m, end_m);
    return !rest || planning::is_clear(*rest, hazards);
  });
  return all;
}

// --- how far it is ---

ShareProgress progress_of(const AreaSearch& area, const SearchShare& share, Instant now) {
  using enum SearchShare::State;
  ShareProgress progress;
  const Instant at = share.state == left ? share.left_at : now;
  // A route that was flown to its end has taken its lanes out of these.
  const bool is_on_route = share.given > 0 && area.state != AreaSearch::State::previewed;
  const std::size_t beyond = is_on_route ? share.given : 0;
  const double flown_m = share.route.distance_at(at);
  for (const SearchShare::RouteLane& lane : share.route_lanes) {
    if (!is_on_route || flown_m >= lane.ends_m) continue;
    ++progress.lanes_left;
    progress.left_m += std::min(lane.length_m, lane.ends_m - flown_m);
  }
  for (std::size_t i = beyond; i < share.lanes.size(); ++i) {
    ++progress.lanes_left;
    progress.left_m += share.lanes[i].length_m;
  }
  if (share.state == done || share.state == left || area.state != AreaSearch::State::flown) {
    return progress;
  }
  Instant ends = share.state == flies ? std::max(share.route.end_time(), now) : now;
  // What no route is given for yet takes as long as its part of the way that is left.
  if (beyond < share.lanes.size()) {
    const double rest =
        static_cast<double>(share.lanes.size() - beyond) / static_cast<double>(share.all);
    ends += from_seconds(rest * share.time_s + kBetweenParts_s);
  }
  progress.ends = ends;
  return progress;
}

std::optional<Instant> expected_end(const AreaSearch& area, Instant now) {
  std::optional<Instant> last;
  for (const auto& [id, share] : area.shares) {
    const auto ends = progress_of(area, share, now).ends;
    if (ends && (!last || *ends > *last)) last = ends;
  }
  return last;
}

void GroundSearch::look_for_rest() { rest_ = !planning::lanes_left(area_->lanes, *cells_).empty(); }

}  // namespace skein::mission
