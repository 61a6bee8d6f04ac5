// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>
#include <utility>
#include <vector>

#include "skein/base/assert.hpp"
#include "skein/hil/run_parallel.hpp"
#include "skein/paper_routes/route_experiments.hpp"
#include "skein/route_figures/route_figures.hpp"

namespace skein::route_figures {

[[nodiscard]] Result<Figures> draw_maps(const Options& options);
[[nodiscard]] Result<Figures> draw_convergence(const Options& options);
[[nodiscard]] Result<Figures> draw_quality(const Options& options);
[[nodiscard]] Result<Figures> draw_flights(const Options& options);
[[nodiscard]] Result<Figures> draw_weights(const Options& options);
[[nodiscard]] Result<Figures> draw_worlds(const Options& options);
[[nodiscard]] Result<Figures> draw_cooperative(const Options& options);
[[nodiscard]] Result<Figures> draw_scale(const Options& options);

[[nodiscard]] std::size_t contenders_count();
inline constexpr std::size_t kStarts = 3;

/// For columns and legends.
[[nodiscard]] constexpr std::string_view short_name(routes::Counting counting) {
  return counting == routes::Counting::iterations ? "iterations" : "evaluations";
}

/// `fly(0)` ... `fly(count - 1)`, in that order.
template <class Run, class Fly>
[[nodiscard]] std::vector<Run> fly_all(std::size_t count, const Options& options, const Fly& fly) {
  auto runs = hil::run_parallel<Run>(
      count, options.jobs, [&fly](std::size_t i) -> Result<Run> { return fly(i); },
      [&options](const Run&) {
        if (options.on_done) options.on_done();
      });
  SKEIN_ASSERT(runs.ok());
  return std::move(*runs);
}

}  // namespace skein::route_figures
