// SPDX-License-Identifier: Apache-2.0
#include "skein/experiments/run_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "skein/experiments/grid.hpp"
#include "skein/shards/csv.hpp"
#include "skein/version/version.hpp"

namespace skein::experiments {
namespace {

using configuration::Experiment;
using configuration::Scenario;

constexpr const char* kExperimentFile = "experiment.yaml";
constexpr const char* kScenarioFile = "scenario.yaml";
constexpr const char* kRunsFile = "runs.csv";
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/// The text by which two experiments are told apart.
std::string identity(Experiment experiment) {
  experiment.title = experiment.notes = "-";
  experiment.runs = 1;
  experiment.chart = {};
  return configuration::to_yaml(experiment);
}
std::string identity(Scenario scenario) {
  scenario.title = scenario.notes = "-";
  return configuration::to_yaml(scenario);
}

/// The experiment with its title and its number of runs, as they were asked for last.
Result<void> keep(const std::filesystem::path& file, const Experiment& experiment) {
  const std::string text = configuration::to_yaml(experiment);
  if (std::filesystem::exists(file)) {
    if (shards::text_of(file) == text) return {};
    const auto before = configuration::load_experiment(file);
    if (!before || identity(*before) != identity(experiment))
      return shards::has_changed(file, "experiment");
  }
  return shards::put_text(file, text);
}

}  // namespace

std::vector<std::string> RunTable::header() const {
  std::vector<std::string> names = axes_;
  names.emplace_back("seed");
  names.insert(names.end(), columns_.begin(), columns_.end());
  names.emplace_back("broken_checks");
  return names;
}

Result<RunTable> RunTable::open(const std::filesystem::path& folder, const Experiment& experiment,
                                const Scenario& base, const shards::Shard& shard,
                                const std::filesystem::path& file) {
  shards::Series series;
  series.kind = kSweep;
  series.program = version();
  series.file = file.string();
  series.first_seed = experiment.first_seed;
  series.runs = experiment.runs;
  series.shard = shard;
  auto opened = shards::RunFolder::open(folder, series);
  if (!opened) return opened.error();
  if (auto kept = keep(folder / kExperimentFile, experiment); !kept) return kept.error();
  if (auto kept = shards::keep_text(folder / kScenarioFile, identity(base), "scenario"); !kept)
    return kept.error();
  if (auto kept = shards::keep_series(folder, series); !kept) return kept.error();

  RunTable table;
  table.folder_ = std::move(*opened);
  for (const auto& axis : experiment.axes) table.axes_.push_back(axis.name);
  for (const Cell& cell : cells_of(experiment)) table.labels_.push_back(labels(experiment, cell));
  for (const auto& column : measure_columns()) table.columns_.emplace_back(column.name);
  for (const Site& site : base.sites) {
    table.sites_.push_back(site.id);
    table.columns_.push_back(fmt::format("formed_site_{}_s", site.id.value));
  }
  auto rows = shards::RowFile::open(folder / kRunsFile, table.header(),
                                    [&](const auto& fields) { return table.read(fields); });
  if (!rows) return rows.error();
  table.file_ = std::move(*rows);
  return table;
}

Result<shards::RowKey> RunTable::read(const std::vector<std::string>& fields) {
  const std::size_t axes = axes_.size();
  const std::vector<std::string> of(fields.begin(),
                                    fields.begin() + static_cast<std::ptrdiff_t>(axes));
  const auto cell = std::find(labels_.begin(), labels_.end(), of);
  if (cell == labels_.end()) return Error{"is of a cell that the experiment does not have"};
  const auto seed = shards::number_of<std::uint64_t>(fields[axes]);
  if (!seed) return Error{"has no seed"};
  Values values(columns_.size(), kNoValue);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string& field = fields[axes + 1 + i];
    if (field.empty()) continue;
    const auto value = shards::number_of<double>(field);
    if (!value) return Error{"has \"" + field + "\" in place of a number"};
    values[i] = *value;
  }
  const auto at = static_cast<std::size_t>(cell - labels_.begin());
  rows_.emplace(std::pair{at, *seed}, std::move(values));
  return shards::RowKey{*seed, at};
}

Result<void> RunTable::append(std::size_t cell, std::uint64_t seed, const Measures& measures) {
  Values values;
  for (const auto& column : measure_columns())
    values.push_back(column.of(measures).value_or(kNoValue));
  for (const SiteId site : sites_) {
    const auto formed = measures.formed_s.find(site);
    values.push_back(formed == measures.formed_s.end() ? kNoValue : formed->second);
  }
  std::vector<std::string> fields = labels_.at(cell);
  fields.push_back(std::to_string(seed));
  // The shortest text that reads back as the same number.
  for (const double value : values)
    fields.push_back(std::isnan(value) ? "" : fmt::format("{}", value));
  fields.push_back(fmt::format("{}", fmt::join(measures.broken, ";")));
  rows_.emplace(std::pair{cell, seed}, std::move(values));
  return file_->append({seed, cell}, fields);
}

Result<void> RunTable::take_over(const std::filesystem::path& folder) {
  return file_->take_over(folder / kRunsFile, [this](const auto& fields) { return read(fields); });
}

std::vector<double> RunTable::values(std::size_t cell, std::size_t column,
                                     std::uint64_t seed_end) const {
  std::vector<double> all;
  const auto end = rows_.lower_bound({cell, seed_end});
  for (auto row = rows_.lower_bound({cell, 0}); row != end; ++row) {
    if (!std::isnan(row->second[column])) all.push_back(row->second[column]);
  }
  return all;
}

Result<void> same_experiment(const std::filesystem::path& folder,
                             const std::filesystem::path& other) {
  const auto differ = [&](const char* name) {
    return Error{fmt::format("{} and {} differ: their runs are of different experiments",
                             (folder / name).string(), (other / name).string())};
  };
  const auto one = configuration::load_experiment(folder / kExperimentFile);
  if (!one) return one.error();
  const auto two = configuration::load_experiment(other / kExperimentFile);
  if (!two) return two.error();
  if (identity(*one) != identity(*two)) return differ(kExperimentFile);
  if (shards::text_of(folder / kScenarioFile) != shards::text_of(other / kScenarioFile))
    return differ(kScenarioFile);
  return {};
}

}  // namespace skein::experiments
