// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "skein/base/result.hpp"
#include "skein/identity/certificate.hpp"
#include "skein/identity/key_change.hpp"

namespace skein::identity {

/// The answer to a request: all that a node needs to take part in a mission, beside its own keys.
/// It is of no use to others.
struct Membership {
  Certificate authority;
  Certificate own;
  KeyChange keys;
  friend bool operator==(const Membership&, const Membership&) = default;
};
inline constexpr std::size_t kMembershipBytesMax =
    1 + 1 + kCertificateBytesMax + 1 + kCertificateBytesMax + kChangeBytesMax;

/// Version (1), length (1) and certificate of the authority, and of the node, then the key change.
[[nodiscard]] Bytes to_bytes(const Membership& membership);
[[nodiscard]] Result<Membership> membership_from(Span bytes);
/// "SKEIN-MEMBER-1:..."
[[nodiscard]] std::string to_text(const Membership& membership);
[[nodiscard]] Result<Membership> membership_from_text(std::string_view text);

/// Do its parts belong together, and are they the authority's? Fails with what to do.
[[nodiscard]] Result<void> check(const Membership& membership, std::int64_t now_unix_s);

}  // namespace skein::identity
