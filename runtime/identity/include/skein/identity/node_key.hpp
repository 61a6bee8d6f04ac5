// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "skein/base/result.hpp"
#include "skein/identity/keys.hpp"
#include "skein/identity/request.hpp"

namespace skein::identity {

/// A node's private keys. It makes them itself, and they never leave it.
struct NodeKey {
  VehicleId node;
  Secret sign;   ///< Ed25519
  Secret agree;  ///< X25519
  [[nodiscard]] PublicKey sign_key() const;
  [[nodiscard]] PublicKey agree_key() const;
};
[[nodiscard]] NodeKey make_node_key(VehicleId node);
[[nodiscard]] Request request_of(const NodeKey& key);
[[nodiscard]] std::string fingerprint(const NodeKey& key);

inline constexpr const char* kNodeKeyFile = "node.key";
inline constexpr const char* kMembershipFile = "membership";
inline constexpr const char* kStartsFile = "starts";

/// Where a node keeps who it is:
///   node.key     its private keys
///   membership   what the authority answered, brought up to date when the key changes
///   starts       how often its program was started
/// All are its own alone (0600), and each is there whole or not at all.
struct KeyFolder {
  std::filesystem::path folder;
  /// Here node.key is looked for first; empty for nowhere. What a service manager hands over
  /// (systemd's LoadCredential=) it also looks after: who may read it is not asked.
  std::filesystem::path credentials;
  /// With $CREDENTIALS_DIRECTORY.
  [[nodiscard]] static KeyFolder of(std::filesystem::path folder);
};

/// Fails where others could read the keys, too.
[[nodiscard]] Result<NodeKey> read_node_key(const KeyFolder& keys);
/// New ones, in place of those that are there; the count of starts goes on. A membership that is
/// there is of no more use.
[[nodiscard]] Result<NodeKey> make_new_node_key(const KeyFolder& keys, VehicleId node);
/// Those of the folder, or new ones; fails where there are some of another node.
[[nodiscard]] Result<NodeKey> read_or_make_node_key(const KeyFolder& keys, VehicleId node);

}  // namespace skein::identity
