// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/coupled/coupled.hpp"
#include "skein/planning/arrival.hpp"
#include "skein/planning/dubins.hpp"
#include "skein/planning/task_path.hpp"

/// For tests: what is wrong with a plan, found from the domain's geometry alone. Nothing here is
/// shared with the solvers.
namespace skein::planning {

inline const CoupledVehicle* vehicle_of(const CoupledProblem& problem, VehicleId id) {
  for (const CoupledVehicle& v : problem.vehicles) {
    if (v.id == id) return &v;
  }
  return nullptr;
}

inline const Site* site_of(const CoupledProblem& problem, SiteId id) {
  for (const Site& s : problem.sites) {
    if (s.id == id) return &s;
  }
  return nullptr;
}

/// The reward-weighted objective by the definitions of the header.
inline double objective_of(const CoupledProblem& problem, const CoupledPlan& plan) {
  double rewards = 0.0;
  double decayed = 0.0;
  double completion = 0.0;
  double makespan = 0.0;
  std::map<std::uint16_t, double> last_end_s;
  for (const TaskId& task : problem.open_tasks) rewards += site_of(problem, task.site)->reward;
  for (const CoupledTask& t : plan.tasks) {
    const Site& site = *site_of(problem, t.task.site);
    decayed += site.reward * std::exp(-site.reward_decay_per_s * t.end_s);
    completion += site.reward * t.end_s;
    makespan = std::max(makespan, t.end_s);
    last_end_s[t.vehicle.value] = std::max(last_end_s[t.vehicle.value], t.end_s);
  }
  if (problem.criterion == Criterion::completion) return completion / rewards;
  if (problem.criterion == Criterion::makespan) return makespan;
  double ranges = 0.0;
  double left = 0.0;
  for (const CoupledVehicle& v : problem.vehicles) {
    ranges += v.range_left_m;
    left += v.range_left_m - v.speed_mps * last_end_s[v.id.value];
  }
  return problem.weights.reward * decayed / rewards + problem.weights.range * left / ranges;
}

/// Finds every rule of the model that a plan breaks.
class CoupledJudge {
 public:
  CoupledJudge(const CoupledProblem& problem, const CoupledPlan& plan)
      : problem_{problem}, plan_{plan} {
    tasks_are_those_asked_for();
    for (const CoupledVehicle& v : problem_.vehicles) flies(v);
    for (const Site& site : problem_.sites) {
      keeps_order(site);
      if (problem_.share != TaskShare::any) shares_out(site);
    }
    if (std::abs(objective_of(problem_, plan_) - plan_.objective) >
        1e-9 * std::max(1.0, std::abs(plan_.objective))) {
      faults_.emplace_back("the objective is not that of the plan");
    }
  }

  [[nodiscard]] std::vector<std::string> take() { return std::move(faults_); }

 private:
  static constexpr double kTime_s = 1e-6;
  static constexpr double kLength_m = 1e-5;

  void say(const CoupledTask& t, const std::string& what) {
    faults_.push_back(to_string(t.task) + " by " + std::to_string(t.vehicle.value) + ": " + what);
  }

  static bool has(const std::vector<SiteId>& sites, SiteId id) {
    return std::find(sites.begin(), sites.end(), id) != sites.end();
  }
  [[nodiscard]] bool is_left_out(SiteId id) const { return has(plan_.left_out, id); }
  [[nodiscard]] bool is_service(const CoupledTask& t) const {
    return t.task.kind == TaskKind::survey && has(problem_.service_sites, t.task.site);
  }

  void tasks_are_those_asked_for() {
    std::vector<TaskId> done;
    for (const CoupledTask& t : plan_.tasks) done.push_back(t.task);
    std::sort(done.begin(), done.end());
    std::vector<TaskId> asked;
    for (const TaskId& task : problem_.open_tasks) {
      if (!is_left_out(task.site)) asked.push_back(task);
    }
    for (const SiteId site : plan_.left_out) {
      if (!has(problem_.optional_sites, site))
        faults_.emplace_back("a site is left out that must not be");
    }
    std::sort(asked.begin(), asked.end());
    if (done != asked) faults_.emplace_back("not every open task is done exactly once");
  }

  void flies(const CoupledVehicle& v) {
    Pose2 pose = v.pose;
    double free_s = 0.0;
    int deliveries = 0;
    for (const CoupledTask& t : plan_.tasks) {
      if (t.vehicle != v.id) continue;
      if (!v.capabilities.has(t.task.kind)) say(t, "not capable");
      const double run_s = is_service(t) ? to_seconds(site_of(problem_, t.task.site)->survey.dwell)
                                         : t.run.length_m / v.speed_mps;
      const bool deliver = t.task.kind == TaskKind::deliver;
      const double run_start_s = deliver ? t.time_s - run_s : t.time_s;
      if (std::abs(run_start_s + run_s - t.end_s) > kTime_s) say(t, "the run has not its length");
      const Pose2 exit = advance(t.entry, t.run.curvature_per_m, t.run.length_m);
      if (deliver) {
        ++deliveries;
        delivers(t, v, exit);
      } else if (is_service(t)) {
        serves(t);
      } else {
        flies_arc(t, v);
      }
      arrives(t, v, pose, run_start_s - free_s);
      pose = exit;
      free_s = t.end_s;
    }
    double home_m = 0.0;
    if (v.home && free_s > 0.0) {
      // Straight: no way is shorter.
      home_m = (*v.home - pose.position()).norm();
    }
    if (free_s * v.speed_mps + home_m > v.range_left_m + kLength_m) {
      faults_.push_back("vehicle " + std::to_string(v.id.value) + ": range");
    }
    if (deliveries > v.loads) {
      faults_.push_back("vehicle " + std::to_string(v.id.value) + ": loads");
    }
  }

  void delivers(const CoupledTask& t, const CoupledVehicle& v, const Pose2& exit) {
    const Site& site = *site_of(problem_, t.task.site);
    const DeliveryRequirement& want = site.deliveries[t.task.index];
    if (std::hypot(exit.x_m - site.position.x(), exit.y_m - site.position.y()) > kLength_m) {
      say(t, "does not end over the site");
    }
    if (std::abs(wrap_pi(exit.heading_rad - want.bearing_rad)) > 1e-9) say(t, "bearing");
    if (std::abs(t.run.length_m - v.final_approach_m) > kLength_m) say(t, "approach");
  }

  void serves(const CoupledTask& t) {
    const Site& site = *site_of(problem_, t.task.site);
    if ((t.entry.position() - site.position).norm() > kLength_m) say(t, "not over the site");
    if (t.run.length_m != 0.0) say(t, "a service has no run");
  }

  void flies_arc(const CoupledTask& t, const CoupledVehicle& v) {
    const Site& site = *site_of(problem_, t.task.site);
    const bool survey = t.task.kind == TaskKind::survey;
    const ArcRequirement& want = survey ? site.survey : site.assessments[t.task.index];
    const double radius_m = survey ? v.sensor_radius_m : v.assess_radius_m;
    const Vec2 spoke = t.entry.position() - site.position;
    if (std::abs(spoke.norm() - radius_m) > kLength_m) say(t, "radius of the arc");
    if (std::abs(std::abs(t.run.curvature_per_m) - 1.0 / radius_m) > 1e-9) say(t, "curvature");
    const Vec2 across = left_of(spoke) * (t.run.curvature_per_m > 0.0 ? 1.0 : -1.0);
    if (std::abs(wrap_pi(std::atan2(across.y(), across.x()) - t.entry.heading_rad)) > 1e-9) {
      say(t, "does not fly along the arc");
    }
    if (want.start_angle_rad) {
      const double angle = std::atan2(spoke.y(), spoke.x());
      if (std::abs(wrap_pi(angle - *want.start_angle_rad)) > 1e-9) say(t, "start angle");
    }
    if (t.run.length_m / v.speed_mps < to_seconds(want.dwell)) say(t, "dwell");
  }

  void arrives(const CoupledTask& t, const CoupledVehicle& v, const Pose2& pose, double transit_s) {
    const double least_m = v.planning_radius_m == 0.0
                               ? (t.entry.position() - pose.position()).norm()
                               : shortest_dubins_length(pose, t.entry, v.planning_radius_m);
    if (std::abs(t.transit_m - transit_s * v.speed_mps) > kLength_m) {
      say(t, "the transit does not fill its time");
    }
    if (t.transit_m < least_m - kLength_m) say(t, "cannot be there in time");
    if (problem_.flyable_waits && v.planning_radius_m > 0.0 &&
        (t.transit_m > least_m + kLength_m || !problem_.hazards.empty())) {
      const Transit transit{pose, t.entry, v.planning_radius_m, v.range_left_m, problem_.hazards};
      const auto path = path_of_length(problem_.avoidance, transit, t.transit_m);
      if (!path) say(t, path.error().message);
    }
  }

  void shares_out(const Site& site) {
    std::map<std::uint16_t, int> tasks;
    for (const CoupledTask& t : plan_.tasks) {
      const bool counts = t.task.site == site.id || problem_.share == TaskShare::one;
      if (counts && t.task.kind != TaskKind::survey) ++tasks[t.vehicle.value];
    }
    for (const auto& [vehicle, count] : tasks) {
      if (count > 1) faults_.emplace_back("a vehicle does more than its share");
    }
  }

  void keeps_order(const Site& site) {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    double survey_end_s = -kNever;
    double first_delivery_s = kNever;
    double last_delivery_s = -kNever;
    double first_assessment_s = kNever;
    double least_common_s = kNever;
    double greatest_common_s = -kNever;
    for (const CoupledTask& t : plan_.tasks) {
      if (t.task.site != site.id) continue;
      if (t.task.kind == TaskKind::survey) survey_end_s = t.end_s;
      if (t.task.kind == TaskKind::assess) {
        first_assessment_s = std::min(first_assessment_s, t.time_s);
      }
      if (t.task.kind == TaskKind::deliver) {
        first_delivery_s = std::min(first_delivery_s, t.time_s);
        last_delivery_s = std::max(last_delivery_s, t.time_s);
        const double common_s = t.time_s - to_seconds(site.deliveries[t.task.index].offset);
        least_common_s = std::min(least_common_s, common_s);
        greatest_common_s = std::max(greatest_common_s, common_s);
      }
    }
    const std::string name = "site " + std::to_string(site.id.value);
    if (first_delivery_s < survey_end_s + to_seconds(problem_.decide_wait) - kTime_s) {
      faults_.push_back(name + ": a delivery before the survey's end and the wait");
    }
    if (first_assessment_s < survey_end_s - kTime_s) {
      faults_.push_back(name + ": an assessment before the survey's end");
    }
    if (first_assessment_s < last_delivery_s + to_seconds(site.assess_wait) - kTime_s) {
      faults_.push_back(name + ": an assessment before the last delivery and the wait");
    }
    if (greatest_common_s - least_common_s > kTime_s) {
      faults_.push_back(name + ": the deliveries are not together");
    }
  }

  const CoupledProblem& problem_;
  const CoupledPlan& plan_;
  std::vector<std::string> faults_;
};

/// Every rule of the model that the plan breaks, as sentences; empty when it is sound.
inline std::vector<std::string> faults_of(const CoupledProblem& problem, const CoupledPlan& plan) {
  return CoupledJudge{problem, plan}.take();
}

}  // namespace skein::planning
