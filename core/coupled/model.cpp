// SPDX-License-Identifier: Apache-2.0
#include "model.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"
#include "skein/base/contains.hpp"
#include "skein/planning/arrival.hpp"
#include "skein/planning/dubins.hpp"

namespace skein::planning::coupled {
namespace {

constexpr int kCounterClockwise = 1;
constexpr int kClockwise = -1;
constexpr double kWaitless_m = 1e-5;  ///< a transit this little above the least has no wait
constexpr int kHoldPassesMax = 50;
constexpr double kSearchWeight = 1e-4;  ///< of the range, over that of all reward
constexpr double kNoGap_radii = 6.0;    ///< poses farther apart have none, see length_gap

/// A way of flying a task, before it is known by which vehicle.
struct Way {
  Index task = 0;
  double start_rad = 0.0;  ///< of an arc; of a service the heading
  int turn = kCounterClockwise;
};

bool is_service(const CoupledProblem& problem, const TaskId& id) {
  return id.kind == TaskKind::survey && contains(problem.service_sites, id.site);
}

/// Every vehicle does, so that headings are all one.
bool turns_on_the_spot(const CoupledProblem& problem) {
  return std::all_of(problem.vehicles.begin(), problem.vehicles.end(),
                     [](const CoupledVehicle& v) { return v.planning_radius_m == 0.0; });
}

std::vector<Way> ways_of(const CoupledProblem& problem, const Site& site, const TaskId& id,
                         Index task) {
  if (id.kind == TaskKind::deliver) return {{task}};
  if (is_service(problem, id)) {
    std::vector<Way> ways;
    const int headings = turns_on_the_spot(problem) ? 1 : problem.free_starts;
    for (int i = 0; i < headings; ++i) ways.push_back({task, wrap_pi(i * kTwoPi / headings), 0});
    return ways;
  }
  const bool survey = id.kind == TaskKind::survey;
  const ArcRequirement& arc = survey ? site.survey : site.assessments[id.index];
  const bool both = survey && (problem.survey_in_both_senses || !arc.start_angle_rad);
  const int starts = arc.start_angle_rad ? 1 : problem.free_starts;
  std::vector<Way> ways;
  for (int i = 0; i < starts; ++i) {
    const double start = arc.start_angle_rad.value_or(0.0) + i * kTwoPi / starts;
    ways.push_back({task, wrap_pi(start), kCounterClockwise});
    if (both) ways.push_back({task, wrap_pi(start), kClockwise});
  }
  return ways;
}

bool alike(const CoupledVehicle& a, const CoupledVehicle& b) {
  return a.speed_mps == b.speed_mps && a.planning_radius_m == b.planning_radius_m &&
         a.final_approach_m == b.final_approach_m && a.sensor_radius_m == b.sensor_radius_m &&
         a.assess_radius_m == b.assess_radius_m && a.capabilities == b.capabilities &&
         (a.loads == 0) == (b.loads == 0);
}

bool equal(const CoupledVehicle& a, const CoupledVehicle& b) {
  return alike(a, b) && a.loads == b.loads && a.range_left_m == b.range_left_m &&
         a.pose.x_m == b.pose.x_m && a.pose.y_m == b.pose.y_m &&
         a.pose.heading_rad == b.pose.heading_rad && a.home == b.home;
}

bool can(const CoupledVehicle& vehicle, TaskKind kind) {
  return vehicle.capabilities.has(kind) && (kind != TaskKind::deliver || vehicle.loads > 0);
}

double arc_radius_m(const CoupledVehicle& vehicle, TaskKind kind) {
  return kind == TaskKind::survey ? vehicle.sensor_radius_m : vehicle.assess_radius_m;
}

/// The lengths of one problem, by what it is given.
class Lengths {
 public:
  explicit Lengths(const CoupledProblem& problem) : problem_{problem} {}

  [[nodiscard]] double transit_m(const Pose2& from, const Pose2& to, double radius_m) const {
    if (problem_.transit_length_m) return problem_.transit_length_m(from, to, radius_m);
    if (radius_m == 0.0) return (to.position() - from.position()).norm();
    if (problem_.hazards.empty()) return shortest_dubins_length(from, to, radius_m);
    const auto path = shortest_clear_path(problem_.avoidance, from, to, radius_m, problem_.hazards);
    return path ? path->length_m() : kInfinity;
  }
  /// Of a transit of a vehicle, with what of the run is flown before the task's time.
  [[nodiscard]] Gap gap(const Pose2& from, const Pose2& to, const CoupledVehicle& vehicle,
                        double reach_s, double before_s) const {
    if (!problem_.flyable_waits || problem_.transit_length_m || reach_s == kInfinity) return {};
    if (vehicle.planning_radius_m == 0.0) return {};
    const double apart_m = kNoGap_radii * vehicle.planning_radius_m;
    if ((to.position() - from.position()).squaredNorm() > apart_m * apart_m) return {};
    const auto lengths = length_gap(from, to, vehicle.planning_radius_m);
    if (!lengths) return {};
    // The ends of a gap can be flown: what is rounded must lie on their outer side.
    const double low_s = (lengths->low_m - kWaitless_m) / vehicle.speed_mps + before_s;
    const double high_s = (lengths->high_m + kWaitless_m) / vehicle.speed_mps + before_s;
    return reach_s < high_s ? Gap{std::max(reach_s, low_s), high_s} : Gap{};
  }
  /// From a pose to the vehicle's home, where it may arrive on any heading; 0
  /// without one.
  [[nodiscard]] double home_m(const Pose2& from, const CoupledVehicle& vehicle) const {
    if (!vehicle.home) return 0.0;
    double least_m = kInfinity;
    const int headings = vehicle.planning_radius_m == 0.0 ? 1 : problem_.free_starts;
    for (int i = 0; i < headings; ++i) {
      const Pose2 home{vehicle.home->x(), vehicle.home->y(), wrap_pi(i * kTwoPi / headings)};
      least_m = std::min(least_m, transit_m(from, home, vehicle.planning_radius_m));
    }
    return least_m;
  }
  [[nodiscard]] bool run_is_clear(const TaskPath& task) const {
    if (problem_.hazards.empty()) return true;
    if (task.run.length_m == 0.0) {
      return std::all_of(problem_.hazards.begin(), problem_.hazards.end(),
                         [&](const Hazard& hazard) {
                           return (hazard.centre - task.entry.position()).norm() >= hazard.radius_m;
                         });
    }
    Path run{.start = task.entry, .segments = {}};
    return run.append(task.run) && is_clear(run, problem_.hazards);
  }

 private:
  const CoupledProblem& problem_;
};

struct Compiler {
  const CoupledProblem& problem;
  Model& model;
  std::vector<Way> ways;

  void add_vehicles();
  void add_chords() const;
  VehicleClass make_class(const CoupledVehicle& vehicle) const;
  void least(VehicleClass& kind) const;
};

VehicleClass Compiler::make_class(const CoupledVehicle& vehicle) const {
  const Lengths lengths{problem};
  const std::size_t visits = ways.size();
  VehicleClass kind;
  kind.reach_s.assign(visits * visits, kInfinity);
  kind.gaps.assign(visits * visits, {});
  std::vector<bool> possible(visits, false);
  std::vector<Pose2> exits;
  for (std::size_t v = 0; v < visits; ++v) {
    const Way& way = ways[v];
    const Task& task = model.tasks[at(way.task)];
    const Site& site = problem.sites[at(task.site)];
    TaskPath path;
    double before_m = 0.0;
    double serves_s = 0.0;
    if (is_service(problem, task.id)) {
      path.entry = {site.position.x(), site.position.y(), way.start_rad};
      path.run = {};
      serves_s = to_seconds(site.survey.dwell);
      possible[v] = can(vehicle, task.id.kind);
    } else if (task.id.kind == TaskKind::deliver) {
      path = delivery_path(site, site.deliveries[task.id.index], vehicle.final_approach_m);
      before_m = path.run.length_m;
      possible[v] = can(vehicle, task.id.kind);
    } else {
      const double radius_m = arc_radius_m(vehicle, task.id.kind);
      possible[v] = can(vehicle, task.id.kind) && radius_m >= vehicle.planning_radius_m;
      if (possible[v]) {
        const ArcRequirement& arc =
            task.id.kind == TaskKind::survey ? site.survey : site.assessments[task.id.index];
        path = arc_path(site, way.start_rad, arc.dwell, radius_m, vehicle.speed_mps, way.turn);
      }
    }
    possible[v] = possible[v] && lengths.run_is_clear(path);
    kind.paths.push_back(path);
    kind.before_s.push_back(before_m / vehicle.speed_mps);
    kind.after_s.push_back((path.run.length_m - before_m) / vehicle.speed_mps + serves_s);
    exits.push_back(advance(path.entry, path.run.curvature_per_m, path.run.length_m));
  }
  for (std::size_t a = 0; a < visits; ++a) {
    for (std::size_t b = 0; b < visits; ++b) {
      if (ways[a].task == ways[b].task || !possible[a] || !possible[b]) continue;
      const double transit_m =
          lengths.transit_m(exits[a], kind.paths[b].entry, vehicle.planning_radius_m);
      const double reach_s = transit_m / vehicle.speed_mps + kind.before_s[b];
      kind.reach_s[a * visits + b] = reach_s;
      kind.gaps[a * visits + b] =
          lengths.gap(exits[a], kind.paths[b].entry, vehicle, reach_s, kind.before_s[b]);
    }
  }
  for (std::size_t v = 0; v < visits; ++v) {
    if (!possible[v]) kind.after_s[v] = kInfinity;
  }
  least(kind);
  return kind;
}

/// With exact lengths a detour by another task is never shorter; with others it may be, and a bound
/// must not trust them.
void Compiler::least(VehicleClass& kind) const {
  const std::size_t visits = ways.size();
  const std::size_t tasks = model.tasks.size();
  std::vector<double> closed = kind.reach_s;
  for (std::size_t m = 0; m < visits; ++m) {
    for (std::size_t a = 0; a < visits; ++a) {
      const double half = closed[a * visits + m] + kind.after_s[m];
      if (half == kInfinity) continue;
      for (std::size_t b = 0; b < visits; ++b) {
        closed[a * visits + b] = std::min(closed[a * visits + b], half + closed[m * visits + b]);
      }
    }
  }
  kind.least_s.assign(visits * tasks, kInfinity);
  kind.least_between_s.assign(tasks * tasks, kInfinity);
  kind.least_after_s.assign(tasks, kInfinity);
  for (std::size_t b = 0; b < visits; ++b) {
    const std::size_t to = at(ways[b].task);
    kind.least_after_s[to] = std::min(kind.least_after_s[to], kind.after_s[b]);
    for (std::size_t a = 0; a < visits; ++a) {
      const double reach = closed[a * visits + b];
      double& single = kind.least_s[a * tasks + to];
      single = std::min(single, reach);
      double& between = kind.least_between_s[at(ways[a].task) * tasks + to];
      between = std::min(between, reach);
    }
  }
}

void Compiler::add_vehicles() {
  const Lengths lengths{problem};
  double range_sum_m = 0.0;
  for (const CoupledVehicle& v : problem.vehicles) range_sum_m += v.range_left_m;
  std::vector<const CoupledVehicle*> first_of_class;
  for (std::size_t i = 0; i < problem.vehicles.size(); ++i) {
    const CoupledVehicle& given = problem.vehicles[i];
    const auto found = std::find_if(first_of_class.begin(), first_of_class.end(),
                                    [&](const auto* other) { return alike(*other, given); });
    Vehicle vehicle;
    vehicle.kind = static_cast<Index>(found - first_of_class.begin());
    if (found == first_of_class.end()) {
      first_of_class.push_back(&given);
      model.classes.push_back(make_class(given));
    }
    const VehicleClass& kind = model.classes[at(vehicle.kind)];
    vehicle.reach_s.assign(ways.size(), kInfinity);
    vehicle.gaps.assign(ways.size(), {});
    vehicle.least_s.assign(model.tasks.size(), kInfinity);
    for (std::size_t v = 0; v < ways.size(); ++v) {
      if (kind.after_s[v] == kInfinity) continue;
      vehicle.reach_s[v] =
          lengths.transit_m(given.pose, kind.paths[v].entry, given.planning_radius_m) /
              given.speed_mps +
          kind.before_s[v];
      vehicle.gaps[v] =
          lengths.gap(given.pose, kind.paths[v].entry, given, vehicle.reach_s[v], kind.before_s[v]);
    }
    for (std::size_t v = 0; v < ways.size(); ++v) {
      double& direct = vehicle.least_s[at(ways[v].task)];
      direct = std::min(direct, vehicle.reach_s[v]);
      if (vehicle.reach_s[v] == kInfinity) continue;
      for (std::size_t t = 0; t < model.tasks.size(); ++t) {
        vehicle.least_s[t] =
            std::min(vehicle.least_s[t], vehicle.reach_s[v] + kind.after_s[v] +
                                             kind.least_s[v * model.tasks.size() + t]);
      }
    }
    vehicle.deadline_s = given.range_left_m / given.speed_mps;
    vehicle.latest_of_task_s.assign(model.tasks.size(), -kInfinity);
    for (std::size_t v = 0; v < ways.size(); ++v) {
      const TaskPath& path = kind.paths[v];
      const Pose2 exit = advance(path.entry, path.run.curvature_per_m, path.run.length_m);
      vehicle.latest_s.push_back(vehicle.deadline_s -
                                 lengths.home_m(exit, given) / given.speed_mps);
      double& latest_s = vehicle.latest_of_task_s[at(ways[v].task)];
      latest_s = std::max(latest_s, vehicle.latest_s.back());
    }
    vehicle.loads = given.loads;
    vehicle.capabilities = given.capabilities;
    if (problem.criterion == Criterion::value && range_sum_m > 0.0) {
      vehicle.range_weight_per_s = problem.weights.range * given.speed_mps / range_sum_m;
    }
    vehicle.search_weight_per_s = vehicle.range_weight_per_s;
    if (model.any_optional && range_sum_m > 0.0) {
      vehicle.search_weight_per_s += kSearchWeight * given.speed_mps / range_sum_m;
    }
    for (std::size_t j = i; j-- > 0;) {
      if (!equal(problem.vehicles[j], given)) continue;
      vehicle.twin = static_cast<Index>(j);
      break;
    }
    model.vehicles.push_back(std::move(vehicle));
  }
}

void Compiler::add_chords() const {
  if (model.criterion != Criterion::value) return;
  double longest_s = 0.0;
  for (const Vehicle& v : model.vehicles) longest_s = std::max(longest_s, v.deadline_s);
  if (!(longest_s > 0.0)) return;
  model.chords_per_s = static_cast<double>(Model::kChords) / longest_s;
  for (std::size_t t = 0; t < model.tasks.size(); ++t) {
    Task& task = model.tasks[t];
    const auto same =
        std::find_if(model.tasks.begin(), model.tasks.begin() + static_cast<std::ptrdiff_t>(t),
                     [&](const Task& other) { return other.decay_per_s == task.decay_per_s; });
    task.chords = same->chords;
    if (&*same != &task) continue;
    task.chords = static_cast<Index>(model.chords.size());
    for (std::size_t c = 0; c <= Model::kChords; ++c) {
      const double end_s = static_cast<double>(c) / model.chords_per_s;
      model.chords.push_back(-std::expm1(-task.decay_per_s * end_s));
    }
  }
}

std::optional<Error> refusal(const CoupledProblem& problem) {
  if (problem.vehicles.empty() || problem.vehicles.size() > kCoupledVehiclesMax) {
    return Error{"A coupled problem has 1 to " + std::to_string(kCoupledVehiclesMax) +
                 " vehicles, not " + std::to_string(problem.vehicles.size())};
  }
  if (problem.open_tasks.empty() || problem.open_tasks.size() > kCoupledTasksMax) {
    return Error{"A coupled problem has 1 to " + std::to_string(kCoupledTasksMax) +
                 " open tasks, not " + std::to_string(problem.open_tasks.size())};
  }
  for (const CoupledVehicle& v : problem.vehicles) {
    if (!(v.speed_mps > 0.0 && v.planning_radius_m >= 0.0)) {
      return Error{"Vehicle " + std::to_string(v.id.value) +
                   " needs a speed above 0 and a turn radius that is not below it"};
    }
    if (v.planning_radius_m == 0.0 && !problem.hazards.empty()) {
      return Error{"Vehicle " + std::to_string(v.id.value) +
                   " turns on the spot; among hazards it needs a turn radius above 0"};
    }
  }
  if (!problem.optional_sites.empty() && problem.criterion != Criterion::value) {
    return Error{"Sites can be left out where the criterion is value, and no other"};
  }
  for (const auto* const named : {&problem.optional_sites, &problem.service_sites}) {
    for (const SiteId id : *named) {
      if (std::any_of(problem.sites.begin(), problem.sites.end(),
                      [&](const Site& s) { return s.id == id; })) {
        continue;
      }
      return Error{"Site " + std::to_string(id.value) +
                   ", which is optional or a service, is none of the problem's"};
    }
  }
  return std::nullopt;
}

}  // namespace

Result<Model> Model::make(const CoupledProblem& problem) {
  if (auto error = refusal(problem)) return *error;
  Model model;
  model.criterion = problem.criterion;
  model.share = problem.share;
  model.decide_wait_s = to_seconds(problem.decide_wait);
  model.sites.resize(problem.sites.size());
  std::vector<TaskId> open = problem.open_tasks;
  std::sort(open.begin(), open.end());
  open.erase(std::unique(open.begin(), open.end()), open.end());
  std::vector<Way> ways;
  double reward_sum = 0.0;
  for (const TaskId& id : open) {
    const auto site = std::find_if(problem.sites.begin(), problem.sites.end(),
                                   [&](const Site& s) { return s.id == id.site; });
    if (site == problem.sites.end() || id.index >= skein::task_count(*site, id.kind)) {
      return Error{"There is no task '" + to_string(id) + "' among the sites of the problem"};
    }
    const auto task = static_cast<Index>(model.tasks.size());
    Task made;
    made.id = id;
    made.site = static_cast<Index>(site - problem.sites.begin());
    made.weight = site->reward;
    made.decay_per_s = site->reward_decay_per_s;
    reward_sum += site->reward;
    made.first_visit = static_cast<Index>(ways.size());
    const auto its_ways = ways_of(problem, *site, id, task);
    made.visits = static_cast<Index>(its_ways.size());
    ways.insert(ways.end(), its_ways.begin(), its_ways.end());
    SiteTasks& tasks = model.sites[at(made.site)];
    tasks.assess_wait_s = to_seconds(site->assess_wait);
    tasks.optional = contains(problem.optional_sites, id.site);
    ++tasks.tasks;
    model.any_optional = model.any_optional || tasks.optional;
    if (id.kind == TaskKind::survey) tasks.survey = task;
    if (id.kind == TaskKind::assess) tasks.assessments.push_back(task);
    if (id.kind == TaskKind::deliver) {
      made.offset_s = to_seconds(site->deliveries[id.index].offset);
      tasks.deliveries.push_back(task);
    }
    model.tasks.push_back(made);
  }
  for (const SiteTasks& site : model.sites) {
    double least_s = kInfinity;
    for (const Index d : site.deliveries) least_s = std::min(least_s, model.tasks[at(d)].offset_s);
    for (const Index d : site.deliveries) {
      model.tasks[at(d)].offset_s -= least_s;
      model.offsets = model.offsets || model.tasks[at(d)].offset_s > 0.0;
    }
  }
  const double reward_weight = problem.criterion == Criterion::value ? problem.weights.reward : 1.0;
  for (Task& task : model.tasks) {
    task.weight = reward_sum > 0.0 ? reward_weight * task.weight / reward_sum : 0.0;
    model.sites[at(task.site)].reward_cost += task.weight;
  }
  for (const Way& way : ways) model.task_of.push_back(way.task);
  model.best_value_ = (reward_sum > 0.0 ? problem.weights.reward : 0.0) + problem.weights.range;
  Compiler compiler{problem, model, std::move(ways)};
  compiler.add_vehicles();
  compiler.add_chords();
  const auto any = [](const std::vector<Gap>& gaps) {
    return std::ranges::any_of(gaps, [](const Gap& gap) { return gap.high_s != 0.0; });
  };
  model.gaps = std::ranges::any_of(model.classes, any, &VehicleClass::gaps) ||
               std::ranges::any_of(model.vehicles, any, &Vehicle::gaps);
  return model;
}

double Model::cost_of(Index task, double end_s) const {
  if (end_s == kInfinity) return kInfinity;
  const Task& t = tasks[at(task)];
  switch (criterion) {
    case Criterion::value:
      return t.weight * -std::expm1(-t.decay_per_s * end_s);
    case Criterion::completion:
      return t.weight * end_s;
    case Criterion::makespan:
      break;
  }
  return end_s;
}

bool has_its_share(const Model& model, const std::vector<Index>& order, const Task& task) {
  if (model.share == TaskShare::any || task.id.kind == TaskKind::survey) return false;
  return std::any_of(order.begin(), order.end(), [&](Index v) {
    const Task& other = model.tasks[at(model.task_of[at(v)])];
    return (other.site == task.site || model.share == TaskShare::one) &&
           other.id.kind != TaskKind::survey;
  });
}

std::vector<bool> left_out_of(const Model& model, const Orders& orders) {
  std::vector<bool> left_out;
  for (const SiteTasks& site : model.sites) left_out.push_back(site.optional && site.tasks > 0);
  for (const auto& order : orders) {
    for (const Index visit : order) {
      left_out[at(model.tasks[at(model.task_of[at(visit)])].site)] = false;
    }
  }
  return left_out;
}

double left_out_cost(const Model& model, const Orders& orders) {
  if (!model.any_optional) return 0.0;
  const std::vector<bool> left_out = left_out_of(model, orders);
  double cost = 0.0;
  for (std::size_t s = 0; s < left_out.size(); ++s) {
    if (left_out[s]) cost += model.sites[s].reward_cost;
  }
  return cost;
}

Timing::Timing(const Model& model, Costs costs)
    : model_{model},
      costs_{costs},
      sites_(model.sites.size()),
      vehicles_(model.vehicles.size()),
      time_s_(model.tasks.size()),
      end_s_(model.tasks.size()) {
  for (const Index t : model.task_of) {
    const Task& task = model.tasks[at(t)];
    visits_.push_back({t, task.site, task.id.kind, task.offset_s});
  }
  for (Index i = 0; i < model.vehicle_count(); ++i) {
    const Vehicle& vehicle = model.vehicles[at(i)];
    fliers_.push_back(
        {model.class_of(i).after_s.data(), vehicle.latest_s.data(),
         costs == Costs::exact ? vehicle.range_weight_per_s : vehicle.search_weight_per_s});
  }
  done_.reserve(model.tasks.size());
}

double Timing::evaluate(const Orders& orders, double limit) {
  std::fill(sites_.begin(), sites_.end(), SiteState{});
  done_.clear();
  ready_ = 0;
  left_ = 0;
  cost_ = 0.0;
  end_sum_s_ = 0.0;
  limit_ = limit;
  for (std::size_t i = 0; i < orders.size(); ++i) {
    const std::vector<Index>& order = orders[i];
    if (order.empty()) continue;
    vehicles_[i] = {order.data(), order.data() + order.size(), kNone, 0.0};
    ready_ |= bit(static_cast<Index>(i));
    left_ += static_cast<int>(order.size());
    for (const Index v : order) {
      const Visit& visit = visits_[at(v)];
      SiteState& site = sites_[at(visit.site)];
      if (visit.kind == TaskKind::survey) site.survey_open = true;
      if (visit.kind == TaskKind::deliver) ++site.deliveries_open;
    }
  }
  while (ready_ != 0) {
    const auto vehicle = static_cast<Index>(std::countr_zero(ready_));
    ready_ &= ready_ - 1;
    advance(vehicle);
    if (cost_ > limit_) return kInfinity;
  }
  return left_ == 0 ? cost_ : kInfinity;
}

void Timing::hold(Index task, double time_s) {
  held_s_.resize(model_.tasks.size(), 0.0);
  held_s_[at(task)] = time_s;
}

void Timing::advance(Index vehicle) {
  VehicleState& state = vehicles_[at(vehicle)];
  while (state.next != state.last) {
    const Index visit = *state.next;
    const Visit& its = visits_[at(visit)];
    SiteState& site = sites_[at(its.site)];
    double time_s = state.free_s + model_.reach_from(vehicle, state.before)[visit];
    if (!held_s_.empty()) time_s = std::max(time_s, held_s_[at(its.task)]);
    if (its.kind != TaskKind::survey) {
      if (site.survey_open) {
        site.for_survey |= bit(vehicle);
        return;
      }
      if (its.kind == TaskKind::deliver) {
        site.common_s = std::max(site.common_s, time_s - its.offset_s);
        // Who comes twice waits for itself: the second never arrives.
        site.at_delivery |= bit(vehicle);
        if (++site.arrived == site.deliveries_open) release(its.site);
        return;
      }
      if (site.deliveries_open > 0) {
        site.for_deliveries |= bit(vehicle);
        return;
      }
      time_s = std::max(time_s, site.last_delivery_s);
    }
    time_s = model_.flyable_s(vehicle, state.before, visit, state.free_s, time_s);
    if (!finish(vehicle, visit, time_s)) return;
    if (its.kind == TaskKind::survey) {
      site.survey_open = false;
      site.survey_end_s = state.free_s;
      site.common_s = state.free_s + model_.decide_wait_s;
      site.last_delivery_s = state.free_s;
      wake(std::exchange(site.for_survey, 0));
    }
  }
}

/// False, and the cost infinite, where the vehicle's range does not suffice.
bool Timing::finish(Index vehicle, Index visit, double time_s) {
  VehicleState& state = vehicles_[at(vehicle)];
  const Flier& its = fliers_[at(vehicle)];
  const Index task = visits_[at(visit)].task;
  const double end_s = time_s + its.after_s[visit];
  if (!(end_s <= its.latest_s[visit])) {
    cost_ = kInfinity;
    ready_ = 0;
    return false;
  }
  time_s_[at(task)] = time_s;
  end_s_[at(task)] = end_s;
  end_sum_s_ += end_s;
  cost_ = model_.add(cost_, costs_ == Costs::exact ? model_.cost_of(task, end_s)
                                                   : model_.least_cost_of(task, end_s));
  if (its.weight_per_s > 0.0) cost_ += its.weight_per_s * (end_s - state.free_s);
  state.free_s = end_s;
  state.before = visit;
  ++state.next;
  done_.push_back({vehicle, visit, state.next != state.last ? *state.next : kNone});
  --left_;
  return true;
}

/// The first moment from site.common_s on that every vehicle there can keep.
double Timing::common_of(const SiteState& site) const {
  double common_s = site.common_s;
  if (!model_.gaps) return common_s;
  for (bool raised = true; raised;) {
    raised = false;
    for (Mask there = site.at_delivery; there != 0; there &= there - 1) {
      const auto vehicle = static_cast<Index>(std::countr_zero(there));
      const VehicleState& state = vehicles_[at(vehicle)];
      const double offset_s = model_.tasks[at(model_.task_of[at(*state.next)])].offset_s;
      const double wanted_s = common_s + offset_s;
      const double time_s =
          model_.flyable_s(vehicle, state.before, *state.next, state.free_s, wanted_s);
      if (time_s <= wanted_s) continue;
      common_s = time_s - offset_s;
      raised = true;
    }
  }
  return common_s;
}

void Timing::release(Index index) {
  SiteState& site = sites_[at(index)];
  const double wait_s = model_.sites[at(index)].assess_wait_s;
  site.common_s = common_of(site);
  for (Mask there = site.at_delivery; there != 0; there &= there - 1) {
    const auto vehicle = static_cast<Index>(std::countr_zero(there));
    const Index visit = *vehicles_[at(vehicle)].next;
    const double time_s = site.common_s + visits_[at(visit)].offset_s;
    if (!finish(vehicle, visit, time_s)) return;
    site.last_delivery_s = std::max(site.last_delivery_s, time_s + wait_s);
  }
  site.deliveries_open = 0;
  wake(site.at_delivery | site.for_deliveries);
}

namespace {

/// The length of the transit of every task in the orders: what it is, and the least.
CoupledTask task_of(const Model& model, const CoupledProblem& problem, const Timing& timing,
                    Index vehicle, Index before, Index visit) {
  const CoupledVehicle& its = problem.vehicles[at(vehicle)];
  const VehicleClass& kind = model.class_of(vehicle);
  const Index index = model.task_of[at(visit)];
  const double free_s = before == kNone ? 0.0 : timing.ends_s()[at(model.task_of[at(before)])];
  const double before_s = kind.before_s[at(visit)];
  const TaskPath& path = kind.paths[at(visit)];
  CoupledTask task;
  task.task = model.tasks[at(index)].id;
  task.vehicle = its.id;
  task.time_s = timing.times_s()[at(index)];
  task.end_s = timing.ends_s()[at(index)];
  task.entry = path.entry;
  task.run = path.run;
  task.transit_m = (task.time_s - before_s - free_s) * its.speed_mps;
  task.least_transit_m = (model.reach_from(vehicle, before)[visit] - before_s) * its.speed_mps;
  return task;
}

Pose2 end_of(const CoupledTask& task) {
  return advance(task.entry, task.run.curvature_per_m, task.run.length_m);
}

/// The least length from the one asked for that can be flown; nothing where none can.
std::optional<double> flyable_m(const CoupledProblem& problem, const CoupledVehicle& vehicle,
                                const Pose2& from, const CoupledTask& task) {
  const bool any =
      !problem.flyable_waits || problem.transit_length_m || vehicle.planning_radius_m == 0.0;
  if (any || task.transit_m <= task.least_transit_m + kWaitless_m) {
    return task.transit_m;
  }
  const Transit transit{from, task.entry, vehicle.planning_radius_m, vehicle.range_left_m,
                        problem.hazards};
  if (surely_flyable(problem.avoidance, transit,
                     shortest_dubins_length(from, task.entry, vehicle.planning_radius_m),
                     task.transit_m)) {
    return task.transit_m;
  }
  const auto length_m = least_length_from(problem.avoidance, transit, task.transit_m);
  return length_m ? std::optional{*length_m} : std::nullopt;
}

/// One pass over all waits; true when nothing had to be held. Nothing where a wait cannot be flown.
std::optional<bool> hold_waits(const Model& model, const CoupledProblem& problem,
                               const Orders& orders, Timing& timing) {
  bool all = true;
  const Timing now = timing;
  for (Index i = 0; i < model.vehicle_count(); ++i) {
    const CoupledVehicle& vehicle = problem.vehicles[at(i)];
    Pose2 from = vehicle.pose;
    Index before = kNone;
    for (const Index visit : orders[at(i)]) {
      const CoupledTask task = task_of(model, problem, now, i, before, visit);
      const auto length_m = flyable_m(problem, vehicle, from, task);
      if (!length_m) return std::nullopt;
      if (*length_m > task.transit_m + kWaitless_m) {
        timing.hold(model.task_of[at(visit)],
                    task.time_s + (*length_m - task.transit_m) / vehicle.speed_mps);
        all = false;
      }
      before = visit;
      from = end_of(task);
    }
  }
  return all;
}

}  // namespace

Result<CoupledPlan> make_plan(const Model& model, const CoupledProblem& problem,
                              const Orders& orders) {
  Timing timing{model};
  double cost = timing.evaluate(orders);
  SKEIN_ASSERT(cost < kInfinity);
  std::optional<bool> settled = false;
  for (int pass = 0; pass < kHoldPassesMax && settled == false && cost < kInfinity; ++pass) {
    settled = hold_waits(model, problem, orders, timing);
    if (settled == false) cost = timing.evaluate(orders);
  }
  if (settled != true) {
    return Error{
        "The plan that was found has a wait for which no path was "
        "found within the range"};
  }
  CoupledPlan plan;
  plan.objective = model.objective(cost + left_out_cost(model, orders));
  const std::vector<bool> left_out = left_out_of(model, orders);
  for (std::size_t s = 0; s < left_out.size(); ++s) {
    if (left_out[s]) plan.left_out.push_back(problem.sites[s].id);
  }
  double weight_sum = 0.0;
  for (Index i = 0; i < model.vehicle_count(); ++i) {
    const CoupledVehicle& vehicle = problem.vehicles[at(i)];
    Index before = kNone;
    double free_s = 0.0;
    for (const Index visit : orders[at(i)]) {
      plan.tasks.push_back(task_of(model, problem, timing, i, before, visit));
      const double end_s = plan.tasks.back().end_s;
      const Task& task = model.tasks[at(model.task_of[at(visit)])];
      const double reward = problem.sites[at(task.site)].reward;
      plan.reward += reward * std::exp(-task.decay_per_s * end_s);
      plan.completion_s += reward * end_s;
      weight_sum += reward;
      plan.makespan_s = std::max(plan.makespan_s, end_s);
      free_s = end_s;
      before = visit;
    }
    plan.range_left_m += vehicle.range_left_m - free_s * vehicle.speed_mps;
  }
  if (weight_sum > 0.0) plan.completion_s /= weight_sum;
  return plan;
}

Error no_plan(const Model& model, Sought sought) {
  for (Index t = 0; t < model.task_count(); ++t) {
    bool any = model.sites[at(model.tasks[at(t)].site)].optional;
    for (Index i = 0; i < model.vehicle_count(); ++i) {
      const Vehicle& vehicle = model.vehicles[at(i)];
      const double end_s = vehicle.least_s[at(t)] + model.class_of(i).least_after_s[at(t)];
      any = any || end_s <= vehicle.latest_of_task_s[at(t)];
    }
    if (!any) {
      return Error{"No vehicle is able to do '" + to_string(model.tasks[at(t)].id) +
                   "' within its range"};
    }
  }
  const std::array<const char*, 3> outcomes = {
      "It is proven that no plan does all ",
      "No plan was found within the planning budget that does all ",
      "No plan was found that does all "};
  return Error{outcomes[static_cast<std::size_t>(sought)] + std::to_string(model.tasks.size()) +
               " tasks within the loads and ranges of " + std::to_string(model.vehicles.size()) +
               " vehicles"};
}

}  // namespace skein::planning::coupled

namespace skein::planning {

double CoupledPlan::gap() const {
  if (!bound) return 1.0;
  return std::abs(objective - *bound) / std::max(std::abs(objective), 1e-12);
}

}  // namespace skein::planning
