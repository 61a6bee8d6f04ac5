// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/result.hpp"

/// The experiments of Wu 2022, repeated: tables beside the paper's values, and its figures from our
/// data (core/routes has the runs themselves).
namespace skein::route_figures {

enum class Experiment : std::uint8_t {
  maps,         ///< tables 2 and 3: chaotic maps for the start and for `a`
  convergence,  ///< fig. 12: value over the budget, every optimiser, at both countings
  weights,      ///< fig. 13: three weightings, drawn
  worlds,       ///< fig. 14 and 15: who wins in random worlds, and by how much
  cooperative,  ///< fig. 16 and 17: three vehicles arrive together, drawn; their distances
  quality,      ///< ours against the best known from the paper's three starts
  flights,      ///< ours against the best known in random worlds, by the costs of flights
  scale,        ///< ours for 5, 10 and 20 vehicles among 30 hazards
  count
};
[[nodiscard]] std::string_view to_string(Experiment experiment);

/// Each once, in the order above; "all" names all. Fails with a sentence that names them.
[[nodiscard]] Result<std::vector<Experiment>> find_experiments(
    const std::vector<std::string>& names);

/// How many runs. As it is: for a quick look.
struct Runs {
  std::size_t maps = 8;          ///< of each map at each of its two places
  std::size_t convergence = 8;   ///< of each optimiser and counting
  std::size_t weights = 3;       ///< of each method and weighting; the best is drawn
  std::size_t worlds = 60;       ///< at each counting
  std::size_t known_worlds = 6;  ///< the first of them, of which the best known is searched for
  std::size_t quality = 50;      ///< from each start
  std::size_t best_known = 1;    ///< searches with 100 times the evaluations from each start
  std::size_t flights = 12;      ///< random worlds, each with four runs and a long search
  std::array<std::size_t, 3> teams{4, 4, 4};  ///< of 5, of 10 and of 20 vehicles
};
/// The paper's numbers, and those of our own claims.
[[nodiscard]] Runs paper_runs();
/// The same number of everything, but of the best known.
[[nodiscard]] Runs runs_of(std::size_t number);

struct Options {
  Runs runs{};
  std::uint64_t seed = 1;  ///< of the first run; then + 1
  std::size_t jobs = 1;    ///< threads; the tables and files do not depend on it
  /// Called after every run, from one thread at a time. May be empty.
  std::function<void()> on_done;
};

struct File {
  std::string name;  ///< worlds.csv, ...
  std::string text;
};
struct Figures {
  std::string text;  ///< tables for a terminal; of times, only `scale` tells any
  std::vector<File> files{};
};

/// How often draw() calls on_done.
[[nodiscard]] std::size_t steps_of(Experiment experiment, const Runs& runs);

/// Runs the experiment. The same options give the same files on every machine. Fails where the
/// cooperative case has no plan.
[[nodiscard]] Result<Figures> draw(Experiment experiment, const Options& options);

}  // namespace skein::route_figures
