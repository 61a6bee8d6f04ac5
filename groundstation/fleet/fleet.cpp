// SPDX-License-Identifier: Apache-2.0
#include "skein/fleet/fleet.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "skein/configuration/deployment.hpp"
#include "skein/configuration/shape_file.hpp"
#include "skein/configuration/track_file.hpp"

namespace skein::fleet {

using configuration::FlightControllerKind;
using configuration::Host;
using configuration::Scenario;
using configuration::ScenarioVehicle;

std::string name_of(VehicleId node) {
  return node == kGroundStation ? "the ground station" : fmt::format("vehicle {}", node.value);
}

namespace {

std::string short_name(VehicleId node) {
  return node == kGroundStation ? "ground" : fmt::format("onboard-{}", node.value);
}

/// Hosts with the same are one machine.
std::pair<std::string, std::string> machine_of(const Host& host) { return {host.ssh, host.run}; }

bool is_loopback(const std::string& address) {
  in_addr parsed{};
  ::inet_pton(AF_INET, address.c_str(), &parsed);
  return ntohl(parsed.s_addr) >> 24U == 127;
}

/// What the files of a formation hold, by the paths that they get on the ground station's host.
struct FormationFiles {
  std::vector<HostFile> files;
  std::vector<std::string> problems;
};

class FormationFilesReader {
 public:
  explicit FormationFilesReader(const Host& ground)
      : folder_{ground.configurations + "/formation/"} {}

  /// Names the file's path on the host in `shape`.
  template <class Named, class Load>
  void take(Named& named, Load load) {
    const auto loaded = load(named.file);
    if (!loaded) {
      read_.problems.push_back(loaded.error().message);
      return;
    }
    const std::string path = folder_ + std::filesystem::path{named.file}.filename().string();
    const auto [other, is_new] = from_.emplace(path, named.file);
    if (is_new) {
      read_.files.push_back({path, to_yaml(*loaded)});
    } else if (other->second != named.file) {
      read_.problems.push_back(
          fmt::format("formation: {} and {} have one name, and go into one folder; rename one",
                      other->second, named.file));
    }
    named.file = path;
  }
  [[nodiscard]] FormationFiles read() && { return std::move(read_); }

 private:
  std::string folder_;
  std::map<std::string, std::string> from_;
  FormationFiles read_;
};

/// As take() says; the formation's names are changed.
FormationFiles formation_files(configuration::FormationConfig& formation, const Host& ground) {
  FormationFilesReader reader{ground};
  for (auto& shape : formation.shapes) reader.take(shape, configuration::load_shape);
  for (auto& track : formation.tracks) reader.take(track, configuration::load_track);
  return std::move(reader).read();
}

const Host* host_of(const Scenario& scenario, VehicleId node) {
  const auto found = std::find_if(scenario.hosts.begin(), scenario.hosts.end(),
                                  [node](const Host& host) { return host.node == node; });
  return found == scenario.hosts.end() ? nullptr : &*found;
}

/// Collects the problems of a fleet.
class Check {
 public:
  explicit Check(const Scenario& scenario) : s_{scenario} {}

  std::vector<std::string> run() {
    if (s_.hosts.empty()) {
      return {"the file names no hosts; add them under hosts (docs/fleet.md)"};
    }
    check_members();
    check_addresses();
    for (const Host& host : s_.hosts) check_ways(host);
    check_buses();
    check_console();
    check_formation();
    return std::move(problems_);
  }

 private:
  template <class... Words>
  void problem(fmt::format_string<Words...> text, Words&&... words) {
    problems_.push_back(fmt::format(text, std::forward<Words>(words)...));
  }

  void check_members() {
    if (host_of(s_, kGroundStation) == nullptr) {
      problem("the ground station (vehicle: 0) has no host; add one");
    }
    for (const ScenarioVehicle& vehicle : s_.vehicles) {
      if (host_of(s_, vehicle.spec.id) != nullptr) continue;
      problem("vehicle {} has no host; add one", vehicle.spec.id.value);
    }
    for (const Host& host : s_.hosts) {
      const bool known =
          host.node == kGroundStation ||
          std::any_of(s_.vehicles.begin(), s_.vehicles.end(),
                      [&](const ScenarioVehicle& v) { return v.spec.id == host.node; });
      if (!known) {
        problem("there is a host of vehicle {}, which is not in the fleet; take it away",
                host.node.value);
      }
    }
  }

  void check_addresses() {
    std::map<std::string, const Host*> first;
    const bool spread = std::any_of(s_.hosts.begin(), s_.hosts.end(), [&](const Host& host) {
      return machine_of(host) != machine_of(s_.hosts.front());
    });
    for (const Host& host : s_.hosts) {
      if (spread && is_loopback(host.address)) {
        problem(
            "the host of {} has the address {}, where other machines do not reach it; write the "
            "one of its mission network",
            name_of(host.node), host.address);
      }
      const auto [other, is_new] = first.emplace(host.address, &host);
      if (!is_new && machine_of(*other->second) != machine_of(host)) {
        problem("the hosts of {} and {} are two machines with one address, {}; mend one",
                name_of(other->second->node), name_of(host.node), host.address);
      }
    }
  }

  void check_ways(const Host& host) {
    if (host.ssh.find_first_of(" \t\n'\"") != std::string::npos ||
        (!host.ssh.empty() && host.ssh.front() == '-')) {
      problem("the host of {} has ssh: {}, which is no user@name; mend it", name_of(host.node),
              host.ssh);
    }
  }

  void check_buses() {
    std::map<std::pair<std::pair<std::string, std::string>, std::pair<std::string, int>>, VehicleId>
        taken;
    for (const ScenarioVehicle& vehicle : s_.vehicles) {
      const Host* const host = host_of(s_, vehicle.spec.id);
      if (host == nullptr) continue;
      const auto& fc = vehicle.flight_controller;
      if (fc.kind != FlightControllerKind::ardupilot) {
        if (!host->can.empty()) {
          problem("the host of vehicle {} names the bus {}, but its flight controller is simulated",
                  vehicle.spec.id.value, host->can);
        }
        continue;
      }
      const std::string bus = host->can.empty() ? fc.ardupilot.can : host->can;
      if (bus.empty()) {
        problem("vehicle {} has an ardupilot on no bus; name one in its host's can",
                vehicle.spec.id.value);
        continue;
      }
      for (const int node : {int{fc.ardupilot.node_id}, int{fc.ardupilot.companion_node_id}}) {
        const auto [other, is_new] =
            taken.emplace(std::pair{machine_of(*host), std::pair{bus, node}}, vehicle.spec.id);
        if (is_new) continue;
        problem("vehicles {} and {} have node {} on one bus, {}; give each node its own id",
                other->second.value, vehicle.spec.id.value, node, bus);
      }
    }
  }

  void check_console() {
    const auto& console = s_.console;
    if (console.port == 0) return;
    const bool here = is_loopback(console.address) || console.address == "::1";
    if (!here && (console.passwords.empty() || console.certificate.empty())) {
      problem(
          "console.address is {}, where everybody reaches it; give console passwords, certificate "
          "and key, or leave the address out",
          console.address);
    }
    std::vector<std::pair<std::string, std::string>> files{{"passwords", console.passwords},
                                                           {"certificate", console.certificate},
                                                           {"key", console.key},
                                                           {"tiles", console.tiles}};
    for (const auto& overlay : console.overlays) files.emplace_back("overlays", overlay.file);
    for (const auto& [key, file] : files) {
      if (file.empty() || file.front() == '/') continue;
      problem(
          "console.{} is {}: a file on the ground station's host, which is not pushed; write its "
          "path there, from /",
          key, file);
    }
  }

  void check_formation() {
    const Host* const ground = host_of(s_, kGroundStation);
    if (ground == nullptr) return;
    auto formation = s_.formation;
    auto files = formation_files(formation, *ground);
    problems_.insert(problems_.end(), files.problems.begin(), files.problems.end());
  }

  const Scenario& s_;
  std::vector<std::string> problems_;
};

configuration::Deployment deployment_of(const Scenario& scenario, std::int64_t epoch_unix_ns) {
  configuration::Deployment deployment;
  deployment.port_base = scenario.air_port;
  deployment.time.epoch_unix_ns = epoch_unix_ns;
  for (const Host& host : scenario.hosts) {
    deployment.elsewhere.emplace(host.node, host.address);
  }
  return deployment;
}

/// Where detectors on board tell what they see: with the unit's other sockets, if it is one.
std::string detections_socket_of(const Host& host) {
  return fmt::format("{}/detections-{}.sock",
                     host.programs.empty() ? "/run/skein" : host.recordings, host.node.value);
}

/// What the hosts read must be what was meant.
Result<void> read_again(const Program& program) {
  const auto outcome = [](const auto& read) {
    return read ? Result<void>{} : Result<void>{read.error()};
  };
  return program.is_ground()
             ? outcome(configuration::parse_ground_config(program.configuration, program.name))
             : outcome(configuration::parse_vehicle_config(program.configuration, program.name));
}

}  // namespace

Program program_of(const Host& host, std::string configuration) {
  Program program;
  const bool ground = host.node == kGroundStation;
  program.host = host;
  program.name = short_name(host.node);
  program.unit =
      ground ? "skein-ground.service" : fmt::format("skein-onboard@{}.service", host.node.value);
  program.file = host.configurations + "/" + program.name + ".yaml";
  program.configuration = std::move(configuration);
  const std::string binary = ground ? "skein-ground" : "skein-onboard";
  program.command = {host.programs.empty() ? binary : host.programs + "/" + binary, "--config",
                     program.file};
  program.mark = binary + " --config " + program.file;
  return program;
}

std::string recordings_of(const Host& host) {
  return host.recordings + "/" + short_name(host.node);
}

std::string keys_of(const Host& host) { return recordings_of(host) + "/keys"; }

std::vector<std::string> problems(const Scenario& scenario) { return Check{scenario}.run(); }

Result<std::vector<Program>> render(const Scenario& scenario, std::int64_t epoch_unix_ns) {
  if (const auto found = problems(scenario); !found.empty()) {
    return Error{fmt::format("{}", fmt::join(found, "\n"))};
  }
  Scenario fleet = scenario;
  fleet.operator_decisions.clear();
  fleet.formation.script.clear();
  const Host& ground_host = *host_of(scenario, kGroundStation);
  const FormationFiles files = formation_files(fleet.formation, ground_host);
  for (ScenarioVehicle& vehicle : fleet.vehicles) {
    const Host& host = *host_of(scenario, vehicle.spec.id);
    if (!host.can.empty()) vehicle.flight_controller.ardupilot.can = host.can;
  }
  const configuration::Deployment deployment = deployment_of(fleet, epoch_unix_ns);
  auto ground = configuration::ground_config(fleet, deployment);
  ground.console = fleet.console;
  ground.recording_folder = recordings_of(ground_host);
  ground.network.keys = keys_of(ground_host);
  std::vector<Program> programs;
  programs.push_back(program_of(ground_host, to_yaml(ground)));
  programs.back().more = files.files;
  for (auto& config : configuration::vehicle_configs(fleet, deployment)) {
    const Host& host = *host_of(scenario, config.vehicle.id);
    config.recording_folder = recordings_of(host);
    config.network.keys = keys_of(host);
    config.detections_socket = detections_socket_of(host);
    programs.push_back(program_of(host, to_yaml(config)));
  }
  for (const Program& program : programs) {
    if (const auto good = read_again(program); !good) return good.error();
  }
  return programs;
}

Result<std::vector<VehicleId>> parse_ids(std::string_view text) {
  const Error wrong{fmt::format("'{}' names no vehicles; write ids such as 1-5,9", text)};
  const auto number = [](std::string_view word) -> std::optional<std::uint16_t> {
    std::uint16_t value = 0;
    const auto end = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end.ec != std::errc{} || end.ptr != word.data() + word.size()) return std::nullopt;
    return value;
  };
  std::set<VehicleId> ids;
  while (true) {
    const std::string_view part = text.substr(0, text.find(','));
    const auto dash = part.find('-');
    const auto first = number(part.substr(0, dash));
    const auto last = dash == std::string_view::npos ? first : number(part.substr(dash + 1));
    if (!first || !last || *first > *last) return wrong;
    for (int id = *first; id <= *last; ++id) ids.insert(VehicleId{static_cast<std::uint16_t>(id)});
    if (part.size() == text.size()) break;
    text.remove_prefix(part.size() + 1);
  }
  return std::vector<VehicleId>{ids.begin(), ids.end()};
}

}  // namespace skein::fleet
