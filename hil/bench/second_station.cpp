// SPDX-License-Identifier: Apache-2.0
#include "second_station.hpp"

#include <system_error>

#include "skein/groundstation/control_socket.hpp"
#include "skein/groundstation/ground_process.hpp"
#include "skein/identity/team.hpp"

namespace skein::hil {
namespace {

constexpr auto kAnswerWithin = std::chrono::milliseconds{1000};
constexpr Duration kAgain = std::chrono::seconds{2};
constexpr const char* kOperators = "operators";

}  // namespace

std::string name_of(VehicleId node) {
  if (is_station(node)) return "ground station " + std::to_string(station_number(node));
  return node == kGroundStation ? "the ground station" : "vehicle " + std::to_string(node.value);
}

std::string log_name(VehicleId node) {
  if (is_station(node)) return "ground-" + std::to_string(station_number(node));
  return node == kGroundStation ? "ground" : "vehicle-" + std::to_string(node.value);
}

Result<configuration::GroundConfig> SecondStation::join(configuration::GroundConfig& first,
                                                        const std::filesystem::path& run_folder,
                                                        bool sealed) {
  first.command = {1, "ground-1", false};
  configuration::GroundConfig second = first;
  second.command = {2, "ground-2", true};
  second.control_socket = groundstation::control_socket_of(first) + "-2";
  second.agencies = {};
  if (second.console.port != 0) ++second.console.port;
  second.recording_folder = (std::filesystem::absolute(run_folder) / log_name(kNode)).string();
  if (!sealed) return second;
  const std::filesystem::path ours = first.network.keys;
  const auto theirs = identity::node_folder(ours.parent_path(), kNode);
  second.network.keys = theirs.string();
  std::error_code failed;
  std::filesystem::copy(ours / kOperators, theirs / kOperators,
                        std::filesystem::copy_options::recursive, failed);
  if (failed) return Error{"the operator's key for " + name_of(kNode) + ": " + failed.message()};
  return second;
}

std::optional<std::string> SecondStation::play(Instant now) {
  if (!next_ || now < *next_) return std::nullopt;
  const auto answer = groundstation::ask(control_socket_, "take command", kAnswerWithin);
  if (answer && answer->done) {
    next_.reset();
    return name_of(kNode) + " takes the command";
  }
  next_ = now + kAgain;
  return name_of(kNode) +
         " does not take the command: " + (answer ? answer->text : answer.error().message);
}

}  // namespace skein::hil
