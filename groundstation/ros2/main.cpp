// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <string>

#include "skein/command_line/read.hpp"
#include "skein/process/log.hpp"
#include "skein/ros2/bridge.hpp"
#include "skein/version/version.hpp"

namespace {

using skein::Error;
using skein::Result;

struct Arguments {
  std::string console = "http://127.0.0.1:7460";
  std::string token_file;
  std::string user;
  std::string password_file;
  std::string markers;
  bool humble = false;
  skein::ros2::RosNodeConfig node;
};

int fail(const std::string& why) {
  std::fprintf(stderr, "skein-ros2: %s\n", why.c_str());
  return skein::process::kExitBadInput;
}

Result<std::string> first_line_of(const std::string& file) {
  std::ifstream stream{file};
  std::string line;
  std::getline(stream, line);
  if (line.empty()) return Error{"cannot read " + file};
  return line;
}

Result<skein::ros2::BridgeConfig> config_of(const Arguments& arguments) {
  skein::ros2::BridgeConfig config;
  config.node = arguments.node;
  if (arguments.humble) config.node.gid_bytes = 24;
  const auto console = skein::ros2::parse_console(arguments.console);
  if (!console) return console.error();
  config.console.address = *console;
  config.console.user = arguments.user;
  const bool by_password = !arguments.user.empty() && !arguments.password_file.empty();
  if (by_password == !arguments.token_file.empty()) {
    return Error{
        "how does the console let it in? Give --token-file, or --user and --password-file"};
  }
  auto secret = first_line_of(by_password ? arguments.password_file : arguments.token_file);
  if (!secret) return secret.error();
  config.console.password = *std::move(secret);
  if (!arguments.markers.empty()) {
    const auto markers = skein::ros2::parse_place(arguments.markers);
    if (!markers || markers->port == 0) {
      return Error{"'" + arguments.markers + "' is no place for markers: 127.0.0.1:6969 is one"};
    }
    config.markers = *markers;
  }
  if (auto good = skein::ros2::check(config); !good) return good.error();
  return config;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{
      "Shows a team to ROS 2, and takes what it proposes: publishes what a ground station's "
      "console "
      "shows as topics of ROS 2 (docs/ros2.md). Needs no ROS 2 on this machine."};
  app.footer(
      "Examples:\n"
      "  skein-ros2 --token-file runs/mine/ground/console.observer.token\n"
      "  skein-ros2 --token-file console.observer.token --domain 42 --markers 127.0.0.1:6969\n"
      "  skein-ros2 --user press --password-file press.password --address 192.168.1.7\n\n"
      "Then, where ROS 2 is: ros2 topic echo /skein/vehicle_3/fix. The process ends on SIGINT or\n"
      "SIGTERM with exit code 0; 2 means bad arguments, 3 that it could not start. A console that\n"
      "does not answer is tried again.");
  app.add_option("--console", arguments.console, "The ground station's console")
      ->capture_default_str();
  app.add_option("--token-file", arguments.token_file,
                 "File with an observer's token: console.observer.token of the recording folder");
  app.add_option("--user", arguments.user,
                 "Or an observer's name, where the console has passwords");
  app.add_option("--password-file", arguments.password_file, "File with that one's password");
  app.add_option(
      "--markers", arguments.markers,
      "Where the ground station takes markers (agencies.markers), as ADDRESS:PORT; without "
      "it proposals are dropped");
  app.add_option("--domain", arguments.node.domain, "ROS_DOMAIN_ID")->capture_default_str();
  app.add_option("--address", arguments.node.address,
                 "IPv4 address of the one interface that it speaks on")
      ->capture_default_str();
  app.add_option("--peer", arguments.node.peers,
                 "IPv4 address of a host that multicast does not reach; may be given again");
  app.add_option("--namespace", arguments.node.name_space, "Begins all topics")
      ->capture_default_str();
  app.add_flag("--humble", arguments.humble,
               "Tells of its node as ROS 2 Humble does (newer ones do not understand that)");
  app.set_version_flag("--version", "skein-ros2 " + skein::version());
  if (const auto ends = skein::command_line::read(app, argc, argv)) return *ends;
  const auto config = config_of(arguments);
  if (!config) return fail(config.error().message);
  return skein::ros2::run(*config);
}
