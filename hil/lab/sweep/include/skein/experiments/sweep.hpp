// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/configuration/experiment.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/experiments/measures.hpp"
#include "skein/experiments/run_table.hpp"
#include "skein/shards/shard.hpp"

namespace skein::experiments {

struct SweepOptions {
  std::filesystem::path folder;
  std::size_t jobs = 1;  ///< threads, each flying one mission at a time; >= 1
  shards::Shard shard;   ///< of all the draws
  /// Called after every run, from one thread at a time.
  std::function<void(const Measures&)> on_done;
  /// Asked before every run; true: those that are under way end, and no other begins.
  std::function<bool()> stopped;
};

struct SweepOutcome {
  std::size_t wanted = 0;   ///< cells times runs; of a shard, those of them that it has
  std::size_t present = 0;  ///< of them, in the table now
  std::size_t flown = 0;    ///< this time
};

/// A run of the experiment: the draws are counted in the order in which one machine flies them.
struct Draw {
  std::uint64_t number = 0;  ///< from 0
  std::size_t cell = 0;
  std::uint64_t seed = 0;
};

/// The runs of the experiment, or of a shard of it, that the table lacks.
[[nodiscard]] std::vector<Draw> missing(const configuration::Experiment& experiment,
                                        const RunTable& table, const shards::Shard& shard = {});

/// Of the experiment's runs that the table has: did every check but completion hold?
[[nodiscard]] bool all_safe(const configuration::Experiment& experiment, const RunTable& table);

/// Flies the runs that the table lacks: the first draw of every cell, then the second, so that a
/// table cut short is one of fewer draws, and leaves the table sorted. Fails where a cell cannot be
/// flown, before anything is.
[[nodiscard]] Result<SweepOutcome> sweep(const configuration::Experiment& experiment,
                                         const configuration::Scenario& base,
                                         const SweepOptions& options, RunTable& table);

/// FOLDER/cells.csv (mean and 95 % confidence interval by cell and measure) and FOLDER/MEASURE.svg,
/// of what the table holds.
[[nodiscard]] Result<void> write_results(const configuration::Experiment& experiment,
                                         const RunTable& table,
                                         const std::filesystem::path& folder);

/// The main measures by cell, for a terminal.
[[nodiscard]] std::string text_table(const configuration::Experiment& experiment,
                                     const RunTable& table);

}  // namespace skein::experiments
