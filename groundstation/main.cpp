// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "mission_commands.hpp"
#include "skein/base/stations.hpp"
#include "skein/base/time.hpp"
#include "skein/command_line/read.hpp"
#include "skein/configuration/ground_config.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/console/users.hpp"
#include "skein/groundstation/audit_chain.hpp"
#include "skein/groundstation/control_socket.hpp"
#include "skein/groundstation/ground_process.hpp"
#include "skein/groundstation/operator_keys.hpp"
#include "skein/groundstation/prompt.hpp"
#include "skein/groundstation/replay_process.hpp"
#include "skein/groundstation/route_planning.hpp"
#include "skein/groundstation/task_planning.hpp"
#include "skein/identity/identity.hpp"
#include "skein/identity/operator_key.hpp"
#include "skein/network/carrier_process.hpp"
#include "skein/process/log.hpp"
#include "skein/process/mission_network.hpp"
#include "skein/recording_export/recording_export.hpp"
#include "skein/version/version.hpp"
#include "typed_password.hpp"

namespace {

namespace groundstation = skein::groundstation;
using skein::configuration::GroundConfig;

constexpr int kExitRefused = 1;
constexpr std::chrono::seconds kAnswerWithin{20};  // a change of a thousand vehicles takes its time

struct PlanArguments {
  std::string scenario;
  std::string folder;
  std::optional<std::uint64_t> seed;
  // Of tasks.
  double seconds = 0.0;    ///< 0: by steps, the same on every machine
  bool all_known = false;  ///< every site of the mission is
  std::string criterion;   ///< of kCriteria, in place of the mission's; empty: that
};

struct Arguments {
  std::string config;
  std::string operator_name;
  bool check_only = false;
  bool watch = false;
  std::string socket;
  bool json = false;
};

struct ReplayArguments {
  std::string recording;
  double speed = 1.0;
  std::optional<double> at_s;
  skein::configuration::ConsoleConfig console;
};

struct PasswordArguments {
  std::string name;
  bool observer = false;
};

skein::Result<GroundConfig> load(const std::string& file) {
  return skein::configuration::load_ground_config(file);
}

int fail(const std::string& why, int status) {
  std::fprintf(stderr, "skein-ground: %s\n", why.c_str());
  return status;
}

int run(const Arguments& arguments) {
  if (arguments.config.empty()) {
    return fail("--config is required; --help has examples", skein::process::kExitBadInput);
  }
  auto config = load(arguments.config);
  if (!config) return fail(config.error().message, skein::process::kExitBadInput);
  if (arguments.watch && config->command.station == 0) {
    return fail("--watch is for one of several ground stations; give it a number: command.station",
                skein::process::kExitBadInput);
  }
  config->command.watches = config->command.watches || arguments.watch;
  if (arguments.check_only) {
    std::printf("%s: good, a fleet of %zu vehicles\n", arguments.config.c_str(),
                config->vehicles.size());
    const std::uint16_t station = config->command.station;
    const auto starts = skein::process::check_start(
        config->network, station == 0 ? skein::kGroundStation : skein::station_node(station));
    if (!starts)
      std::fprintf(stderr, "it would not start here: %s\n", starts.error().message.c_str());
    return 0;
  }
  groundstation::Login login{arguments.operator_name, {}};
  // Whoever sits before it signs what he authorises.
  const bool has_key =
      !config->network.keys.empty() && skein::identity::is_name(login.name) &&
      std::filesystem::exists(skein::identity::operator_file(config->network.keys, login.name));
  if (has_key && ::isatty(STDIN_FILENO) == 1) {
    login.password = groundstation::typed_password(login.name);
  }
  return groundstation::run(*config, login);
}

/// CLI11 takes -1 for the greatest number.
std::string why_no_seed(const std::string& text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  return error == std::errc{} && end == text.data() + text.size()
             ? ""
             : "'" + text + "' is no seed, which is a whole number from 0 to 18446744073709551615";
}

/// Gives a running ground station a line of its prompt.
int tell(const Arguments& arguments, const std::string& line) {
  if (line.find_first_not_of(" \t") == std::string::npos) {
    return fail("what shall it be told? A line of its prompt, such as status; help lists them",
                skein::process::kExitBadInput);
  }
  if (auto input = groundstation::parse_input(line); !input) {
    return fail(input.error().message, skein::process::kExitBadInput);
  }
  GroundConfig config;
  if (!arguments.config.empty()) {
    auto loaded = load(arguments.config);
    if (!loaded) return fail(loaded.error().message, skein::process::kExitBadInput);
    config = *std::move(loaded);
  }
  if (!arguments.socket.empty()) config.control_socket = arguments.socket;
  const auto answer = groundstation::ask(groundstation::control_socket_of(config),
                                         (arguments.json ? "json " : "") + line, kAnswerWithin);
  if (!answer) return fail(answer.error().message, skein::process::kExitCannotStart);
  std::fputs(answer->text.c_str(), answer->done || arguments.json ? stdout : stderr);
  return answer->done ? 0 : kExitRefused;
}

/// Unlocks an operator's key in a running ground station, or locks it there.
int unlock(const Arguments& arguments, bool locks) {
  GroundConfig config;
  if (!arguments.config.empty()) {
    auto loaded = load(arguments.config);
    if (!loaded) return fail(loaded.error().message, skein::process::kExitBadInput);
    config = *std::move(loaded);
  }
  if (!arguments.socket.empty()) config.control_socket = arguments.socket;
  groundstation::Unlock asked;
  if (!locks) {
    asked = {arguments.operator_name, groundstation::typed_password(arguments.operator_name)};
  }
  const auto answer = groundstation::ask(groundstation::control_socket_of(config),
                                         groundstation::line_of(asked), kAnswerWithin);
  skein::identity::wipe(asked.password);
  if (!answer) return fail(answer.error().message, skein::process::kExitCannotStart);
  std::fputs(answer->text.c_str(), answer->done ? stdout : stderr);
  return answer->done ? 0 : kExitRefused;
}

/// The folder that a plan is written into.
std::filesystem::path folder_of(const PlanArguments& arguments) {
  if (!arguments.folder.empty()) return arguments.folder;
  return std::filesystem::path{"runs"} / std::filesystem::path{arguments.scenario}.stem();
}

int tell_written(const PlanArguments& arguments,
                 const skein::Result<std::vector<std::string>>& files) {
  if (!files) return fail(files.error().message, skein::process::kExitCannotStart);
  std::printf("into %s:", folder_of(arguments).c_str());
  for (const std::string& file : *files) std::printf(" %s", file.c_str());
  std::printf("\n");
  return 0;
}

/// What was planned before is not of what was refused now.
int refuse_plan(const PlanArguments& arguments, const std::string& why) {
  const auto before = folder_of(arguments) / "plan.yaml";
  if (!std::filesystem::exists(before)) return fail(why, kExitRefused);
  return fail(why + "; " + before.string() + " and what is beside it are of an earlier plan",
              kExitRefused);
}

int plan_routes(const PlanArguments& arguments, const skein::configuration::Scenario& scenario) {
  skein::routes::RoutePlannerParams params;
  const bool shows = ::isatty(STDERR_FILENO) == 1;
  params.go_on = [shows](const skein::routes::RoutePlanProgress& progress) {
    if (shows) {
      std::fprintf(stderr, "\rarrival at %.1f s: %zu vehicles, %llu routes tried ",
                   progress.arrival_s, progress.vehicles,
                   static_cast<unsigned long long>(progress.evaluations));
    }
    return true;
  };
  const auto planned = groundstation::plan_routes(scenario, params);
  if (shows) std::fputs("\r\033[K", stderr);
  if (!planned) return refuse_plan(arguments, planned.error().message);
  std::fputs(groundstation::routes_text(*planned).c_str(), stdout);
  if (!planned->check.ok())
    return refuse_plan(arguments, "the plan breaks a rule; nothing is written");
  return tell_written(arguments,
                      groundstation::write_routes(*planned, scenario, folder_of(arguments)));
}

int plan_tasks(const PlanArguments& arguments, const skein::configuration::Scenario& scenario) {
  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;
  const auto begun = Clock::now();
  const bool shows = ::isatty(STDERR_FILENO) == 1;
  skein::planning::PlanningBudget budget{groundstation::kTaskingSteps, {}};
  if (arguments.seconds > 0.0) budget.steps_max = std::numeric_limits<std::uint64_t>::max();
  int told_s = 0;
  budget.expired = [&] {
    const double gone_s = Seconds{Clock::now() - begun}.count();
    if (shows && gone_s >= told_s + 1) {
      std::fprintf(stderr, "\rplanning for %d s ", told_s = static_cast<int>(gone_s));
    }
    return arguments.seconds > 0.0 && gone_s >= arguments.seconds;
  };
  const auto planned = groundstation::plan_tasks(scenario, budget);
  if (shows) std::fputs("\r\033[K", stderr);
  if (!planned) return refuse_plan(arguments, planned.error().message);
  std::fputs(groundstation::tasks_text(*planned).c_str(), stdout);
  return tell_written(arguments, groundstation::write_tasks(*planned, folder_of(arguments)));
}

/// Of a mission of routes its routes; else the tasks at its known sites.
int plan(const PlanArguments& arguments) {
  auto scenario = skein::configuration::load_flyable_scenario(arguments.scenario);
  if (!scenario) return fail(scenario.error().message, skein::process::kExitBadInput);
  if (arguments.seed) scenario->seed = *arguments.seed;
  if (scenario->flies_routes()) return plan_routes(arguments, *scenario);
  if (scenario->sites.empty()) {
    return fail(arguments.scenario + ": the mission has neither routes nor sites to plan",
                skein::process::kExitBadInput);
  }
  if (arguments.all_known) {
    scenario->tasking.known.clear();
    for (const skein::Site& site : scenario->sites) scenario->tasking.known.push_back(site.id);
  }
  const auto& criteria = skein::configuration::kCriteria;
  if (const auto wanted = std::ranges::find(criteria, arguments.criterion);
      wanted != criteria.end()) {
    scenario->tasking.criterion =
        static_cast<skein::planning::Criterion>(wanted - criteria.begin());
  }
  if (auto good = skein::configuration::check(*scenario); !good) {
    return fail(good.error().message, skein::process::kExitBadInput);
  }
  return plan_tasks(arguments, *scenario);
}

/// A line for a password file, from a password on standard input.
int password(const PasswordArguments& arguments) {
  using skein::console::Role;
  if (arguments.name.empty() || arguments.name.find_first_of(":\n") != std::string::npos) {
    return fail("a name has no colon in it", skein::process::kExitBadInput);
  }
  const std::string typed = groundstation::typed_password(arguments.name);
  if (typed.size() < groundstation::kPasswordMin) {
    return fail("a password has at least 8 characters", skein::process::kExitBadInput);
  }
  const Role role = arguments.observer ? Role::observer : Role::op;
  std::printf("%s:%s:%s\n", arguments.name.c_str(),
              std::string{skein::console::to_string(role)}.c_str(),
              skein::console::hash_password(typed).c_str());
  return 0;
}

struct ExportArguments {
  std::string recording;
  std::string csv;
  std::string geojson;
  std::string kml;
};

/// What is in a recording.
int info(const std::string& recording) {
  const auto text = skein::recording_export::summary(recording);
  if (!text) return fail(text.error().message, skein::process::kExitBadInput);
  std::fputs(text->c_str(), stdout);
  return 0;
}

int export_recording(const ExportArguments& arguments) {
  using skein::recording_export::Format;
  if (arguments.csv.empty() && arguments.geojson.empty() && arguments.kml.empty()) {
    return fail("export into what? Give --csv, --geojson or --kml a folder",
                skein::process::kExitBadInput);
  }
  for (const auto& [format, folder] : {std::pair{Format::csv, arguments.csv},
                                       {Format::geojson, arguments.geojson},
                                       {Format::kml, arguments.kml}}) {
    if (folder.empty()) continue;
    const auto written = skein::recording_export::write(arguments.recording, format, folder);
    if (!written) return fail(written.error().message, skein::process::kExitBadInput);
    std::printf("into %s:", folder.c_str());
    for (const std::string& file : written->files) std::printf(" %s", file.c_str());
    std::printf("\n");
    if (written->damaged > 0) {
      std::fprintf(stderr, "skein-ground: warning: %zu damaged parts are left out\n",
                   written->damaged);
    }
    if (!written->complete) {
      std::fprintf(stderr,
                   "skein-ground: warning: not closed by its process, the end may be missing\n");
    }
  }
  return 0;
}

struct AuditArguments {
  std::string file;
  std::string keys;
};

/// The certificate of the mission's authority, from the folder of a member's or the mission's keys.
skein::Result<skein::identity::Certificate> authority_of(const std::string& folder) {
  auto membership = skein::identity::read_membership(skein::identity::KeyFolder::of(folder));
  if (!membership) return membership.error();
  return std::move(membership->authority);
}

const char* verdict_on(const groundstation::AuditFindings& findings, bool are_checked) {
  if (!findings.good()) return "CHANGED";
  if (!are_checked) return "the chain holds; no signature was checked";
  if (findings.good_signatures == 0) return "NOT PROVEN: the chain holds, but nothing signs it";
  return findings.after_signature == 0 ? "unchanged" : "unchanged up to its last signature";
}

int verify_audit(const AuditArguments& arguments) {
  std::ifstream file{arguments.file, std::ios::binary};
  if (!file) return fail("cannot read " + arguments.file, skein::process::kExitBadInput);
  const std::string text{std::istreambuf_iterator<char>{file}, {}};
  std::optional<skein::identity::Certificate> authority;
  if (!arguments.keys.empty()) {
    auto found = authority_of(arguments.keys);
    if (!found) return fail(found.error().message, skein::process::kExitBadInput);
    authority = *std::move(found);
  }
  const auto findings = groundstation::verify_audit(text, authority ? &*authority : nullptr);
  for (const std::string& fault : findings.faults) std::printf("%s\n", fault.c_str());
  for (const std::string& remark : findings.remarks) std::printf("note: %s\n", remark.c_str());
  std::printf("%s: %zu orders and decisions, %zu signatures: %s\n", arguments.file.c_str(),
              findings.entries, findings.signatures, verdict_on(findings, authority.has_value()));
  const bool is_proven = !authority || findings.good_signatures > 0;
  return findings.good() && is_proven ? 0 : kExitRefused;
}

/// The command line: each command knows what to do once it was given.
class CommandLine {
 public:
  CommandLine() {
    app_.footer(
        "Examples:\n"
        "  skein-ground --config ground.yaml\n"
        "  skein-ground formation --config ground.yaml preview form wedge spacing 5\n"
        "  skein-ground tell --config ground.yaml --json status\n"
        "  skein-ground plan scenarios/routes-3.yaml\n"
        "  skein-ground info runs/mine/mission.mcap\n"
        "  skein-ground replay runs/mine\n\n"
        "At its prompt, `help` lists the commands. Without a terminal it runs on and logs.\n"
        "The keys of the file are explained in docs/configuration.md. The process ends on\n"
        "SIGINT, SIGTERM or `quit` with exit code 0; 1 means that an order was refused, 2 bad\n"
        "arguments or configuration, 3 that it could not start or that none answers.");
    // One thread so far. NOLINTNEXTLINE(concurrency-mt-unsafe)
    const char* user = std::getenv("USER");
    arguments_.operator_name = user != nullptr && *user != '\0' ? user : "operator";
    app_.add_option("--config", arguments_.config, "The ground station's configuration, YAML");
    app_.add_option("--operator", arguments_.operator_name, "Who decides at the prompt")
        ->capture_default_str();
    app_.add_flag("--check-config", arguments_.check_only,
                  "Read the configuration, say whether it is good, end");
    app_.add_flag("--watch", arguments_.watch,
                  "Of one of several ground stations: its operator takes the command, it does not "
                  "by itself");
    app_.set_version_flag("--version", "skein-ground " + skein::version());
    app_.set_help_all_flag("--help-all", "The same of every command");
    app_.require_subcommand(0, 1);  // 'tell record stop': what follows a command is its own
    add_orders();
    add_plan();
    add_password();
    add_unlock();
    for (const CLI::App* group :
         {&missions_.mission(), &missions_.keys(), &missions_.enrolment()}) {
      actions_[group] = [this] { return missions_.run(); };
    }
    add_recordings();
    add_replay();
    add_audit();
  }

  int run(int argc, char** argv) {
    if (const auto ends = skein::command_line::read(app_, argc, argv)) return *ends;
    const auto given = app_.get_subcommands();
    return given.empty() ? ::run(arguments_) : actions_.at(given.front())();
  }

 private:
  CLI::App& add(const char* name, const char* description, std::function<int()> action) {
    CLI::App& command = *app_.add_subcommand(name, description);
    actions_[&command] = std::move(action);
    return command;
  }

  /// A command that hands the rest of its words, as one line, to a running ground station.
  void add_tell(const char* name, const char* description, const char* footer,
                const std::function<int(const std::vector<std::string>&)>& action) {
    CLI::App& command = *app_.add_subcommand(name, description);
    command.add_option("--config", arguments_.config,
                       "The running ground station's configuration; without it, the one of the "
                       "default port is told");
    command.add_option("--socket", arguments_.socket, "The name of its control socket, instead");
    command.add_flag("--json", arguments_.json, "Answer in JSON: done, text, data");
    command.footer(footer);
    command.prefix_command();
    actions_[&command] = [&command, action] { return action(command.remaining()); };
  }

  void add_orders() {
    add_tell("formation",
             "Gives the formation of a running ground station an order, as at its prompt",
             "Examples:\n"
             "  skein-ground formation take-off\n"
             "  skein-ground formation preview form wedge spacing 5 heading 90\n"
             "  skein-ground formation --config runs/mine/ground.yaml form heart\n"
             "  skein-ground formation places",
             [this](const auto& words) { return tell_formation(CLI::detail::join(words, " ")); });
    add_tell("tell",
             "Gives a running ground station any line of its prompt: the words behind the options",
             "`skein-ground tell help` lists what it knows. Examples:\n"
             "  skein-ground tell status\n"
             "  skein-ground tell --socket skein-ground-7400 hold all",
             [this](const auto& words) { return tell(arguments_, CLI::detail::join(words, " ")); });
    add_tell(
        "record",
        "Has a running ground station record into a folder, which is named behind the options, "
        "or stop",
        "Examples:\n"
        "  skein-ground record runs/evening\n"
        "  skein-ground record stop",
        [this](const auto& words) {
          // The ground station may have been started elsewhere.
          const bool folder = words.size() == 1 && words[0] != "stop";
          return tell(arguments_, "record " + (folder ? std::filesystem::absolute(words[0]).string()
                                                      : CLI::detail::join(words, " ")));
        });
  }

  void add_unlock() {
    const auto add_one = [this](const char* name, const char* description,
                                bool locks) -> CLI::App& {
      CLI::App& command =
          add(name, description, [this, locks] { return unlock(arguments_, locks); });
      command.add_option("--config", arguments_.config,
                         "The running ground station's configuration; without it, the one of the "
                         "default port is told");
      command.add_option("--socket", arguments_.socket, "The name of its control socket, instead");
      return command;
    };
    CLI::App& opens =
        add_one("unlock",
                "Unlocks an operator's key in a running ground station: what is authorised at "
                "its prompt and command line is signed with it",
                false);
    opens.add_option("--operator", arguments_.operator_name, "Whose")->capture_default_str();
    opens.footer(
        "The password is asked for, or read from standard input.\n"
        "Example:\n"
        "  skein-ground unlock --operator ada");
    add_one("lock",
            "Locks the operator's key that unlock opened: nobody signs at the prompt and command "
            "line until one is unlocked again",
            true)
        .footer(
            "Example:\n"
            "  skein-ground lock --config ground.yaml");
  }

  int tell_formation(const std::string& line) {
    if (!groundstation::is_of_formation(line)) {
      return fail("'" + line +
                      "' is no order to the formation: take-off, rally, form SHAPE, land, preview "
                      "and one of these, or places",
                  skein::process::kExitBadInput);
    }
    return tell(arguments_, line);
  }

  void add_plan() {
    CLI::App& command =
        add("plan", "Plans a mission file's routes, or the tasks at its known sites, before it",
            [this] { return plan(planning_); });
    command
        .add_option("scenario", planning_.scenario,
                    "A mission with `routes`, or with sites that `tasking` knows; YAML")
        ->required();
    command.add_option("--out", planning_.folder, "Folder for the plan (default: runs/NAME)");
    command.add_option("--seed", planning_.seed, "Of routes, in place of the mission's")
        ->check(why_no_seed);
    command.add_flag("--all-known", planning_.all_known, "Every site of the mission is known");
    const auto& criteria = skein::configuration::kCriteria;
    command.add_option("--criterion", planning_.criterion, "Of tasks, in place of the mission's")
        ->check(CLI::IsMember(std::set<std::string>(criteria.begin(), criteria.end())));
    command
        .add_option("--time", planning_.seconds,
                    "Of tasks: seconds to plan for (default: some seconds of work, with which the "
                    "same mission gives the same plan on every machine)")
        ->check(skein::command_line::number_in(0.01, 86400.0));
    command.footer(
        "Examples:\n"
        "  skein-ground plan scenarios/routes-3.yaml\n"
        "  skein-ground plan scenarios/coalition-32.yaml --all-known --criterion makespan\n\n"
        "Writes plan.yaml, which `skein-hil run --routes` flies (of tasks `simulate --routes`, "
        "too).\n"
        "Of routes also GeoJSON, KML, a .plan for each vehicle that QGroundControl reads, and a\n"
        "picture. Exit status 1: no plan, or a rule is broken; 2: bad arguments or mission.");
  }

  void add_password() {
    CLI::App& command = add("password", "Makes the line of a user for the console's password file",
                            [this] { return password(account_); });
    command.add_option("name", account_.name, "Who it is for")->required();
    command.add_flag("--observer", account_.observer, "May look, but give no orders");
    command.footer(
        "The password is asked for, or read from standard input.\n"
        "Example:\n"
        "  skein-ground password ada >> passwords    # a file of mode 600");
  }

  void add_recordings() {
    CLI::App& look =
        add("info", "Tells what is in a recording", [this] { return info(looked_at_); });
    look.add_option("recording", looked_at_, "An MCAP file, or a folder of a node or a run")
        ->required();
    look.footer(
        "Example:\n"
        "  skein-ground info runs/mine/mission.mcap");
    CLI::App& command = add("export", "Writes a recording's tracks and events for other tools",
                            [this] { return export_recording(exporting_); });
    command
        .add_option("recording", exporting_.recording,
                    "An MCAP file, or a folder of a node or a run")
        ->required();
    command.add_option("--csv", exporting_.csv, "Folder for tables: all numbers, exact");
    command.add_option("--geojson", exporting_.geojson, "Folder for flight.geojson");
    command.add_option("--kml", exporting_.kml, "Folder for flight.kml");
    command.footer(
        "Example:\n"
        "  skein-ground export runs/mine --csv tables --kml .");
  }

  void add_replay() {
    CLI::App& command = add("replay", "Shows a recording in the console, as it was", [this] {
      return groundstation::replay(
          replaying_.recording, replaying_.console, replaying_.speed,
          replaying_.at_s ? std::optional{skein::at_seconds(*replaying_.at_s)} : std::nullopt);
    });
    command
        .add_option("recording", replaying_.recording,
                    "An MCAP file, or a folder of a node or a run")
        ->required();
    command.add_option("--port", replaying_.console.port, "Of the console, on loopback")
        ->capture_default_str();
    command.add_option("--speed", replaying_.speed, "Recorded seconds in a second")
        ->check(skein::command_line::number_in(0.1, 100.0))
        ->capture_default_str();
    command.add_option("--at", replaying_.at_s,
                       "Seconds of mission time: shows that moment, paused");
    command.add_option("--tiles", replaying_.console.tiles,
                       "Map: a folder z/x/y.png or an MBTiles file");
    command.footer(
        "A node's recording shows what that node heard; a run's, what every node said.\n"
        "Example:\n"
        "  skein-ground replay runs/mine --speed 4");
  }

  void add_audit() {
    CLI::App& group = add("audit", "Looks at the log of who gave which order, audit.jsonl",
                          [this] { return verify_audit(auditing_); });
    group.require_subcommand(1);
    group.footer(
        "Example:\n"
        "  skein-ground audit verify /var/lib/skein/ground/audit.jsonl");
    CLI::App& verify = *group.add_subcommand(
        "verify", "Says whether a line was changed, left out or put in, and who signed");
    verify.add_option("file", auditing_.file, "audit.jsonl of a ground station's recording folder")
        ->required();
    verify.add_option("--keys", auditing_.keys,
                      "Folder of the mission's keys, or of a member's: its authority is believed");
    verify.footer(
        "Exit status 0: unchanged as far as it is signed; 1: changed, or nothing signs it.\n"
        "Example:\n"
        "  skein-ground audit verify /var/lib/skein/ground/audit.jsonl "
        "--keys /var/lib/skein/ground/keys");
  }

  CLI::App app_{
      "The ground station: shows the fleet and its mission, and is where an operator\n"
      "authorises or refuses deliveries and gives a formation its orders."};
  std::map<const CLI::App*, std::function<int()>> actions_;
  groundstation::MissionCommands missions_{app_};
  Arguments arguments_;
  PlanArguments planning_;
  PasswordArguments account_;
  std::string looked_at_;
  ExportArguments exporting_;
  ReplayArguments replaying_;
  AuditArguments auditing_;
};

}  // namespace

int main(int argc, char** argv) {
  if (const auto status = skein::network::run_carrier(argc, argv)) return *status;
  return CommandLine{}.run(argc, argv);
}
