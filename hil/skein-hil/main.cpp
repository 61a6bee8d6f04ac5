// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "commands.hpp"

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
      "  skein-hil sweep scenarios/experiments/radio.yaml            600 missions, means and plots\n"
      "  skein-hil routes                                  figures of cooperative routes\n"
      "  skein-hil can dump vcan0                          what is said on a CAN bus\n"
      "Scenario files are explained in docs/scenarios.md.");
  app.require_subcommand(1);

  skein::hil::RunArguments run;
  run.programs = std::filesystem::canonical("/proc/self/exe").parent_path();
  auto* run_command =
      app.add_subcommand("run", "Fly a scenario with real processes, judge it, write a report");
  run_command->add_option("scenario", run.scenario, "Scenario file (YAML)")->required();
  run_command->add_option("--rate", run.rate, "Mission seconds in a real second")
      ->check(CLI::Range(0.1, 20.0))
      ->capture_default_str();
  run_command->add_option("--routes", run.routes,
                          "A plan of `skein-ground plan`, for a mission of routes (without it one "
                          "is made)");
  run_command->add_option("--seed", run.seed, "In place of the scenario's");
  run_command->add_option("--out", run.folder, "Folder of the run (default: runs/NAME-TIME)");
  run_command
      ->add_option("--port-base", run.port_base,
                   "First UDP port (default: free ports are looked for)")
      ->check(CLI::Range(1024, 65000));
  run_command
      ->add_option("--lead", run.lead_s,
                   "Seconds from the start of the programs to that of the mission; a slow machine "
                   "wants more (default: by the number of vehicles)")
      ->check(CLI::Range(1.0, 600.0));
  run_command->add_option("--can", run.can,
                          "CAN bus of all flight controllers, such as vcan0 (default: multicast "
                          "buses of their own on loopback)");
  run_command->add_flag("--headless", run.headless, "No progress line; news only");
  run_command->add_flag("--prompt", run.prompt,
                        "Decide about deliveries yourself, at the ground station's prompt, in "
                        "place of the scenario's script");
  run_command
      ->add_option("--console", run.console_port,
                   "Serve the ground station's console on this port of loopback (such as 7460); "
                   "with --prompt you decide there")
      ->check(CLI::Range(1, 65535));
  run_command->footer(
      "Ends with status 0 only if every check held; 1 if one failed, 2 for bad input.\n"
      "Example: skein-hil run scenarios/coalition-6.yaml --rate 2");

  skein::hil::SimulateArguments simulate;
  simulate.program = argv[0];
  auto* simulate_command =
      app.add_subcommand("simulate", "Fly a scenario in virtual time with the same agents");
  simulate_command->add_option("scenario", simulate.scenario, "Scenario file (YAML)")->required();
  simulate_command->add_option("--seed", simulate.seed, "In place of the scenario's");
  auto* trace = simulate_command->add_flag("--trace", simulate.trace, "Print every event");
  simulate_command
      ->add_option("--faults", simulate.faults,
                   "What goes wrong, drawn from the seed: none, lossy, partition, crash, clocks,\n"
                   "hazards, operator, joining, several of them with commas, or mixed; of a "
                   "formation\n"
                   "none, vehicle, leader, ground, loss, silence, partition, restart, clocks or "
                   "mixed")
      ->capture_default_str();
  simulate_command
      ->add_option("--runs", simulate.runs,
                   "Fly it so often, with the seeds SEED, SEED + 1, ..., and print a summary")
      ->check(CLI::Range(1, 10'000'000))
      ->excludes(trace);
  simulate_command
      ->add_option("--jobs", simulate.jobs, "Missions at a time (default: one for each core)")
      ->check(CLI::Range(1, 1024));
  simulate_command->footer(
      "The same file and seed print the same bytes. Every mission is judged; ends with status 0\n"
      "only if every check held; 1 if one failed, 2 for bad input.\n"
      "Examples: skein-hil simulate scenarios/coalition-32.yaml --seed 7 --trace\n"
      "          skein-hil simulate scenarios/faults-8.yaml --runs 1000 --faults mixed\n"
      "          skein-hil simulate scenarios/formation-5.yaml --runs 1000 --faults mixed");

  skein::hil::ReexecuteArguments reexecute;
  auto* reexecute_command = app.add_subcommand(
      "reexecute",
      "Run a flight's agents anew from what they were given, and compare what they decide");
  reexecute_command->add_option("run", reexecute.run, "Folder of the run, or of one vehicle in it")
      ->required();
  reexecute_command->add_option("--vehicle", reexecute.vehicle, "Only this one")
      ->check(CLI::Range(1, 65535));
  reexecute_command->footer(
      "Every flight plan and message must be the same, byte for byte; the first that is not is\n"
      "printed. Ends with status 0 if all are, 1 if not, 2 where there is nothing to run.\n"
      "Example: skein-hil reexecute runs/coalition-32-20260101-120000 --vehicle 7");

  skein::hil::ChangesArguments changes;
  changes.program = argv[0];
  auto* changes_command = app.add_subcommand(
      "changes", "Plan random changes of formation, and judge their separation in continuous time");
  changes_command->add_option("--runs", changes.runs, "How many changes, of 5 to 100 vehicles")
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  changes_command->add_option("--first-seed", changes.first_seed, "Of the first; then + 1")
      ->capture_default_str();
  changes_command
      ->add_option("--jobs", changes.jobs, "Changes at a time (default: one for each core)")
      ->check(CLI::Range(1, 1024));
  changes_command->footer(
      "Ends with status 0 if nobody comes nearer than separation and reserve, 1 if somebody does.\n"
      "Example: skein-hil changes --runs 10000");

  skein::hil::SweepArguments sweep;
  auto* sweep_command = app.add_subcommand(
      "sweep", "Fly an experiment: a grid of parameters, many draws of each, with statistics");
  sweep_command->add_option("experiment", sweep.experiment, "Experiment file (YAML)")->required();
  sweep_command->add_option("--out", sweep.folder, "Folder of the results (default: runs/NAME)");
  sweep_command->add_option("--runs", sweep.runs, "Draws of each cell, in place of the file's")
      ->check(CLI::Range(1, 1'000'000));
  sweep_command->add_option("--jobs", sweep.jobs, "Missions at a time (default: one for each core)")
      ->check(CLI::Range(1, 1024));
  sweep_command->footer(
      "Writes runs.csv (a row after every run), cells.csv (means with 95 % intervals) and a plot\n"
      "of each measure. What is in the folder is not flown again: after an interruption, or to "
      "add\n"
      "draws, call it again. Ends with status 0 if all was flown and every check but completion\n"
      "held, 1 if not, 2 for bad input.\n"
      "Examples: skein-hil sweep scenarios/experiments/mission-32.yaml\n"
      "          skein-hil sweep scenarios/experiments/radio.yaml --runs 10 --out runs/radio-10");

  skein::hil::SwapArguments swap;
  auto* swap_command = app.add_subcommand(
      "swap",
      "Compare methods of avoidance: agents on a circle change to the opposite side at once");
  swap_command
      ->add_option("--method", swap.methods,
                   "passage, field, orca, orca-limited; several with commas")
      ->delimiter(',')
      ->capture_default_str();
  swap_command->add_option("--agents", swap.agents, "How many; several numbers with commas")
      ->delimiter(',')
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  swap_command->add_option("--seeds", swap.seeds, "Runs of each method and number")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  swap_command->add_option("--first-seed", swap.first_seed, "Of the first run; then + 1")
      ->capture_default_str();
  swap_command
      ->add_option("--radius", swap.radius_m,
                   "Of the circle, m (default: 10 for 5 agents, 40 for 32, 100 for 100, 200 for "
                   "250)")
      ->check(CLI::Range(3.0, 10'000.0));
  swap_command->add_option("--noise", swap.noise_m, "Starts are so far off their places at most, m")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  swap_command->add_option("--delay", swap.delay_s, "Of messages, s")
      ->check(CLI::Range(0.0, 5.0))
      ->capture_default_str();
  swap_command->add_option("--loss", swap.loss, "Share of the messages that are lost")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  swap_command->add_option("--separation", swap.separation_m, "Least distance wanted, m")
      ->check(CLI::Range(0.1, 100.0))
      ->capture_default_str();
  swap_command->add_option("--csv", swap.csv, "File to write, a row for each run");
  swap_command->add_option("--plots", swap.plots,
                           "Folder for the tracks of the first seed, as SVG");
  swap_command->add_option("--jobs", swap.jobs, "Runs at a time (default: one for each core)")
      ->check(CLI::Range(1, 1024));
  swap_command->footer(
      "t/T is the time until all are there over that of a straight way without others. Distances\n"
      "are judged in continuous time. The same seed gives the same run. Ends with status 0 if no\n"
      "pair came nearer than the separation and all arrived, 1 if not, 2 for bad input.\n"
      "Examples: skein-hil swap --agents 32 --seeds 100 --method orca\n"
      "          skein-hil swap --agents 5,32,100 --method field,orca --csv swap.csv\n"
      "          skein-hil swap --agents 5 --delay 0 --loss 0 --seeds 1 --plots .");

  skein::hil::RoutesArguments routes;
  auto* routes_command = app.add_subcommand(
      "routes",
      "Repeat the experiments of Wu et al. 2022 on cooperative routes, and draw their figures");
  routes_command
      ->add_option("--what", routes.what,
                   "maps, convergence, weights, worlds, cooperative, quality, scale, or all;\n"
                   "several with commas")
      ->delimiter(',')
      ->capture_default_str();
  auto* paper = routes_command->add_flag(
      "--paper", routes.paper, "The paper's numbers of runs: 200 of each map, 600 worlds");
  routes_command
      ->add_option("--runs", routes.runs, "Runs of everything, in place of a quick look's")
      ->check(CLI::Range(1, 100'000))
      ->excludes(paper);
  routes_command->add_option("--seed", routes.seed, "Of the first run; then + 1")
      ->capture_default_str();
  routes_command->add_option("--out", routes.folder, "Folder of the tables and figures")
      ->capture_default_str();
  routes_command->add_option("--jobs", routes.jobs, "Runs at a time (default: one for each core)")
      ->check(CLI::Range(1, 1024));
  routes_command->footer(
      "Prints tables beside the paper's values; writes a CSV and SVG files of each experiment. "
      "The\n"
      "same seed gives the same files. A quick look at all takes about a minute on one core,\n"
      "--paper a quarter of an hour. Ends with status 0, or 2 for bad input.\n"
      "Examples: skein-hil routes\n"
      "          skein-hil routes --what worlds,quality --paper --jobs 8\n"
      "          skein-hil routes --what maps --runs 50 --out runs/maps");

  skein::hil::ShapesArguments shapes;
  auto* shapes_command =
      app.add_subcommand("shapes", "Print or draw the places of a formation's shapes");
  shapes_command
      ->add_option("shapes", shapes.shapes,
                   "line_abreast, column, echelon, wedge, pentagon, or a file (YAML)")
      ->required();
  shapes_command->add_option("--vehicles", shapes.vehicles, "How many; several numbers with commas")
      ->delimiter(',')
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  shapes_command->add_option("--spacing", shapes.spacing_m, "Least distance of two places, m")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  shapes_command->add_option("--svg", shapes.picture, "Picture to write, in place of the numbers");
  shapes_command->footer(
      "Places are around the shape's centre, in the order in which they are filled: dx along the\n"
      "track, dy to its left, dz up. The shapes are explained in docs/formation.md.\n"
      "Examples: skein-hil shapes wedge --vehicles 15\n"
      "          skein-hil shapes scenarios/shapes/heart.yaml --vehicles 5,12,32 --spacing 4 --svg "
      "heart.svg");

  skein::hil::CanDumpArguments dump;
  skein::hil::CanReplayArguments replay;
  auto* can_command = app.add_subcommand("can", "Look at a CAN bus, record it, replay a record");
  can_command->require_subcommand(1);
  auto* dump_command = can_command->add_subcommand(
      "dump", "Show what is said on a bus: DroneCAN and the MAVLink in it");
  dump_command
      ->add_option("bus", dump.bus, "can0, vcan0, ... or mcast:NUMBER, mcast:NUMBER@INTERFACE")
      ->required();
  dump_command->add_option("--log", dump.log, "File to write, as candump -L does");
  dump_command->add_option("--seconds", dump.seconds, "End after that (default: at Ctrl-C)")
      ->check(CLI::PositiveNumber);
  dump_command->footer("Example: skein-hil can dump mcast:0 --log flight.log");
  auto* replay_command =
      can_command->add_subcommand("replay", "Send a record (candump -L) to a bus, and show it");
  replay_command->add_option("log", replay.log, "File of candump -L")->required();
  replay_command->add_option("bus", replay.bus,
                             "As for dump; without it, the record is only shown");
  replay_command->add_option("--rate", replay.rate, "Seconds of the record in a real second")
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str();
  replay_command->footer("Example: skein-hil can replay flight.log mcast:1 --rate 10");

  CLI11_PARSE(app, argc, argv);
  if (dump_command->parsed()) return skein::hil::dump_can(dump);
  if (replay_command->parsed()) return skein::hil::replay_can(replay);
  if (run_command->parsed()) return skein::hil::run(run);
  if (reexecute_command->parsed()) return skein::hil::reexecute(reexecute);
  if (changes_command->parsed()) return skein::hil::changes(changes);
  if (routes_command->parsed()) return skein::hil::routes(routes);
  if (shapes_command->parsed()) return skein::hil::shapes(shapes);
  if (swap_command->parsed()) return skein::hil::swap(swap);
  return sweep_command->parsed() ? skein::hil::sweep(sweep) : skein::hil::simulate(simulate);
}
