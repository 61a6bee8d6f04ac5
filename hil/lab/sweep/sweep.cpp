// SPDX-License-Identifier: Apache-2.0
#include "skein/experiments/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "skein/experiments/grid.hpp"
#include "skein/experiments/plots.hpp"
#include "skein/experiments/statistics.hpp"
#include "skein/hil/run_parallel.hpp"
#include "skein/hil/team_mission.hpp"
#include "skein/shards/csv.hpp"
#include "skein/shards/run_folder.hpp"

namespace skein::experiments {
namespace {

using configuration::Experiment;
using configuration::Scenario;

std::uint64_t seed_end(const Experiment& experiment) {
  return experiment.first_seed + experiment.runs;
}

std::string cells_csv(const Experiment& experiment, const RunTable& table) {
  std::vector<std::string> head;
  for (const auto& axis : experiment.axes) head.push_back(axis.name);
  for (const auto* name : {"measure", "runs", "mean", "half_width_95", "deviation"})
    head.emplace_back(name);
  std::string text = shards::csv_line(head);
  const std::vector<Cell> cells = cells_of(experiment);
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    for (std::size_t column = 0; column < table.columns().size(); ++column) {
      const Estimate e = estimate(table.values(cell, column, seed_end(experiment)));
      std::vector<std::string> row = labels(experiment, cells[cell]);
      row.push_back(table.columns()[column]);
      row.push_back(std::to_string(e.count));
      // Of no value there is no mean, of one no interval.
      row.push_back(e.count > 0 ? fmt::format("{}", e.mean) : "");
      row.push_back(e.count > 1 ? fmt::format("{}", e.half_width) : "");
      row.push_back(e.count > 1 ? fmt::format("{}", e.deviation) : "");
      text += shards::csv_line(row);
    }
  }
  return text;
}

/// The first axis lies along the plot; a series is a combination of the others' points.
Plot plot_of(const Experiment& experiment, const RunTable& table, std::size_t column) {
  Plot plot;
  plot.title = experiment.title;
  const auto& known = measure_columns();
  plot.y_label =
      column < known.size() ? std::string{known.at(column).label} : table.columns()[column];
  plot.x_label = experiment.axes.front().name;
  for (const auto& point : experiment.axes.front().points) plot.x.push_back(point.label);
  const std::vector<Cell> cells = cells_of(experiment);
  const std::size_t series = cells.size() / plot.x.size();
  for (std::size_t s = 0; s < series; ++s) {
    const std::vector<std::string> words = labels(experiment, cells[s]);
    Series one;
    for (std::size_t axis = 1; axis < words.size(); ++axis)
      one.name += (axis > 1 ? ", " : "") + words[axis];
    if (words.size() == 2) one.name = experiment.axes[1].name + " " + one.name;
    for (std::size_t x = 0; x < plot.x.size(); ++x)
      one.values.push_back(estimate(table.values(x * series + s, column, seed_end(experiment))));
    plot.series.push_back(std::move(one));
  }
  return plot;
}

}  // namespace

std::vector<Draw> missing(const Experiment& experiment, const RunTable& table,
                          const shards::Shard& shard) {
  const std::size_t cells = cells_of(experiment).size();
  std::vector<Draw> draws;
  Draw draw{0, 0, experiment.first_seed};
  for (; draw.seed < seed_end(experiment); ++draw.seed) {
    for (draw.cell = 0; draw.cell < cells; ++draw.cell, ++draw.number) {
      if (shard.has(draw.number) && !table.has(draw.cell, draw.seed)) draws.push_back(draw);
    }
  }
  return draws;
}

bool all_safe(const Experiment& experiment, const RunTable& table) {
  const auto at = std::find(table.columns().begin(), table.columns().end(), "safe");
  const auto column = static_cast<std::size_t>(at - table.columns().begin());
  for (std::size_t cell = 0; cell < cells_of(experiment).size(); ++cell) {
    const auto safe = table.values(cell, column, seed_end(experiment));
    if (std::find(safe.begin(), safe.end(), 0.0) != safe.end()) return false;
  }
  return true;
}

Result<SweepOutcome> sweep(const Experiment& experiment, const Scenario& base,
                           const SweepOptions& options, RunTable& table) {
  const std::vector<Cell> cells = cells_of(experiment);
  for (const Cell& cell : cells) {
    if (const auto one = mission_of(experiment, base, cell, experiment.first_seed); !one)
      return one.error();
  }
  const checks::Limits limits = hil::limits_of(base.expect);
  const std::vector<Draw> draws = missing(experiment, table, options.shard);
  const auto fly = [&](std::size_t i) -> Result<Measures> {
    const auto mission = mission_of(experiment, base, cells[draws[i].cell], draws[i].seed);
    if (!mission) return mission.error();
    return measure(*mission, limits);
  };
  std::size_t flown = 0;
  const auto take = [&](std::size_t i, Measures&& measures) -> Result<void> {
    if (auto kept = table.append(draws[i].cell, draws[i].seed, measures); !kept) return kept;
    ++flown;
    if (options.on_done) options.on_done(measures);
    return {};
  };
  if (const auto done =
          hil::each_parallel<Measures>(draws.size(), options.jobs, fly, take, options.stopped);
      !done) {
    return done.error();
  }
  if (const auto sorted = table.sort(); !sorted) return sorted.error();
  const std::uint64_t all = cells.size() * experiment.runs;
  const std::size_t wanted = static_cast<std::size_t>(all / options.shard.count) +
                             (options.shard.number <= all % options.shard.count ? 1 : 0);
  return SweepOutcome{wanted, wanted - (draws.size() - flown), flown};
}

Result<void> write_results(const Experiment& experiment, const RunTable& table,
                           const std::filesystem::path& folder) {
  if (auto done = shards::put_text(folder / "cells.csv", cells_csv(experiment, table)); !done)
    return done;
  for (std::size_t column = 0; column < table.columns().size(); ++column) {
    const Plot plot = plot_of(experiment, table, column);
    const bool bars = experiment.chart == configuration::ExperimentChart::bars;
    auto done = shards::put_text(folder / (table.columns()[column] + ".svg"), svg(plot, bars));
    if (!done) return done;
  }
  return {};
}

std::string text_table(const Experiment& experiment, const RunTable& table) {
  static constexpr std::array<std::string_view, 6> kShown{
      "value", "mission_s", "tasks_done", "coalitions", "attempts_failed", "safe"};
  std::vector<std::vector<std::string>> rows(1);
  for (const auto& axis : experiment.axes) rows.front().push_back(axis.name);
  rows.front().emplace_back("runs");
  for (const auto name : kShown) rows.front().emplace_back(name);
  const std::vector<Cell> cells = cells_of(experiment);
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    std::vector<std::string> row = labels(experiment, cells[cell]);
    for (const auto name : kShown) {
      const auto at = std::find(table.columns().begin(), table.columns().end(), name);
      const auto column = static_cast<std::size_t>(at - table.columns().begin());
      const Estimate e = estimate(table.values(cell, column, seed_end(experiment)));
      if (name == kShown.front()) row.push_back(std::to_string(e.count));
      const int digits = name == "mission_s" ? 1 : name == "value" || name == "safe" ? 3 : 2;
      row.push_back(e.count == 0 ? "-"
                    : e.count == 1
                        ? fmt::format("{:.{}f}", e.mean, digits)
                        : fmt::format("{:.{}f} +- {:.{}f}", e.mean, digits, e.half_width, digits));
    }
    rows.push_back(std::move(row));
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      std::size_t width = 0;
      for (const auto& other : rows) width = std::max(width, other[i].size());
      line += fmt::format("{:<{}}  ", row[i], width);
    }
    line.resize(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace skein::experiments
