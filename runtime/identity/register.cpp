// SPDX-License-Identifier: Apache-2.0
#include "skein/identity/register.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "bytes.hpp"
#include "files.hpp"
#include "text_form.hpp"

namespace skein::identity {
namespace {

constexpr std::size_t kLineMax = 400;  ///< of a certificate; the list of who was revoked is longer
constexpr std::size_t kFileMax = (kMembersMax + 8) * kLineMax;
constexpr TextForm kKeyForm{"SKEIN-EPOCH-KEY-1:", "key of an epoch", 1 + kKeyBytes};

std::string to_text(const seal::EpochKey& key) {
  Bytes bytes = ByteWriter{}.number(key.epoch, 1).add(key.secret).take();
  std::string text = to_text(kKeyForm, bytes);
  wipe(bytes);
  return text;
}

Result<seal::EpochKey> epoch_key_from_text(std::string_view text) {
  auto bytes = bytes_from_text(kKeyForm, text);
  if (!bytes) return bytes.error();
  ByteReader in{*bytes, "key of an epoch"};
  seal::EpochKey key;
  key.epoch = static_cast<std::uint8_t>(in.number(1, "epoch"));
  in.require(key.epoch != 0, "epoch");
  key.secret = in.array<kKeyBytes>("key");
  wipe(*bytes);
  return in.finish(key);
}

Result<void> in_order(const Register& mission) {
  for (std::size_t i = 0; i < mission.members.size(); ++i) {
    const Certificate& member = mission.members[i];
    if (member.serial.value != i + 1 || member.mission != mission.authority.mission ||
        (member.role == Role::ground && member.node == kGroundStation) != (i == 0)) {
      return Error{fmt::format("its certificate {} does not belong there", i + 1)};
    }
  }
  const bool one = mission.authority.role == Role::authority && !mission.members.empty() &&
                   mission.revoked.mission == mission.authority.mission &&
                   mission.revoked.epoch == mission.key.epoch;
  if (!one) return Error{"its parts do not belong together"};
  return {};
}

Result<Register> from_text(std::string_view text) {
  const auto lines = lines_of(text);
  if (lines.size() < 4) return Error{"is cut off"};
  auto authority = certificate_from_text(lines[0]);
  if (!authority) return authority.error();
  const auto key = epoch_key_from_text(lines[1]);
  if (!key) return key.error();
  auto revoked = revocation_list_from_text(lines[2]);
  if (!revoked) return revoked.error();
  Register mission{std::move(authority).value(), *key, std::move(revoked).value(), {}};
  for (std::size_t i = 3; i < lines.size(); ++i) {
    auto member = certificate_from_text(lines[i]);
    if (!member) return member.error();
    mission.members.push_back(std::move(member).value());
  }
  if (auto good = in_order(mission); !good) return good.error();
  return mission;
}

}  // namespace

Result<Register> read_register(const std::filesystem::path& file) {
  auto text = read_file(file, kFileMax, Readers::owner);
  if (!text) return text.error();
  auto mission = from_text(*text);
  wipe(*text);
  if (!mission) {
    return of_file(file, Error{mission.error().message +
                               "; put the folder back from a copy, or create a new mission"});
  }
  return mission;
}

std::vector<Certificate> who_is_out(const Register& mission) {
  std::map<std::string, Certificate> newest;
  for (const Certificate& member : mission.members) {
    const std::string holder = holder_of(member);
    const auto known = newest.find(holder);
    const bool holds = known != newest.end() && !mission.revoked.contains(known->second.serial);
    if (!holds) newest.insert_or_assign(holder, member);
  }
  std::vector<Certificate> out;
  for (const auto& [holder, member] : newest) {
    if (mission.revoked.contains(member.serial)) out.push_back(member);
  }
  std::ranges::sort(out, {}, &Certificate::serial);
  return out;
}

std::filesystem::path register_file(const std::filesystem::path& folder) {
  return folder / kRegisterFile;
}

Result<void> write_register(const std::filesystem::path& file, const Register& mission,
                            Durable durable) {
  std::string text;
  text.reserve((mission.members.size() + 8) * kLineMax);  // no copy of the key is left behind
  text.append(to_text(mission.authority)).append("\n");
  text.append(to_text(mission.key)).append("\n");
  text.append(to_text(mission.revoked)).append("\n");
  for (const Certificate& member : mission.members) text.append(to_text(member)).append("\n");
  auto kept = write_file(file, text, durable);
  wipe(text);
  return kept;
}

}  // namespace skein::identity
