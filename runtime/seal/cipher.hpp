// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "skein/seal/header.hpp"
#include "skein/seal/keys.hpp"

struct evp_cipher_ctx_st;

namespace skein::seal {

/// AES-128-GCM (NIST SP 800-38D) under the key of one start of one node, which HKDF-SHA256
/// (RFC 5869) makes of the epoch's. The nonce is the counter; the clear header is authenticated.
/// Not for two threads at once.
class Cipher {
 public:
  enum class Direction : std::uint8_t { seal, open };
  Cipher(const EpochKey& key, const SenderStart& start, Direction direction);

  /// `out` takes header, what was sealed, and tag: kOverheadBytes more than `plain` has.
  void seal(const Header& header, std::span<const std::uint8_t> plain, std::span<std::uint8_t> out);
  /// `plain` takes kOverheadBytes less than the datagram has. False where it was not sealed with
  /// this key; `plain` then holds nothing of use.
  [[nodiscard]] bool open(const Header& header, std::span<const std::uint8_t> datagram,
                          std::span<std::uint8_t> plain);

 private:
  struct Free {
    void operator()(evp_cipher_ctx_st* context) const;
  };
  std::unique_ptr<evp_cipher_ctx_st, Free> context_;
};

}  // namespace skein::seal
