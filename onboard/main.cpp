// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

#include "skein/configuration/vehicle_config.hpp"
#include "skein/onboard/vehicle_process.hpp"
#include "skein/process/log.hpp"
#include "skein/version/version.hpp"

int main(int argc, char** argv) {
  CLI::App app{
      "The process of one vehicle: joins the mission network, takes part in coalitions and\n"
      "flies the vehicle's flight controller."};
  app.footer(
      "Example:\n  skein-onboard --config vehicle-07.yaml\n\n"
      "The keys of the file are explained in docs/configuration.md. The process ends on\n"
      "SIGINT or SIGTERM with exit code 0; 2 means bad arguments or configuration, 3 that it\n"
      "could not start.");
  std::string file;
  bool check_only = false;
  app.add_option("--config", file, "The vehicle's configuration, YAML")->required();
  app.add_flag("--check-config", check_only, "Read the configuration, say whether it is good, end");
  app.set_version_flag("--version", "skein-onboard " + skein::version());
  app.set_help_all_flag("--help-all", "The same of every command");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : skein::process::kExitBadInput;
  }

  const auto config = skein::configuration::load_vehicle_config(file);
  if (!config) {
    std::fprintf(stderr, "skein-onboard: %s\n", config.error().message.c_str());
    return skein::process::kExitBadInput;
  }
  if (check_only) {
    std::printf("%s: good, vehicle %u\n", file.c_str(),
                static_cast<unsigned>(config->vehicle.id.value));
    return 0;
  }
  return skein::onboard::fly(*config);
}
