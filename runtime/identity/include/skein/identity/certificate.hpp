// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "skein/base/result.hpp"
#include "skein/identity/keys.hpp"

namespace skein::identity {

enum class Role : std::uint8_t { authority = 1, ground, vehicle, op };
/// "authority", "ground", "vehicle", "operator"
[[nodiscard]] const char* to_text(Role role);

inline constexpr std::size_t kNameMax = 32;
/// Of a mission or an operator: letters, digits, '.', '_' and '-', the first a letter or a digit.
/// It becomes a file's name, and is shown on terminals.
[[nodiscard]] bool is_name(std::string_view name);

/// What the mission's authority says of a key: whose it is, in which mission, until when. Who has
/// the authority's own certificate needs no list of the others.
struct Certificate {
  MissionId mission;
  Serial serial;
  Role role = Role::vehicle;
  /// Of a vehicle; of a ground station that was enrolled beside the mission's own (is_station());
  /// else 0.
  VehicleId node;
  std::string name;       ///< of an operator, and in the authority's the mission's; else empty
  PublicKey sign_key{};   ///< Ed25519
  PublicKey agree_key{};  ///< X25519, of ground station and vehicles; else zeros
  std::int64_t not_before_unix_s = 0;
  std::int64_t not_after_unix_s = 0;
  Signature signature{};  ///< the authority's; its own under its own
  friend bool operator==(const Certificate&, const Certificate&) = default;
};
inline constexpr std::size_t kCertificateBytesMax = 201;

/// One form for each certificate, big endian: version (1), mission (16), serial (4), role (1), node
/// (2), length of the name (1) and name, sign_key (32), agree_key (32) where the role has one,
/// not_before and not_after (8 each), signature (64).
[[nodiscard]] Bytes to_bytes(const Certificate& certificate);
[[nodiscard]] Result<Certificate> certificate_from(Span bytes);
/// A line "SKEIN-CERT-1:..." of letters, digits and colon that a QR code holds as such.
[[nodiscard]] std::string to_text(const Certificate& certificate);
[[nodiscard]] Result<Certificate> certificate_from_text(std::string_view text);

[[nodiscard]] std::string fingerprint(const Certificate& certificate);
/// Whose it is: "vehicle 3", "operator ada", "ground station", "ground station 2" or
/// "authority".
[[nodiscard]] std::string holder_of(const Certificate& certificate);

/// Signs all but the signature, under a purpose of its own.
void sign(Certificate& certificate, const Secret& authority_key);

/// What is to be thought of what somebody brought.
enum class Trust : std::uint8_t {
  good,
  forged,  ///< not signed by whom it says, or changed since
  other_mission,
  not_yet_valid,  ///< or our clock is behind
  expired,
  wrong_role,  ///< whose key it is may not say this
  revoked,
  unknown,  ///< no certificate of the sender is known
  count
};
[[nodiscard]] const char* to_text(Trust trust);

/// Is it the authority's own?
[[nodiscard]] Trust check_authority(const Certificate& authority, std::int64_t now_unix_s);
/// Did that authority sign it? Precondition: the authority's own was checked.
[[nodiscard]] Trust check(const Certificate& certificate, const Certificate& authority,
                          std::int64_t now_unix_s);
/// Why it is not good, and what to do, for people.
[[nodiscard]] std::string why_not(const Certificate& certificate, Trust trust,
                                  std::int64_t now_unix_s);
/// As 2026-05-01 12:00 UTC.
[[nodiscard]] std::string utc_text(std::int64_t unix_s);

}  // namespace skein::identity
