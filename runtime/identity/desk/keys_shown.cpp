// SPDX-License-Identifier: Apache-2.0
#include "skein/identity_desk/keys_shown.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "skein/codec/json_text.hpp"
#include "skein/identity/identity.hpp"
#include "skein/identity/register.hpp"

namespace skein::identity_desk {
namespace {

using codec::Json;
using identity::Certificate;
using identity::Role;

constexpr std::int64_t kSecondsOfDay = 86'400;

/// What could be read, and why the rest could not.
struct Found {
  std::optional<identity::NodeKey> key;
  std::optional<identity::Membership> membership;
  std::optional<std::uint16_t> starts;
  std::optional<identity::Register> mission;  ///< in the authority's folder
  std::vector<std::string> problems;
};

template <class T>
void take(Found& found, std::optional<T>& into, Result<T> read) {
  if (read) {
    into = std::move(read).value();
  } else {
    found.problems.push_back(read.error().message);
  }
}

/// What is private in a node's folder and an authority's; none of it is for others.
void look_at_modes(Found& found, const std::filesystem::path& folder) {
  constexpr auto kOthers = std::filesystem::perms::group_all | std::filesystem::perms::others_all;
  std::vector<std::filesystem::path> files;
  std::error_code failed;
  for (const auto& where : {folder, folder / "operators"}) {
    for (const auto& entry : std::filesystem::directory_iterator{where, failed}) {
      if (entry.is_regular_file(failed)) files.push_back(entry.path());
    }
  }
  std::ranges::sort(files);
  for (const auto& file : files) {
    const auto mode = std::filesystem::status(file, failed).permissions();
    if (failed || (mode & kOthers) == std::filesystem::perms::none) continue;
    if (std::ranges::any_of(found.problems, [&file](const std::string& problem) {
          return problem.starts_with(file.string() + ":");
        })) {
      continue;
    }
    found.problems.push_back(
        fmt::format("{0}: others may read it, too (mode {1:04o}); chmod 600 {0}", file.string(),
                    static_cast<unsigned>(mode)));
  }
}

Found find(const identity::KeyFolder& keys, std::int64_t now_unix_s) {
  Found found;
  take(found, found.key, identity::read_node_key(keys));
  if (!found.key) return found;  // without keys the rest is of no use
  take(found, found.starts, identity::starts_of(keys));
  take(found, found.membership, identity::read_membership(keys));
  if (found.membership) {
    if (const auto opened = identity::Identity::open(keys, now_unix_s); !opened) {
      found.problems.push_back(opened.error().message);
    }
  }
  const auto file = identity::register_file(keys.folder);
  if (std::filesystem::exists(file)) take(found, found.mission, identity::read_register(file));
  if (found.mission && found.membership &&
      found.mission->key.epoch != found.membership->keys.grant.epoch) {
    found.problems.push_back(fmt::format(
        "{}: a command was cut off; any 'skein-ground mission' command there completes it",
        keys.folder.string()));
  }
  look_at_modes(found, keys.folder);
  return found;
}

bool is_revoked(const identity::Register& mission, const Certificate& member) {
  return mission.revoked.contains(member.serial);
}

std::string remaining(const Certificate& c, std::int64_t now_unix_s) {
  const std::int64_t left = c.not_after_unix_s - now_unix_s;
  if (left < 0) return "over";
  return left < 2 * kSecondsOfDay ? fmt::format("{} hours left", left / 3600)
                                  : fmt::format("{} days left", left / kSecondsOfDay);
}

std::string text_of(const identity::KeyFolder& keys, const Found& found, std::int64_t now_unix_s) {
  std::string text = fmt::format("keys         {}\n", keys.folder.string());
  if (found.membership) {
    const auto& [authority, own, change] = *found.membership;
    text.append(fmt::format("mission      {}, until {} ({})\n", authority.name,
                            identity::utc_text(authority.not_after_unix_s),
                            remaining(authority, now_unix_s)));
    text.append(fmt::format("             {}\n", to_text(authority.mission)));
    text.append(fmt::format("authority    {}\n", fingerprint(authority)));
    text.append(fmt::format("this node    {}, certificate {}\n", holder_of(own), own.serial.value));
    text.append(fmt::format("epoch        {}, {} revoked\n", change.grant.epoch,
                            change.revoked.serials.size()));
  } else if (found.key) {
    text.append(fmt::format("this node    {}, not enrolled\n", found.key->node.value));
  }
  if (found.key) text.append(fmt::format("fingerprint  {}\n", fingerprint(*found.key)));
  if (found.starts) text.append(fmt::format("starts       {}\n", *found.starts));
  if (found.mission) {
    text.append("members      certificate  fingerprint\n");
    for (const Certificate& member : found.mission->members) {
      text.append(fmt::format("             {:>11}  {}  {}{}\n", member.serial.value,
                              fingerprint(member), holder_of(member),
                              is_revoked(*found.mission, member) ? "  REVOKED" : ""));
    }
  }
  for (const std::string& problem : found.problems)
    text.append("problem      ").append(problem).append("\n");
  return text;
}

Json json_of(const Certificate& c) {
  Json json{{"certificate", c.serial.value}, {"role", to_text(c.role)}};
  if (c.role == Role::vehicle) json["vehicle"] = c.node.value;
  if (!c.name.empty()) json["name"] = c.name;
  json["fingerprint"] = fingerprint(c);
  json["not_before_unix_s"] = c.not_before_unix_s;
  json["not_after_unix_s"] = c.not_after_unix_s;
  return json;
}

Json json_of(const identity::KeyFolder& keys, const Found& found) {
  Json json{{"folder", keys.folder.string()}};
  if (found.membership) {
    const auto& [authority, own, change] = *found.membership;
    json["mission"] = json_of(authority);
    json["mission"]["id"] = to_text(authority.mission);
    json["epoch"] = change.grant.epoch;
    json["own"] = json_of(own);
  }
  if (found.key) {
    json["node"] = found.key->node.value;
    json["fingerprint"] = fingerprint(*found.key);
  }
  if (found.starts) json["starts"] = *found.starts;
  if (found.mission) {
    json["members"] = Json::array();
    for (const Certificate& member : found.mission->members) {
      Json one = json_of(member);
      one["revoked"] = is_revoked(*found.mission, member);
      json["members"].push_back(std::move(one));
    }
  }
  json["problems"] = found.problems;
  json["good"] = found.problems.empty();
  return json;
}

}  // namespace

KeysShown show_keys(const identity::KeyFolder& keys, std::int64_t now_unix_s) {
  const Found found = find(keys, now_unix_s);
  return {text_of(keys, found, now_unix_s), codec::json_text(json_of(keys, found)),
          found.problems.empty()};
}

}  // namespace skein::identity_desk
