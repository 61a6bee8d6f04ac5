// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "bench_options.hpp"
#include "bench_radio.hpp"
#include "external_hosts.hpp"
#include "flight_controllers.hpp"
#include "flooder.hpp"
#include "interrupt_watch.hpp"
#include "link_listener.hpp"
#include "mission_watch.hpp"
#include "nemesis.hpp"
#include "orders_to_land.hpp"
#include "other_release.hpp"
#include "ports.hpp"
#include "run_keys.hpp"
#include "second_station.hpp"
#include "site_reports.hpp"
#include "skein/configuration/deployment.hpp"
#include "skein/groundstation/ground_process.hpp"
#include "skein/hil/child_process.hpp"
#include "skein/hil/fault_timeline.hpp"
#include "skein/hil/team_mission.hpp"
#include "skein/identity/team.hpp"
#include "skein/mission/may_say.hpp"
#include "skein/network/node.hpp"
#include "skein/process/mission_network.hpp"
#include "skein/process/token.hpp"
#include "skein/recording/writer.hpp"
#include "skein/version/version.hpp"
#include "skein/wording/wording.hpp"
#include "truth_recorder.hpp"
#include "user_autopilots.hpp"

namespace skein::hil {
namespace {

using std::chrono::steady_clock;
using std::chrono::system_clock;

/// The bench's own node: it hears everybody and is in no radio's table.
constexpr VehicleId kBench = mission::kSensors;
constexpr auto kPeriod = std::chrono::milliseconds{50};
constexpr Duration kAfterwards = std::chrono::seconds{3};
constexpr Duration kReportAgain = std::chrono::seconds{10};
constexpr auto kStopWithin = std::chrono::seconds{8};
/// Node ids for them and their companions on one bus.
constexpr std::size_t kCanVehiclesMax = 50;

/// Where there are more, Fast DDS stays in the agents' processes: twice as many processes would
/// measure the machine.
constexpr std::size_t kNodesPerProcessor = 4;
/// How long an external vehicle may be silent. On the bench a process that ends is seen at once.
constexpr auto kExternalSilence = std::chrono::seconds{10};
/// What starting a vehicle takes on a machine that is busy with other things, and where Fast DDS
/// has a process of its own.
constexpr double kLead_s = 0.3;
constexpr double kIsolatedLead_s = 0.8;
/// What configuring and starting external hosts takes, all at once.
constexpr double kExternalLead_s = 6.0;

std::string seconds_text(double s) { return fmt::format("{:.1f} s", s); }

class Bench {
 public:
  Bench(const configuration::Scenario& scenario, const BenchOptions& options,
        ExternalHosts external, UserAutopilots autopilots,
        const std::function<void(const BenchProgress&)>& on_progress)
      : scenario_{scenario},
        options_{options},
        autopilots_{std::move(autopilots)},
        on_progress_{on_progress},
        external_{std::move(external)},
        sensors_{scenario},
        radio_{radio_params(scenario.radio)},
        timeline_{all_faults(scenario, options)},
        mission_{scenario},
        nemesis_{{processes_,
                  [this](VehicleId id, std::optional<std::size_t> bytes) {
                    return start_anew(id, bytes);
                  },
                  [this](const std::string& news) { say(news); }}} {
    progress_.now = Instant{Duration::min()};
  }

  Result<void> start() {
    const std::size_t nodes = scenario_.vehicles.size() + 2;
    const auto base = options_.dds ? port_block(options_.address, options_.port_base, 2 * nodes)
                                   : port_block(scenario_.air.group, options_.port_base, 1);
    if (!base) return base.error();
    const auto buses = can_buses(*base);
    if (!buses) return buses.error();
    if (auto made = radio_.open(); !made) return made;
    if (Flooder::is_wanted(scenario_)) {
      if (options_.dds) return Error{"a flood_vehicle floods the air; leave --dds out"};
      auto flooder = Flooder::open(scenario_.air.group, *base, options_.address);
      if (!flooder) return flooder.error();
      flooder_.emplace(std::move(flooder).value());
    }

    if (!options_.links.empty()) {
      auto listener = LinkListener::start(options_.links, options_.run_folder / "links.log");
      if (!listener) return listener.error();
      links_.emplace(std::move(listener).value());
    }
    configuration::Deployment deployment = deploy(*base, *buses);
    if (options_.sealed) {
      if (auto made = make_run_keys(options_.run_folder, all_nodes()); !made) return made;
    }
    if (auto open = open_truth(vehicle_configs(deployment)); !open) return open;
    if (!options_.autopilots.empty()) {
      if (auto up = boot_autopilots(vehicle_configs(deployment)); !up) return up;
    }
    begin_in(lead_s(deployment), deployment);
    if (auto begun = record_truth(deployment); !begun) return begun;
    const auto configs = vehicle_configs(deployment);
    if (auto up = external_.start(configs); !up) return up;
    started_ = steady_clock::now();
    auto ground = configuration::ground_config(scenario_, deployment);
    if (external_.ground() != nullptr) {
      ground.network.transport_plugin = external_.ground()->radio_plugin;
    }
    control_socket_ = groundstation::control_socket_of(ground);
    if (auto joined = join_second(ground); !joined) return joined;
    if (auto kept = keep_console_token(ground.recording_folder); !kept) return kept;
    // All of it before the first program runs, and wants the processor, too.
    std::ofstream{configuration_of(kGroundStation)} << configuration::to_yaml(ground);
    for (const auto& config : configs) {
      if (external_.has(config.vehicle.id)) continue;
      configs_.emplace(config.vehicle.id, config);
      nemesis_.set_clock(config.vehicle.id, clock_offset(options_.faults, config.vehicle.id));
      if (auto written = write_configuration(config.vehicle.id); !written) return written;
    }
    if (auto up = launch(kGroundStation, "skein-ground"); !up) return up;
    if (second_) {
      if (auto up = launch(SecondStation::kNode, "skein-ground"); !up) return up;
    }
    radio_.add(kGroundStation);
    for (const auto& config : configs) {
      radio_.add(config.vehicle.id);
      if (auto up = launch_vehicle(config); !up) return up;
    }
    configuration::NetworkConfig own = ground.network;
    if (options_.dds) {
      own.port = static_cast<std::uint16_t>(*base + 2 * (nodes - 1));
      own.peers.push_back({kGroundStation, ground.network.address, ground.network.port});
    }
    own.address = options_.address;
    own.keys = options_.sealed ? deployment.keys.at(kBench) : "";
    own.transport_plugin.clear();  // it hears all,
    own.air.hops_max = 1;          // and is heard by all
    return listen(own, deployment);
  }

  BenchOutcome run() {
    for (auto next = steady_clock::now(); !finished(); next += kPeriod) {
      std::this_thread::sleep_until(next);
      const std::chrono::duration<double> late = steady_clock::now() - next;
      if (late.count() > outcome_.late_s) outcome_.late_s = late.count();
      const Instant now = mission_now();
      hear();
      watch(now);
      if (now >= Instant{}) {
        play_faults(now);
        move_radio(now);
        for (const auto& by : timeline_.interference().floods) flooder_->say(by, kPeriod);
        sense(now);
        land_at_the_end(now);
      } else if (links_ && outcome_.all_heard_s) {
        move_radio(now);  // a real network needs a while to find its ways
      }
      progress_.now = now;
      say({});
    }
    outcome_.ended_at = progress_.now;
    outcome_.finished = mission_.over(progress_.now);
    outcome_.interrupted = InterruptWatch::interrupted();
    return stop();
  }

 private:
  /// From the start of the programs: all have started and found each other before.
  [[nodiscard]] double lead_s(const configuration::Deployment& deployment) const {
    if (options_.lead_s > 0.0) return options_.lead_s;
    const double each_s = options_.dds && deployment.isolated ? kIsolatedLead_s : kLead_s;
    double lead_s = 3.0 + each_s * static_cast<double>(scenario_.vehicles.size());
    if (!external_.empty()) lead_s += kExternalLead_s;
    double take_off_s = 0.0;
    for (const auto& vehicle : scenario_.vehicles) {
      if (!from_ground(vehicle.spec, vehicle.flight_controller)) continue;
      const bool emulated = !user_flown(vehicle.spec, vehicle.flight_controller);
      take_off_s = std::max(take_off_s, take_off_lead_s(vehicle.spec, emulated));
    }
    return lead_s + take_off_s;
  }

  void begin_in(double lead_s, configuration::Deployment& deployment) {
    const auto lead = std::chrono::duration_cast<std::chrono::milliseconds>(
        std::chrono::duration<double>{lead_s});
    epoch_ = steady_clock::now() + lead;
    deployment.time.epoch_unix_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(
                                        (system_clock::now() + lead).time_since_epoch())
                                        .count();
    outcome_.epoch_unix_ns = deployment.time.epoch_unix_ns;
  }

  [[nodiscard]] bool user_flown(const VehicleSpec& spec,
                                const configuration::FlightControllerConfig& controller) const {
    return hil::user_flown(spec, controller, external_, autopilots_);
  }

  /// A user's autopilot begins there, and an emulated copter that flies in formation. When an
  /// external host's own flight controller takes off is its crew's to say.
  [[nodiscard]] bool from_ground(const VehicleSpec& spec,
                                 const configuration::FlightControllerConfig& controller) const {
    const auto* host = external_.host_of(spec.id);
    if (host != nullptr && host->flight_controller == configuration::HostFlightController::own) {
      return false;
    }
    return user_flown(spec, controller) ||
           (controller.kind == configuration::FlightControllerKind::ardupilot &&
            configuration::flies_formation(spec));
  }

  /// Who begins on the ground is taken off before the mission, and waits near its start.
  [[nodiscard]] std::vector<configuration::VehicleConfig> vehicle_configs(
      const configuration::Deployment& deployment) const {
    auto configs = configuration::vehicle_configs(scenario_, deployment);
    for (auto& config : configs) {
      if (!from_ground(config.vehicle, config.flight_controller)) continue;
      config.flight_controller.ardupilot.take_over = configuration::TakeOverKind::from_ground;
      config.flight_controller.ardupilot.takeoff_height_m =
          configuration::flies_formation(config.vehicle) ? kHover_m : config.vehicle.height_m;
    }
    return configs;
  }

  Result<void> open_truth(const std::vector<configuration::VehicleConfig>& configs) {
    const auto aircraft =
        simulated_aircraft(configs, [this](VehicleId vehicle) { return external_.has(vehicle); });
    if (aircraft.empty()) return {};
    auto truth = TruthRecorder::open(aircraft, configs.front().origin);
    if (!truth) return truth.error();
    truth_ = std::move(truth).value();
    return {};
  }
  Result<void> record_truth(const configuration::Deployment& deployment) {
    if (!truth_) return {};
    return truth_->record(options_.run_folder, deployment.time.epoch_unix_ns,
                          [this] { return mission_now(); });
  }

  /// One after another: a simulator that boots takes a processor.
  Result<void> boot_autopilots(const std::vector<configuration::VehicleConfig>& configs) {
    int instance = 0;
    for (const auto& config : configs) {
      if (!user_flown(config.vehicle, config.flight_controller)) continue;
      const std::string name = "fc-" + std::to_string(config.vehicle.id.value);
      const auto command =
          autopilot_command(autopilots_, config, instance++, truth_->port(config.vehicle.id),
                            options_.run_folder / name);
      if (!command) return command.error();
      const auto log = options_.run_folder / (name + ".log");
      auto child = ChildProcess::start(*command, log, {});
      if (!child) return child.error();
      auto& started =
          flight_controllers_.emplace(config.vehicle.id, std::move(child).value()).first->second;
      user_flown_.insert(config.vehicle.id);
      if (auto up = await_autopilot(config, started, log); !up) return up;
      say("the autopilot of " + name_of(config.vehicle.id) + " has booted");
    }
    return {};
  }

  /// Where everybody is.
  configuration::Deployment deploy(std::uint16_t port_base, const std::vector<std::string>& buses) {
    const std::size_t processors = std::max(1U, std::thread::hardware_concurrency());
    const bool few = all_nodes().size() <= kNodesPerProcessor * processors;
    configuration::Deployment deployment;
    deployment.address = options_.address;
    deployment.port_base = port_base;
    deployment.dds = options_.dds;
    deployment.domain_id = static_cast<std::uint16_t>(port_base % 200);
    deployment.transport_plugin = std::filesystem::absolute(options_.radio_plugin).string();
    deployment.time.rate = options_.rate;
    deployment.recording_folder = std::filesystem::absolute(options_.run_folder).string();
    deployment.can_buses = buses;
    deployment.elsewhere = external_.addresses();
    deployment.console_port = options_.console_port;
    deployment.isolated = few;
    if (options_.dds && !few) {
      say(fmt::format("{} nodes on {} processors: Fast DDS has no process of its own here",
                      all_nodes().size(), processors));
    }
    if (options_.sealed) use_run_keys(deployment, options_.run_folder, all_nodes());
    return deployment;
  }

  /// The bench among them.
  [[nodiscard]] std::vector<VehicleId> all_nodes() const {
    std::vector<VehicleId> nodes{kGroundStation, kBench};
    if (options_.ground_stations > 1) nodes.push_back(SecondStation::kNode);
    for (const auto& vehicle : scenario_.vehicles) nodes.push_back(vehicle.spec.id);
    return nodes;
  }

  [[nodiscard]] Result<void> keep_console_token(const std::filesystem::path& folder) const {
    if (options_.console_port == 0) return {};
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    return process::keep_token(folder / process::kConsoleTokenFile, options_.console_token);
  }

  /// The ground station is one of two from then on, where two are wanted.
  Result<void> join_second(configuration::GroundConfig& ground) {
    if (options_.ground_stations < 2) return {};
    const auto second = SecondStation::join(ground, options_.run_folder, options_.sealed);
    if (!second) return second.error();
    second_.emplace(second->control_socket, options_.take_command_at);
    std::ofstream{configuration_of(SecondStation::kNode)} << configuration::to_yaml(*second);
    return keep_console_token(second->recording_folder);
  }

  Result<void> launch_vehicle(const configuration::VehicleConfig& config) {
    if (external_.has(config.vehicle.id)) return {};
    if (auto up = launch_flight_controller(config); !up) return up;
    return launch(config.vehicle.id, "skein-onboard");
  }

  /// Opens the bench's own node and recording.
  Result<void> listen(const configuration::NetworkConfig& own,
                      const configuration::Deployment& deployment) {
    const auto start = process::start_node(own, kBench);
    if (!start) return start.error();
    recording::Writer::Options recorder;
    recorder.session = {
        kBench, start->instance, "skein-hil", version(), deployment.time.epoch_unix_ns, ""};
    auto writer = recording::Writer::open(options_.run_folder / "bench", recorder);
    if (!writer) return writer.error();
    writer_ = std::move(writer).value();
    network::NodeConfig bench = process::node_config(own, *start, {});
    bench.role = codec::Role::ground;
    bench.queue_limit = 16384;
    auto node = network::Node::open(bench);
    if (!node) return node.error();
    node_ = std::move(node).value();
    return {};
  }

  [[nodiscard]] Instant mission_now() const {
    const auto since = std::chrono::duration<double>(steady_clock::now() - epoch_).count();
    return at_seconds(since * options_.rate);
  }

  [[nodiscard]] std::filesystem::path configuration_of(VehicleId id) const {
    return options_.run_folder / (log_name(id) + ".yaml");
  }

  Result<void> write_configuration(VehicleId id) {
    const auto left_out =
        hil::write_configuration(configs_.at(id), configuration_of(id), programs_of(id));
    if (!left_out) return left_out.error();
    if (!left_out->empty()) say(name_of(id) + " is of a release that has no " + *left_out);
    return {};
  }

  /// Another release's, where faults say so; null: ours.
  [[nodiscard]] const std::filesystem::path* programs_of(VehicleId id) const {
    return is_of_other_release(options_.faults, id) ? &options_.other_programs : nullptr;
  }

  Result<void> start_anew(VehicleId id, std::optional<std::size_t> file_bytes_max) {
    processes_.erase(id);
    return launch(id, configs_.contains(id) ? "skein-onboard" : "skein-ground", file_bytes_max);
  }

  Result<void> launch(VehicleId id, const std::string& program,
                      std::optional<std::size_t> file_bytes_max = {}) {
    const auto file = configuration_of(id);
    const bool terminal = options_.prompt && id == kGroundStation;
    const auto& programs =
        is_of_other_release(options_.faults, id) ? options_.other_programs : options_.programs;
    std::vector<std::string> command{(programs / program).string(), "--config", file.string()};
    if (const Duration ahead = nemesis_.clock_off(id); ahead != Duration{}) {
      outcome_.clocks_off[id] = ahead;
      command.insert(command.end(), {"--clock-ahead", fmt::format("{}", to_seconds(ahead))});
    }
    if (id == kGroundStation && external_.ground() != nullptr) {
      const std::vector<std::string> before{"/bin/sh", "-c",
                                            "exec " + external_.ground()->run + " \"$@\"", "sh"};
      command.insert(command.begin(), before.begin(), before.end());
    }
    auto child = ChildProcess::start(
        command, terminal ? std::filesystem::path{} : options_.run_folder / (log_name(id) + ".log"),
        {{"SKEIN_RADIO_TABLE", radio_.table()},
         {"SKEIN_RADIO_SEED", std::to_string(scenario_.seed)}},
        -1, file_bytes_max);
    if (!child) return child.error();
    processes_.emplace(id, std::move(child).value());
    return {};
  }

  /// The buses of the flight controllers that the scenario leaves to us.
  [[nodiscard]] Result<std::vector<std::string>> can_buses(std::uint16_t port_base) const {
    std::size_t on_can = 0;
    std::size_t ours = 0;
    std::vector<std::string> buses;  // of those that the scenario leaves to us; of ours, empty
    for (const auto& vehicle : scenario_.vehicles) {
      const auto& fc = vehicle.flight_controller;
      if (fc.kind != configuration::FlightControllerKind::ardupilot) continue;
      ++on_can;
      if (!fc.ardupilot.can.empty()) continue;
      const configuration::Host* const host = external_.host_of(vehicle.spec.id);
      buses.push_back(host != nullptr ? host->can : bus_of(vehicle));
      if (buses.back().empty()) ++ours;
    }
    if (on_can > 0 && options_.rate != 1.0) {
      return Error{"flight controllers on CAN fly in real time; leave --rate out"};
    }
    if (buses.size() > kCanVehiclesMax) {
      return Error{"at most " + std::to_string(kCanVehiclesMax) +
                   " vehicles can be on CAN; make the others simulated"};
    }
    if (ours == 0) return buses;
    auto quiet = quiet_buses(ours, port_base);
    if (!quiet) return quiet.error();
    for (std::string& bus : buses) {
      if (!bus.empty()) continue;
      bus = std::move(quiet->back());
      quiet->pop_back();
    }
    return buses;
  }

  Result<void> launch_flight_controller(const configuration::VehicleConfig& config) {
    if (config.flight_controller.kind != configuration::FlightControllerKind::ardupilot) return {};
    if (flight_controllers_.contains(config.vehicle.id)) return {};  // a user's own
    const std::string name = "fc-" + std::to_string(config.vehicle.id.value);
    auto child = ChildProcess::start(
        flight_controller_command(options_.programs, config, truth_->port(config.vehicle.id),
                                  scenario_.faults),
        options_.run_folder / (name + ".log"), {});
    if (!child) return child.error();
    child->make_realtime();
    flight_controllers_.emplace(config.vehicle.id, std::move(child).value());
    return {};
  }

  /// Empty: to be looked for.
  [[nodiscard]] std::string bus_of(const configuration::ScenarioVehicle& vehicle) const {
    return user_flown(vehicle.spec, vehicle.flight_controller) ? kAutopilotBus : options_.can;
  }

  void hear() {
    while (const auto received = node_->poll()) {
      if (const auto* telemetry = std::get_if<mission::Telemetry>(&received->message)) {
        tell_who_starts_anew(*telemetry);
        last_[telemetry->vehicle] = *telemetry;
        mission_.on_telemetry(*telemetry);
        if (external_.has(telemetry->vehicle)) heard_at_[telemetry->vehicle] = steady_clock::now();
        progress_.vehicles_heard = last_.size();
        if (!outcome_.all_heard_s && last_.size() == scenario_.vehicles.size()) {
          outcome_.all_heard_s =
              std::chrono::duration<double>(steady_clock::now() - started_).count();
          say("all " + std::to_string(last_.size()) + " vehicles heard " +
              seconds_text(*outcome_.all_heard_s) + " after the start; the mission begins at 0 s");
        }
      } else if (const auto* event = std::get_if<mission::MissionEvent>(&received->message)) {
        (void)mission_.on_event(*event);
        sensors_.on_event(*event);
        if (!options_.faults.empty()) outcome_.heard.push_back({mission_now(), *event});
        progress_.sites_done = mission_.sites_done();
        // At its prompt the ground station tells of it.
        if (!options_.prompt && is_news(event->kind())) {
          say(seconds_text(to_seconds(event->time)) + "  " + wording::text_of(*event));
        }
      }
    }
  }

  /// A dead process ends the run; so does a vehicle that nobody has heard when the mission begins.
  void watch(Instant now) {
    for (auto& [id, process] : processes_) {
      if (killed_.contains(id) || reported_.contains(id) || nemesis_.is_down(id)) continue;
      const auto how = process.ended();
      if (!how) continue;
      reported_.insert(id);
      if (options_.prompt && id == kGroundStation && process.clean()) {
        outcome_.quit = true;
        say("the operator has ended the run");
        continue;
      }
      note_death(name_of(id), *how, log_name(id));
    }
    for (auto& [id, process] : flight_controllers_) {
      if (killed_.contains(id) || fc_reported_.contains(id)) continue;
      const auto how = process.ended();
      if (!how) continue;
      fc_reported_.insert(id);
      note_death("the flight controller of " + name_of(id), *how, "fc-" + std::to_string(id.value));
    }
    if (links_ && !links_reported_) {
      if (const auto how = links_->ended()) {
        links_reported_ = true;
        note_death("the program of --links", *how, "links");
      }
    }
    watch_for_silence(now);
  }

  void note_death(const std::string& who, const std::string& how, const std::string& log) {
    outcome_.deaths.push_back(who + " ended by itself: " + how + "; its log is " +
                              (options_.run_folder / (log + ".log")).string());
    say(outcome_.deaths.back());
  }

  void watch_for_silence(Instant now) {
    if (now >= Instant{} && !outcome_.all_heard_s && outcome_.deaths.empty()) {
      std::string missing;
      std::string hosts;
      for (const auto& v : scenario_.vehicles) {
        if (last_.contains(v.spec.id)) continue;
        missing += " " + std::to_string(v.spec.id.value);
        if (const auto* host = external_.host_of(v.spec.id)) {
          hosts += "; vehicle " + std::to_string(v.spec.id.value) + " is on " + host->address +
                   ": do " + host->address + " and " + options_.address +
                   " reach each other by UDP? Its log is on the host";
        }
      }
      outcome_.deaths.push_back("not heard before the mission began: vehicle" + missing + hosts);
      say(outcome_.deaths.back());
    }
    for (const auto& [id, at] : heard_at_) {
      if (steady_clock::now() - at < kExternalSilence || !reported_.insert(id).second) continue;
      outcome_.deaths.push_back(name_of(id) + ", which is external, is not heard any more");
      say(outcome_.deaths.back());
    }
  }

  [[nodiscard]] std::map<VehicleId, Vec2> positions() const {
    std::map<VehicleId, Vec2> at;
    for (const auto& [id, telemetry] : last_) {
      if (!killed_.contains(id)) at.emplace(id, telemetry.state.position().horizontal());
    }
    return at;
  }

  /// Of who is there to see something: its program runs, and has been heard.
  [[nodiscard]] SiteReports::Team team() const {
    SiteReports::Team team;
    for (const auto& [id, telemetry] : last_) {
      const auto ended = ended_.find(id);
      const bool runs = ended == ended_.end() || ended->second != telemetry.instance;
      if (runs && !killed_.contains(id)) team.emplace(id, telemetry);
    }
    return team;
  }

  /// Hazards that have appeared: as it would be by the operator, who goes on telling of them.
  void tell_who_starts_anew(const mission::Telemetry& telemetry) {
    const auto known = last_.find(telemetry.vehicle);
    if (known == last_.end() || known->second.instance == telemetry.instance) return;
    for (const auto& h : scenario_.hazards) {
      if (told_.contains(h.hazard.id)) publish(mission::HazardReport{h.hazard});
    }
  }

  void play_faults(Instant now) {
    if (const auto news = second_ ? second_->play(now) : std::nullopt) say(*news);
    timeline_.play(
        now, [this](Role role) { return having(team(), role); },
        [this, now](const Fault& fault, const std::vector<VehicleId>& who) {
          if (nemesis_.begin(fault, who, now)) {
            for (const VehicleId id : who) {
              if (!nemesis_.is_down(id)) continue;
              sensors_.on_program_end(id);
              if (last_.contains(id)) ended_[id] = last_.at(id).instance;
            }
          } else if (std::holds_alternative<ProgramsEnd>(fault.what)) {
            for (const VehicleId id : who) kill(id, now);
          } else {
            if (std::holds_alternative<Healing>(fault.what)) outcome_.healed_at = now;
            say("fault: " + describe(fault));
          }
          return true;
        });
    if (const auto up = nemesis_.step(now); !up) {
      outcome_.deaths.push_back("cannot be started anew: " + up.error().message);
    }
  }

  void kill(VehicleId id, Instant now) {
    const auto process = processes_.find(id);
    if (process == processes_.end() || !killed_.insert(id).second) return;
    process->second.signal(SIGKILL);
    const auto fc = flight_controllers_.find(id);
    if (!options_.faults.empty()) {
      nemesis_.note_gone(id, now);
    } else if (fc != flight_controllers_.end()) {
      fc->second.signal(SIGKILL);
    }
    outcome_.killed.push_back(id);
    mission_.on_killed(id);
    sensors_.on_program_end(id);
    say("fault: " + name_of(id) + " is killed");
  }

  void move_radio(Instant now) {
    std::set<VehicleId> silent = killed_;
    if (second_) silent.erase(kGroundStation);
    for (const auto& [id, process] : processes_) {
      if (nemesis_.is_down(id)) silent.insert(id);
    }
    radio_.move({positions(), silent, timeline_.interference(), options_.rate, now}, external_,
                links_ ? &*links_ : nullptr);
  }

  void sense(Instant now) {
    for (const auto& report : sensors_.look(team())) {
      publish(report);
      ++progress_.sites_found;
    }
    if (outcome_.healed_at && now >= report_again_at_) {
      report_again_at_ = now + kReportAgain;
      for (const auto& report : sensors_.report_unattended(team())) {
        say("site " + std::to_string(report.site.id.value) + " is reported to " +
            name_of(report.finder));
        publish(report);
      }
    }
    for (const auto& h : scenario_.hazards) {
      if (h.known_before() || now < h.known_from || !told_.insert(h.hazard.id).second) continue;
      publish(mission::HazardReport{h.hazard});
    }
  }

  /// Where the scenario ends on the ground.
  void land_at_the_end(Instant now) {
    if (scenario_.ends != configuration::Ending::landed || !mission_.work_done(now)) return;
    if (const auto news = to_land_.give(control_socket_, now)) say(*news);
  }

  [[nodiscard]] bool finished() {
    if (InterruptWatch::interrupted() || outcome_.quit || !outcome_.deaths.empty()) return true;
    if (progress_.now >= Instant{} + scenario_.duration_max) return true;
    if (!mission_.over(progress_.now) || nemesis_.anybody_down()) return false;
    if (!options_.faults.empty() && !outcome_.healed_at) return false;
    if (!stop_at_) stop_at_ = progress_.now + kAfterwards;
    return progress_.now >= *stop_at_;
  }

  /// What no process of the run says, its recordings must have too.
  void publish(const mission::Message& message) {
    node_->publish(message);
    if (writer_) writer_->write(message, kBench, mission_now());
  }

  BenchOutcome stop() {
    nemesis_.let_go();
    hear();
    outcome_.spans = nemesis_.spans();
    outcome_.last = last_;
    writer_.reset();
    truth_.reset();
    for (const auto& [id, telemetry] : last_) {
      outcome_.control_overruns += telemetry.control_overruns;
      outcome_.messages_dropped += telemetry.messages_dropped;
    }
    // The vehicles first, so that the ground station hears their last words.
    std::vector<ChildProcess*> vehicles;
    for (auto& [id, process] : processes_) {
      const bool is_ground = id == kGroundStation || is_station(id);
      if (!is_ground && !killed_.contains(id)) vehicles.push_back(&process);
    }
    for (std::string& problem : external_.stop()) outcome_.deaths.push_back(std::move(problem));
    const bool clean = stop_all(vehicles, kStopWithin);
    std::vector<ChildProcess*> controllers;
    std::vector<ChildProcess*> autopilots;
    for (auto& [id, process] : flight_controllers_) {
      if (killed_.contains(id) && options_.faults.empty()) continue;
      (user_flown_.contains(id) ? autopilots : controllers).push_back(&process);
    }
    const bool controllers_clean = stop_all(controllers, kStopWithin);
    (void)stop_all(autopilots, kStopWithin);  // how they end is theirs
    std::vector<ChildProcess*> ground;
    for (const VehicleId id : {kGroundStation, SecondStation::kNode}) {
      const auto process = processes_.find(id);
      if (process != processes_.end() && !killed_.contains(id)) ground.push_back(&process->second);
    }
    outcome_.stopped_cleanly = stop_all(ground, kStopWithin) && clean && controllers_clean;
    for (auto& [id, process] : processes_) {
      const auto how = process.ended();
      if (killed_.contains(id) || reported_.contains(id) || !how || process.clean()) continue;
      outcome_.deaths.push_back(name_of(id) + " did not end cleanly when asked: " + *how);
    }
    if (links_ && !links_->stop()) {
      outcome_.deaths.push_back("the program of --links did not end with its input; it is killed");
    }
    outcome_.external = external_.vehicles();
    for (const auto& missing : external_.collect(options_.run_folder)) {
      outcome_.not_collected.push_back(missing.why);
    }
    remove_run_keys(options_.run_folder);
    return outcome_;
  }

  void say(const std::string& news) {
    progress_.news = news;
    if (on_progress_) on_progress_(progress_);
  }

  const configuration::Scenario& scenario_;
  const BenchOptions& options_;
  UserAutopilots autopilots_;
  const std::function<void(const BenchProgress&)>& on_progress_;
  InterruptWatch interrupts_;
  ExternalHosts external_;
  std::optional<LinkListener> links_;
  bool links_reported_ = false;           ///< that it has ended
  std::unique_ptr<TruthRecorder> truth_;  ///< none where no aircraft is simulated
  std::map<VehicleId, ChildProcess> processes_;
  std::optional<SecondStation> second_;  ///< ground station
  std::map<VehicleId, ChildProcess> flight_controllers_;
  std::set<VehicleId> user_flown_;  ///< of these by autopilots of the user's own
  std::unique_ptr<network::Node> node_;
  std::optional<recording::Writer> writer_;  ///< of what the bench itself says
  SiteReports sensors_;
  Instant report_again_at_{};
  steady_clock::time_point started_;
  steady_clock::time_point epoch_;
  std::map<VehicleId, configuration::VehicleConfig> configs_;
  std::map<VehicleId, mission::Telemetry> last_;
  std::map<VehicleId, InstanceId> ended_;  ///< of programs that start anew: which was ended last
  std::map<VehicleId, steady_clock::time_point> heard_at_;  ///< external vehicles
  std::set<HazardId> told_;
  std::set<VehicleId> killed_;
  std::set<VehicleId> reported_;
  std::set<VehicleId> fc_reported_;
  BenchRadio radio_;
  std::optional<Flooder> flooder_;  ///< where the scenario has floods
  FaultTimeline timeline_;
  MissionWatch mission_;
  Nemesis nemesis_;
  std::string control_socket_;  ///< of the ground station
  OrdersToLand to_land_;
  std::optional<Instant> stop_at_;
  BenchProgress progress_;
  BenchOutcome outcome_;
};

}  // namespace

Result<BenchOutcome> fly(const configuration::Scenario& scenario, const BenchOptions& options,
                         const std::function<void(const BenchProgress&)>& on_progress) {
  std::error_code failed;
  if (std::filesystem::exists(options.run_folder, failed) &&
      !std::filesystem::is_empty(options.run_folder, failed) && !failed) {
    return Error{options.run_folder.string() +
                 ": there is something in it already, perhaps an earlier run; name another --out, "
                 "or remove it"};
  }
  std::filesystem::create_directories(options.run_folder, failed);
  if (failed) return Error{options.run_folder.string() + ": cannot be made: " + failed.message()};
  auto external = ExternalHosts::make(scenario, options.external);
  if (!external) return external.error();
  configuration::Scenario here = scenario;
  give_buses(here, *external);
  auto autopilots =
      user_autopilots(options.autopilots, options.autopilot_parameters, options.autopilot_model);
  if (!autopilots) return autopilots.error();
  if (const auto possible = check_options(here, options, *external, *autopilots); !possible) {
    return possible.error();
  }
  Bench bench{here, options, std::move(external).value(), std::move(autopilots).value(),
              on_progress};
  if (const auto started = bench.start(); !started) return started.error();
  return bench.run();
}

}  // namespace skein::hil
