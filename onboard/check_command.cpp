// SPDX-License-Identifier: Apache-2.0
#include "check_command.hpp"

#include <cstdio>
#include <utility>

#include "check_makers.hpp"
#include "skein/configuration/vehicle_config.hpp"

namespace skein::onboard {
namespace {

constexpr int kExitFails = 1;

}  // namespace

CheckCommand::CheckCommand(CLI::App& app) {
  check_ = app.add_subcommand("check", "Looks at all that a flight needs, before it");
  check_->add_option("--config", config_, "The vehicle's configuration, YAML")->required();
  check_->add_flag("--json", json_, "For programs");
  check_->footer(
      "A line for each thing that was looked at: ok, warn or FAIL, what, and what to do. It asks\n"
      "the autopilot and changes nothing there: no setpoint, no mode, no HEARTBEAT. Exit status\n"
      "0: nothing fails, 1: something does, 2: bad arguments.\n"
      "Example:\n"
      "  skein-onboard check --config /etc/skein/onboard-1.yaml");
}

int CheckCommand::run() const {
  const auto config = configuration::load_vehicle_config(config_);
  Checks checks;
  if (config) {
    checks = check_before_flight(*config);
  } else {
    checks.push_back(fail("configuration", config_, config.error().message));
  }
  std::fputs(json_ ? (json_of(checks) + "\n").c_str() : text_of(checks).c_str(), stdout);
  return is_good(checks) ? 0 : kExitFails;
}

}  // namespace skein::onboard
