// SPDX-License-Identifier: Apache-2.0
#include "skein/fleet/remote.hpp"

#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <map>
#include <sstream>
#include <string_view>

#include "command.hpp"

namespace skein::fleet {
namespace {

using configuration::Host;

constexpr std::chrono::seconds kAnswerWithin{90};  ///< a unit may take 60 of them to start
constexpr std::chrono::minutes kCollectWithin{10};
constexpr int kSshFailed = 255;
// What our scripts end with.
constexpr int kRuns = 75;
constexpr int kBadConfiguration = 76;
constexpr int kDidNotStay = 77;
constexpr int kDidNotEnd = 78;
constexpr int kFlies = 79;
constexpr int kMayFly = 80;

/// One word for a shell.
std::string shell_word(std::string_view text) {
  std::string word = "'";
  for (const char c : text) {
    if (c == '\'') {
      word += "'\\''";
    } else {
      word += c;
    }
  }
  return word + "'";
}

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream{text};
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

std::string last_line(std::string_view text) {
  while (!text.empty() && text.back() == '\n') text.remove_suffix(1);
  const auto begin = text.rfind('\n');
  return std::string{begin == std::string_view::npos ? text : text.substr(begin + 1)};
}

std::string place_of(const Host& host) {
  return host.ssh.empty() ? host.address : host.ssh + ", " + host.address;
}

/// Runs the script there; fails where the host was not reached.
Result<CommandOutcome> run_on(const Host& host, const std::string& script, std::string_view input,
                              std::chrono::milliseconds within = kAnswerWithin,
                              const std::filesystem::path& into = {}) {
  auto outcome = run_command(command_on(host, script), input, within, into);
  const auto unreached = [&](const std::string& why) {
    return Error{fmt::format("the host of {} ({}) is not reached: {}", name_of(host.node),
                             place_of(host), why)};
  };
  if (!outcome) return unreached(outcome.error().message);
  if (!host.ssh.empty() && outcome->status == kSshFailed) {
    return unreached(last_line(outcome->errors));
  }
  return outcome;
}

Error failed(const Program& program, const std::string& what, const CommandOutcome& outcome) {
  const std::string why = last_line(outcome.errors);
  return Error{fmt::format("{} ({}): {}{}{}", name_of(program.host.node), place_of(program.host),
                           what, why.empty() ? "" : ": ", why)};
}

/// Makes of a program what the scripts below use: main_pid prints its process id, and fails where
/// it does not run; state prints a word; runs says whether it does, or will by itself.
std::string names(const Program& program) {
  const Host& host = program.host;
  std::string script = fmt::format("file={} unit={} program={}\n", shell_word(program.file),
                                   shell_word(program.unit), shell_word(program.command.front()));
  if (host.programs.empty()) {
    return script +
           "main_pid() { systemctl is-active --quiet \"$unit\" && "
           "systemctl show -p MainPID --value \"$unit\"; }\n"
           "state() { systemctl is-active \"$unit\"; }\n"
           // One that waits to be started again runs in a moment.
           "runs() { case $(systemctl is-active \"$unit\") in inactive|failed|unknown) return 1;; "
           "esac; }\n";
  }
  // A process id is used again by others: the command line says whether it is still ours.
  return script +
         fmt::format("pidfile={0} log={1} mark={2}\n",
                     shell_word(host.recordings + "/" + program.name + ".pid"),
                     shell_word(host.recordings + "/" + program.name + ".log"),
                     shell_word(program.mark)) +
         "main_pid() { p=$(cat \"$pidfile\" 2>/dev/null) && [ -r \"/proc/$p/cmdline\" ] && "
         "tr '\\0' ' ' <\"/proc/$p/cmdline\" | grep -qF -- \"$mark\" && echo \"$p\"; }\n"
         "state() { if main_pid >/dev/null; then echo running; else echo stopped; fi; }\n"
         "runs() { main_pid >/dev/null; }\n";
}

/// Puts what comes in where `path` is: complete, on the disk, or not at all.
std::string put_script(const std::string& path) {
  return fmt::format(
      "path={}\n"
      "new=\"${{path%/*}}/.${{path##*/}}.new\"\n"
      "mkdir -p \"${{path%/*}}\" && cat >\"$new\" && chmod 644 \"$new\" && sync \"$new\" || exit "
      "1\n",
      shell_word(path));
}
/// As put_script, for whoever has the folder below which it is put.
std::string put_secret_script(const std::string& path) {
  return fmt::format(
      "path={}\n"
      "there=${{path%/*}}; made=$path\n"
      "while [ ! -d \"$there\" ]; do made=$there; there=${{there%/*}}; done\n"
      "umask 077; new=\"$path.new\"\n"
      "mkdir -p \"${{path%/*}}\" && cat >\"$new\" && mv -f \"$new\" \"$path\" || exit 1\n"
      "[ \"$(id -u)\" -ne 0 ] || chown -R --reference=\"$there\" \"$made\"\n",
      shell_word(path));
}
constexpr std::string_view kRename = "mv -f \"$new\" \"$path\" && sync \"${path%/*}\"\n";

/// A configuration that the program there refuses must not replace one that it takes.
constexpr std::string_view kCheck =
    "if command -v \"$program\" >/dev/null; then\n"
    "  said=$(\"$program\" --config \"$new\" --check-config 2>&1) || "
    "{ echo \"$said\" >&2; rm -f \"$new\"; exit 76; }\n"
    "fi\n";

std::string start_script(const Program& program) {
  std::string script = names(program) + "main_pid >/dev/null && exit 0\n";
  if (program.host.programs.empty()) {
    return script +
           "systemctl start \"$unit\" || exit 77\n"
           "main_pid >/dev/null || { systemctl is-active \"$unit\" >&2; exit 77; }\n";
  }
  std::string command;
  for (const std::string& word : program.command) command += " " + shell_word(word);
  script += "mkdir -p \"${pidfile%/*}\" || exit 77\n";
  script +=
      program.realtime ? "first=; chrt -f 70 true 2>/dev/null && first='chrt -f 70'\n" : "first=\n";
  // It is a session of its own, so that it outlives ours. Half a second shows whether it stays.
  return script + fmt::format("setsid $first{} </dev/null >>\"$log\" 2>&1 &\n", command) +
         "echo $! >\"$pidfile\"\n"
         "for i in 1 2 3 4 5; do sleep 0.1; kill -0 \"$(cat \"$pidfile\")\" 2>/dev/null || break; "
         "done\n"
         "main_pid >/dev/null || { tail -n 1 \"$log\" >&2; exit 77; }\n";
}

std::string stop_script(const Program& program, bool force) {
  std::string script = names(program);
  if (program.host.programs.empty()) {
    script += "runs || exit 0\n";
    if (!force && !program.is_ground()) {
      // It says 1 on the ground, and 3 where no process has the socket.
      script += fmt::format(
          "\"$program\" status --socket /run/skein/{}.sock --flying >/dev/null 2>&1\n"
          "case $? in 0) exit 79;; 1|3) ;; *) exit 80;; esac\n",
          program.name);
    }
    return script + "systemctl stop \"$unit\" || exit 78\n";
  }
  return script +
         "p=$(main_pid) || exit 0\n"
         "kill -TERM \"$p\" || exit 78\n"
         "i=0\n"
         "while main_pid >/dev/null; do\n"
         "  i=$((i + 1)); [ $i -gt 100 ] && exit 78\n"
         "  sleep 0.1\n"
         "done\n"
         "rm -f \"$pidfile\"\n";
}

/// Prints its clock first, then a line for each thing, then the configuration.
std::string status_script(const Program& program) {
  return "date +%s%N\n" + names(program) +
         "echo \"state $(state)\"\n"
         "echo \"version $(\"$program\" --version 2>/dev/null)\"\n"
         "if p=$(main_pid); then\n"
         "  age=$(ps -o etimes= -p \"$p\") || age=0\n"
         "  echo \"running $(($(date +%s) - age))\"\n"
         "fi\n"
         "if [ -r \"$file\" ]; then\n"
         "  echo \"written $(stat -c %Y \"$file\")\"\n"
         "  echo configuration\n"
         "  cat \"$file\"\n"
         "fi\n";
}

/// Of "KEY VALUE" lines, until a line that is `configuration`; what follows it is that.
struct Said {
  std::map<std::string, std::string> values;
  std::optional<std::string> configuration;
};
Said read(const std::string& text) {
  Said said;
  std::istringstream stream{text};
  for (std::string line; std::getline(stream, line);) {
    if (line == "configuration") {
      std::ostringstream rest;
      rest << stream.rdbuf();
      said.configuration = rest.str();
      break;
    }
    const auto space = line.find(' ');
    said.values[line.substr(0, space)] = space == std::string::npos ? "" : line.substr(space + 1);
  }
  return said;
}

std::optional<std::int64_t> number_of(const std::string& text) {
  std::int64_t value = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end.ec != std::errc{}) return std::nullopt;
  return value;
}

template <class Config>
void compare(const Result<Config>& there, const Result<Config>& ours, Status& status) {
  if (!there) {
    status.unreadable = there.error().message;
    return;
  }
  if (ours) status.drift = configuration::differences(*there, *ours);
}

void compare(const Program& program, const std::string& there, Status& status) {
  if (program.is_ground()) {
    return compare(configuration::parse_ground_config(there, program.file),
                   configuration::parse_ground_config(program.configuration, program.name), status);
  }
  compare(configuration::parse_vehicle_config(there, program.file),
          configuration::parse_vehicle_config(program.configuration, program.name), status);
}

double seconds_of(std::chrono::nanoseconds duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

std::vector<std::string> command_on(const Host& host, const std::string& script) {
  std::vector<std::string> command = words_of(host.run);
  command.insert(command.end(), {"sh", "-c", script});
  if (host.ssh.empty()) return command;
  std::string line;  // ssh gives its words to a shell there
  for (const std::string& word : command) line += (line.empty() ? "" : " ") + shell_word(word);
  return {"ssh", "-o", "BatchMode=yes", "-o", "ConnectTimeout=5", "--", host.ssh, line};
}

Result<void> push(const Program& program, bool force) {
  std::string guard = names(program);
  if (!force) guard += "if runs; then exit 75; fi\n";
  for (const HostFile& file : program.more) {
    const std::string script =
        file.secret ? put_secret_script(file.path) : put_script(file.path) + std::string{kRename};
    const auto put = run_on(program.host, guard + script, file.text);
    if (!put) return put.error();
    if (put->status == kRuns) break;  // which is told below
    if (put->status != 0) return failed(program, file.path + " could not be written", *put);
  }
  std::string script = guard + put_script(program.file);
  script.append(kCheck).append(kRename);
  const auto put = run_on(program.host, script, program.configuration);
  if (!put) return put.error();
  switch (put->status) {
    case 0:
      return {};
    case kRuns:
      return Error{fmt::format(
          "{} ({}) runs, perhaps in flight: it is given no other configuration; stop it first, or "
          "--force, which it heeds at its next start",
          name_of(program.host.node), place_of(program.host))};
    case kBadConfiguration:
      return failed(program, "its program refuses the configuration; is it of this version?", *put);
    default:
      return failed(program, program.file + " could not be written", *put);
  }
}

Result<void> start(const Program& program) {
  const auto outcome = run_on(program.host, start_script(program), "");
  if (!outcome) return outcome.error();
  if (outcome->status == 0) return {};
  if (outcome->status == kDidNotStay) {
    return failed(program, program.name + " does not stay up", *outcome);
  }
  return failed(program, program.name + " could not be started", *outcome);
}

Result<void> stop(const Program& program, bool force) {
  const auto outcome = run_on(program.host, stop_script(program, force), "");
  if (!outcome) return outcome.error();
  if (outcome->status == 0) return {};
  if (outcome->status == kFlies) {
    return Error{fmt::format(
        "{} ({}) flies: land it first, or --force, and its flight controller's failsafe takes over",
        name_of(program.host.node), place_of(program.host))};
  }
  if (outcome->status == kMayFly) {
    return Error{fmt::format(
        "{} ({}) does not say whether it flies: look, and --force where it is on the ground",
        name_of(program.host.node), place_of(program.host))};
  }
  if (outcome->status == kDidNotEnd) {
    return failed(program, program.name + " was asked to end and still runs", *outcome);
  }
  return failed(program, program.name + " could not be stopped", *outcome);
}

Status status(const Program& program) {
  Status status;
  const auto outcome = run_on(program.host, status_script(program), "");
  if (!outcome || outcome->status != 0) {
    status.trouble = outcome ? failed(program, "its state is not told", *outcome).message
                             : outcome.error().message;
    return status;
  }
  status.reachable = true;
  const auto clock_end = outcome->output.find('\n');
  if (const auto clock = number_of(outcome->output.substr(0, clock_end))) {
    const std::chrono::nanoseconds ours = outcome->first_output.time_since_epoch();
    status.clock_offset_s = seconds_of(std::chrono::nanoseconds{*clock} - ours);
  }
  Said said = read(outcome->output.substr(clock_end + 1));
  status.state = said.values["state"];
  status.version = said.values["version"];
  const auto since = number_of(said.values["running"]);
  const auto written = number_of(said.values["written"]);
  status.running = since.has_value();
  status.outdated = since && written && *written > *since;
  status.configured = said.configuration.has_value();
  if (status.configured) compare(program, *said.configuration, status);
  return status;
}

Result<void> collect(const Host& host, const std::string& from,
                     const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  const auto archive = folder / ".collected.tar";
  const auto packed =
      run_on(host, "tar -C " + shell_word(from) + " -cf - .", "", kCollectWithin, archive);
  if (!packed) return packed.error();
  const auto unpacked =
      packed->status == 0
          ? run_command({"tar", "-C", folder.string(), "-xf", archive.string()}, "", kCollectWithin)
          : packed;
  std::filesystem::remove(archive, failure);
  if (!unpacked) return unpacked.error();
  if (unpacked->status == 0) return {};
  return Error{fmt::format("the recordings of {} ({}) in {} are not to be had: {}",
                           name_of(host.node), place_of(host), from, last_line(unpacked->errors))};
}

Result<void> remove(const Host& host, const std::string& folder) {
  const auto removed = run_on(host, "rm -rf -- " + shell_word(folder), "");
  if (!removed) return removed.error();
  if (removed->status == 0) return {};
  return Error{folder + " on " + place_of(host) + " is not removed: " + last_line(removed->errors)};
}

}  // namespace skein::fleet
