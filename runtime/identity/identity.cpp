// SPDX-License-Identifier: Apache-2.0
#include "skein/identity/identity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "crypto.hpp"
#include "files.hpp"
#include "skein/base/assert.hpp"
#include "text_form.hpp"

namespace skein::identity {
namespace {

constexpr std::size_t kMembershipFileMax = 4096;
constexpr std::size_t kStartsFileMax = 16;

/// What the key of the epoch is, if that membership is of those keys.
Result<seal::EpochKey> opened(const NodeKey& key, const Membership& membership) {
  const Certificate& own = membership.own;
  if (own.node != key.node || own.sign_key != key.sign_key() || own.agree_key != key.agree_key()) {
    return Error{fmt::format(
        "the membership is that of {} {} with the keys {}, and this node is "
        "{} with the keys {}; enrol with its own request",
        to_text(own.role), own.node.value, fingerprint(own), key.node.value, fingerprint(key))};
  }
  const auto epoch_key = open_grant(membership.keys.grant, key.agree);
  if (!epoch_key) return Error{"the membership's key was not wrapped for this node; enrol again"};
  return *epoch_key;
}

Result<void> keep(const KeyFolder& keys, const Membership& membership) {
  return write_file(keys.folder / kMembershipFile, to_text(membership) + "\n", Durable::yes);
}

/// May what is here give way to that?
Result<void> may_replace(const KeyFolder& keys, const Membership& membership,
                         std::int64_t now_unix_s) {
  if (!is_there(keys.folder / kMembershipFile)) return {};
  const auto known = read_membership(keys);
  if (!known || !check(*known, now_unix_s)) return {};  // of no use any more
  if (known->own.mission != membership.own.mission) {
    return Error{fmt::format(
        "{}: is a member of the mission '{}' until {}; leave it with --replace",
        keys.folder.string(), known->authority.name, utc_text(known->own.not_after_unix_s))};
  }
  if (known->keys.grant.epoch > membership.keys.grant.epoch) {
    return Error{fmt::format("{}: has a later key of this mission already; nothing is to be done",
                             keys.folder.string())};
  }
  return {};
}

}  // namespace

Result<Membership> read_membership(const KeyFolder& keys) {
  const auto file = keys.folder / kMembershipFile;
  if (!is_there(file)) {
    return Error{
        fmt::format("{}: is not there; bring the request to the ground station, and its "
                    "answer with 'skein-onboard enrol --membership' here",
                    file.string())};
  }
  const auto text = read_file(file, kMembershipFileMax, Readers::anybody);
  if (!text) return text.error();
  auto membership = membership_from_text(*text);
  if (!membership) return of_file(file, membership.error());
  return membership;
}

Result<void> store_membership(const KeyFolder& keys, const Membership& membership,
                              std::int64_t now_unix_s, bool replace) {
  const auto key = read_node_key(keys);
  if (!key) return key.error();
  if (auto good = check(membership, now_unix_s); !good) return good;
  if (const auto epoch_key = opened(*key, membership); !epoch_key) return epoch_key.error();
  if (!replace) {
    if (auto may = may_replace(keys, membership, now_unix_s); !may) return may;
  }
  return keep(keys, membership);
}

Result<std::uint16_t> starts_of(const KeyFolder& keys) {
  const auto file = keys.folder / kStartsFile;
  const auto text = is_there(file) ? read_file(file, kStartsFileMax, Readers::anybody)
                                   : Result<std::string>{std::string{}};
  if (!text) return text.error();
  const auto starts = whole_number(without_space_around(*text));
  if (!starts) {
    return Error{
        fmt::format("{0}: does not say how often the node was started; write a number "
                    "that it has not reached yet: echo 1000 > {0}",
                    file.string())};
  }
  return *starts;
}

Result<seal::SenderStart> count_start(const KeyFolder& keys, VehicleId node,
                                      std::uint16_t at_least) {
  const auto lock = FolderLock::take(keys.folder);
  if (!lock) return lock.error();
  const auto starts = starts_of(keys);
  if (!starts) return starts.error();
  if (*starts == std::numeric_limits<std::uint16_t>::max()) {
    return Error{
        fmt::format("{}: was started 65535 times; make new keys in another folder and "
                    "enrol anew",
                    keys.folder.string())};
  }
  const auto number = std::max(static_cast<std::uint16_t>(*starts + 1), at_least);
  if (auto kept = write_file(keys.folder / kStartsFile, fmt::format("{}\n", number), Durable::yes);
      !kept) {
    return kept.error();
  }
  std::array<std::uint8_t, 3> random{};
  fill_random(random);
  return seal::SenderStart{
      .sender = node,
      .number = number,
      .random = static_cast<std::uint32_t>(random[0] << 16U | random[1] << 8U | random[2])};
}

Result<void> note_start(const KeyFolder& keys, std::uint16_t number) {
  const auto lock = FolderLock::take(keys.folder);
  if (!lock) return lock.error();
  const auto starts = starts_of(keys);
  if (!starts) return starts.error();
  if (*starts >= number) return {};
  return write_file(keys.folder / kStartsFile, fmt::format("{}\n", number), Durable::yes);
}

std::uint16_t start_number(InstanceId instance) {
  return static_cast<std::uint16_t>(instance.value >> 24U);
}

InstanceId instance_of(const seal::SenderStart& start) {
  return {std::uint64_t{start.number} << 24U | start.random};
}

const char* to_text(Changed changed) {
  switch (changed) {
    case Changed::taken:
      return "taken";
    case Changed::known:
      return "known";
    case Changed::not_ours:
      return "not_ours";
    case Changed::forged:
      return "forged";
    case Changed::revoked:
      return "revoked";
    case Changed::count:
      break;
  }
  return "";
}

Identity::Identity(KeyFolder keys, NodeKey key, Membership membership,
                   const seal::EpochKey& epoch_key)
    : keys_{std::move(keys)},
      key_{std::move(key)},
      membership_{std::move(membership)},
      epoch_key_{epoch_key} {}

Result<Identity> Identity::open(const KeyFolder& keys, std::int64_t now_unix_s) {
  auto key = read_node_key(keys);
  if (!key) return key.error();
  auto membership = read_membership(keys);
  if (!membership) return membership.error();
  const auto file = keys.folder / kMembershipFile;
  if (const auto good = check(*membership, now_unix_s); !good) return of_file(file, good.error());
  const auto epoch_key = opened(*key, *membership);
  if (!epoch_key) return of_file(file, epoch_key.error());
  return Identity{keys, std::move(key).value(), std::move(membership).value(), *epoch_key};
}

Verifier Identity::verifier() const {
  Verifier made{membership_.authority};
  SKEIN_ASSERT(made.learn(membership_.keys.revoked) == Trust::good);
  return made;
}

Changed Identity::take(const KeyChange& change) {
  const auto& [revoked, grant] = change;
  if (grant.mission != own().mission || revoked.mission != own().mission) return Changed::not_ours;
  if (grant.epoch <= epoch_key_.epoch) return Changed::known;
  if (grant.epoch != revoked.epoch || check(revoked, authority()) != Trust::good) {
    return Changed::forged;
  }
  if (revoked.contains(own().serial)) return Changed::revoked;
  if (grant.member != own().serial) return Changed::not_ours;
  if (check(grant, authority()) != Trust::good) return Changed::forged;
  const auto key = open_grant(grant, key_.agree);
  if (!key) return Changed::forged;
  epoch_key_ = *key;
  membership_.keys = change;
  return Changed::taken;
}

Result<void> Identity::store() const { return keep(keys_, membership_); }

}  // namespace skein::identity
