// SPDX-License-Identifier: Apache-2.0
#include "external_hosts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <future>
#include <iterator>
#include <utility>

#include "flight_controllers.hpp"
#include "skein/fleet/remote.hpp"
#include "skein/hil/radio/link_table.hpp"
#include "skein/identity/node_key.hpp"
#include "skein/recording/recording.hpp"

namespace skein::hil {
namespace {

using configuration::FlightControllerKind;
using configuration::Host;
using configuration::HostFlightController;
using configuration::VehicleConfig;

/// Of a host: half of what the protocol allows two clocks to differ, by default.
constexpr double kClockOffMax_s = 0.25;

/// Of one run, so that what an earlier one left is not fetched again; within the program's own
/// folder, since it may have the right to write there only.
std::string recordings_of(const Host& host, const VehicleConfig& config) {
  return fmt::format("{}/run-{}", fleet::recordings_of(host), config.time.epoch_unix_ns);
}

Result<std::string> text_of(const std::filesystem::path& file) {
  std::ifstream stream{file};
  std::string text{std::istreambuf_iterator<char>{stream}, {}};
  if (!stream) return Error{"cannot read " + file.string()};
  return text;
}

bool is_on_can(const configuration::FlightControllerConfig& fc) {
  return fc.kind == FlightControllerKind::ardupilot;
}

/// Flies the vehicle in place of a flight controller.
fleet::Program emulator_of(const Host& host, const VehicleConfig& config) {
  fleet::Program program;
  program.host = host;
  program.name = fmt::format("fc-{}", host.node.value);
  program.command = flight_controller_command(host.programs, config, {}, {});
  const auto& fc = config.flight_controller.ardupilot;
  program.mark = fmt::format("skein-fc --bus {} --node {} ", fc.can, fc.node_id);
  program.realtime = true;
  return program;
}

/// Calls it for every element at once; the outcomes are in their order.
template <class Element, class Do>
auto at_once(std::vector<Element>& elements, Do what) {
  std::vector<std::future<decltype(what(elements.front()))>> under_way;
  under_way.reserve(elements.size());
  for (Element& element : elements) {
    under_way.push_back(
        std::async(std::launch::async, [&element, &what] { return what(element); }));
  }
  std::vector<decltype(what(elements.front()))> outcomes;
  outcomes.reserve(under_way.size());
  for (auto& one : under_way) outcomes.push_back(one.get());
  return outcomes;
}

}  // namespace

Result<ExternalHosts> ExternalHosts::make(const configuration::Scenario& scenario,
                                          const std::vector<VehicleId>& vehicles) {
  std::vector<Host> hosts;
  std::optional<Host> ground;
  for (const VehicleId id : vehicles) {
    const std::string who = fleet::name_of(id);
    const auto host = std::find_if(scenario.hosts.begin(), scenario.hosts.end(),
                                   [id](const Host& h) { return h.node == id; });
    if (id == kGroundStation) {
      if (host == scenario.hosts.end() || !host->ssh.empty()) {
        return Error{
            "the ground station runs on this machine; as external it has a host without ssh, whose "
            "run names its network, such as `ip netns exec ground`"};
      }
      ground = *host;
      continue;
    }
    const auto vehicle = std::find_if(scenario.vehicles.begin(), scenario.vehicles.end(),
                                      [id](const auto& v) { return v.spec.id == id; });
    if (vehicle == scenario.vehicles.end()) {
      return Error{"--external names " + who + ", which is not in the scenario"};
    }
    if (host == scenario.hosts.end()) {
      return Error{who +
                   " is external and has no host; add it under hosts, or name the fleet's "
                   "file by --fleet"};
    }
    if (is_on_can(vehicle->flight_controller) && host->can.empty()) {
      return Error{who + " has a flight controller on CAN; name its bus in its host's can"};
    }
    const auto happens = [&scenario, id](configuration::FaultKind kind) {
      return std::ranges::any_of(scenario.faults, [kind, id](const auto& fault) {
        return fault.kind == kind && fault.vehicle == id;
      });
    };
    using enum configuration::FaultKind;
    if (happens(kill_vehicle)) return Error{"a fault kills " + who + "; leave it on the bench"};
    if (happens(battery)) {
      return Error{"a fault is of the battery of " + who + "; leave it on the bench"};
    }
    hosts.push_back(*host);
  }
  ExternalHosts external{std::move(hosts)};
  external.ground_ = std::move(ground);
  if (!external.empty()) {
    auto feed = radio::FeedSender::open();
    if (!feed) return feed.error();
    external.feed_.emplace(std::move(feed).value());
  }
  return external;
}

ExternalHosts::ExternalHosts(ExternalHosts&&) noexcept = default;

ExternalHosts::~ExternalHosts() { (void)stop(); }

const Host* ExternalHosts::host_of(VehicleId vehicle) const {
  const auto found = std::find_if(hosts_.begin(), hosts_.end(),
                                  [vehicle](const Host& host) { return host.node == vehicle; });
  return found == hosts_.end() ? nullptr : &*found;
}

std::map<VehicleId, std::string> ExternalHosts::addresses() const {
  std::map<VehicleId, std::string> all;
  if (ground_) all.emplace(ground_->node, ground_->address);
  for (const Host& host : hosts_) all.emplace(host.node, host.address);
  return all;
}

Result<void> ExternalHosts::start(const std::vector<VehicleConfig>& configs) {
  for (const VehicleConfig& given : configs) {
    const Host* const host = host_of(given.vehicle.id);
    if (host == nullptr) continue;
    VehicleConfig config = given;
    const std::filesystem::path keys = given.network.keys;  // of the bench's making
    config.recording_folder = recordings_of(*host, config);
    if (!keys.empty()) config.network.keys = config.recording_folder + "/keys";
    config.network.transport_plugin = host->radio_plugin;
    Started& started = started_.emplace_back();
    started.host = *host;
    started.recordings = config.recording_folder;
    started.aircraft =
        is_on_can(config.flight_controller) && host->flight_controller == HostFlightController::own;
    if (is_on_can(config.flight_controller) &&
        host->flight_controller == HostFlightController::emulated) {
      started.programs.push_back(emulator_of(*host, config));
    }
    started.programs.push_back(fleet::program_of(*host, to_yaml(config)));
    if (keys.empty()) continue;
    for (const char* name :
         {identity::kNodeKeyFile, identity::kMembershipFile, identity::kStartsFile}) {
      auto text = text_of(keys / name);
      if (!text) return text.error();
      started.programs.back().more.push_back(
          {config.network.keys + "/" + name, std::move(*text), true});
    }
  }
  for (const Result<void>& up : at_once(started_, &ExternalHosts::bring_up)) {
    if (!up) return up;
  }
  return {};
}

Result<void> ExternalHosts::bring_up(Started& started) {
  const fleet::Program& companion = started.programs.back();
  const fleet::Status there = fleet::status(companion);
  if (!there.reachable) return Error{there.trouble};
  if (std::abs(there.clock_offset_s) > kClockOffMax_s) {
    return Error{fmt::format("the clock of the host of {} is {:+.1f} s off; set it, as by NTP",
                             fleet::name_of(started.host.node), there.clock_offset_s)};
  }
  // The companion's configuration first, which is refused where it flies.
  if (auto pushed = fleet::push(companion, false); !pushed) return pushed;
  started.ours = true;
  for (const fleet::Program& program : started.programs) {
    if (auto up = fleet::start(program); !up) return up;
  }
  return {};
}

void ExternalHosts::tell(const radio::Hearing& hearing) const {
  const Host* const host = host_of(hearing.self);
  if (host != nullptr && feed_) feed_->send(hearing, host->address);
}

std::vector<std::string> ExternalHosts::stop() {
  std::vector<std::string> problems;
  const auto ended = at_once(started_, [](Started& started) {
    std::string problem;
    if (!started.ours) return problem;
    std::for_each(started.programs.rbegin(), started.programs.rend(),
                  [&](const fleet::Program& program) {
                    const auto stopped = fleet::stop(program, !started.aircraft);
                    if (!stopped && problem.empty()) problem = stopped.error().message;
                  });
    started.ours = false;
    return problem;
  });
  for (const std::string& problem : ended) {
    if (!problem.empty()) problems.push_back(problem);
  }
  return problems;
}

std::vector<ExternalHosts::Missing> ExternalHosts::collect(
    const std::filesystem::path& run_folder) {
  std::vector<Missing> missing;
  for (const Started& started : started_) {
    const auto folder = run_folder / recording::folder_name(started.host.node);
    const auto done = fleet::collect(started.host, started.recordings, folder);
    if (done) {
      (void)fleet::remove(started.host, started.recordings);  // what is left is in nobody's way
      continue;
    }
    std::error_code failure;
    std::filesystem::remove_all(folder, failure);
    missing.push_back({started.host.node, done.error().message});
  }
  return missing;
}

void give_buses(configuration::Scenario& scenario, const ExternalHosts& hosts) {
  for (auto& vehicle : scenario.vehicles) {
    const Host* const host = hosts.host_of(vehicle.spec.id);
    if (host == nullptr || !is_on_can(vehicle.flight_controller)) continue;
    // An emulated one is as the bench's own: node ids and take-over are for the bench to choose.
    vehicle.flight_controller.ardupilot.can =
        host->flight_controller == HostFlightController::own ? host->can : "";
  }
}

}  // namespace skein::hil
