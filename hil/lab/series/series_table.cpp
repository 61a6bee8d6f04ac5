// SPDX-License-Identifier: Apache-2.0
#include "skein/series/series_table.hpp"

#include <fmt/format.h>

#include <utility>

namespace skein::series {
namespace {

constexpr const char* kScenarioFile = "scenario.yaml";
constexpr const char* kScenarioAndPlan = "scenario, or its plan (--routes),";
constexpr const char* kRunsFile = "runs.csv";

/// The file's text as comments, so that the whole stays a scenario.
std::string commented(const std::filesystem::path& file) {
  std::string text = fmt::format("# {}:\n# ", file.filename().string());
  for (const char c : shards::text_of(file)) text += c == '\n' ? "\n# " : std::string{c};
  return text + "\n";
}

shards::RowFile::Reader reader_of(bool formation) {
  return [formation](const std::vector<std::string>& fields) -> Result<shards::RowKey> {
    const auto row = parse_row(fields, formation);
    if (!row) return row.error();
    return shards::RowKey{row->seed, 0};
  };
}

}  // namespace

std::string identity(configuration::Scenario scenario) {
  scenario.title = scenario.notes = "-";
  scenario.seed = 1;
  std::string files;
  const auto keep = [&files](std::string& name) {
    files += commented(name);
    name = std::filesystem::path{name}.filename().string();
  };
  for (auto& shape : scenario.formation.shapes) keep(shape.file);
  for (auto& track : scenario.formation.tracks) keep(track.file);
  return configuration::to_yaml(scenario) + files;
}

Result<SeriesTable> SeriesTable::open(const std::filesystem::path& folder,
                                      const shards::Series& series, const std::string& scenario) {
  auto opened = shards::RunFolder::open(folder, series);
  if (!opened) return opened.error();
  if (auto kept = shards::keep_text(folder / kScenarioFile, scenario, kScenarioAndPlan); !kept)
    return kept.error();
  if (auto kept = shards::keep_series(folder, series); !kept) return kept.error();
  const bool formation = series.kind == kFormation;
  auto rows =
      shards::RowFile::open(folder / kRunsFile, row_columns(formation), reader_of(formation));
  if (!rows) return rows.error();
  return SeriesTable{std::move(*opened), std::move(*rows), series};
}

std::vector<std::uint64_t> SeriesTable::seeds() const {
  std::vector<std::uint64_t> seeds;
  for (std::uint64_t draw = 0; draw < series_.runs; ++draw)
    if (series_.shard.has(draw)) seeds.push_back(series_.first_seed + draw);
  return seeds;
}

std::vector<std::uint64_t> SeriesTable::missing() const {
  std::vector<std::uint64_t> missing = seeds();
  std::erase_if(missing, [this](std::uint64_t seed) { return rows_.has({seed, 0}); });
  return missing;
}

std::size_t SeriesTable::others() const {
  return rows_.size() - (seeds().size() - missing().size());
}

Result<void> SeriesTable::append(const RunRow& row) {
  return rows_.append({row.seed, 0}, row_fields(row, series_.kind == kFormation));
}

Result<void> SeriesTable::take_over(const std::filesystem::path& folder) {
  return rows_.take_over(folder / kRunsFile, reader_of(series_.kind == kFormation));
}

Result<Summary> SeriesTable::summary(const std::string& program) const {
  Summary summary{series_, program};
  const auto added = rows_.each([&](const std::vector<std::string>& fields) -> Result<void> {
    const auto row = parse_row(fields, series_.kind == kFormation);
    if (!row) return row.error();
    // A folder may hold more runs than are asked for.
    if (row->seed - series_.first_seed < series_.runs) summary.add(*row);
    return {};
  });
  if (!added) return added.error();
  return summary;
}

std::string scenario_of(const std::filesystem::path& folder) {
  return shards::text_of(folder / kScenarioFile);
}

Result<void> same_scenario(const std::filesystem::path& folder,
                           const std::filesystem::path& other) {
  if (scenario_of(folder) == scenario_of(other)) return {};
  return Error{
      fmt::format("{} and {} differ: their runs are of different scenarios, or plans (--routes)",
                  (folder / kScenarioFile).string(), (other / kScenarioFile).string())};
}

Result<void> write_summary(const Summary& summary, const std::filesystem::path& folder) {
  return shards::put_text(folder / "summary.txt", summary.text());
}

}  // namespace skein::series
