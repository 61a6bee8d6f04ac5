// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "skein/formation/change_planner.hpp"

/// Random changes of formation, planned and then judged by code apart from the planner.
namespace skein::change_trials {

struct ChangeTrial {
  std::uint64_t seed = 0;
  formation::ChangeRequest request;
  bool random_assignment = false;  ///< otherwise of least squares
};

/// 5 to 100 vehicles between shapes or random free places, with random separations.
[[nodiscard]] ChangeTrial draw_change(std::uint64_t seed);

struct JudgedChange {
  std::uint64_t seed = 0;
  std::size_t vehicles = 0;
  bool random_assignment = false;
  std::string refused;  ///< the planner's reason; empty: it was planned
  formation::Way way = formation::Way::straight;
  double wanted_m = 0.0;  ///< separation and reserve
  double least_m = 0.0;   ///< of any two, in continuous time, heights stretched; never too much
  std::string violation;  ///< empty: none
};

/// What the change does with the request: starts, ends, ceiling, speed, and the least distance of
/// any two. It looks every 20 ms at all positions, takes each for flying straight in between, and
/// subtracts what its acceleration can bend its way.
[[nodiscard]] JudgedChange judge_change(const formation::ChangeRequest& request,
                                        const formation::PlannedChange& planned);

/// draw_change(), plan_change() and judge_change().
[[nodiscard]] JudgedChange try_change(std::uint64_t seed);

/// In the order of seeds, whatever the number of threads. `on_done` from one thread at a time.
[[nodiscard]] std::vector<JudgedChange> try_changes(
    std::uint64_t first_seed, std::size_t runs, std::size_t jobs,
    const std::function<void(const JudgedChange&)>& on_done = {});

}  // namespace skein::change_trials
