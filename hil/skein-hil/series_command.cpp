// SPDX-License-Identifier: Apache-2.0
//
// Many seeds of one scenario, on this machine or as one shard of several.
#include <fmt/format.h>

#include <cstdio>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "progress_line.hpp"
#include "skein/hil/fault_profiles.hpp"
#include "skein/hil/run_parallel.hpp"
#include "skein/series/run_row.hpp"
#include "skein/series/series_table.hpp"
#include "skein/series/summary.hpp"
#include "skein/version/version.hpp"
#include "stop_signal.hpp"

namespace skein::hil {
namespace {

using series::RunRow;

shards::Series series_of(const configuration::Scenario& scenario,
                         const SimulateArguments& arguments) {
  shards::Series series;
  series.kind = scenario.flies_formation() ? series::kFormation : series::kSites;
  series.program = version();
  series.file = arguments.scenario.string();
  series.faults = arguments.faults;
  series.plan = arguments.routes.string();
  series.first_seed = scenario.seed;
  series.runs = *arguments.runs;
  series.shard = arguments.shard;
  if (scenario.flies_formation()) series.separation_m = scenario.formation.separation.horizontal_m;
  return series;
}

int tell(const series::Summary& summary) {
  fmt::print("{}", summary.text());
  return summary.held() ? kExitHeld : kExitViolated;
}

/// Nothing is kept of a run but what the summary counts.
int fly_and_sum_up(const shards::Series& series, const series::Flight& flight, std::size_t jobs,
                   const std::string& program) {
  ProgressLine line{series.runs};
  series::Summary summary{series, program};
  std::map<std::size_t, RunRow> early;  // that ended before one of an earlier seed
  const auto take = [&](std::size_t i, RunRow&& row) -> Result<void> {
    line.count(row.held());
    early.emplace(i, std::move(row));
    while (!early.empty() && early.begin()->first == summary.runs()) {
      summary.add(early.begin()->second);
      early.erase(early.begin());
    }
    return {};
  };
  const auto fly = [&](std::size_t i) { return flight(series.first_seed + i); };
  const auto flown = each_parallel<RunRow>(series.runs, jobs, fly, take);
  line.clear();
  return flown ? tell(summary) : complain(flown.error());
}

int fly_into(const SimulateArguments& arguments, const shards::Series& series,
             const std::string& scenario, const series::Flight& flight) {
  auto table = series::SeriesTable::open(arguments.folder, series, scenario);
  if (!table) return complain(table.error());
  const std::vector<std::uint64_t> seeds = table->missing();
  ProgressLine line{seeds.size()};
  listen_for_stop();
  std::size_t flown = 0;
  const auto take = [&](std::size_t, RunRow&& row) {
    ++flown;
    line.count(row.held());
    return table->append(row);
  };
  const auto fly = [&](std::size_t i) { return flight(seeds[i]); };
  const auto done =
      each_parallel<RunRow>(seeds.size(), jobs_of(arguments.jobs), fly, take, asked_to_stop);
  line.clear();
  if (!done) return complain(done.error());
  if (const std::size_t others = table->others(); others > 0) {
    fmt::print(stderr, "{} holds {} runs more than are asked for; they are not counted\n",
               arguments.folder.string(), others);
  }
  if (const auto sorted = table->sort(); !sorted) return complain(sorted.error());
  fmt::print(stderr, "{} runs flown now\n", flown);
  if (flown < seeds.size()) {
    fmt::print(stderr, "interrupted, {} runs are missing; the same command goes on where it was\n",
               seeds.size() - flown);
    return kExitViolated;
  }
  if (!series.shard.whole()) {
    fmt::print("shard {}: all its runs are in {}\n", shards::to_string(series.shard),
               arguments.folder.string());
    return kExitHeld;
  }
  const auto summary = table->summary(arguments.program);
  if (!summary) return complain(summary.error());
  if (const auto written = series::write_summary(*summary, arguments.folder); !written)
    return complain(written.error());
  return tell(*summary);
}

}  // namespace

int simulate_many(const configuration::Scenario& scenario, const SimulateArguments& arguments) {
  // What is wrong is told before anything is flown.
  const auto first = seeded_mission(scenario, scenario.seed, arguments.faults);
  if (!first) return complain(first.error());
  const shards::Series series = series_of(scenario, arguments);
  const auto flight = series::flight_of(scenario, arguments.faults);
  if (arguments.folder.empty())
    return fly_and_sum_up(series, flight, jobs_of(arguments.jobs), arguments.program);
  return fly_into(arguments, series, series::identity(scenario), flight);
}

}  // namespace skein::hil
