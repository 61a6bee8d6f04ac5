// SPDX-License-Identifier: Apache-2.0
#include "link_params.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>

namespace skein::onboard {
namespace {

/// Who can read it can fly the aircraft.
Result<mavlink::SigningKey> read_signing_key(const std::string& file) {
  const std::string what = "flight_controller.signing_key: " + file + ": ";
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) {
    return Error{what + std::generic_category().message(errno)};
  }
  if (!S_ISREG(status.st_mode)) return Error{what + "is no file"};
  if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    return Error{fmt::format("{}others may read it, too (mode {:04o}); chmod 600 {}", what,
                             status.st_mode & 07777U, file)};
  }
  std::ifstream in{file};
  const std::string text{std::istreambuf_iterator<char>{in}, {}};
  if (!in) return Error{what + "cannot be read"};
  auto key = mavlink::key_from_text(text);
  if (!key) return Error{what + key.error().message};
  return key;
}

}  // namespace

Result<ardupilot::CanLinkParams> can_params(const configuration::VehicleConfig& config,
                                            std::int64_t unix_us) {
  const configuration::ArdupilotConfig& fc = config.flight_controller.ardupilot;
  ardupilot::CanLinkParams params;
  params.node_id = fc.node_id;
  params.companion_node_id = fc.companion_node_id;
  params.serial_id = fc.serial_id;
  ardupilot::CompanionParams& companion = params.companion;
  companion.vehicle = config.vehicle;
  companion.fence = config.fence;
  companion.remote_id = config.remote_id;
  companion.unix_us = unix_us;
  companion.system_id = fc.system_id;
  switch (fc.take_over) {
    case configuration::TakeOverKind::in_flight:
      companion.take_over = ardupilot::TakeOver::in_flight;
      break;
    case configuration::TakeOverKind::from_ground:
      companion.take_over = ardupilot::TakeOver::from_ground;
      break;
    case configuration::TakeOverKind::when_guided:
    case configuration::TakeOverKind::count:
      companion.take_over = ardupilot::TakeOver::when_guided;
      break;
  }
  companion.takeoff_height_m = fc.takeoff_height_m;
  companion.geoid_height_m = fc.geoid_height_m;
  if (!fc.signing_key.empty()) {
    const auto key = read_signing_key(fc.signing_key);
    if (!key) return key.error();
    companion.signing = mavlink::Signing{*key, unix_us};
  }
  return params;
}

}  // namespace skein::onboard
