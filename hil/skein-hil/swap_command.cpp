// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "commands.hpp"
#include "skein/hil/run_parallel.hpp"
#include "skein/swap/swap.hpp"

namespace skein::hil {
namespace {

std::string ratio_text(const std::optional<double>& value) {
  return value ? fmt::format("{:.3f}", *value) : "-";
}

std::string csv_rows(const std::string& method, std::size_t agents,
                     const std::vector<swap::SwapRun>& runs) {
  std::string text;
  for (const swap::SwapRun& run : runs) {
    text +=
        fmt::format("{},{},{},{:.4f},{},{},{},{:.4f},{:.4f},{}\n", method, agents, run.seed,
                    run.ideal_s, run.arrived_s ? fmt::format("{:.2f}", *run.arrived_s) : "",
                    run.not_arrived, run.breached_pairs, run.least_m, run.way_ratio, run.messages);
  }
  return text;
}

bool write(const std::filesystem::path& file, const std::string& text) {
  return (std::ofstream{file, std::ios::binary} << text).flush().good();
}

/// One line on a terminal that is written over.
void show_progress(const std::string& method, std::size_t agents, std::size_t done,
                   std::size_t runs) {
  static const bool terminal = ::isatty(STDERR_FILENO) != 0;
  if (!terminal) return;
  fmt::print(stderr, "\r{:60}\r", "");
  if (done < runs) fmt::print(stderr, "{}, {} agents: {}/{} runs", method, agents, done, runs);
  std::fflush(stderr);
}

void print_row(const std::string& method, const swap::SwapOptions& options,
               const swap::SwapSummary& summary) {
  fmt::print("{:<13} {:>6} {:>6g} {:>8} {:>8} {:>9.3f} {:>9} {:>8} {:>8}\n", method, options.agents,
             options.radius_m, summary.runs_breached, summary.breached_pairs, summary.least_m,
             summary.deadlocked, ratio_text(summary.ratio_mean), ratio_text(summary.ratio_max));
  std::fflush(stdout);
}

/// Flies the first seed again, for its tracks.
bool plot(const swap::Method& method, const swap::SwapOptions& options, std::uint64_t seed,
          const std::filesystem::path& file) {
  const auto flown = swap::fly_swap(options, method.make, seed, true);
  if (!flown) return false;
  const swap::SwapRun& run = *flown;
  const std::string ratio =
      run.arrived_s ? fmt::format("{:.2f} times the ideal time", *run.arrived_s / run.ideal_s)
                    : fmt::format("{} never arrive", run.not_arrived);
  return write(
      file, swap::swap_svg(fmt::format("{}, {} agents, seed {}: {}, {} pairs nearer than "
                                       "{:g} m",
                                       method.name, options.agents, seed, ratio, run.breached_pairs,
                                       options.setting.separation.horizontal_m),
                           run));
}

}  // namespace

int swap(const SwapArguments& arguments) {
  std::vector<const swap::Method*> methods;
  for (const std::string& name : arguments.methods) {
    const auto method = swap::find_method(name);
    if (!method) return complain(method.error().message);
    methods.push_back(*method);
  }
  std::string csv =
      "method,agents,seed,ideal_s,arrived_s,not_arrived,breached_pairs,least_m,way_ratio,"
      "messages\n";
  fmt::print("messages {:.0f} ms late, {:.0f} % lost; {} runs each; separation {:g} m\n",
             1e3 * arguments.delay_s, 1e2 * arguments.loss, arguments.seeds,
             arguments.separation_m);
  fmt::print("{:<13} {:>6} {:>6} {:>8} {:>8} {:>9} {:>9} {:>8} {:>8}\n", "method", "agents",
             "radius", "breached", "pairs", "least m", "deadlock", "mean t/T", "max t/T");
  bool held = true;
  for (const std::size_t agents : arguments.agents) {
    swap::SwapOptions options;
    options.agents = agents;
    options.radius_m =
        arguments.radius_m > 0.0 ? arguments.radius_m : swap::default_radius_m(agents);
    options.start_noise_m = arguments.noise_m;
    options.setting.message_delay_s = arguments.delay_s;
    options.setting.message_loss = arguments.loss;
    options.setting.separation = {arguments.separation_m, arguments.separation_m};
    for (const swap::Method* method : methods) {
      const std::string name{method->name};
      std::size_t done = 0;
      const auto on_done = [&](const swap::SwapRun&) {
        show_progress(name, agents, ++done, arguments.seeds);
      };
      const auto runs = swap::fly_swaps(options, method->make, arguments.first_seed,
                                        arguments.seeds, jobs_of(arguments.jobs), on_done);
      if (!runs) return complain(name + ": " + runs.error().message);
      const auto summary = swap::summarise(*runs);
      held = held && summary.runs_breached == 0 && summary.deadlocked == 0;
      print_row(name, options, summary);
      csv += csv_rows(name, agents, *runs);
      if (arguments.plots.empty()) continue;
      const auto file = arguments.plots / fmt::format("{}-{}.svg", name, agents);
      if (!plot(*method, options, arguments.first_seed, file)) {
        return complain(file.string() + ": cannot be written; name a folder that is there");
      }
    }
  }
  if (!arguments.csv.empty() && !write(arguments.csv, csv)) {
    return complain(arguments.csv.string() + ": cannot be written; check the path");
  }
  return held ? kExitHeld : kExitViolated;
}

}  // namespace skein::hil
