// SPDX-License-Identifier: Apache-2.0
#include "skein/experiments/run_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <sstream>

#include "csv.hpp"
#include "skein/experiments/grid.hpp"

namespace skein::experiments {
namespace {

using configuration::Experiment;
using configuration::Scenario;

template <class T>
bool parse(const std::string& text, T& value) {
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  return end.ec == std::errc{} && end.ptr == text.data() + text.size();
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in{file, std::ios::binary};
  return {std::istreambuf_iterator<char>{in}, {}};
}

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

/// Writes the text where there is no file yet; fails where the file has another text.
Result<void> keep(const std::filesystem::path& file, const std::string& text,
                  std::string_view what) {
  if (!std::filesystem::exists(file)) {
    std::ofstream out{file, std::ios::binary};
    out << text << std::flush;
    if (!out) return not_written(file.string());
    return {};
  }
  if (text_of(file) == text) return {};
  return Error{
      fmt::format("{}: the {} has changed since the runs in this folder were flown; name "
                  "another folder with --out, or remove this one to begin anew",
                  file.string(), what)};
}

}  // namespace

std::string RunTable::header() const {
  std::vector<std::string> names = axes_;
  names.emplace_back("seed");
  names.insert(names.end(), columns_.begin(), columns_.end());
  names.emplace_back("broken_checks");
  return csv_line(names);
}

Result<RunTable> RunTable::open(const std::filesystem::path& folder, const Experiment& experiment,
                                const Scenario& base) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    return Error{folder.string() + ": cannot be made: " + error.message() +
                 "; name another folder with --out"};
  }
  if (auto kept = keep(folder / "experiment.yaml", identity(experiment), "experiment"); !kept)
    return kept.error();
  if (auto kept = keep(folder / "scenario.yaml", identity(base), "scenario"); !kept)
    return kept.error();

  RunTable table;
  for (const auto& axis : experiment.axes) table.axes_.push_back(axis.name);
  for (const Cell& cell : cells_of(experiment)) table.labels_.push_back(labels(experiment, cell));
  for (const auto& column : measure_columns()) table.columns_.emplace_back(column.name);
  for (const Site& site : base.sites) {
    table.sites_.push_back(site.id);
    table.columns_.push_back(fmt::format("formed_site_{}_s", site.id.value));
  }
  const auto file = folder / "runs.csv";
  table.name_ = file.string();
  if (auto read = table.read(file); !read) return read.error();
  table.out_.open(file, std::ios::binary | std::ios::app);
  if (std::filesystem::file_size(file, error) == 0) table.out_ << table.header() << std::flush;
  if (!table.out_) return not_written(table.name_);
  return table;
}

Result<void> RunTable::read(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return {};
  std::string text = text_of(file);
  // A program that was ended while it wrote leaves half a row.
  text.resize(text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1);
  std::error_code error;
  std::filesystem::resize_file(file, text.size(), error);
  if (error) return Error{name_ + ": cannot be written: " + error.message()};
  std::istringstream lines{text};
  std::string line;
  if (!std::getline(lines, line)) return {};
  if (line + "\n" != header()) {
    return Error{name_ +
                 ":1: has other columns than this program writes; name another folder with --out"};
  }
  for (std::size_t number = 2; std::getline(lines, line); ++number) {
    const auto bad = [&](std::string_view what) {
      return Error{fmt::format("{}:{}: {}; remove the line", name_, number, what)};
    };
    const std::vector<std::string> fields = csv_fields(line);
    const std::size_t axes = axes_.size();
    if (fields.size() != axes + columns_.size() + 2) return bad("has not one field a column");
    const std::vector<std::string> of(fields.begin(),
                                      fields.begin() + static_cast<std::ptrdiff_t>(axes));
    const auto cell = std::find(labels_.begin(), labels_.end(), of);
    std::uint64_t seed = 0;
    if (cell == labels_.end()) return bad("is of a cell that the experiment does not have");
    if (!parse(fields[axes], seed)) return bad("has no seed");
    Values values(columns_.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::string& field = fields[axes + 1 + i];
      double value = 0.0;
      if (field.empty()) continue;
      if (!parse(field, value)) return bad("has \"" + field + "\" in place of a number");
      values[i] = value;
    }
    rows_.emplace(std::pair{seed, static_cast<std::size_t>(cell - labels_.begin())},
                  std::move(values));
  }
  return {};
}

Result<void> RunTable::append(std::size_t cell, std::uint64_t seed, const Measures& measures) {
  Values values;
  for (const auto& column : measure_columns()) values.push_back(column.of(measures));
  for (const SiteId site : sites_) {
    const auto formed = measures.formed_s.find(site);
    values.push_back(formed == measures.formed_s.end() ? std::nullopt
                                                       : std::optional{formed->second});
  }
  std::vector<std::string> fields = labels_.at(cell);
  fields.push_back(std::to_string(seed));
  // The shortest text that reads back as the same number.
  for (const auto& value : values) fields.push_back(value ? fmt::format("{}", *value) : "");
  fields.push_back(fmt::format("{}", fmt::join(measures.broken, ";")));
  rows_.emplace(std::pair{seed, cell}, std::move(values));
  out_ << csv_line(fields) << std::flush;
  if (!out_) return not_written(name_);
  return {};
}

std::vector<double> RunTable::values(std::size_t cell, std::size_t column,
                                     std::uint64_t seed_end) const {
  std::vector<double> all;
  for (const auto& [key, values] : rows_) {
    if (key.second == cell && key.first < seed_end && values[column])
      all.push_back(*values[column]);
  }
  return all;
}

}  // namespace skein::experiments
