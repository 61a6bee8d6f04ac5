// SPDX-License-Identifier: Apache-2.0
#include <glpk.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "instances.hpp"
#include "judge.hpp"
#include "skein/planning/dubins.hpp"
#include "skein/planning/task_path.hpp"

/// Coupled problems of a linear criterion as mixed integer programs, solved by GLPK, which knows
/// nothing of us: arcs from task to task for each vehicle, times by large constants.
namespace skein::planning {
namespace {

class Program {
 public:
  explicit Program(const CoupledProblem& problem)
      : problem_{problem}, tasks_{problem.open_tasks}, lp_{glp_create_prob()} {
    glp_term_out(GLP_OFF);
    double late_s = 0.0;
    for (const CoupledVehicle& v : problem.vehicles) {
      late_s = std::max(late_s, v.range_left_m / v.speed_mps);
    }
    if (const auto plan = greedy_awards(problem)) {
      late_s = (problem.criterion == Criterion::makespan ? 1.0 : 2.0) * plan->makespan_s;
    }
    late_s_ = late_s;
    for (std::size_t k = 0; k < tasks_.size(); ++k) {
      time_.push_back(variable(GLP_CV, late_s_));
      end_.push_back(variable(GLP_CV, late_s_));
    }
    makespan_ = variable(GLP_CV, late_s_);
    for (std::size_t i = 0; i < problem.vehicles.size(); ++i) add_vehicle(i);
    for (std::size_t k = 0; k < tasks_.size(); ++k) {
      constrain(GLP_FX, 1.0, once_[k]);
      // end = time + what the vehicle that does it takes
      std::vector<Term> sum{{end_[k], 1.0}, {time_[k], -1.0}};
      sum.insert(sum.end(), after_[k].begin(), after_[k].end());
      constrain(GLP_FX, 0.0, sum);
      constrain(GLP_LO, 0.0, {{makespan_, 1.0}, {end_[k], -1.0}});
    }
    add_precedence();
    if (problem.criterion == Criterion::makespan) {
      glp_set_obj_coef(lp_, makespan_, 1.0);
    } else {
      for (const int e : end_) {
        glp_set_obj_coef(lp_, e, 1.0 / static_cast<double>(tasks_.size()));
      }
    }
    glp_load_matrix(lp_, static_cast<int>(row_.size()) - 1, row_.data(), column_.data(),
                    value_.data());
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program() { glp_delete_prob(lp_); }

  [[nodiscard]] std::optional<double> solve() {
    glp_iocp options;
    glp_init_iocp(&options);
    options.msg_lev = GLP_MSG_OFF;
    options.presolve = GLP_ON;
    if (glp_intopt(lp_, &options) != 0 || glp_mip_status(lp_) != GLP_OPT) return std::nullopt;
    return glp_mip_obj_val(lp_);
  }

 private:
  using Term = std::pair<int, double>;

  int variable(int kind, double high) {
    const int v = glp_add_cols(lp_, 1);
    glp_set_col_kind(lp_, v, kind);
    if (kind == GLP_CV) glp_set_col_bnds(lp_, v, GLP_DB, 0.0, high);
    return v;
  }

  void constrain(int kind, double bound, const std::vector<Term>& terms) {
    const int r = glp_add_rows(lp_, 1);
    glp_set_row_bnds(lp_, r, kind, bound, bound);
    for (const auto& [column, value] : terms) {
      row_.push_back(r);
      column_.push_back(column);
      value_.push_back(value);
    }
  }

  [[nodiscard]] TaskPath path_of(const CoupledVehicle& v, const TaskId& task) const {
    const Site& site = *site_of(problem_, task.site);
    if (task.kind == TaskKind::deliver) {
      return delivery_path(site, site.deliveries[task.index], v.final_approach_m);
    }
    const bool survey = task.kind == TaskKind::survey;
    const ArcRequirement& arc = survey ? site.survey : site.assessments[task.index];
    return arc_path(site, *arc.start_angle_rad, arc.dwell,
                    survey ? v.sensor_radius_m : v.assess_radius_m, v.speed_mps, 1);
  }

  void add_vehicle(std::size_t i) {
    once_.resize(tasks_.size());
    after_.resize(tasks_.size());
    const CoupledVehicle& v = problem_.vehicles[i];
    std::vector<std::vector<Term>> in(tasks_.size());
    std::vector<std::vector<Term>> out(tasks_.size());
    std::vector<Term> starts;
    std::vector<Term> deliveries;
    for (std::size_t b = 0; b < tasks_.size(); ++b) {
      if (!v.capabilities.has(tasks_[b].kind)) continue;
      const TaskPath to = path_of(v, tasks_[b]);
      const bool deliver = tasks_[b].kind == TaskKind::deliver;
      const double run_s = to.run.length_m / v.speed_mps;
      for (std::size_t a = 0; a <= tasks_.size(); ++a) {
        const bool start = a == tasks_.size();
        if (a == b || (!start && !v.capabilities.has(tasks_[a].kind))) continue;
        Pose2 from = v.pose;
        if (!start) {
          const TaskPath last = path_of(v, tasks_[a]);
          from = advance(last.entry, last.run.curvature_per_m, last.run.length_m);
        }
        const double reach_s =
            shortest_dubins_length(from, to.entry, v.planning_radius_m) / v.speed_mps +
            (deliver ? run_s : 0.0);
        const int arc = variable(GLP_BV, 1.0);
        in[b].emplace_back(arc, 1.0);
        if (start) {
          starts.emplace_back(arc, 1.0);
          constrain(GLP_LO, 0.0, {{time_[b], 1.0}, {arc, -reach_s}});
        } else {
          out[a].emplace_back(arc, -1.0);
          // time of b >= end of a + reach, where the arc is flown
          constrain(GLP_LO, -late_s_,
                    {{time_[b], 1.0}, {end_[a], -1.0}, {arc, -reach_s - late_s_}});
        }
        once_[b].emplace_back(arc, 1.0);
        if (deliver) deliveries.emplace_back(arc, 1.0);
        if (!deliver) after_[b].emplace_back(arc, -run_s);
        // end of b <= range, where the arc is flown
        constrain(
            GLP_UP, late_s_,
            {{end_[b], 1.0}, {arc, late_s_ - std::min(late_s_, v.range_left_m / v.speed_mps)}});
      }
    }
    if (!starts.empty()) constrain(GLP_UP, 1.0, starts);
    if (!deliveries.empty()) constrain(GLP_UP, v.loads, deliveries);
    for (std::size_t k = 0; k < tasks_.size(); ++k) {
      std::vector<Term> flow = in[k];
      flow.insert(flow.end(), out[k].begin(), out[k].end());
      if (!flow.empty()) constrain(GLP_LO, 0.0, flow);
    }
  }

  void add_precedence() {
    for (std::size_t a = 0; a < tasks_.size(); ++a) {
      for (std::size_t b = 0; b < tasks_.size(); ++b) {
        if (a == b || tasks_[a].site != tasks_[b].site) continue;
        const Site& site = *site_of(problem_, tasks_[a].site);
        const TaskKind first = tasks_[a].kind;
        const TaskKind second = tasks_[b].kind;
        if (first == TaskKind::survey && second == TaskKind::deliver) {
          constrain(GLP_LO, to_seconds(problem_.decide_wait), {{time_[b], 1.0}, {end_[a], -1.0}});
        }
        if (first == TaskKind::deliver && second == TaskKind::assess) {
          constrain(GLP_LO, to_seconds(site.assess_wait), {{time_[b], 1.0}, {time_[a], -1.0}});
        }
        if (first == TaskKind::deliver && second == TaskKind::deliver) {
          const Duration later =
              site.deliveries[tasks_[b].index].offset - site.deliveries[tasks_[a].index].offset;
          constrain(GLP_FX, to_seconds(later), {{time_[b], 1.0}, {time_[a], -1.0}});
        }
      }
    }
  }

  const CoupledProblem& problem_;
  std::vector<TaskId> tasks_;
  glp_prob* lp_;
  double late_s_ = 0.0;
  int makespan_ = 0;
  std::vector<int> time_;
  std::vector<int> end_;
  std::vector<std::vector<Term>> once_;   ///< by task: its arcs
  std::vector<std::vector<Term>> after_;  ///< by task: - seconds from its time to its end
  std::vector<int> row_ = {0};            // GLPK counts from 1
  std::vector<int> column_ = {0};
  std::vector<double> value_ = {0.0};
};

void expect_equal(std::uint64_t seed, Criterion criterion) {
  SCOPED_TRACE(testing::Message() << static_cast<int>(criterion) << " seed " << seed);
  Random random{40 + seed};
  CoupledDraw draw;
  draw.sites = 2;
  draw.vehicles = 3;
  draw.deliveries = 1 + seed % 2;
  draw.interval_s = seed % 4 == 3 ? 5.0 : 0.0;
  CoupledProblem problem = draw_problem(random, draw);
  problem.criterion = criterion;
  problem.decide_wait = std::chrono::seconds{5};
  problem.flyable_waits = false;  // gaps would need more variables
  const auto plan = branch_and_bound(problem, {});
  ASSERT_TRUE(plan.ok() && plan->proven);
  const auto oracle = Program{problem}.solve();
  ASSERT_TRUE(oracle.has_value());
  EXPECT_NEAR(plan->objective, *oracle, 1e-5 * *oracle);
}

TEST(CoupledOracle, BranchAndBoundEqualsTheMixedIntegerProgram) {
  expect_equal(0, Criterion::completion);
  expect_equal(2, Criterion::makespan);
  expect_equal(3, Criterion::makespan);
}

TEST(CoupledOracle, DISABLED_BranchAndBoundEqualsManyMixedIntegerPrograms) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    expect_equal(seed, Criterion::completion);
    expect_equal(seed, Criterion::makespan);
  }
}

}  // namespace
}  // namespace skein::planning
