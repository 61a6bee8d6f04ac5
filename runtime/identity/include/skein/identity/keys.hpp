// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "skein/base/ids.hpp"

/// Who is who in a mission: keys that nodes make themselves, certificates of the mission's
/// authority on the ground laptop, the key that the team shares, and who lost it (docs/keys.md).
namespace skein::identity {

using Bytes = std::vector<std::uint8_t>;
using Span = std::span<const std::uint8_t>;

inline constexpr std::size_t kKeyBytes = 32;
using PublicKey = std::array<std::uint8_t, kKeyBytes>;
/// Ed25519 (RFC 8032).
using Signature = std::array<std::uint8_t, 64>;

/// So that the compiler does not leave it out.
void wipe(std::span<std::uint8_t> bytes);
void wipe(std::string& text);

/// 32 bytes that nobody else may know; forgotten when it ends.
class Secret {
 public:
  Secret() = default;
  Secret(const Secret&) = default;
  Secret& operator=(const Secret&) = default;
  ~Secret() { wipe(bytes); }
  std::array<std::uint8_t, kKeyBytes> bytes{};
};
/// From the system's generator, which is fit for keys. No seed: equal keys must not come twice.
[[nodiscard]] Secret random_secret();

struct MissionId {
  std::array<std::uint8_t, 16> bytes{};
  friend auto operator<=>(const MissionId&, const MissionId&) = default;
};
/// In hexadecimal.
[[nodiscard]] std::string to_text(const MissionId& id);

/// Of a certificate, in its mission: the authority's own is 0.
using Serial = Id<struct SerialTag, std::uint32_t>;

/// As many as can seal (seal::Opener::kNodesMax).
inline constexpr std::size_t kMembersMax = 4096;

/// What two people compare, as ABCD-EFGH-IJKL-MNOP: 80 bits of the SHA-256 of both keys. To make
/// other keys with the same is beyond anybody.
[[nodiscard]] std::string fingerprint(const PublicKey& sign, const PublicKey& agree);

}  // namespace skein::identity
