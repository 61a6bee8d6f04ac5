// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "check_command.hpp"
#include "key_commands.hpp"
#include "skein/command_line/read.hpp"
#include "skein/configuration/vehicle_config.hpp"
#include "skein/network/carrier_process.hpp"
#include "skein/onboard/status.hpp"
#include "skein/onboard/vehicle_process.hpp"
#include "skein/process/log.hpp"
#include "skein/process/mission_network.hpp"
#include "skein/version/version.hpp"

namespace {

namespace onboard = skein::onboard;
using skein::hal::Airborne;

constexpr std::chrono::seconds kAnswerWithin{5};

// What `status --flying` ends with: the packages' scripts read it.
constexpr int kMayFly = 0;
constexpr int kOnGround = 1;
constexpr int kNobodyThere = 3;
constexpr int kNotKnown = 4;

struct Arguments {
  std::string config;
  bool check_only = false;
  onboard::HostOptions host;
};

struct StatusArguments {
  std::string socket;
  bool json = false;
  bool flying = false;
};

int fail(const std::string& why, int status) {
  std::fprintf(stderr, "skein-onboard: %s\n", why.c_str());
  return status;
}

int fly(const Arguments& arguments) {
  if (arguments.config.empty()) {
    return fail("--config is required; --help has an example", skein::process::kExitBadInput);
  }
  const auto config = skein::configuration::load_vehicle_config(arguments.config);
  if (!config) return fail(config.error().message, skein::process::kExitBadInput);
  if (arguments.check_only) {
    std::printf("%s: good, vehicle %u\n", arguments.config.c_str(),
                static_cast<unsigned>(config->vehicle.id.value));
    const auto starts = skein::process::check_start(config->network, config->vehicle.id);
    if (!starts)
      std::fprintf(stderr, "it would not start here: %s\n", starts.error().message.c_str());
    return 0;
  }
  return onboard::fly(*config, arguments.host);
}

/// Of this host's vehicles.
std::vector<std::string> sockets() {
  std::vector<std::string> found;
  std::error_code failed;
  for (std::filesystem::directory_iterator file{onboard::kStatusSockets, failed}, end;
       !failed && file != end; file.increment(failed)) {
    const std::string name = file->path().filename();
    if (name.starts_with("onboard-") && name.ends_with(".sock")) found.push_back(file->path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

int show_status(const std::string& socket, const StatusArguments& arguments) {
  const auto asked = onboard::ask_status(socket, kAnswerWithin);
  if (asked.failed == onboard::NoStatus::nobody_there) {
    return fail("no process of a vehicle has the status socket " + socket, kNobodyThere);
  }
  if (asked.failed == onboard::NoStatus::not_allowed) {
    return fail("you may not ask " + socket + ": root and the group of its process may (skein)",
                kNotKnown);
  }
  if (asked.failed) return fail("the process of " + socket + " does not answer", kNotKnown);
  if (arguments.flying) {
    const Airborne airborne = onboard::airborne_in(asked.line);
    std::puts(airborne == Airborne::yes ? "yes" : airborne == Airborne::no ? "no" : "not known");
    return airborne == Airborne::yes ? kMayFly : airborne == Airborne::no ? kOnGround : kNotKnown;
  }
  if (arguments.json) {
    std::puts(asked.line.c_str());
    return 0;
  }
  const auto text = onboard::status_text(asked.line);
  if (!text) return fail(text.error().message, kNotKnown);
  std::fputs(text->c_str(), stdout);
  return 0;
}

int show_status(const StatusArguments& arguments) {
  const auto all = arguments.socket.empty() ? sockets() : std::vector{arguments.socket};
  if (all.empty()) {
    return fail(
        std::string{"no process of a vehicle has a status socket in "} + onboard::kStatusSockets,
        kNobodyThere);
  }
  if (arguments.flying && all.size() > 1) {
    return fail("several vehicles are on this host; give --socket", skein::process::kExitBadInput);
  }
  int worst = 0;
  for (const std::string& socket : all) worst = std::max(worst, show_status(socket, arguments));
  return worst;
}

}  // namespace

int main(int argc, char** argv) {
  if (const auto status = skein::network::run_carrier(argc, argv)) return *status;
  CLI::App app{
      "The process of one vehicle: joins the mission network, takes part in coalitions and\n"
      "flies the vehicle's flight controller."};
  app.footer(
      "Examples:\n  skein-onboard --config vehicle-07.yaml\n  skein-onboard status\n"
      "  skein-onboard check --config vehicle-07.yaml\n  skein-onboard enrol --id 7\n\n"
      "The keys of the file are explained in docs/configuration.md. The process ends on\n"
      "SIGINT or SIGTERM with exit code 0; 2 means bad arguments or configuration, 3 that it\n"
      "could not start.");
  Arguments arguments;
  StatusArguments status;
  app.add_option("--config", arguments.config, "The vehicle's configuration, YAML");
  app.add_flag("--check-config", arguments.check_only,
               "Read the configuration, say whether it is good, end");
  app.add_option_function<double>(
         "--clock-ahead",
         [&arguments](double s) { arguments.host.clock_ahead = skein::from_seconds(s); },
         "For a bench: as if this machine's clock was so many seconds ahead")
      ->check(CLI::Range(-3600.0, 3600.0));
  app.add_option("--status-socket", arguments.host.status_socket,
                 "Path of a Unix socket where `skein-onboard status` learns how it is");
  app.set_version_flag("--version", "skein-onboard " + skein::version());
  app.set_help_all_flag("--help-all", "The same of every command");
  app.require_subcommand(0, 1);
  CLI::App& asks =
      *app.add_subcommand("status", "Tells how the vehicles of this host are, by their processes");
  asks.add_option("--socket", status.socket,
                  "Of this process (default: all onboard-*.sock in /run/skein)");
  asks.add_flag("--json", status.json, "As the process says it: one line of JSON");
  asks.add_flag("--flying", status.flying,
                "Only whether it may be in the air. Ends with 0 if so, with 1 on the ground, with "
                "3 where there is no process, with 4 where it is not known");
  const onboard::KeyCommands keys{app};
  const onboard::CheckCommand check{app};
  if (const auto ends = skein::command_line::read(app, argc, argv)) return *ends;
  if (keys.given()) return keys.run();
  if (check.given()) return check.run();
  return asks.parsed() ? show_status(status) : fly(arguments);
}
