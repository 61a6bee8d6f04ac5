// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "skein/configuration/ground_config.hpp"
#include "skein/groundstation/ground_process.hpp"
#include "skein/process/log.hpp"

int main(int argc, char** argv) {
  CLI::App app{
      "The ground station: shows the fleet and its mission, and is where an operator\n"
      "authorises or refuses deliveries."};
  app.footer(
      "Example:\n  skein-ground --config ground.yaml\n\n"
      "At its prompt, `help` lists the commands. Without a terminal it runs on and logs.\n"
      "The keys of the file are explained in docs/configuration.md. The process ends on\n"
      "SIGINT, SIGTERM or `quit` with exit code 0; 2 means bad arguments or configuration, 3\n"
      "that it could not start.");
  std::string file;
  // One thread so far. NOLINTNEXTLINE(concurrency-mt-unsafe)
  const char* user = std::getenv("USER");
  std::string operator_name = user != nullptr && *user != '\0' ? user : "operator";
  bool check_only = false;
  app.add_option("--config", file, "The ground station's configuration, YAML")->required();
  app.add_option("--operator", operator_name, "Who decides at the prompt")->capture_default_str();
  app.add_flag("--check-config", check_only, "Read the configuration, say whether it is good, end");
  app.set_version_flag("--version", "skein-ground " SKEIN_VERSION);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : skein::process::kExitBadInput;
  }

  const auto config = skein::configuration::load_ground_config(file);
  if (!config) {
    std::fprintf(stderr, "skein-ground: %s\n", config.error().message.c_str());
    return skein::process::kExitBadInput;
  }
  if (check_only) {
    std::printf("%s: good, a fleet of %zu vehicles\n", file.c_str(), config->vehicles.size());
    return 0;
  }
  return skein::groundstation::run(*config, operator_name);
}
