// SPDX-License-Identifier: Apache-2.0
#include "commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <future>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/configuration/utc.hpp"
#include "skein/fleet/fleet.hpp"
#include "skein/fleet/remote.hpp"

namespace skein::fleet {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* kEpochFile = "epoch";

std::filesystem::path folder_of(const FleetArguments& arguments) {
  if (!arguments.folder.empty()) return arguments.folder;
  return std::filesystem::path{"runs"} / ("fleet-" + arguments.file.stem().string());
}

int complain(const FleetArguments& arguments, const std::string& sentences, int status) {
  if (arguments.json) fmt::print("{}\n", Json{{"done", false}, {"problems", sentences}}.dump(2));
  fmt::print(stderr, "{}\n", sentences);
  return status;
}

std::optional<std::int64_t> kept_epoch(const FleetArguments& arguments) {
  std::ifstream file{folder_of(arguments) / kEpochFile};
  std::string text;
  return std::getline(file, text) ? configuration::parse_utc(text) : std::nullopt;
}

std::int64_t now_unix_ns() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

/// The file's, the one that is given, or the one that was given before.
Result<std::int64_t> epoch_of(const configuration::Scenario& fleet,
                              const FleetArguments& arguments) {
  if (fleet.epoch_unix_ns) {
    if (arguments.epoch.empty()) return *fleet.epoch_unix_ns;
    return Error{"the epoch stands in the file; leave --epoch out, or take it from there"};
  }
  if (arguments.epoch == "now") {
    return now_unix_ns();
  }
  if (!arguments.epoch.empty()) {
    const auto epoch = configuration::parse_utc(arguments.epoch);
    if (epoch) return *epoch;
    return Error{"--epoch " + arguments.epoch +
                 ": write now, or a time in UTC such as 2026-11-23T08:00:00Z"};
  }
  if (const auto kept = kept_epoch(arguments)) return *kept;
  return Error{
      "the fleet has no epoch, and every host would count from its own start; give it one, once, "
      "by --epoch now, or in the file: epoch: 2026-11-23T08:00:00Z"};
}

/// What a command works with.
struct Fleet {
  configuration::Scenario scenario;
  std::int64_t epoch_unix_ns = 0;
  std::vector<Program> programs;  ///< all
  std::vector<Program> chosen;    ///< by --only
};

/// Otherwise what `status` is the exit status for.
struct Refusal {
  std::string sentences;
  int status = kExitBadInput;
};

std::optional<Refusal> choose(Fleet& fleet, const std::string& only) {
  if (only.empty()) {
    fleet.chosen = fleet.programs;
    return std::nullopt;
  }
  const auto ids = parse_ids(only);
  if (!ids) return Refusal{"--only " + ids.error().message};
  for (const VehicleId id : *ids) {
    const auto found = std::find_if(fleet.programs.begin(), fleet.programs.end(),
                                    [id](const Program& p) { return p.host.node == id; });
    if (found == fleet.programs.end()) {
      return Refusal{fmt::format("--only names {}, which is not in the fleet", name_of(id))};
    }
    fleet.chosen.push_back(*found);
  }
  return std::nullopt;
}

/// What a command is done to does not depend on the epoch where it only ends programs.
enum class Epoch : std::uint8_t { needed, any };

std::optional<Refusal> load(const FleetArguments& arguments, Fleet& fleet,
                            Epoch needs = Epoch::needed) {
  auto scenario = configuration::load_flyable_scenario(arguments.file);
  if (!scenario) return Refusal{scenario.error().message};
  fleet.scenario = std::move(scenario).value();
  const std::string name = arguments.file.string() + ": ";
  const auto epoch = epoch_of(fleet.scenario, arguments);
  const bool no_epoch = !epoch && needs == Epoch::needed;
  std::string wrong;
  for (const std::string& problem : problems(fleet.scenario)) wrong += name + problem + "\n";
  if (no_epoch) wrong += name + epoch.error().message + "\n";
  if (!wrong.empty()) {
    wrong.pop_back();
    return Refusal{wrong, no_epoch && !arguments.epoch.empty() ? kExitBadInput : kExitDiffers};
  }
  fleet.epoch_unix_ns = epoch ? *epoch : now_unix_ns();
  auto programs = render(fleet.scenario, fleet.epoch_unix_ns);
  if (!programs) return Refusal{name + programs.error().message, kExitDiffers};
  fleet.programs = std::move(programs).value();
  return choose(fleet, arguments.only);
}

Result<void> write(const std::filesystem::path& file, const std::string& text) {
  std::error_code failure;
  std::filesystem::create_directories(file.parent_path(), failure);
  auto beside = file;
  beside += ".new";
  std::ofstream out{beside, std::ios::binary};
  out << text;
  out.close();
  if (out) std::filesystem::rename(beside, file, failure);
  if (!out || failure) return Error{file.string() + ": cannot be written; check its folder"};
  return {};
}

/// What every host is given, to look at, and the epoch, for the commands that follow.
Result<void> write_folder(const Fleet& fleet, const std::filesystem::path& folder) {
  const std::string epoch = configuration::utc_text(fleet.epoch_unix_ns) + "\n";
  if (auto done = write(folder / kEpochFile, epoch); !done) return done;
  for (const Program& program : fleet.programs) {
    if (auto done = write(folder / (program.name + ".yaml"), program.configuration); !done) {
      return done;
    }
    for (const HostFile& file : program.more) {
      const auto path = folder / "formation" / std::filesystem::path{file.path}.filename();
      if (auto done = write(path, file.text); !done) return done;
    }
  }
  return {};
}

std::string epoch_line(const Fleet& fleet) {
  return "mission time zero is " + configuration::utc_text(fleet.epoch_unix_ns);
}

/// On every chosen host at once.
template <class Outcome>
std::vector<Outcome> on_all(const std::vector<Program>& programs,
                            const std::function<Outcome(const Program&)>& what) {
  std::vector<std::future<Outcome>> under_way;
  under_way.reserve(programs.size());
  for (const Program& program : programs) {
    under_way.push_back(
        std::async(std::launch::async, [&program, &what] { return what(program); }));
  }
  std::vector<Outcome> outcomes;
  outcomes.reserve(under_way.size());
  for (auto& one : under_way) outcomes.push_back(one.get());
  return outcomes;
}

/// Tells what came of a command on each chosen host.
int tell(const FleetArguments& arguments, const Fleet& fleet, const char* done,
         const std::vector<Result<void>>& outcomes) {
  Json hosts = Json::array();
  bool all = true;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const Program& program = fleet.chosen[i];
    const bool good = outcomes[i].ok();
    all = all && good;
    const std::string problem = good ? "" : outcomes[i].error().message;
    hosts.push_back({{"vehicle", program.host.node.value}, {"done", good}, {"problem", problem}});
    if (arguments.json) continue;
    if (good) {
      fmt::print("{}: {}\n", name_of(program.host.node), done);
    } else {
      fmt::print(stderr, "{}\n", problem);
    }
  }
  if (arguments.json) fmt::print("{}\n", Json{{"done", all}, {"hosts", hosts}}.dump(2));
  return all ? kExitAsTheFile : kExitDiffers;
}

int tell_of(const FleetArguments& arguments, const Fleet& fleet, const char* done,
            const std::function<Result<void>(const Program&)>& what) {
  return tell(arguments, fleet, done, on_all<Result<void>>(fleet.chosen, what));
}

/// A program is started only with what the file says.
Result<void> start_as_the_file(const Program& program) {
  const Status there = status(program);
  if (!there.reachable) return Error{there.trouble};
  if (there.running && there.as_the_file() && !there.outdated) return start(program);
  if (there.running) {
    return Error{fmt::format("{} runs with another configuration than the file{}; stop it first",
                             name_of(program.host.node),
                             there.drift.empty() ? "" : ": " + there.drift.front().key)};
  }
  if (!there.configured) {
    return Error{name_of(program.host.node) + " has no configuration; push it first"};
  }
  if (!there.as_the_file()) {
    return Error{fmt::format("{} has another configuration than the file{}; push it first",
                             name_of(program.host.node),
                             there.drift.empty() ? "" : ": " + there.drift.front().key)};
  }
  return start(program);
}

std::string configuration_word(const Status& status) {
  if (!status.configured) return "none";
  if (!status.unreadable.empty()) return "unreadable";
  if (!status.drift.empty()) return "differs";
  return status.outdated ? "newer than run" : "as the file";
}

Json json_of(const Program& program, const Status& s) {
  Json drift = Json::array();
  for (const auto& d : s.drift) {
    drift.push_back({{"key", d.key}, {"there", d.first}, {"file", d.second}});
  }
  Json json{{"vehicle", program.host.node.value},
            {"address", program.host.address},
            {"reachable", s.reachable}};
  if (!s.reachable) {
    json["problem"] = s.trouble;
    return json;
  }
  json.update({{"running", s.running},
               {"state", s.state},
               {"configuration", configuration_word(s)},
               {"as_the_file", s.as_the_file()},
               {"drift", drift},
               {"version", s.version},
               {"clock_offset_s", s.clock_offset_s}});
  return json;
}

constexpr std::size_t kDriftShown = 12;

void print(const Program& program, const Status& s, double clock_guard_s) {
  if (!s.reachable) {
    fmt::print("{:18} {:15} {}\n", name_of(program.host.node), program.host.address, s.trouble);
    return;
  }
  fmt::print("{:18} {:15} {:9} {:14} clock {:+.3f} s{}  {}\n", name_of(program.host.node),
             program.host.address, s.state, configuration_word(s), s.clock_offset_s,
             std::abs(s.clock_offset_s) > clock_guard_s ? " (beyond clock_guard_s)" : "",
             s.version.empty() ? "no program" : s.version);
  if (!s.unreadable.empty()) fmt::print("  {}\n", s.unreadable);
  for (std::size_t i = 0; i < std::min(s.drift.size(), kDriftShown); ++i) {
    const auto& d = s.drift[i];
    const auto shown = [](const std::string& value) { return value.empty() ? "nothing" : value; };
    fmt::print("  {}: {} there, {} in the file\n", d.key, shown(d.first), shown(d.second));
  }
  if (s.drift.size() > kDriftShown) {
    fmt::print("  and {} more keys\n", s.drift.size() - kDriftShown);
  }
}

}  // namespace

int check(const FleetArguments& arguments) {
  Fleet fleet;
  if (const auto refused = load(arguments, fleet)) {
    return complain(arguments, refused->sentences, refused->status);
  }
  if (arguments.json) {
    fmt::print("{}\n", Json{{"done", true}, {"hosts", fleet.programs.size()}}.dump(2));
    return kExitAsTheFile;
  }
  fmt::print("{}: good, {} hosts; {}\n", arguments.file.string(), fleet.programs.size(),
             epoch_line(fleet));
  if (!fleet.scenario.operator_decisions.empty() || !fleet.scenario.formation.script.empty()) {
    fmt::print(
        "what the file decides and orders by script is for the bench; in the field an "
        "operator does\n");
  }
  const auto simulated = std::count_if(
      fleet.scenario.vehicles.begin(), fleet.scenario.vehicles.end(), [](const auto& vehicle) {
        return vehicle.flight_controller.kind == configuration::FlightControllerKind::simulated;
      });
  if (simulated > 0) {
    fmt::print(
        "{} of {} vehicles are simulated, each on its host; flight_controller: {{kind: "
        "ardupilot}} makes them fly\n",
        simulated, fleet.scenario.vehicles.size());
  }
  return kExitAsTheFile;
}

int render_files(const FleetArguments& arguments) {
  Fleet fleet;
  if (const auto refused = load(arguments, fleet)) {
    return complain(arguments, refused->sentences, refused->status);
  }
  const auto folder = folder_of(arguments);
  if (const auto written = write_folder(fleet, folder); !written) {
    return complain(arguments, written.error().message, kExitBadInput);
  }
  if (arguments.json) {
    fmt::print("{}\n", Json{{"done", true}, {"folder", folder.string()}}.dump(2));
  } else {
    fmt::print("{} configurations into {}; {}\n", fleet.programs.size(), folder.string(),
               epoch_line(fleet));
  }
  return kExitAsTheFile;
}

int push_all(const FleetArguments& arguments) {
  Fleet fleet;
  if (const auto refused = load(arguments, fleet)) {
    return complain(arguments, refused->sentences, refused->status);
  }
  const auto kept = kept_epoch(arguments);
  if (!arguments.only.empty() && kept && *kept != fleet.epoch_unix_ns) {
    return complain(arguments,
                    "--only would give some hosts another epoch than the others have, " +
                        configuration::utc_text(*kept) + "; push to all, or leave --epoch out",
                    kExitBadInput);
  }
  const auto outcomes = on_all<Result<void>>(
      fleet.chosen, [&](const Program& program) { return push(program, arguments.force); });
  const bool any = std::ranges::any_of(outcomes, [](const auto& outcome) { return outcome.ok(); });
  // What no host has taken is not what the commands that follow go by.
  if (any) {
    if (const auto written = write_folder(fleet, folder_of(arguments)); !written) {
      return complain(arguments, written.error().message, kExitBadInput);
    }
    if (!arguments.json) fmt::print("{}\n", epoch_line(fleet));
  }
  return tell(arguments, fleet, "configured", outcomes);
}

int start_all(const FleetArguments& arguments) {
  Fleet fleet;
  if (const auto refused = load(arguments, fleet)) {
    return complain(arguments, refused->sentences, refused->status);
  }
  return tell_of(arguments, fleet, "runs", start_as_the_file);
}

int stop_all(const FleetArguments& arguments) {
  Fleet fleet;
  if (const auto refused = load(arguments, fleet, Epoch::any)) {
    return complain(arguments, refused->sentences, refused->status);
  }
  // The ground station last, and only where no vehicle is left in the air without it.
  bool all = true;
  std::vector<Result<void>> outcomes =
      on_all<Result<void>>(fleet.chosen, [&](const Program& program) {
        return program.is_ground() ? Result<void>{} : stop(program, arguments.force);
      });
  for (const auto& outcome : outcomes) all = all && outcome.ok();
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (!fleet.chosen[i].is_ground()) continue;
    outcomes[i] = all ? stop(fleet.chosen[i], arguments.force)
                      : Error{"the ground station goes on: not all vehicles have stopped"};
  }
  return tell(arguments, fleet, "stopped", outcomes);
}

int show_status(const FleetArguments& arguments) {
  Fleet fleet;
  if (const auto refused = load(arguments, fleet)) {
    return complain(arguments, refused->sentences, refused->status);
  }
  const auto all = on_all<Status>(fleet.chosen, status);
  const double guard_s = to_seconds(fleet.scenario.protocol.clock_guard);
  Json hosts = Json::array();
  bool good = true;
  for (std::size_t i = 0; i < all.size(); ++i) {
    good = good && all[i].as_the_file() && std::abs(all[i].clock_offset_s) <= guard_s;
    hosts.push_back(json_of(fleet.chosen[i], all[i]));
    if (!arguments.json) print(fleet.chosen[i], all[i], guard_s);
  }
  if (arguments.json) {
    fmt::print("{}\n", Json{{"done", good},
                            {"epoch", configuration::utc_text(fleet.epoch_unix_ns)},
                            {"hosts", hosts}}
                           .dump(2));
  } else {
    fmt::print("{}\n", epoch_line(fleet));
  }
  return good ? kExitAsTheFile : kExitDiffers;
}

}  // namespace skein::fleet
