// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "skein/base/result.hpp"
#include "skein/identity/keys.hpp"

namespace skein::identity {

/// A vehicle's wish to be enrolled, into whatever mission: its public keys. The proof, its own
/// signature, shows that it has the private one to sign with. Who names an agree_key that is not
/// his cannot read what he is given.
struct Request {
  VehicleId vehicle;
  PublicKey sign_key{};
  PublicKey agree_key{};
  Signature proof{};
  friend bool operator==(const Request&, const Request&) = default;
};
inline constexpr std::size_t kRequestBytes = 131;

/// Version (1), vehicle (2), sign_key (32), agree_key (32), proof (64).
[[nodiscard]] Bytes to_bytes(const Request& request);
[[nodiscard]] Result<Request> request_from(Span bytes);
/// "SKEIN-REQUEST-1:..."
[[nodiscard]] std::string to_text(const Request& request);
[[nodiscard]] Result<Request> request_from_text(std::string_view text);

void sign(Request& request, const Secret& sign_key);
[[nodiscard]] bool is_proven(const Request& request);

}  // namespace skein::identity
