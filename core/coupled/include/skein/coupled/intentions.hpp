// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/base/ids.hpp"
#include "skein/coupled/coupled.hpp"
#include "skein/domain/site.hpp"
#include "skein/domain/task.hpp"
#include "skein/domain/vehicle.hpp"

/// From vehicles and sites to a coupled problem, and from its plan to where vehicles go first.
namespace skein::planning {

/// As a vehicle plans: at cruise speed, with its planning radius and its whole range.
[[nodiscard]] CoupledVehicle coupled_vehicle(const VehicleSpec& spec, const Pose2& pose);

/// All tasks of the sites, as the open ones of a problem.
[[nodiscard]] std::vector<TaskId> tasks_of(const std::vector<Site>& sites);

/// Of the many plans that are equally good, one with short ways: among vehicles that fly alike and
/// have one task or none, the tasks but for surveys go to those who are nearest in sum. Every task
/// keeps its time. The problem is one without coming home, and of waits of any length.
void settle_ties(const CoupledProblem& problem, CoupledPlan& plan);

/// Where a vehicle goes before anybody has awarded it anything: to the sites that it is to survey,
/// in their order; who surveys none, to where it can begin its first task from, and around there.
/// A minute after that should have ended it also goes to the site of the most tasks, to and fro.
struct Intention {
  VehicleId vehicle;
  std::vector<Vec2> way;  ///< empty: it has no task
};

/// One for each vehicle of the problem. A site is gone to on the side where its survey begins, and
/// so near that it is found; who waits does so short of its task's entry, where there is no hazard.
[[nodiscard]] std::vector<Intention> intentions_of(const CoupledProblem& problem,
                                                   const CoupledPlan& plan);

}  // namespace skein::planning
