// SPDX-License-Identifier: Apache-2.0
#include "key_commands.hpp"

#include <cstdio>

#include "skein/identity/identity.hpp"
#include "skein/identity_desk/given.hpp"
#include "skein/identity_desk/keys_shown.hpp"
#include "skein/process/log.hpp"

namespace skein::onboard {
namespace {

using identity::KeyFolder;
using identity_desk::now_unix_s;

constexpr int kExitRefused = 1;
constexpr const char* kKeysHelp = "Folder of its keys (default: /var/lib/skein/onboard-ID/keys)";

int fail(const std::string& why, int status) {
  std::fprintf(stderr, "skein-onboard: %s\n", why.c_str());
  return status;
}

KeyFolder folder_of(const std::string& given, std::uint16_t id) {
  return KeyFolder::of(given.empty() ? "/var/lib/skein/onboard-" + std::to_string(id) + "/keys"
                                     : given);
}

}  // namespace

KeyCommands::KeyCommands(CLI::App& app) {
  enrol_ = app.add_subcommand("enrol",
                              "Makes this vehicle's keys and asks to take part in a "
                              "mission, or keeps the answer");
  enrol_->add_option("--id", id_, "The vehicle's number")->check(CLI::Range(1, 65535));
  enrol_->add_option("--keys", folder_, kKeysHelp);
  enrol_->add_option("--membership", membership_,
                     "The ground station's answer: the line itself, its file, or -");
  enrol_->add_flag("--new-keys", new_keys_, "Makes others, where the old ones were revoked");
  enrol_->add_flag("--replace", replace_, "Leaves the mission that it is a member of");
  enrol_->footer(
      "Prints a request for skein-ground mission enrol; the keys stay where they are, and a\n"
      "second time the same request is printed. Exit status 1: refused, 2: bad arguments.\n"
      "Examples:\n"
      "  skein-onboard enrol --id 3 > vehicle-3.txt\n"
      "  skein-onboard enrol --membership memberships/vehicle-3.txt");
  CLI::App& keys = *app.add_subcommand("keys", "Tells of this vehicle's keys and its mission");
  keys.require_subcommand(1);
  show_ = keys.add_subcommand("show", "Shows its mission and what is wrong");
  show_->add_option("--id", id_, "The vehicle's number")->check(CLI::Range(1, 65535));
  show_->add_option("--keys", folder_, kKeysHelp);
  show_->add_flag("--json", json_, "For programs");
}

bool KeyCommands::given() const { return enrol_->parsed() || show_->parsed(); }

int KeyCommands::run() const {
  if (!membership_.empty()) return store();
  if (id_ == 0 && (enrol_->parsed() || folder_.empty())) {
    return fail("which vehicle? --id N", process::kExitBadInput);
  }
  return enrol_->parsed() ? request() : show();
}

int KeyCommands::request() const {
  const KeyFolder keys = folder_of(folder_, id_);
  const auto key = new_keys_ ? identity::make_new_node_key(keys, VehicleId{id_})
                             : identity::read_or_make_node_key(keys, VehicleId{id_});
  if (!key) return fail(key.error().message, kExitRefused);
  std::printf("%s\n", to_text(request_of(*key)).c_str());
  std::fprintf(stderr, "vehicle %u: %s\n", static_cast<unsigned>(id_), fingerprint(*key).c_str());
  return 0;
}

int KeyCommands::store() const {
  const auto membership = identity_desk::given_membership(membership_);
  if (!membership) return fail(membership.error().message, process::kExitBadInput);
  const auto& [authority, own, keys] = *membership;
  const auto kept = identity::store_membership(folder_of(folder_, own.node.value), *membership,
                                               now_unix_s(), replace_);
  if (!kept) return fail(kept.error().message, kExitRefused);
  std::printf("vehicle %u is a member of the mission %s until %s\nauthority %s\n",
              static_cast<unsigned>(own.node.value), authority.name.c_str(),
              identity::utc_text(own.not_after_unix_s).c_str(), fingerprint(authority).c_str());
  return 0;
}

int KeyCommands::show() const {
  const auto shown = identity_desk::show_keys(folder_of(folder_, id_), now_unix_s());
  std::fputs(json_ ? (shown.json + "\n").c_str() : shown.text.c_str(), stdout);
  return shown.good ? 0 : kExitRefused;
}

}  // namespace skein::onboard
