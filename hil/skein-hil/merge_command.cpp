// SPDX-License-Identifier: Apache-2.0
//
// Shards put together, as if one machine had flown them.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <system_error>
#include <vector>

#include "commands.hpp"
#include "skein/configuration/experiment.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/experiments/run_table.hpp"
#include "skein/experiments/sweep.hpp"
#include "skein/series/series_table.hpp"
#include "skein/series/summary.hpp"
#include "skein/shards/run_folder.hpp"

namespace skein::hil {
namespace {

constexpr std::size_t kShown = 20;  ///< missing runs, and commands, that are named

struct Part {
  std::filesystem::path folder;
  shards::Series series;
};

bool is_sweep(const shards::Series& series) { return series.kind == experiments::kSweep; }

/// The folders with what they are of, if they are all of one experiment and none of them is `out`.
Result<std::vector<Part>> parts_of(const MergeArguments& arguments) {
  std::vector<Part> parts;
  for (const auto& folder : arguments.folders) {
    const auto series = shards::read_series(folder);
    if (!series) return series.error();
    std::error_code error;
    if (std::filesystem::equivalent(folder, arguments.out, error))
      return Error{folder.string() + ": is merged into itself; name another folder with --out"};
    parts.push_back({folder, *series});
    const Part& first = parts.front();
    auto same = shards::same_series(first.series, first.folder.string(), *series, folder.string());
    if (same && is_sweep(*series)) same = experiments::same_experiment(first.folder, folder);
    if (same && !is_sweep(*series)) same = series::same_scenario(first.folder, folder);
    if (!same) return same.error();
  }
  return parts;
}

/// The whole of which they are parts: the greatest number of runs that was asked for, now or when
/// `out` was put together.
shards::Series whole_of(const std::vector<Part>& parts, const std::filesystem::path& out) {
  shards::Series whole = parts.front().series;
  whole.shard = {};
  for (const Part& part : parts) whole.runs = std::max(whole.runs, part.series.runs);
  if (const auto before = shards::read_series(out)) whole.runs = std::max(whole.runs, before->runs);
  return whole;
}

/// That the shard has, or would have where folders are named by their shards' numbers.
std::string folder_of(const shards::Shard& shard, const std::vector<Part>& parts) {
  for (const Part& part : parts) {
    if (part.series.shard == shard) return part.folder.string();
  }
  const Part& first = parts.front();
  if (first.folder.filename() == std::to_string(first.series.shard.number) &&
      first.series.shard.count == shard.count)
    return (first.folder.parent_path() / std::to_string(shard.number)).string();
  return "FOLDER";
}

/// How the shard is flown, into the folder that it has or a new one.
std::string command_of(const MergeArguments& arguments, const shards::Series& whole,
                       const shards::Shard& shard, const std::vector<Part>& parts) {
  std::string text = fmt::format("{} {} {} --runs {}", arguments.program,
                                 is_sweep(whole) ? "sweep" : "simulate", whole.file, whole.runs);
  if (!is_sweep(whole)) text += fmt::format(" --seed {}", whole.first_seed);
  return text + shards::options_of(whole) +
         fmt::format(" --shard {} --out {}", shards::to_string(shard), folder_of(shard, parts));
}

/// Of draws that are in no folder: which, and who flies them.
void tell_of_missing(const MergeArguments& arguments, const shards::Series& whole,
                     const std::vector<experiments::Draw>& draws, const std::vector<Part>& parts) {
  if (draws.empty()) return;
  // With folders of several divisions, the finest: its shards are the shortest.
  shards::Shard division;
  for (const Part& part : parts) division.count = std::max(division.count, part.series.shard.count);
  std::map<std::size_t, std::size_t> lacking;
  for (const auto& draw : draws) ++lacking[division.of(draw.number)];
  std::vector<std::size_t> numbers;
  for (const auto& [number, runs] : lacking) numbers.push_back(number);
  std::string some;
  for (std::size_t i = 0; i < std::min(draws.size(), kShown); ++i)
    some += fmt::format("{}{}", i == 0 ? " seed " : ", ", draws[i].seed);
  fmt::print(stderr, "{} runs are missing:{}{}\nof shards {} of {}; to fly them:\n", draws.size(),
             some, draws.size() > kShown ? ", ..." : "", shards::ranges(numbers), division.count);
  for (std::size_t i = 0; i < std::min(numbers.size(), kShown); ++i) {
    division.number = numbers[i];
    fmt::print(stderr, "  {}\n", command_of(arguments, whole, division, parts));
  }
  if (numbers.size() > kShown) fmt::print(stderr, "  ...\n");
}

int merge_sweep(const MergeArguments& arguments, const std::vector<Part>& parts) {
  const shards::Series whole = whole_of(parts, arguments.out);
  const auto& first = parts.front().folder;
  auto experiment = configuration::load_experiment(first / "experiment.yaml");
  if (!experiment) return complain(experiment.error());
  const auto base = configuration::load_scenario(first / "scenario.yaml");
  if (!base) return complain(base.error());
  experiment->runs = whole.runs;
  auto table = experiments::RunTable::open(arguments.out, *experiment, *base, {}, whole.file);
  if (!table) return complain(table.error());
  for (const Part& part : parts) {
    if (const auto taken = table->take_over(part.folder); !taken) return complain(taken.error());
  }
  if (const auto sorted = table->sort(); !sorted) return complain(sorted.error());
  tell_of_missing(arguments, whole, experiments::missing(*experiment, *table), parts);
  return tell_of_sweep(*experiment, *table, arguments.out);
}

int merge_series(const MergeArguments& arguments, const std::vector<Part>& parts) {
  const shards::Series whole = whole_of(parts, arguments.out);
  auto table =
      series::SeriesTable::open(arguments.out, whole, series::scenario_of(parts.front().folder));
  if (!table) return complain(table.error());
  for (const Part& part : parts) {
    if (const auto taken = table->take_over(part.folder); !taken) return complain(taken.error());
  }
  if (const auto sorted = table->sort(); !sorted) return complain(sorted.error());
  std::vector<experiments::Draw> draws;
  for (const std::uint64_t seed : table->missing())
    draws.push_back({seed - whole.first_seed, 0, seed});
  tell_of_missing(arguments, whole, draws, parts);
  if (!draws.empty()) return kExitViolated;
  const auto summary = table->summary(arguments.program);
  if (!summary) return complain(summary.error());
  if (const auto written = series::write_summary(*summary, arguments.out); !written)
    return complain(written.error());
  fmt::print("{}", summary->text());
  return summary->held() ? kExitHeld : kExitViolated;
}

}  // namespace

int merge(const MergeArguments& arguments) {
  const auto parts = parts_of(arguments);
  if (!parts) return complain(parts.error());
  return is_sweep(parts->front().series) ? merge_sweep(arguments, *parts)
                                         : merge_series(arguments, *parts);
}

}  // namespace skein::hil
