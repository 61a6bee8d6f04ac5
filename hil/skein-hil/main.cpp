// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include "commands.hpp"
#include "skein/command_line/read.hpp"
#include "skein/hil/fault_profiles.hpp"
#include "skein/hil/process_faults.hpp"
#include "skein/shards/shard.hpp"
#include "skein/version/version.hpp"

namespace skein::hil {
namespace {

// Each adds one command with its options; what the command returns becomes the status.

/// CLI11 takes -1 for the greatest number.
std::string why_no_seed(const std::string& text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  return error == std::errc{} && end == text.data() + text.size()
             ? ""
             : "'" + text + "' is no seed, which is a whole number from 0 to 18446744073709551615";
}

CLI::Option* add_shard(CLI::App& command, shards::Shard& shard) {
  return command
      .add_option_function<std::string>(
          "--shard", [&shard](const std::string& text) { shard = *shards::parse_shard(text); },
          "Only every Nth run, of which this is the Kth part; skein-hil merge puts them together")
      ->type_name("K/N")
      ->check([](const std::string& text) {
        const auto parsed = shards::parse_shard(text);
        return parsed ? std::string{} : parsed.error().message;
      });
}

template <class Count>
void add_jobs(CLI::App& command, Count& jobs, const std::string& what) {
  command.add_option("--jobs", jobs, what + " at a time (default: one for each core)")
      ->check(CLI::Range(1, 1024));
}

template <class Seed>
void add_first_seed(CLI::App& command, const std::string& name, Seed& seed) {
  command.add_option(name, seed, "Of the first run; then + 1")
      ->check(why_no_seed)
      ->capture_default_str();
}

/// Of vehicles that are not on this machine.
void add_external(CLI::App& command, RunArguments& arguments) {
  auto* external = command.add_option(
      "--external", arguments.external,
      "Vehicles on other machines, such as 1-3,7: they are configured, started and ended there");
  command
      .add_option("--fleet", arguments.fleet,
                  "The fleet's file, which names their hosts (default: the scenario does)")
      ->needs(external);
  command
      .add_option("--address", arguments.address,
                  "IPv4 address where they reach this machine (default: the ground station's of "
                  "that file)")
      ->needs(external);
}

void add_autopilot(CLI::App& command, RunArguments& arguments) {
  auto* autopilot = command.add_option(
      "--autopilot", arguments.autopilots,
      "Your own ArduPilot for software in the loop, such as ~/ardupilot/build/sitl/bin/arduplane, "
      "in place of skein-fc; arducopter for copters. It boots, arms, takes off and flies");
  command
      .add_option("--autopilot-parameters", arguments.autopilot_parameters,
                  "Files of parameters for it (default: plane.parm or copter.parm beside it)")
      ->needs(autopilot);
  command
      .add_option("--autopilot-model", arguments.autopilot_model,
                  "Which plane its simulator flies, such as plane-jet for 40 to 70 m/s, with the "
                  "parameters of that one (default: plane)")
      ->needs(autopilot);
}

/// What goes wrong with processes.
void add_process_faults(CLI::App& command, RunArguments& arguments) {
  auto* faults = command
                     .add_option("--faults", arguments.faults,
                                 fmt::format("What goes wrong, drawn from the seed, several with "
                                             "commas:\n{}",
                                             fmt::join(process_profiles(), ", ")))
                     ->capture_default_str()
                     ->excludes("--rate");
  command
      .add_option("--other-bin", arguments.other_programs,
                  "Folder of another release's programs, for vehicles that the faults 'versions' "
                  "draw; the mission is flown in clear then")
      ->check(CLI::ExistingDirectory)
      ->needs(faults);
}

void add_run(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<RunArguments>();
  arguments->programs = std::filesystem::canonical("/proc/self/exe").parent_path();
  auto* command =
      app.add_subcommand("run", "Fly a scenario with real processes, judge it, write a report");
  command->add_option("scenario", arguments->scenario, "Scenario file (YAML)")->required();
  command->add_option("--rate", arguments->rate, "Mission seconds in a real second")
      ->check(command_line::number_in(0.1, 20.0))
      ->capture_default_str();
  command->add_option("--routes", arguments->routes,
                      "A plan of `skein-ground plan`: of a mission of routes (without it one "
                      "is made), or of tasks, with which they begin");
  command->add_option("--seed", arguments->seed, "In place of the scenario's")->check(why_no_seed);
  command->add_option("--out", arguments->folder, "Folder of the run (default: runs/NAME-TIME)");
  add_process_faults(*command, *arguments);
  command
      ->add_option("--port-base", arguments->port_base,
                   "First UDP port (default: free ports are looked for)")
      ->check(CLI::Range(1024, 65000));
  command
      ->add_option("--lead", arguments->lead_s,
                   "Seconds from the start of the programs to that of the mission; a slow machine "
                   "wants more (default: by the number of vehicles)")
      ->check(command_line::number_in(1.0, 600.0));
  command->add_option("--can", arguments->can,
                      "CAN bus of all flight controllers, such as vcan0 (default: multicast "
                      "buses of their own on loopback)");
  add_autopilot(*command, *arguments);
  add_external(*command, *arguments);
  command->add_flag("--headless", arguments->headless, "No progress line; news only");
  command->add_flag("--prompt", arguments->prompt,
                    "Decide about deliveries yourself, at the ground station's prompt, in "
                    "place of the scenario's script");
  command
      ->add_option("--console", arguments->console_port,
                   "Serve the ground station's console on this port of loopback (such as 7460); "
                   "with --prompt you decide there")
      ->check(CLI::Range(1, 65535));
  command
      ->add_option("--ground-stations", arguments->ground_stations,
                   "2: a second one watches; its console is at the next port")
      ->check(CLI::Range(1, 2))
      ->excludes("--external");
  command
      ->add_option("--take-command", arguments->take_command_s,
                   "Mission second at which the second ground station takes the command")
      ->needs("--ground-stations");
  command
      ->add_flag("--clear", arguments->clear,
                 "Fly without keys, in clear, on loopback: to compare with a sealed run")
      ->excludes("--external");
  command
      ->add_flag("--dds", arguments->dds,
                 "Speak to each node by itself, with Fast DDS: to compare with the air")
      ->excludes("--external");
  command
      ->add_flag(
          "--relay", arguments->relay,
          "Let the nodes pass on what others say (air.hops_max: 16), over radios that do not")
      ->excludes("--dds");
  command->add_option("--links", arguments->links,
                      "Command of a program that makes the links of a real network as the "
                      "scenario's radio has them: docs/mesh.md");
  command->footer(
      "Ends with status 0 only if every check held; 1 if one failed, 2 for bad input.\n"
      "Examples: skein-hil run scenarios/coalition-6.yaml --rate 2\n"
      "          skein-hil run scenarios/nemesis-8.yaml --dds --faults crash,stall --seed 7\n"
      "          skein-hil run scenarios/hil-5-27.yaml --external 1-5 --fleet fleet.yaml");
  command->callback([arguments, &status] { status = run(*arguments); });
}

void add_simulate(CLI::App& app, const std::string& program, int& status) {
  const auto arguments = std::make_shared<SimulateArguments>();
  arguments->program = program;
  auto* command =
      app.add_subcommand("simulate", "Fly a scenario in virtual time with the same agents");
  command->add_option("scenario", arguments->scenario, "Scenario file (YAML)")->required();
  command->add_option("--seed", arguments->seed, "In place of the scenario's")->check(why_no_seed);
  command->add_option("--routes", arguments->routes,
                      "A plan of tasks of `skein-ground plan`, with which they begin");
  auto* trace = command->add_flag("--trace", arguments->trace, "Print every event");
  command
      ->add_option("--faults", arguments->faults,
                   fmt::format("What goes wrong, drawn from the seed, several with commas; with "
                               "sites:\n{};\nof a formation: {}",
                               fmt::join(fault_profiles(MissionKind::sites), ", "),
                               fmt::join(fault_profiles(MissionKind::formation), ", ")))
      ->capture_default_str();
  auto* runs = command
                   ->add_option("--runs", arguments->runs,
                                "Fly it so often, with the seeds SEED, SEED + 1, ..., and print a "
                                "summary")
                   ->check(CLI::Range(1, 10'000'000))
                   ->excludes(trace);
  add_jobs(*command, arguments->jobs, "Missions");
  auto* folder = command
                     ->add_option("--out", arguments->folder,
                                  "Folder that keeps a row of every run; what it has is not flown "
                                  "again")
                     ->needs(runs);
  add_shard(*command, arguments->shard)->needs(folder);
  command->footer(
      "The same file and seed print the same bytes. Every mission is judged; ends with status 0\n"
      "only if every check held; 1 if one failed, 2 for bad input. A shard ends with 0 when all "
      "of\n"
      "its runs are flown, whatever became of them.\n"
      "Examples: skein-hil simulate scenarios/coalition-32.yaml --seed 7 --trace\n"
      "          skein-hil simulate scenarios/faults-8.yaml --runs 1000 --faults mixed\n"
      "          skein-hil simulate scenarios/formation-5.yaml --runs 1000 --faults mixed\n"
      "          skein-hil simulate scenarios/faults-8.yaml --runs 1000000 --shard 3/500 --out "
      "runs/f8/3");
  command->callback([arguments, &status] { status = simulate(*arguments); });
}

void add_reexecute(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<ReexecuteArguments>();
  auto* command = app.add_subcommand(
      "reexecute",
      "Run a flight's agents anew from what they were given, and compare what they decide");
  command->add_option("run", arguments->run, "Folder of the run, or of one vehicle in it")
      ->required();
  command->add_option("--vehicle", arguments->vehicle, "Only this one")
      ->check(CLI::Range(1, 65535));
  command->footer(
      "Every flight plan and message must be the same, byte for byte; the first that is not is\n"
      "printed. Ends with status 0 if all are, 1 if not, 2 where there is nothing to run.\n"
      "Example: skein-hil reexecute runs/coalition-32-20260101-120000 --vehicle 7");
  command->callback([arguments, &status] { status = reexecute(*arguments); });
}

void add_changes(CLI::App& app, const std::string& program, int& status) {
  const auto arguments = std::make_shared<ChangesArguments>();
  arguments->program = program;
  auto* command = app.add_subcommand(
      "changes", "Plan random changes of formation, and judge their separation in continuous time");
  command->add_option("--runs", arguments->runs, "How many changes, of 5 to 100 vehicles")
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  add_first_seed(*command, "--first-seed", arguments->first_seed);
  add_jobs(*command, arguments->jobs, "Changes");
  command->footer(
      "Ends with status 0 if nobody is seen nearer than separation and reserve, 1 if somebody is.\n"
      "The least distance that is printed is less by what ways can bend between two looks.\n"
      "Example: skein-hil changes --runs 10000");
  command->callback([arguments, &status] { status = changes(*arguments); });
}

void add_sweep(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<SweepArguments>();
  auto* command = app.add_subcommand(
      "sweep", "Fly an experiment: a grid of parameters, many draws of each, with statistics");
  command->add_option("experiment", arguments->experiment, "Experiment file (YAML)")->required();
  command->add_option("--out", arguments->folder, "Folder of the results (default: runs/NAME)");
  command->add_option("--runs", arguments->runs, "Draws of each cell, in place of the file's")
      ->check(CLI::Range(1, 1'000'000));
  add_jobs(*command, arguments->jobs, "Missions");
  add_shard(*command, arguments->shard)->needs("--out");
  command->footer(
      "Writes runs.csv (a row after every run), cells.csv (means with 95 % intervals) and a plot\n"
      "of each measure. What is in the folder is not flown again: after an interruption, or to "
      "add\n"
      "draws, call it again. Ends with status 0 if all was flown and every check but completion\n"
      "held, 1 if not, 2 for bad input. A shard ends with 0 when all of its runs are flown,\n"
      "whatever became of them.\n"
      "Examples: skein-hil sweep scenarios/experiments/mission-32.yaml\n"
      "          skein-hil sweep scenarios/experiments/radio.yaml --runs 10 --out runs/radio-10\n"
      "          skein-hil sweep scenarios/experiments/radio.yaml --shard 3/20 --out runs/radio/3");
  command->callback([arguments, &status] { status = sweep(*arguments); });
}

void add_merge(CLI::App& app, const std::string& program, int& status) {
  const auto arguments = std::make_shared<MergeArguments>();
  arguments->program = program;
  auto* command = app.add_subcommand(
      "merge",
      "Put the shards of a simulate or a sweep together, as if one machine had flown them");
  command->add_option("folders", arguments->folders, "Folders of the shards")->required();
  command->add_option("--out", arguments->out, "Folder of the whole")->required();
  command->footer(
      "Tables, plots and what is printed have the same bytes as those of one machine. A run that\n"
      "two folders tell of differently is an error that names both. What is missing is told, with\n"
      "the shards that have it. Ends with status 0 if all was flown and every check held (of a\n"
      "sweep: but completion), 1 if not, 2 for bad input.\n"
      "Example: skein-hil merge runs/f8/* --out runs/f8-whole");
  command->callback([arguments, &status] { status = merge(*arguments); });
}

void add_tours(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<ToursArguments>();
  auto* command = app.add_subcommand(
      "tours", "Plan round trips of one vehicle that touch every circle of a file");
  command->add_option("file", arguments->files, "A circle in each line: x y radius, in metres")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("--radius", arguments->radius_m, "Least turn radius, m")
      ->required()
      ->check(CLI::Range(1e-6, 1e6));
  command->add_option("--steps", arguments->steps, "Of the search")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000'000));
  command->add_option("--seed", arguments->seed, "Of the search")
      ->capture_default_str()
      ->check(why_no_seed);
  command->add_option("--plots", arguments->plots, "Folder for a picture of each, as SVG")
      ->check(CLI::ExistingDirectory);
  command->footer(
      "Prints a row of CSV for each file: length, seconds, and the order in which its circles are\n"
      "met. The same seed gives the same tour.\n"
      "Example: skein-hil tours circles.txt --radius 40 --plots .");
  command->callback([arguments, &status] { status = tours(*arguments); });
}

void add_orienteering(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<OrienteeringArguments>();
  auto* command = app.add_subcommand(
      "orienteering", "Plan who of a team goes where, if there is no time to go everywhere");
  command
      ->add_option("file", arguments->files,
                   "Lines of n, m and tmax, then x, y and score of each place")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("--nodes", arguments->nodes, "Of the search for a proof")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000'000));
  command->add_option("--steps", arguments->steps, "Of ruin and recreate, where that proves none")
      ->capture_default_str()
      ->check(CLI::Range(0, 1'000'000'000));
  command->add_option("--seed", arguments->seed, "Of ruin and recreate")
      ->capture_default_str()
      ->check(why_no_seed);
  command->footer(
      "Prints a row of CSV for each file: the score, and what no team can get more than. All "
      "begin\n"
      "at the first place and end at the last. The same seed gives the same row, but for seconds.\n"
      "Example: skein-hil orienteering p4.2.a.txt p4.2.b.txt --steps 20000");
  command->callback([arguments, &status] { status = orienteering(*arguments); });
}

void add_swap(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<SwapArguments>();
  auto* command = app.add_subcommand(
      "swap",
      "Compare methods of avoidance: agents on a circle change to the opposite side at once");
  command
      ->add_option("--method", arguments->methods,
                   "passage, field, orca, orca-limited; several with commas")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--agents", arguments->agents, "How many; several numbers with commas")
      ->delimiter(',')
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  command->add_option("--seeds", arguments->seeds, "Runs of each method and number")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  add_first_seed(*command, "--first-seed", arguments->first_seed);
  command
      ->add_option("--radius", arguments->radius_m,
                   "Of the circle, m (default: 10 for 5 agents, 40 for 32, 100 for 100, 200 for "
                   "250)")
      ->check(command_line::number_in(3.0, 10'000.0));
  command
      ->add_option("--noise", arguments->noise_m, "Starts are so far off their places at most, m")
      ->check(command_line::number_in(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--delay", arguments->delay_s, "Of messages, s")
      ->check(command_line::number_in(0.0, 5.0))
      ->capture_default_str();
  command->add_option("--loss", arguments->loss, "Share of the messages that are lost")
      ->check(command_line::number_in(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--separation", arguments->separation_m, "Least distance wanted, m")
      ->check(command_line::number_in(0.1, 100.0))
      ->capture_default_str();
  command->add_option("--csv", arguments->csv, "File to write, a row for each run");
  command->add_option("--plots", arguments->plots,
                      "Folder for the tracks of the first seed, as SVG");
  add_jobs(*command, arguments->jobs, "Runs");
  command->footer(
      "t/T is the time until all are there over that of a straight way without others. Distances\n"
      "are judged in continuous time. The same seed gives the same run. Ends with status 0 if no\n"
      "pair came nearer than the separation and all arrived, 1 if not, 2 for bad input.\n"
      "Examples: skein-hil swap --agents 32 --seeds 100 --method orca\n"
      "          skein-hil swap --agents 5,32,100 --method field,orca --csv swap.csv\n"
      "          skein-hil swap --agents 5 --delay 0 --loss 0 --seeds 1 --plots .");
  command->callback([arguments, &status] { status = swap(*arguments); });
}

void add_routes(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<RoutesArguments>();
  auto* command = app.add_subcommand(
      "routes",
      "Repeat the experiments of Wu et al. 2022 on cooperative routes, and draw their figures");
  command
      ->add_option(
          "--what", arguments->what,
          "maps, convergence, weights, worlds, cooperative, quality, flights,\nscale, or all;\n"
          "several with commas")
      ->delimiter(',')
      ->capture_default_str();
  auto* paper = command->add_flag("--paper", arguments->paper,
                                  "The paper's numbers of runs: 200 of each map, 600 worlds");
  command->add_option("--runs", arguments->runs, "Runs of everything, in place of a quick look's")
      ->check(CLI::Range(1, 100'000))
      ->excludes(paper);
  add_first_seed(*command, "--seed", arguments->seed);
  command->add_option("--out", arguments->folder, "Folder of the tables and figures")
      ->capture_default_str();
  add_jobs(*command, arguments->jobs, "Runs");
  command->footer(
      "Prints tables beside the paper's values; writes a CSV and SVG files of each experiment. "
      "The\n"
      "same seed gives the same files. A quick look at all takes about a minute on one core,\n"
      "--paper a quarter of an hour. Ends with status 0, or 2 for bad input.\n"
      "Examples: skein-hil routes\n"
      "          skein-hil routes --what worlds,quality --paper --jobs 8\n"
      "          skein-hil routes --what maps --runs 50 --out runs/maps");
  command->callback([arguments, &status] { status = routes(*arguments); });
}

void add_shapes(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<ShapesArguments>();
  auto* command = app.add_subcommand("shapes", "Print or draw the places of a formation's shapes");
  command
      ->add_option("shapes", arguments->shapes,
                   "line-abreast, column, echelon, wedge, pentagon, or a file (YAML)")
      ->required();
  command->add_option("--vehicles", arguments->vehicles, "How many; several numbers with commas")
      ->delimiter(',')
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--spacing", arguments->spacing_m, "Least distance of two places, m")
      ->check(command_line::number_in(0.1, 1000.0))
      ->capture_default_str();
  command->add_option("--svg", arguments->picture, "Picture to write, in place of the numbers");
  command->footer(
      "Places are around the shape's centre, in the order in which they are filled: dx along the\n"
      "track, dy to its left, dz up. The shapes are explained in docs/formation.md.\n"
      "Examples: skein-hil shapes wedge --vehicles 15\n"
      "          skein-hil shapes scenarios/shapes/heart.yaml --vehicles 5,12,32 --spacing 4 --svg "
      "heart.svg");
  command->callback([arguments, &status] { status = shapes(*arguments); });
}

void add_can_dump(CLI::App& can, int& status) {
  const auto arguments = std::make_shared<CanDumpArguments>();
  auto* command =
      can.add_subcommand("dump", "Show what is said on a bus: DroneCAN and the MAVLink in it");
  command
      ->add_option("bus", arguments->bus,
                   "can0, vcan0, ... or mcast:NUMBER, mcast:NUMBER@INTERFACE")
      ->required();
  command->add_option("--log", arguments->log, "File to write, as candump -L does");
  command->add_option("--seconds", arguments->seconds, "End after that (default: at Ctrl-C)")
      ->check(command_line::number_in(0.01, 1e9));
  command->footer("Example: skein-hil can dump mcast:0 --log flight.log");
  command->callback([arguments, &status] { status = dump_can(*arguments); });
}

void add_can_replay(CLI::App& can, int& status) {
  const auto arguments = std::make_shared<CanReplayArguments>();
  auto* command = can.add_subcommand("replay", "Send a record (candump -L) to a bus, and show it");
  command->add_option("log", arguments->log, "File of candump -L")->required();
  command->add_option("bus", arguments->bus, "As for dump; without it, the record is only shown");
  command->add_option("--rate", arguments->rate, "Seconds of the record in a real second")
      ->check(command_line::number_in(0.01, 1000.0))
      ->capture_default_str();
  command->footer("Example: skein-hil can replay flight.log mcast:1 --rate 10");
  command->callback([arguments, &status] { status = replay_can(*arguments); });
}

void add_can(CLI::App& app, int& status) {
  auto* command = app.add_subcommand("can", "Look at a CAN bus, record it, replay a record");
  command->require_subcommand(1);
  command->footer(
      "Examples: skein-hil can dump mcast:0 --log flight.log\n"
      "          skein-hil can replay flight.log mcast:1 --rate 10");
  add_can_dump(*command, status);
  add_can_replay(*command, status);
}

}  // namespace
}  // namespace skein::hil

int main(int argc, char** argv) {
  CLI::App app{
      "The bench of Skein: flies a scenario with one process for each vehicle, a ground station "
      "and a\n"
      "radio between them, judges what was flown, and compares it with published results."};
  app.footer(
      "Examples:\n"
      "  skein-hil run scenarios/coalition-6.yaml          six vehicles, a minute\n"
      "  skein-hil run scenarios/coalition-32.yaml         the mission of 32 vehicles\n"
      "  skein-hil simulate scenarios/coalition-32.yaml    the same in virtual time, in a second\n"
      "  skein-hil sweep scenarios/experiments/radio.yaml            600 missions, means and "
      "plots\n"
      "  skein-hil routes                                  figures of cooperative routes\n"
      "  skein-hil can dump vcan0                          what is said on a CAN bus\n"
      "Scenario files are explained in docs/scenarios.md.");
  app.require_subcommand(1);
  app.set_version_flag("--version", "skein-hil " + skein::version());
  app.set_help_all_flag("--help-all", "The same of every command");

  int status = 0;
  const std::string program = argv[0];
  skein::hil::add_run(app, status);
  skein::hil::add_simulate(app, program, status);
  skein::hil::add_reexecute(app, status);
  skein::hil::add_changes(app, program, status);
  skein::hil::add_sweep(app, status);
  skein::hil::add_merge(app, program, status);
  skein::hil::add_swap(app, status);
  skein::hil::add_routes(app, status);
  skein::hil::add_tours(app, status);
  skein::hil::add_orienteering(app, status);
  skein::hil::add_shapes(app, status);
  skein::hil::add_can(app, status);
  return skein::command_line::read(app, argc, argv).value_or(status);
}
