// SPDX-License-Identifier: Apache-2.0
#include "mission_commands.hpp"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <system_error>
#include <utility>

#include "skein/base/stations.hpp"
#include "skein/console/users.hpp"
#include "skein/identity/authority.hpp"
#include "skein/identity/identity.hpp"
#include "skein/identity_desk/given.hpp"
#include "skein/identity_desk/keys_shown.hpp"
#include "skein/process/log.hpp"
#include "typed_password.hpp"

namespace skein::groundstation {
namespace {

using identity::Authority;
using identity_desk::now_unix_s;

constexpr int kExitRefused = 1;

int fail(const std::string& why, int status) {
  std::fprintf(stderr, "skein-ground: %s\n", why.c_str());
  return status;
}

/// "vehicle 3", "station 2"
std::string name_of(VehicleId node) {
  return is_station(node) ? "station " + std::to_string(station_number(node))
                          : "vehicle " + std::to_string(node.value);
}

int refuse(const Error& error) { return fail(error.message, kExitRefused); }

Result<std::vector<identity::Request>> read_requests(const std::vector<std::string>& given) {
  std::vector<identity::Request> requests;
  for (const std::string& argument : given) {
    const auto lines = identity_desk::given_lines(argument, "SKEIN-");
    if (!lines) return lines.error();
    for (const std::string& line : *lines) {
      const auto request = identity::request_from_text(line);
      if (!request) return Error{argument.substr(0, 60) + ": " + request.error().message};
      requests.push_back(*request);
    }
  }
  return requests;
}

/// Did somebody compare them?
bool are_compared() {
  std::fputs("Does each of them show the same? [y/N] ", stderr);
  std::string answer;
  std::getline(std::cin, answer);
  return answer == "y" || answer == "yes";
}

Result<void> write_answers(const std::vector<identity::Membership>& answers,
                           const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  for (const auto& answer : answers) {
    std::string name = name_of(answer.own.node) + ".txt";
    std::ranges::replace(name, ' ', '-');
    const auto file = folder / name;
    std::ofstream stream{file};
    stream << to_text(answer) << '\n';
    if (!stream.flush()) return Error{"cannot write " + file.string()};
    std::printf("%s\n", file.c_str());
  }
  return {};
}

std::optional<identity::Serial> find(const Authority& authority, const std::string& kind,
                                     const std::string& which) {
  if (kind == "operator") return authority.serial_of(which);
  VehicleId vehicle;
  const auto [end, error] =
      std::from_chars(which.data(), which.data() + which.size(), vehicle.value);
  if (error != std::errc{} || end != which.data() + which.size()) return std::nullopt;
  if (kind == "vehicle") {
    return is_station(vehicle) ? std::nullopt : authority.serial_of(vehicle);
  }
  const bool is_number = vehicle.value >= 1 && vehicle.value <= kStationsMax;
  return is_number ? authority.serial_of(station_node(vehicle.value)) : std::nullopt;
}

}  // namespace

MissionCommands::MissionCommands(CLI::App& app) {
  mission_ = app.add_subcommand("mission", "Makes a mission, and says who takes part in it");
  mission_->require_subcommand(1);
  mission_->footer(
      "A team of five, from nothing: docs/keys.md. Exit status 1: refused, 2: bad arguments.");
  add_create();
  add_enrol();
  add_operator();
  add_revoke();
  keys_ = app.add_subcommand("keys", "Tells of the keys and members of a mission");
  keys_->require_subcommand(1);
  keys_->footer(
      "Example:\n"
      "  skein-ground keys show --keys keys/ground");
  add_show();
  add_enrolment(app);
}

int MissionCommands::run() const {
  if (enrolment_->parsed()) return membership_.empty() ? ask_to_enrol() : keep_answer();
  const CLI::App& group = mission_->parsed() ? *mission_ : *keys_;
  return actions_.at(group.get_subcommands().front())();
}

CLI::App& MissionCommands::add(CLI::App& to, const char* name, const char* description,
                               std::function<int()> action) {
  CLI::App& command = *to.add_subcommand(name, description);
  command.add_option("--keys", folder_, "The mission's folder on the ground station's machine")
      ->capture_default_str();
  actions_[&command] = std::move(action);
  return command;
}

void MissionCommands::add_create() {
  CLI::App& command =
      add(*mission_, "create", "Makes a mission's authority and the ground station's keys",
          [this] { return create(); });
  command.add_option("name", name_, "Of the mission")->required();
  command.add_option("--days", days_, "How long its certificates are valid")->capture_default_str();
  command.footer(
      "Example:\n"
      "  skein-ground mission create ridge --keys keys/ground");
}

void MissionCommands::add_enrol() {
  CLI::App& command =
      add(*mission_, "enrol",
          "Takes vehicles and other ground stations into the mission, by their requests",
          [this] { return enrol(); });
  command
      .add_option("request", requests_,
                  "What skein-onboard enrol, or skein-ground enrol on another ground station's "
                  "machine, printed: the line itself, files of such lines, or -")
      ->required();
  command.add_option("--out", out_, "Folder for the answers, a file each (default: printed)");
  command.add_flag("--yes", yes_, "The fingerprints were compared; ask nothing");
  command.footer(
      "The answers are of no use to others: bring them to the vehicles in whatever way, for\n"
      "skein-onboard enrol --membership.\n"
      "Examples:\n"
      "  skein-ground mission enrol requests/*.txt --out memberships\n"
      "  skein-ground mission enrol SKEIN-REQUEST-1:...");
}

void MissionCommands::add_enrolment(CLI::App& app) {
  enrolment_ = app.add_subcommand("enrol",
                                  "Of another ground station than the mission's own: makes its "
                                  "keys and asks to take part, or keeps the answer");
  enrolment_->add_option("--station", station_, "Its number, from 2 on")
      ->check(CLI::Range(std::uint16_t{2}, kStationsMax));
  enrolment_->add_option("--keys", folder_, "Folder of its keys")->capture_default_str();
  enrolment_->add_option("--membership", membership_,
                         "The mission's answer: the line itself, its file, or -");
  enrolment_->add_flag("--new-keys", new_keys_, "Makes others, where the old ones were revoked");
  enrolment_->add_flag("--replace", replace_, "Leaves the mission that it is a member of");
  enrolment_->footer(
      "The request is for skein-ground mission enrol on the mission's own ground station. Who is "
      "to\n"
      "authorise deliveries here needs his key here, too: copy operators/NAME.key.\n"
      "Examples:\n"
      "  skein-ground enrol --station 2 > station-2.txt\n"
      "  skein-ground enrol --membership memberships/station-2.txt");
}

int MissionCommands::ask_to_enrol() const {
  if (station_ == 0) return fail("which ground station? --station N", process::kExitBadInput);
  const auto keys = identity::KeyFolder::of(folder_);
  const VehicleId node = station_node(station_);
  const auto key = new_keys_ ? identity::make_new_node_key(keys, node)
                             : identity::read_or_make_node_key(keys, node);
  if (!key) return refuse(key.error());
  std::printf("%s\n", to_text(request_of(*key)).c_str());
  std::fprintf(stderr, "%s: %s\n", name_of(node).c_str(), fingerprint(*key).c_str());
  return 0;
}

int MissionCommands::keep_answer() const {
  const auto membership = identity_desk::given_membership(membership_);
  if (!membership) return fail(membership.error().message, process::kExitBadInput);
  const auto kept = identity::store_membership(identity::KeyFolder::of(folder_), *membership,
                                               now_unix_s(), replace_);
  if (!kept) return refuse(kept.error());
  std::printf("%s is of the mission %s until %s\nauthority %s\n",
              name_of(membership->own.node).c_str(), membership->authority.name.c_str(),
              identity::utc_text(membership->own.not_after_unix_s).c_str(),
              fingerprint(membership->authority).c_str());
  return 0;
}

void MissionCommands::add_operator() {
  CLI::App& command =
      add(*mission_, "operator", "Makes an operator's key, which his password unlocks",
          [this] { return enrol_operator(); });
  command.add_option("name", name_, "Of the operator")->required();
  command.footer(
      "The password is asked for, or read from standard input. Printed is his line for the\n"
      "console's password file, as skein-ground password prints it.\n"
      "Example:\n"
      "  skein-ground mission operator ada >> passwords    # a file of mode 600");
}

void MissionCommands::add_revoke() {
  CLI::App& command =
      add(*mission_, "revoke",
          "Puts a vehicle, an operator or another ground station out of the mission",
          [this] { return revoke(); });
  command.add_option("kind", kind_, "vehicle, station or operator")
      ->required()
      ->check(CLI::IsMember({"vehicle", "station", "operator"}));
  command
      .add_option("which", which_,
                  "The number of the vehicle or the ground station, or the operator's name")
      ->required();
  command.footer(
      "All others are given another key.\n"
      "Example:\n"
      "  skein-ground mission revoke vehicle 3");
}

void MissionCommands::add_show() {
  CLI::App& command =
      add(*keys_, "show", "Shows mission, members and what is wrong", [this] { return show(); });
  command.add_flag("--json", json_, "For programs");
}

int MissionCommands::create() const {
  const auto made = Authority::create(folder_, name_, days_, now_unix_s());
  if (!made) return refuse(made.error());
  std::printf("mission %s until %s, keys in %s\nauthority %s\n", name_.c_str(),
              identity::utc_text(made->certificate().not_after_unix_s).c_str(), folder_.c_str(),
              fingerprint(made->certificate()).c_str());
  return 0;
}

int MissionCommands::enrol() const {
  const auto requests = read_requests(requests_);
  if (!requests) return fail(requests.error().message, process::kExitBadInput);
  for (const auto& request : *requests) {
    std::fprintf(stderr, "%s: %s\n", name_of(request.vehicle).c_str(),
                 identity::fingerprint(request.sign_key, request.agree_key).c_str());
  }
  if (!yes_ && ::isatty(STDIN_FILENO) != 1) {
    return fail("compare these with what the others show, and give --yes", kExitRefused);
  }
  if (!yes_ && !are_compared()) return fail("nobody was enrolled", kExitRefused);
  auto authority = Authority::open(folder_);  // not before: somebody may take his time to compare
  if (!authority) return refuse(authority.error());
  const auto answers = authority->enrol(*requests, now_unix_s());
  if (!answers) return refuse(answers.error());
  if (!out_.empty()) {
    const auto written = write_answers(*answers, out_);
    return written ? 0 : refuse(written.error());
  }
  for (const auto& answer : *answers) std::printf("%s\n", to_text(answer).c_str());
  return 0;
}

int MissionCommands::enrol_operator() const {
  std::string password = typed_password(name_);
  if (password.size() < kPasswordMin) {
    return fail("a password has at least 8 characters", process::kExitBadInput);
  }
  auto authority = Authority::open(folder_);
  if (!authority) return refuse(authority.error());
  const auto made = authority->enrol_operator(name_, password, now_unix_s());
  if (!made) return refuse(made.error());
  std::printf("%s:operator:%s\n", name_.c_str(), console::hash_password(password).c_str());
  identity::wipe(password);
  std::fprintf(stderr, "operator %s: %s\n", name_.c_str(), fingerprint(*made).c_str());
  return 0;
}

int MissionCommands::revoke() const {
  auto authority = Authority::open(folder_);
  if (!authority) return refuse(authority.error());
  const auto serial = find(*authority, kind_, which_);
  if (!serial) {
    return fail("there is no " + kind_ + " " + which_.substr(0, 60) +
                    " in this mission; skein-ground keys show lists them",
                kExitRefused);
  }
  if (const auto done = authority->revoke(*serial); !done) return refuse(done.error());
  std::printf("%s %s is out (certificate %u); the others have the key of epoch %u\n", kind_.c_str(),
              which_.c_str(), static_cast<unsigned>(serial->value),
              static_cast<unsigned>(authority->epoch()));
  return 0;
}

int MissionCommands::show() const {
  const auto shown = identity_desk::show_keys(identity::KeyFolder::of(folder_), now_unix_s());
  std::fputs(json_ ? (shown.json + "\n").c_str() : shown.text.c_str(), stdout);
  return shown.good ? 0 : kExitRefused;
}

}  // namespace skein::groundstation
