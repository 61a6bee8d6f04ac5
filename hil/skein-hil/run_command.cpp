// SPDX-License-Identifier: Apache-2.0
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <string>

#include "commands.hpp"
#include "skein/base/contains.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/fleet/fleet.hpp"
#include "skein/hil/bench.hpp"
#include "skein/hil/judgement.hpp"
#include "skein/hil/process_faults.hpp"
#include "skein/hil/team_mission.hpp"
#include "skein/hindsight/hindsight.hpp"
#include "skein/process/token.hpp"
#include "skein/recording/merge.hpp"
#include "skein/recording/recording.hpp"
#include "skein/report/report.hpp"

namespace skein::hil {
namespace {

constexpr std::uint8_t kRelayHops = 16;

/// One line that is written over, and news above it.
class ProgressLine {
 public:
  ProgressLine(bool shown, std::size_t vehicles, std::size_t sites)
      : shown_{shown && ::isatty(STDOUT_FILENO) != 0}, vehicles_{vehicles}, sites_{sites} {}
  void update(const BenchProgress& p) {
    if (!p.news.empty()) {
      clear();
      fmt::print("{}\n", p.news);
    }
    if (shown_) {
      const double t = std::max(-1e4, to_seconds(p.now));
      fmt::print("\r{:7.1f} s   vehicles heard {}/{}   sites found {}/{}, done {}/{} ", t,
                 p.vehicles_heard, vehicles_, p.sites_found, sites_, p.sites_done, sites_);
    }
    std::fflush(stdout);
  }
  void clear() const {
    if (shown_) fmt::print("\r{:78}\r", "");
  }

 private:
  bool shown_;
  std::size_t vehicles_;
  std::size_t sites_;
};

Result<configuration::Scenario> flyable_scenario(const RunArguments& arguments) {
  auto scenario = configuration::load_flyable_scenario(arguments.scenario);
  if (!scenario) return scenario;
  if (arguments.seed) scenario->seed = *arguments.seed;
  if (arguments.relay) scenario->air.hops_max = kRelayHops;
  if (const auto given = give_routes(*scenario, arguments.routes); !given) return given.error();
  if (arguments.prompt) {
    scenario->operator_decisions.clear();
    scenario->formation.script.clear();
  }
  return scenario;
}

/// Who is external, on which hosts.
Result<void> give_hosts(configuration::Scenario& scenario, BenchOptions& options,
                        const RunArguments& arguments) {
  if (arguments.external.empty()) return {};
  auto external = fleet::parse_ids(arguments.external);
  if (!external) return Error{"--external " + external.error().message};
  options.external = std::move(external).value();
  if (!arguments.fleet.empty()) {
    auto file = configuration::load_scenario(arguments.fleet);
    if (!file) return file.error();
    scenario.hosts = std::move(file->hosts);
  }
  options.address = arguments.address;
  for (const auto& host : scenario.hosts) {
    if (!options.address.empty() || contains(options.external, kGroundStation)) break;
    if (host.node == kGroundStation) options.address = host.address;
  }
  if (!options.address.empty()) return {};
  return Error{
      "the hosts need an address of this machine; name the ground station's host "
      "(vehicle: 0), or give --address, as where it is external itself"};
}

BenchOptions options_of(const RunArguments& arguments) {
  BenchOptions options;
  options.programs = arguments.programs;
  options.radio_plugin = arguments.programs.parent_path() / "lib" / "skein" / "libskein_radio.so";
  options.rate = arguments.rate;
  options.port_base = arguments.port_base;
  options.lead_s = arguments.lead_s;
  options.can = arguments.can;
  options.autopilots = arguments.autopilots;
  options.autopilot_parameters = arguments.autopilot_parameters;
  options.autopilot_model = arguments.autopilot_model;
  options.prompt = arguments.prompt;
  options.sealed = !arguments.clear;
  options.dds = arguments.dds;
  options.links = arguments.links;
  options.ground_stations = arguments.ground_stations;
  if (arguments.take_command_s) options.take_command_at = at_seconds(*arguments.take_command_s);
  options.console_port = arguments.console_port;
  if (options.console_port != 0) options.console_token = process::make_token();
  options.run_folder =
      !arguments.folder.empty()
          ? arguments.folder
          : std::filesystem::path{"runs"} / fmt::format("{}-{:%Y%m%d-%H%M%S}",
                                                        arguments.scenario.stem().string(),
                                                        fmt::localtime(std::time(nullptr)));
  return options;
}

/// Judges the run, writes its report and map, and says whether every check held.
bool report_on(const configuration::Scenario& scenario, const checks::RunRecord& record,
               const BenchOutcome& outcome, const RunArguments& arguments,
               const std::filesystem::path& folder) {
  report::Contents contents;
  contents.title = scenario.title;
  contents.summary =
      fmt::format("{}, seed {}, {:%Y-%m-%d %H:%M}, mission time at {} times real time",
                  arguments.scenario.filename().string(), scenario.seed,
                  fmt::localtime(std::time(nullptr)), arguments.rate);
  contents.replay = fmt::format("{} replay {}", (arguments.programs / "skein-ground").string(),
                                std::filesystem::absolute(folder).string());
  contents.replay_url = fmt::format("http://127.0.0.1:{}/", configuration::ConsoleConfig{}.port);
  contents.run = std::filesystem::absolute(folder).filename().string();
  contents.limits = limits_of(scenario.expect);
  contents.checks = judge_run(scenario, record, outcome);
  contents.comparison = compare(site_figures(record, contents.limits), scenario.reference);
  contents.record = record;
  std::string compared;
  if (!record.sites.empty()) {
    const auto hindsight = hindsight::look_back(record, contents.limits);
    if (hindsight) contents.hindsight = hindsight::table_of(*hindsight);
    compared = hindsight::comparison_text(hindsight) + "\n";
  }
  const auto page = folder / "report.html";
  std::ofstream{page} << report::html(contents);
  std::ofstream{folder / "map.svg"} << report::mission_svg(record);
  fmt::print("\nreport: {}\nrecord: {} (MCAP: all that was said and flown)\nreplay: {}\n\n{}",
             page.string(), (folder / recording::kRunFileName).string(), contents.replay,
             report::truth_text(record, contents.limits) + compared +
                 report::text_table(contents.checks, contents.comparison));
  return std::all_of(contents.checks.begin(), contents.checks.end(),
                     [](const auto& check) { return check.held(); });
}

void tell_how_to_repeat(const RunArguments& arguments, std::uint64_t seed) {
  const auto& other = arguments.other_programs;
  fmt::print(
      "\nThe same faults again, at the same moments of the mission:\n  {} run {} --faults {} "
      "--seed {}{}{}\n",
      (arguments.programs / "skein-hil").string(), arguments.scenario.string(), arguments.faults,
      seed, arguments.dds ? " --dds" : "", other.empty() ? "" : " --other-bin " + other.string());
}

}  // namespace

bool wants_an_operator(const configuration::Scenario& scenario) {
  return scenario.operator_decisions.empty() &&
         std::any_of(scenario.sites.begin(), scenario.sites.end(),
                     [](const Site& site) { return task_count(site, TaskKind::deliver) > 0; });
}

int run(const RunArguments& arguments) {
  if (!arguments.autopilots.empty()) {
    if (const auto kept = keep_autopilots_on_loopback(arguments.console_port != 0); !kept) {
      return complain(kept.error().message);
    }
  }
  auto scenario = flyable_scenario(arguments);
  if (!scenario) return complain(scenario.error().message);
  BenchOptions options = options_of(arguments);
  if (const auto given = give_hosts(*scenario, options, arguments); !given) {
    return complain(given.error().message);
  }
  auto faults = spoil(*scenario, arguments.faults, !arguments.other_programs.empty());
  if (!faults) return complain(faults.error().message);
  options.faults = std::move(*faults);
  options.other_programs = arguments.other_programs;
  // Not every release has keys.
  if (std::ranges::any_of(options.faults, [](const Fault& fault) {
        return std::holds_alternative<OtherRelease>(fault.what);
      })) {
    options.sealed = false;
  }
  if (!std::filesystem::exists(options.radio_plugin)) {
    return complain(options.radio_plugin.string() + ": not there; build it with ./dev build");
  }

  fmt::print("{}: {} vehicles, {} sites, seed {}; into {}\n", scenario->title,
             scenario->vehicles.size(), scenario->sites.size(), scenario->seed,
             options.run_folder.string());
  if (options.console_port != 0) {
    fmt::print("console: http://127.0.0.1:{}/#{}\n", options.console_port, options.console_token);
    if (options.ground_stations > 1) {
      fmt::print("console of the second: http://127.0.0.1:{}/#{}\n", options.console_port + 1,
                 options.console_token);
    }
    std::fflush(stdout);
  }
  if (wants_an_operator(*scenario) && !arguments.prompt && arguments.console_port == 0) {
    fmt::print(
        "nobody is there to authorise deliveries, so none is flown: the scenario has no "
        "operator_decisions; --prompt or --console lets you decide\n");
  }
  for (const Fault& fault : options.faults) fmt::print("drawn: {}\n", describe(fault));
  ProgressLine line{!arguments.headless && !arguments.prompt, scenario->vehicles.size(),
                    scenario->sites.size()};
  const auto outcome = fly(*scenario, options, [&](const BenchProgress& p) { line.update(p); });
  line.clear();
  if (!outcome) return complain(outcome.error().message);
  if (outcome->interrupted) fmt::print("interrupted; everything is stopped\n");

  const auto merged = recording::merge_run(options.run_folder);
  if (!merged) fmt::print(stderr, "{}\n", merged.error().message);
  const auto record = read_record(*scenario, options.run_folder, *outcome);
  if (!record) {
    for (const auto& death : outcome->deaths) fmt::print(stderr, "{}\n", death);
    return complain(record.error().message);
  }
  const bool held = report_on(*scenario, *record, *outcome, arguments, options.run_folder);
  if (!options.faults.empty()) {
    fmt::print("the bench was late by {:.2f} s at most\n", outcome->late_s);
    if (!held) tell_how_to_repeat(arguments, scenario->seed);
  }
  return held && !outcome->interrupted ? kExitHeld : kExitViolated;
}

}  // namespace skein::hil
