// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/configuration/host.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/configuration/vehicle_config.hpp"

/// A fleet in the field, from one file: what every host is given, and how it is given
/// (docs/fleet.md).
namespace skein::fleet {

/// A file for a host, by its path there.
struct HostFile {
  std::string path;
  std::string text;
  bool secret = false;  ///< of the program's user alone, who has the folder that it is put below
};

/// One program on its host. It is a unit of systemd, unless the host names a folder of programs.
struct Program {
  configuration::Host host;
  std::string name;            ///< onboard-3, ground: of its configuration, recordings and log
  std::string unit;            ///< skein-onboard@3.service
  std::string file;            ///< the path of its configuration there
  std::string configuration;   ///< YAML
  std::vector<HostFile> more;  ///< that the configuration names
  std::vector<std::string> command;  ///< its own command line; the program first, by its path
  std::string mark;                  ///< only this program has it in its command line
  bool realtime = false;             ///< before all that is not, where the host allows it

  [[nodiscard]] bool is_ground() const { return host.node == kGroundStation; }
};

/// "vehicle 3", "the ground station".
[[nodiscard]] std::string name_of(VehicleId node);

/// The program of a vehicle, or of the ground station, with this configuration.
[[nodiscard]] Program program_of(const configuration::Host& host, std::string configuration);
/// Where that program records.
[[nodiscard]] std::string recordings_of(const configuration::Host& host);
/// Where its keys are (docs/keys.md).
[[nodiscard]] std::string keys_of(const configuration::Host& host);

/// What does not fit together, one sentence each: hosts that are missing or twice, addresses and
/// ports, buses and their nodes, files, a console that is open to everybody. Reads the shapes that
/// the formation names. Precondition: configuration::check(scenario).
[[nodiscard]] std::vector<std::string> problems(const configuration::Scenario& scenario);

/// The programs of all hosts, the ground station's first. What decides in an operator's place on
/// the bench (operator_decisions, the formation's script) is left out: in the field an operator
/// does. Fails, a sentence a line, where there are problems().
[[nodiscard]] Result<std::vector<Program>> render(const configuration::Scenario& scenario,
                                                  std::int64_t epoch_unix_ns);

/// Ids as people write them: "1-5,9". Fails with what is wrong.
[[nodiscard]] Result<std::vector<VehicleId>> parse_ids(std::string_view text);

}  // namespace skein::fleet
