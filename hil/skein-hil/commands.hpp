// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/configuration/experiment.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/experiments/run_table.hpp"
#include "skein/shards/shard.hpp"

namespace skein::hil {

inline constexpr int kExitHeld = 0;      ///< every check held
inline constexpr int kExitViolated = 1;  ///< one did not
inline constexpr int kExitBadInput = 2;  ///< nothing was flown

/// What a command ends with that cannot go on.
inline int complain(const std::string& sentence) {
  std::fputs((sentence + "\n").c_str(), stderr);
  return kExitBadInput;
}
inline int complain(const Error& error) { return complain(error.message); }

struct RunArguments {
  std::filesystem::path scenario;
  std::filesystem::path programs;
  std::filesystem::path folder;
  double rate = 1.0;
  std::optional<std::uint64_t> seed;
  std::uint16_t port_base = 0;
  double lead_s = 0.0;  ///< 0: by the number of vehicles
  std::string can;      ///< bus of the flight controllers; empty: one each is looked for
  std::vector<std::string> autopilots;            ///< in place of skein-fc
  std::vector<std::string> autopilot_parameters;  ///< files
  std::string autopilot_model;                    ///< of its simulator's planes
  std::filesystem::path routes;  ///< a plan for a mission of routes; empty: one is made
  bool headless = false;
  std::string faults = "none";
  std::filesystem::path other_programs;  ///< of another release; empty: none
  bool dds = false;
  bool relay = false;  ///< in place of the scenario's air.hops_max
  std::string links;   ///< a program that makes the links of a real network; empty: none
  bool clear = false;
  bool prompt = false;
  std::uint16_t console_port = 0;  ///< 0: no console
  int ground_stations = 1;
  std::optional<double> take_command_s{};
  std::string external;         ///< ids of vehicles on other machines
  std::filesystem::path fleet;  ///< file that names their hosts; empty: the scenario does
  std::string address;          ///< of this machine; empty: as that file says of the ground station
};
/// Gives the vehicles the routes of the plan's file, or of a plan that is made and printed, where
/// the mission asks for routes; else the search routes of a plan of tasks, where one is given.
[[nodiscard]] Result<void> give_routes(configuration::Scenario& scenario,
                                       const std::filesystem::path& plan);
/// Nothing is delivered in such a mission unless an operator takes part: it has deliveries, and no
/// operator_decisions.
[[nodiscard]] bool wants_an_operator(const configuration::Scenario& scenario);
int run(const RunArguments& arguments);

struct SimulateArguments {
  std::string program;  ///< as it was called, for the line that flies a seed again
  std::filesystem::path scenario;
  std::optional<std::uint64_t> seed;
  std::filesystem::path routes;  ///< a plan of tasks; empty: none
  bool trace = false;
  std::string faults = "none";
  std::optional<std::size_t> runs;  ///< without: one, with its events
  std::size_t jobs = 0;             ///< 0: one for each core
  std::filesystem::path folder;     ///< that keeps the runs; empty: none
  shards::Shard shard;              ///< with a folder
};
int simulate(const SimulateArguments& arguments);
/// What simulate() does with --runs.
int simulate_many(const configuration::Scenario& scenario, const SimulateArguments& arguments);
/// What simulate() does with one run of a formation.
int simulate_formation(const configuration::Scenario& scenario, const SimulateArguments& arguments);

struct ReexecuteArguments {
  std::filesystem::path run;
  std::optional<std::uint16_t> vehicle;  ///< without: all
};
int reexecute(const ReexecuteArguments& arguments);

struct ChangesArguments {
  std::string program;  ///< as it was called
  std::size_t runs = 10'000;
  std::uint64_t first_seed = 1;
  std::size_t jobs = 0;  ///< 0: one for each core
};
int changes(const ChangesArguments& arguments);

struct SweepArguments {
  std::filesystem::path experiment;
  std::filesystem::path folder;
  std::optional<std::size_t> runs;  ///< in place of the experiment's
  std::size_t jobs = 0;             ///< 0: one for each core
  shards::Shard shard;
};
int sweep(const SweepArguments& arguments);
/// Writes tables and plots of what the table has, prints the main ones, and gives the status.
int tell_of_sweep(const configuration::Experiment& experiment, const experiments::RunTable& table,
                  const std::filesystem::path& folder);

struct MergeArguments {
  std::string program;  ///< as it was called
  std::vector<std::filesystem::path> folders;
  std::filesystem::path out;
};
int merge(const MergeArguments& arguments);

struct SwapArguments {
  std::vector<std::string> methods{"passage"};
  std::vector<std::size_t> agents{32};
  std::size_t seeds = 10;
  std::uint64_t first_seed = 1;
  double radius_m = 0.0;  ///< 0: by the number of agents
  double noise_m = 0.1;   ///< of the starts
  double delay_s = 0.2;   ///< of messages
  double loss = 0.2;      ///< share of messages
  double separation_m = 3.0;
  std::filesystem::path csv;    ///< empty: none is written
  std::filesystem::path plots;  ///< folder; empty: none
  std::size_t jobs = 0;         ///< 0: one for each core
};
int swap(const SwapArguments& arguments);

struct ToursArguments {
  std::vector<std::filesystem::path> files;
  double radius_m = 0.0;
  std::uint64_t steps = 6000;
  std::uint64_t seed = 1;
  std::filesystem::path plots;  ///< folder; empty: none
};
int tours(const ToursArguments& arguments);

struct OrienteeringArguments {
  std::vector<std::filesystem::path> files;
  std::uint64_t nodes = 300;
  std::uint64_t steps = 3000;
  std::uint64_t seed = 1;
};
int orienteering(const OrienteeringArguments& arguments);

struct RoutesArguments {
  std::vector<std::string> what{"all"};  ///< as route_figures::find_experiments() takes them
  bool paper = false;                    ///< the paper's numbers of runs
  std::optional<std::size_t> runs;       ///< in place of all numbers
  std::uint64_t seed = 1;
  std::filesystem::path folder = "runs/routes";
  std::size_t jobs = 0;  ///< 0: one for each core
};
int routes(const RoutesArguments& arguments);

struct ShapesArguments {
  std::vector<std::string> shapes;  ///< names, or files
  std::vector<std::size_t> vehicles{5};
  double spacing_m = 5.0;
  std::filesystem::path picture;  ///< empty: the places are printed
};
int shapes(const ShapesArguments& arguments);

struct CanDumpArguments {
  std::string bus;            ///< as can::open() takes it
  std::filesystem::path log;  ///< empty: none is written
  std::optional<double> seconds;
};
int dump_can(const CanDumpArguments& arguments);

struct CanReplayArguments {
  std::filesystem::path log;
  std::string bus;    ///< empty: nothing is sent, only shown
  double rate = 1.0;  ///< seconds of the log in a real second
};
int replay_can(const CanReplayArguments& arguments);

}  // namespace skein::hil
