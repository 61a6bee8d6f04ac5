// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <string>

#include "commands.hpp"
#include "skein/configuration/experiment.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/experiments/grid.hpp"
#include "skein/experiments/run_table.hpp"
#include "skein/experiments/sweep.hpp"
#include "skein/hil/run_parallel.hpp"
#include "skein/shards/shard.hpp"
#include "stop_signal.hpp"

namespace skein::hil {
namespace {

/// How far, and how long still: a line that is written over, or one now and then in a log.
class Progress {
 public:
  explicit Progress(std::size_t runs) : runs_{runs}, terminal_{::isatty(STDERR_FILENO) != 0} {
    if (!terminal_) next_ += kLogPeriod;
  }

  void count(bool safe) {
    ++done_;
    if (!safe) ++broken_;
    const auto now = Clock::now();
    if (now < next_ && done_ < runs_) return;
    next_ = now + (terminal_ ? kTerminalPeriod : kLogPeriod);
    const double passed = std::chrono::duration<double>(now - start_).count();
    const double left = passed * static_cast<double>(runs_ - done_) / static_cast<double>(done_);
    fmt::print(stderr, "{}{}/{} runs, {} violated, {:.0f} s left{}", terminal_ ? "\r" : "", done_,
               runs_, broken_, left, terminal_ ? "   " : "\n");
    std::fflush(stderr);
  }
  void clear() const {
    if (terminal_) fmt::print(stderr, "\r{:60}\r", "");
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kTerminalPeriod{200};
  static constexpr std::chrono::milliseconds kLogPeriod{30'000};
  std::size_t runs_;
  bool terminal_;
  std::size_t done_ = 0;
  std::size_t broken_ = 0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_ = start_;
};

}  // namespace

int sweep(const SweepArguments& arguments) {
  auto experiment = configuration::load_experiment(arguments.experiment);
  if (!experiment) return complain(experiment.error().message);
  if (arguments.runs) experiment->runs = *arguments.runs;
  const auto base =
      configuration::load_scenario(arguments.experiment.parent_path() / experiment->scenario);
  if (!base) return complain(arguments.experiment.string() + ": scenario: " + base.error().message);

  experiments::SweepOptions options;
  options.folder = !arguments.folder.empty()
                       ? arguments.folder
                       : std::filesystem::path{"runs"} / arguments.experiment.stem();
  options.jobs = jobs_of(arguments.jobs);
  options.shard = arguments.shard;
  auto table = experiments::RunTable::open(options.folder, *experiment, *base, options.shard,
                                           arguments.experiment);
  if (!table) return complain(table.error().message);

  Progress progress{experiments::missing(*experiment, *table, options.shard).size()};
  options.on_done = [&](const experiments::Measures& m) { progress.count(m.safe); };
  options.stopped = asked_to_stop;
  listen_for_stop();
  const auto outcome = experiments::sweep(*experiment, *base, options, *table);
  progress.clear();
  if (!outcome) return complain(arguments.experiment.string() + ": " + outcome.error().message);
  fmt::print(stderr, "{} runs flown now\n", outcome->flown);
  const bool whole = outcome->present == outcome->wanted;
  int status = whole ? kExitHeld : kExitViolated;
  if (options.shard.whole()) {
    status = tell_of_sweep(*experiment, *table, options.folder);
  } else {
    fmt::print("shard {}: {} of {} runs; {}\n", shards::to_string(options.shard), outcome->present,
               outcome->wanted, options.folder.string());
  }
  if (!whole) fmt::print(stderr, "interrupted; the same command goes on where it was\n");
  return status;
}

int tell_of_sweep(const configuration::Experiment& experiment, const experiments::RunTable& table,
                  const std::filesystem::path& folder) {
  if (const auto written = experiments::write_results(experiment, table, folder); !written)
    return complain(written.error().message);
  const std::size_t wanted = experiments::cells_of(experiment).size() * experiment.runs;
  const std::size_t present = wanted - experiments::missing(experiment, table).size();
  fmt::print("{}\n{}\n{} of {} runs; tables and plots: {}\n", experiment.title,
             experiments::text_table(experiment, table), present, wanted, folder.string());
  return present == wanted && experiments::all_safe(experiment, table) ? kExitHeld : kExitViolated;
}

}  // namespace skein::hil
