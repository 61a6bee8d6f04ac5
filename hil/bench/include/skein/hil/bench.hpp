// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/hil/fault.hpp"
#include "skein/hil/program_spans.hpp"
#include "skein/mission/messages.hpp"

namespace skein::hil {

struct BenchOptions {
  std::filesystem::path programs;      ///< folder of skein-onboard, skein-fc and skein-ground
  std::filesystem::path radio_plugin;  ///< libskein_radio.so
  std::filesystem::path run_folder;    ///< made; configurations, logs and recordings go there
  double rate = 1.0;                   ///< mission seconds in a real second
  std::uint16_t port_base = 0;         ///< UDP; 0 looks for free ports
  std::string address = "127.0.0.1";   ///< of this machine, where all nodes reach it
  /// Vehicles whose programs run on the hosts that the scenario names.
  std::vector<VehicleId> external;
  /// From the start of the programs to mission time 0; 0: by the number of vehicles.
  double lead_s = 0.0;
  /// For all flight controllers whose bus the scenario does not name; empty: quiet multicast buses,
  /// one for each.
  std::string can;
  /// A user's own builds of ArduPilot for software in the loop, for the vehicles of their airframe
  /// in place of skein-fc; and files of parameters for them.
  std::vector<std::string> autopilots;
  std::vector<std::string> autopilot_parameters;
  std::string autopilot_model;  ///< of its simulator's planes
  bool dds = false;             ///< Fast DDS, to each node by itself; else by the air
  /// Of a shell: a program that makes a real network's links as the bench says (docs/mesh.md);
  /// empty: none.
  std::string links;
  bool sealed = true;              ///< with keys that are made for the run
  std::uint16_t console_port = 0;  ///< of the ground station's page; 0: it has none
  std::string console_token;       ///< that opens it
  /// Besides those of the scenario (spoil()). An aircraft outlives its program then, and flies on
  /// by its flight controller.
  std::vector<Fault> faults;
  std::filesystem::path other_programs;    ///< of another release, for whom faults say so
  int ground_stations = 1;                 ///< 2: the second watches; its page is at the next port
  std::optional<Instant> take_command_at;  ///< when the second takes the command; none: never
  bool prompt =
      false;  ///< leave the decisions to skein-ground's prompt (its input is the terminal's)
};

/// How far a run is, several times a second.
struct BenchProgress {
  Instant now{};
  std::size_t vehicles_heard = 0;
  std::size_t sites_found = 0;
  std::size_t sites_done = 0;
  std::string news;  ///< a line worth printing, or empty
};

struct HeardEvent {
  Instant at{};
  mission::MissionEvent event;
};

/// What happened on the bench besides what the processes recorded.
struct BenchOutcome {
  bool finished = false;              ///< all sites done, or the script of a formation
  Instant ended_at{};                 ///< mission time
  std::optional<double> all_heard_s;  ///< real seconds from the first start until all were heard
  std::vector<VehicleId> killed;      ///< on purpose, by the scenario's faults
  std::vector<std::string> deaths;    ///< processes that ended by themselves, and how
  bool stopped_cleanly = false;       ///< all ended with status 0 when asked to
  bool interrupted = false;           ///< by Ctrl-C
  bool quit = false;                  ///< by the operator at the ground station's prompt
  std::size_t external = 0;           ///< vehicles on other machines
  std::vector<std::string> not_collected;    ///< why, of each of these without its recording
  std::uint64_t control_overruns = 0;        ///< missed control periods, all vehicles together
  ProgramSpans spans;                        ///< what faults did to programs
  std::int64_t epoch_unix_ns = 0;            ///< mission time 0
  std::map<VehicleId, Duration> clocks_off;  ///< by faults, so far ahead; of who has started so
  std::optional<Instant> healed_at;          ///< the radio; nothing: it does not in this mission
  std::vector<HeardEvent> heard;             ///< with BenchOptions::faults, by the bench
  std::map<VehicleId, mission::Telemetry> last;  ///< of each vehicle
  double late_s = 0.0;                 ///< the bench itself, at most: the machine was busy
  std::uint64_t messages_dropped = 0;  ///< by full queues or as damaged, all vehicles together
};

/// User's own autopilots speak on a multicast bus, whose frames are to stay on this machine: unless
/// the way to it is loopback already, this process and what it starts get a network of their own.
/// Before any thread is started. `reached`: from outside of it, so that it may not be.
[[nodiscard]] Result<void> keep_autopilots_on_loopback(bool reached);

/// Starts one skein-onboard for each vehicle, one skein-fc (or a user's own autopilot, which takes
/// off before the mission begins) for each whose flight controller is an ardupilot, one
/// skein-ground and the radio between them, plays the sensors and the faults, and stops everything
/// when all sites are done, at the scenario's duration_max, when a process dies unasked, when the
/// operator at the prompt quits, or on SIGINT or SIGTERM. Nothing is left running or in /dev/shm,
/// whatever happens. External vehicles are configured and started on their hosts, told of the
/// radio, ended with the rest, and what they recorded is fetched into the run folder. Fails, with
/// what to do, when it cannot start, and where the run folder has something in it.
[[nodiscard]] Result<BenchOutcome> fly(
    const configuration::Scenario& scenario, const BenchOptions& options,
    const std::function<void(const BenchProgress&)>& on_progress);

}  // namespace skein::hil
