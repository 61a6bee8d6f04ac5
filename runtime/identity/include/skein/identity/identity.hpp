// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/identity/key_change.hpp"
#include "skein/identity/membership.hpp"
#include "skein/identity/node_key.hpp"
#include "skein/identity/signing.hpp"
#include "skein/seal/keys.hpp"

namespace skein::identity {

[[nodiscard]] Result<Membership> read_membership(const KeyFolder& keys);
/// Keeps what the authority answered, if it is good and for these keys. `replace`: of another
/// mission than the one that is kept.
[[nodiscard]] Result<void> store_membership(const KeyFolder& keys, const Membership& membership,
                                            std::int64_t now_unix_s, bool replace);

/// How often it was started; 0 where it never was. Fails where that was lost.
[[nodiscard]] Result<std::uint16_t> starts_of(const KeyFolder& keys);
/// Counts one more, on the disk before it returns: call it once in a run, before the first
/// datagram. No clock has part in it, so that no number comes twice where one begins at 1970.
/// The number is `at_least` that, where it is to be greater than another machine's.
[[nodiscard]] Result<seal::SenderStart> count_start(const KeyFolder& keys, VehicleId node,
                                                    std::uint16_t at_least = 0);
/// Another machine has started under that number as the node that this one may speak as: the next
/// start of this one is counted beyond it.
[[nodiscard]] Result<void> note_start(const KeyFolder& keys, std::uint16_t number);
/// The number of a start by what instance_of() made of it.
[[nodiscard]] std::uint16_t start_number(InstanceId instance);
/// Tells processes apart as the start does.
[[nodiscard]] InstanceId instance_of(const seal::SenderStart& start);

/// What became of news of the key.
enum class Changed : std::uint8_t {
  taken,     ///< the key is another one now; store() keeps it
  known,     ///< of this epoch or an earlier one
  not_ours,  ///< for another member or mission
  forged,
  revoked,  ///< the news is that this node is out
  count
};
[[nodiscard]] const char* to_text(Changed changed);

/// Who a node is in its mission. Of one thread.
class Identity {
 public:
  /// Fails where a file is missing or broken, the node was revoked, or its certificate is not valid
  /// now: "FILE: what; what to do".
  [[nodiscard]] static Result<Identity> open(const KeyFolder& keys, std::int64_t now_unix_s);

  [[nodiscard]] const Certificate& own() const { return membership_.own; }
  [[nodiscard]] const Certificate& authority() const { return membership_.authority; }
  [[nodiscard]] const RevocationList& revoked() const { return membership_.keys.revoked; }
  [[nodiscard]] const seal::EpochKey& epoch_key() const { return epoch_key_; }
  [[nodiscard]] Signer signer() const { return Signer{membership_.own.mission, key_.sign}; }
  /// Knows the authority and who was revoked.
  [[nodiscard]] Verifier verifier() const;

  [[nodiscard]] Changed take(const KeyChange& change);
  /// For the next start. Apart from take(), since a disk may take seconds.
  [[nodiscard]] Result<void> store() const;

 private:
  Identity(KeyFolder keys, NodeKey key, Membership membership, const seal::EpochKey& epoch_key);
  KeyFolder keys_;
  NodeKey key_;
  Membership membership_;
  seal::EpochKey epoch_key_;
};

}  // namespace skein::identity
