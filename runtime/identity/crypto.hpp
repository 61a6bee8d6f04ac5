// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "skein/identity/keys.hpp"

/// What we use of OpenSSL. What cannot fail but for a lack of memory is an assertion.
namespace skein::identity {

void fill_random(std::span<std::uint8_t> bytes);
[[nodiscard]] std::array<std::uint8_t, 32> sha256(Span bytes);

[[nodiscard]] PublicKey ed25519_public(const Secret& key);
[[nodiscard]] Signature ed25519_sign(const Secret& key, Span message);
[[nodiscard]] bool ed25519_verify(const PublicKey& key, Span message, const Signature& signature);

[[nodiscard]] PublicKey x25519_public(const Secret& key);
/// None where the other's key is one of the few that agree on the same with everybody.
[[nodiscard]] std::optional<Secret> x25519(const Secret& own, const PublicKey& other);
/// RFC 5869.
[[nodiscard]] Secret hkdf_sha256(const Secret& secret, Span salt, Span info);
/// RFC 7914, N = 2^15, r = 8, p = 1.
[[nodiscard]] Secret scrypt(std::string_view password, Span salt);

/// AES-256-GCM with the nonce 0: a key wraps one thing only. `clear` is authenticated, too.
using Wrapped = std::array<std::uint8_t, kKeyBytes + 16>;
[[nodiscard]] Wrapped wrap(const Secret& key, Span clear, const Secret& inside);
[[nodiscard]] std::optional<Secret> unwrap(const Secret& key, Span clear, const Wrapped& wrapped);

}  // namespace skein::identity
