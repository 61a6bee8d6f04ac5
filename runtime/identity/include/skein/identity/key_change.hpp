// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/identity/certificate.hpp"
#include "skein/identity/keys.hpp"
#include "skein/seal/keys.hpp"

namespace skein::identity {

/// A mission's first epoch is 1; each revocation begins another, until there are none left.
inline constexpr std::uint8_t kEpochMax = 255;
inline constexpr std::size_t kRevokedMax = kEpochMax - 1;

/// All who were revoked before that epoch began. A later epoch's list replaces an earlier one's.
struct RevocationList {
  MissionId mission;
  std::uint8_t epoch = 1;
  std::vector<Serial> serials;  ///< in order, each once
  Signature signature{};        ///< the authority's
  [[nodiscard]] bool contains(Serial serial) const;
  friend bool operator==(const RevocationList&, const RevocationList&) = default;
};

/// The epoch's key, for one member alone. An X25519 key that is used once and the member's make the
/// key (HKDF-SHA256) that it is wrapped with (AES-256-GCM); all the rest is authenticated.
struct EpochGrant {
  static constexpr std::size_t kWrappedBytes = kKeyBytes + 16;
  MissionId mission;
  std::uint8_t epoch = 1;
  Serial member;
  PublicKey once{};
  std::array<std::uint8_t, kWrappedBytes> wrapped{};
  Signature signature{};  ///< the authority's
  friend bool operator==(const EpochGrant&, const EpochGrant&) = default;
};

/// What a member is told when the key changes: the news and the key together, so that nobody has
/// the one without the other. Nothing in it is secret, and it fits one datagram: it may go in clear
/// and through anybody's hands, to who missed it, too.
struct KeyChange {
  RevocationList revoked;
  EpochGrant grant;  ///< of the same mission and epoch
  friend bool operator==(const KeyChange&, const KeyChange&) = default;
};
/// Its first byte: neither a sealed datagram's nor an RTPS message's.
inline constexpr std::uint8_t kChangeMark = 0xA2;
inline constexpr std::size_t kRevocationListBytesMax = 83 + 4 * kRevokedMax;
inline constexpr std::size_t kGrantBytes = 166;
inline constexpr std::size_t kChangeBytesMax = 1 + kRevocationListBytesMax + kGrantBytes;

/// Version (1), mission (16), epoch (1), how many (1), serials (4 each), signature (64).
[[nodiscard]] Bytes to_bytes(const RevocationList& list);
[[nodiscard]] Result<RevocationList> revocation_list_from(Span bytes);
/// Version (1), mission (16), epoch (1), member (4), once (32), wrapped (48), signature (64).
[[nodiscard]] Bytes to_bytes(const EpochGrant& grant);
[[nodiscard]] Result<EpochGrant> grant_from(Span bytes);
/// The mark (1), the list, the grant.
[[nodiscard]] Bytes to_bytes(const KeyChange& change);
[[nodiscard]] Result<KeyChange> key_change_from(Span bytes);
/// "SKEIN-REVOKED-1:...", "SKEIN-CHANGE-1:..."
[[nodiscard]] std::string to_text(const RevocationList& list);
[[nodiscard]] Result<RevocationList> revocation_list_from_text(std::string_view text);
[[nodiscard]] std::string to_text(const KeyChange& change);
[[nodiscard]] Result<KeyChange> key_change_from_text(std::string_view text);

void sign(RevocationList& list, const Secret& authority_key);
[[nodiscard]] Trust check(const RevocationList& list, const Certificate& authority);

/// Precondition: the member has an agree_key that others can agree on a secret with.
[[nodiscard]] EpochGrant make_grant(const seal::EpochKey& key, const Certificate& member,
                                    const Secret& authority_key);
[[nodiscard]] Trust check(const EpochGrant& grant, const Certificate& authority);
/// None where it was wrapped for another key.
[[nodiscard]] std::optional<seal::EpochKey> open_grant(const EpochGrant& grant,
                                                       const Secret& agree_key);

}  // namespace skein::identity
