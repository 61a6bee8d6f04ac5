// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "skein/configuration/ground_config.hpp"
#include "skein/groundstation/audit.hpp"
#include "skein/groundstation/console_desk.hpp"
#include "skein/groundstation/control_socket.hpp"
#include "skein/groundstation/ground_process.hpp"
#include "skein/groundstation/operator_keys.hpp"
#include "skein/groundstation/recorder.hpp"
#include "skein/mission/ground_node.hpp"
#include "skein/process/key_watch.hpp"
#include "skein/process/mission_network.hpp"
#include "skein/process/wake.hpp"
#include "station_network.hpp"

/// What run() makes before its loop begins, and tells the log before and after.
namespace skein::groundstation {

void serve_console(ConsoleDesk& console, const configuration::GroundConfig& config,
                   std::int64_t epoch_unix_ns, OperatorKeys& keys, process::Wake& wake);
/// None, and a warning, where it cannot be had.
std::unique_ptr<ControlSocket> open_control(const configuration::GroundConfig& config,
                                            process::Wake& wake);
void recall_mission(const configuration::GroundConfig& config, std::int64_t epoch_unix_ns,
                    mission::GroundNode& ground, ConsoleDesk& console);
/// By the password that was typed, or lies in a file.
Result<void> unlock_first(OperatorKeys& keys, const configuration::OperatorConfig& config,
                          const Login& login);
std::optional<AuditKey> audit_key(const process::NodeStart& start);
void log_start(const configuration::GroundConfig& config, const process::NodeStart& start,
               const std::string& operator_name);
void log_summary(const network::Node& node, const mission::GroundNode& ground);
/// None without keys.
std::unique_ptr<process::KeyWatch> watch_keys(process::NodeStart& start,
                                              const configuration::NetworkConfig& config,
                                              StationNetwork& network,
                                              process::KeyWatch::OnTold on_told);
Result<Recorder> open_recorder(const configuration::GroundConfig& config, InstanceId instance,
                               std::int64_t epoch_unix_ns);

}  // namespace skein::groundstation
