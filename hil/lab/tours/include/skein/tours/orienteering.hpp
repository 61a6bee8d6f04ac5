// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "skein/base/result.hpp"
#include "skein/coupled/coupled.hpp"

namespace skein::planning {

/// Team orienteering (Chao, Golden and Wasil, "The team orienteering problem", EJOR 1996) as a
/// coupled problem: places of which each may be left out, a service without duration at each, by
/// vehicles that fly straight from place to place at 1 m/s and must be at their end within their
/// time.
///
/// The text as the public instances have it: lines `n 32`, `m 2` and `tmax 42.5`, then n lines of
/// x, y and score; the first is where all begin, the last where they end. `name` stands for the
/// file in messages: "file:line: what is wrong".
[[nodiscard]] Result<CoupledProblem> parse_orienteering(std::string_view text,
                                                        const std::string& name);

/// Of the places that are not left out.
[[nodiscard]] double score_of(const CoupledProblem& problem, const CoupledPlan& plan);
/// Of all.
[[nodiscard]] double score_of(const CoupledProblem& problem);

}  // namespace skein::planning
