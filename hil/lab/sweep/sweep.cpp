// SPDX-License-Identifier: Apache-2.0
#include "skein/experiments/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <mutex>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "csv.hpp"
#include "skein/experiments/grid.hpp"
#include "skein/experiments/plots.hpp"
#include "skein/experiments/statistics.hpp"
#include "skein/hil/team_mission.hpp"

namespace skein::experiments {
namespace {

using configuration::Experiment;
using configuration::Scenario;

struct Draw {
  std::size_t cell = 0;
  std::uint64_t seed = 0;
};

std::uint64_t seed_end(const Experiment& experiment) {
  return experiment.first_seed + experiment.runs;
}

std::vector<Draw> missing_draws(const Experiment& experiment, const RunTable& table) {
  const std::size_t cells = cells_of(experiment).size();
  std::vector<Draw> draws;
  for (std::uint64_t seed = experiment.first_seed; seed < seed_end(experiment); ++seed) {
    for (std::size_t cell = 0; cell < cells; ++cell) {
      if (!table.has(cell, seed)) draws.push_back({cell, seed});
    }
  }
  return draws;
}

Result<void> write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out{file, std::ios::binary};
  out << text << std::flush;
  if (!out) return not_written(file.string());
  return {};
}

/// Takes draws one after the other, from several threads.
class Flights {
 public:
  Flights(const Experiment& experiment, const Scenario& base, const SweepOptions& options,
          RunTable& table)
      : experiment_{experiment},
        base_{base},
        options_{options},
        table_{table},
        limits_{hil::limits_of(base.expect)},
        cells_{cells_of(experiment)},
        draws_{missing_draws(experiment, table)} {}

  [[nodiscard]] std::size_t size() const { return draws_.size(); }
  [[nodiscard]] std::size_t flown() const { return flown_; }
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

  void work() {
    while (const auto draw = take()) {
      const auto mission = mission_of(experiment_, base_, cells_[draw->cell], draw->seed);
      if (!mission) {
        fail(mission.error());
        return;
      }
      const Measures measures = measure(*mission, limits_);
      const std::lock_guard lock{mutex_};
      if (const auto kept = table_.append(draw->cell, draw->seed, measures); !kept) {
        error_ = kept.error();
        return;
      }
      ++flown_;
      if (options_.on_done) options_.on_done(measures);
    }
  }

 private:
  std::optional<Draw> take() {
    const std::lock_guard lock{mutex_};
    if (error_ || next_ == draws_.size() || (options_.stopped && options_.stopped())) return {};
    return draws_[next_++];
  }
  void fail(const Error& error) {
    const std::lock_guard lock{mutex_};
    error_ = error;
  }

  const Experiment& experiment_;
  const Scenario& base_;
  const SweepOptions& options_;
  RunTable& table_;
  checks::Limits limits_;
  std::vector<Cell> cells_;
  std::vector<Draw> draws_;
  std::mutex mutex_;
  std::size_t next_ = 0;
  std::size_t flown_ = 0;
  std::optional<Error> error_;
};

std::string cells_csv(const Experiment& experiment, const RunTable& table) {
  std::vector<std::string> head;
  for (const auto& axis : experiment.axes) head.push_back(axis.name);
  for (const auto* name : {"measure", "runs", "mean", "half_width_95", "deviation"})
    head.emplace_back(name);
  std::string text = csv_line(head);
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
      text += csv_line(row);
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

std::size_t missing(const Experiment& experiment, const RunTable& table) {
  return missing_draws(experiment, table).size();
}

Result<SweepOutcome> sweep(const Experiment& experiment, const Scenario& base,
                           const SweepOptions& options, RunTable& table) {
  const std::vector<Cell> cells = cells_of(experiment);
  for (const Cell& cell : cells) {
    if (const auto one = mission_of(experiment, base, cell, experiment.first_seed); !one)
      return one.error();
  }
  Flights flights{experiment, base, options, table};
  std::vector<std::jthread> others;
  for (std::size_t i = 1; i < std::min(options.jobs, flights.size()); ++i)
    others.emplace_back([&flights] { flights.work(); });
  flights.work();
  others.clear();  // joins them
  if (flights.error()) return *flights.error();
  const std::size_t wanted = cells.size() * experiment.runs;
  return SweepOutcome{wanted, wanted - missing(experiment, table), flights.flown()};
}

Result<void> write_results(const Experiment& experiment, const RunTable& table,
                           const std::filesystem::path& folder) {
  if (auto done = write(folder / "cells.csv", cells_csv(experiment, table)); !done) return done;
  for (std::size_t column = 0; column < table.columns().size(); ++column) {
    const Plot plot = plot_of(experiment, table, column);
    const bool bars = experiment.chart == configuration::ExperimentChart::bars;
    auto done = write(folder / (table.columns()[column] + ".svg"), svg(plot, bars));
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
