// SPDX-License-Identifier: Apache-2.0
#include "ground_start.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "skein/groundstation/recall.hpp"
#include "skein/identity/operator_key.hpp"
#include "skein/version/version.hpp"

namespace skein::groundstation {
namespace {

std::string who_decides(const configuration::GroundConfig& config,
                        const std::string& operator_name) {
  if (!config.operator_decisions.empty()) return "with decisions scripted by the scenario";
  return "decisions by " + operator_name;
}

}  // namespace

void serve_console(ConsoleDesk& console, const configuration::GroundConfig& config,
                   std::int64_t epoch_unix_ns, OperatorKeys& keys, process::Wake& wake) {
  if (config.console.port == 0) return;
  if (const auto served = console.serve(config, epoch_unix_ns, keys, [&wake] { wake.notify(); });
      !served) {
    spdlog::warn("there is no console: {}", served.error().message);
  } else {
    spdlog::info(
        "console: {} (`console` at the prompt, or 'skein-ground tell console': what opens it)",
        console.url());
  }
}

/// None, and a warning, where it cannot be had.
std::unique_ptr<ControlSocket> open_control(const configuration::GroundConfig& config,
                                            process::Wake& wake) {
  auto control = ControlSocket::open(control_socket_of(config), [&wake] { wake.notify(); });
  if (control) return std::move(*control);
  spdlog::warn("takes no orders from other programs: {}", control.error().message);
  return nullptr;
}

void recall_mission(const configuration::GroundConfig& config, std::int64_t epoch_unix_ns,
                    mission::GroundNode& ground, ConsoleDesk& console) {
  if (config.recording_folder.empty()) return;
  const std::size_t messages =
      recall(config.recording_folder, epoch_unix_ns, ground,
             [&console](const mission::Message& message, VehicleId sender, Instant at) {
               console.recall(message, sender, at);
             });
  if (messages == 0) return;
  spdlog::info("goes on with this mission: {} messages of its recording are recalled", messages);
}

/// By the password that was typed, or lies in a file.
Result<void> unlock_first(OperatorKeys& keys, const configuration::OperatorConfig& config,
                          const Login& login) {
  if (login.password) return keys.unlock_machine(login.name, *login.password);
  if (config.name.empty()) return {};
  auto password = identity::read_password(config.password_file);
  if (!password) return Error{"operator.password_file: " + password.error().message};
  const auto unlocked = keys.unlock_machine(config.name, *password);
  identity::wipe(*password);
  return unlocked;
}

std::optional<AuditKey> audit_key(const process::NodeStart& start) {
  if (!start.identity) return std::nullopt;
  return AuditKey{start.identity->signer(), start.identity->own(), start.instance};
}

void log_start(const configuration::GroundConfig& config, const process::NodeStart& start,
               const std::string& operator_name) {
  spdlog::info("ground station of {} vehicles, {}, {}; type help", config.vehicles.size(),
               process::how_it_speaks(start), who_decides(config, operator_name));
}

void log_summary(const network::Node& node, const mission::GroundNode& ground) {
  const auto traffic = process::traffic_of(node);
  spdlog::info(
      "ended: messages sent {}, received {}, dropped {}, refused of their senders {}; datagrams of "
      "strangers {}, decisions unproven {}; network restarted {} times, messages not sent "
      "meanwhile {}",
      traffic.sent, traffic.received, traffic.dropped + ground.dropped(), ground.refused(),
      traffic.of_strangers, traffic.unproven, traffic.restarts, traffic.unconnected);
  process::log_air(node);
}

/// None without keys.
std::unique_ptr<process::KeyWatch> watch_keys(process::NodeStart& start,
                                              const configuration::NetworkConfig& config,
                                              StationNetwork& network,
                                              process::KeyWatch::OnTold on_told) {
  if (!start.identity) return nullptr;
  return std::make_unique<process::KeyWatch>(
      network.ear(), std::move(*start.identity), config.keys, std::move(on_told),
      [&network](const auto& revoked, const auto& key, Duration old_for) {
        network.on_key(revoked, key, old_for);
      });
}

Result<Recorder> open_recorder(const configuration::GroundConfig& config, InstanceId instance,
                               std::int64_t epoch_unix_ns) {
  recording::Writer::Options options;
  options.session = {kGroundStation, instance,      "skein-ground",
                     version(),      epoch_unix_ns, to_yaml(config)};
  options.bytes_max = config.recording_limit_mb * 1'000'000ULL;
  return Recorder::open(config.recording_folder, std::move(options));
}

}  // namespace skein::groundstation
