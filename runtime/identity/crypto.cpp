// SPDX-License-Identifier: Apache-2.0
#include "crypto.hpp"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/kdf.h>
#include <openssl/rand.h>

#include <algorithm>
#include <memory>

#include "skein/base/assert.hpp"

namespace skein::identity {
namespace {

constexpr std::uint64_t kScryptN = 1U << 15U;
constexpr std::uint64_t kScryptR = 8;
constexpr std::uint64_t kScryptP = 1;
constexpr std::uint64_t kScryptMemory = 48U << 20U;  ///< N and r take 32 MiB
constexpr std::size_t kTagBytes = 16;

struct Free {
  void operator()(EVP_PKEY* key) const { EVP_PKEY_free(key); }
  void operator()(EVP_PKEY_CTX* context) const { EVP_PKEY_CTX_free(context); }
  void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  void operator()(EVP_CIPHER_CTX* context) const { EVP_CIPHER_CTX_free(context); }
};
using Key = std::unique_ptr<EVP_PKEY, Free>;
using KeyContext = std::unique_ptr<EVP_PKEY_CTX, Free>;
using DigestContext = std::unique_ptr<EVP_MD_CTX, Free>;
using CipherContext = std::unique_ptr<EVP_CIPHER_CTX, Free>;

int length(Span bytes) { return static_cast<int>(bytes.size()); }

Key private_key(int type, const Secret& key) {
  Key made{EVP_PKEY_new_raw_private_key(type, nullptr, key.bytes.data(), key.bytes.size())};
  SKEIN_ASSERT(made != nullptr);
  return made;
}

Key public_key(int type, const PublicKey& key) {
  Key made{EVP_PKEY_new_raw_public_key(type, nullptr, key.data(), key.size())};
  SKEIN_ASSERT(made != nullptr);
  return made;
}

PublicKey public_of(int type, const Secret& key) {
  PublicKey made{};
  std::size_t size = made.size();
  SKEIN_ASSERT(EVP_PKEY_get_raw_public_key(private_key(type, key).get(), made.data(), &size) == 1);
  return made;
}

}  // namespace

void wipe(std::span<std::uint8_t> bytes) { OPENSSL_cleanse(bytes.data(), bytes.size()); }
void wipe(std::string& text) { OPENSSL_cleanse(text.data(), text.size()); }

void fill_random(std::span<std::uint8_t> bytes) {
  SKEIN_ASSERT(RAND_priv_bytes(bytes.data(), static_cast<int>(bytes.size())) == 1);
}

Secret random_secret() {
  Secret secret;
  fill_random(secret.bytes);
  return secret;
}

std::array<std::uint8_t, 32> sha256(Span bytes) {
  std::array<std::uint8_t, 32> made{};
  unsigned size = 0;
  SKEIN_ASSERT(EVP_Digest(bytes.data(), bytes.size(), made.data(), &size, EVP_sha256(), nullptr) ==
               1);
  return made;
}

PublicKey ed25519_public(const Secret& key) { return public_of(EVP_PKEY_ED25519, key); }
PublicKey x25519_public(const Secret& key) { return public_of(EVP_PKEY_X25519, key); }

Signature ed25519_sign(const Secret& key, Span message) {
  const Key own = private_key(EVP_PKEY_ED25519, key);
  const DigestContext context{EVP_MD_CTX_new()};
  SKEIN_ASSERT(context != nullptr);
  Signature made{};
  std::size_t size = made.size();
  SKEIN_ASSERT(EVP_DigestSignInit(context.get(), nullptr, nullptr, nullptr, own.get()) == 1 &&
               EVP_DigestSign(context.get(), made.data(), &size, message.data(), message.size()) ==
                   1);
  return made;
}

bool ed25519_verify(const PublicKey& key, Span message, const Signature& signature) {
  const Key others = public_key(EVP_PKEY_ED25519, key);
  const DigestContext context{EVP_MD_CTX_new()};
  SKEIN_ASSERT(context != nullptr);
  SKEIN_ASSERT(EVP_DigestVerifyInit(context.get(), nullptr, nullptr, nullptr, others.get()) == 1);
  return EVP_DigestVerify(context.get(), signature.data(), signature.size(), message.data(),
                          message.size()) == 1;
}

std::optional<Secret> x25519(const Secret& own, const PublicKey& other) {
  const Key mine = private_key(EVP_PKEY_X25519, own);
  const Key others = public_key(EVP_PKEY_X25519, other);
  const KeyContext context{EVP_PKEY_CTX_new(mine.get(), nullptr)};
  SKEIN_ASSERT(context != nullptr && EVP_PKEY_derive_init(context.get()) == 1);
  Secret shared;
  std::size_t size = shared.bytes.size();
  // OpenSSL refuses where the result is zero, as RFC 7748 advises.
  if (EVP_PKEY_derive_set_peer(context.get(), others.get()) != 1 ||
      EVP_PKEY_derive(context.get(), shared.bytes.data(), &size) != 1) {
    return std::nullopt;
  }
  return shared;
}

Secret hkdf_sha256(const Secret& secret, Span salt, Span info) {
  const KeyContext context{EVP_PKEY_CTX_new_id(EVP_PKEY_HKDF, nullptr)};
  EVP_PKEY_CTX* const c = context.get();
  Secret made;
  std::size_t size = made.bytes.size();
  SKEIN_ASSERT(c != nullptr && EVP_PKEY_derive_init(c) == 1 &&
               EVP_PKEY_CTX_set_hkdf_md(c, EVP_sha256()) == 1 &&
               EVP_PKEY_CTX_set1_hkdf_key(c, secret.bytes.data(), length(secret.bytes)) == 1 &&
               EVP_PKEY_CTX_set1_hkdf_salt(c, salt.data(), length(salt)) == 1 &&
               EVP_PKEY_CTX_add1_hkdf_info(c, info.data(), length(info)) == 1 &&
               EVP_PKEY_derive(c, made.bytes.data(), &size) == 1);
  return made;
}

Secret scrypt(std::string_view password, Span salt) {
  Secret made;
  SKEIN_ASSERT(EVP_PBE_scrypt(password.data(), password.size(), salt.data(), salt.size(), kScryptN,
                              kScryptR, kScryptP, kScryptMemory, made.bytes.data(),
                              made.bytes.size()) == 1);
  return made;
}

Wrapped wrap(const Secret& key, Span clear, const Secret& inside) {
  const CipherContext context{EVP_CIPHER_CTX_new()};
  EVP_CIPHER_CTX* const c = context.get();
  const std::array<std::uint8_t, 12> nonce{};
  Wrapped made{};
  int written = 0;
  SKEIN_ASSERT(
      c != nullptr &&
      EVP_EncryptInit_ex(c, EVP_aes_256_gcm(), nullptr, key.bytes.data(), nonce.data()) == 1 &&
      EVP_EncryptUpdate(c, nullptr, &written, clear.data(), length(clear)) == 1 &&
      EVP_EncryptUpdate(c, made.data(), &written, inside.bytes.data(), length(inside.bytes)) == 1 &&
      EVP_EncryptFinal_ex(c, made.data() + kKeyBytes, &written) == 1 &&
      EVP_CIPHER_CTX_ctrl(c, EVP_CTRL_AEAD_GET_TAG, kTagBytes, made.data() + kKeyBytes) == 1);
  return made;
}

std::optional<Secret> unwrap(const Secret& key, Span clear, const Wrapped& wrapped) {
  const CipherContext context{EVP_CIPHER_CTX_new()};
  EVP_CIPHER_CTX* const c = context.get();
  const std::array<std::uint8_t, 12> nonce{};
  std::array<std::uint8_t, kTagBytes> tag{};
  std::copy(wrapped.begin() + kKeyBytes, wrapped.end(), tag.begin());
  Secret inside;
  int written = 0;
  SKEIN_ASSERT(c != nullptr && EVP_DecryptInit_ex(c, EVP_aes_256_gcm(), nullptr, key.bytes.data(),
                                                  nonce.data()) == 1);
  const bool good =
      EVP_DecryptUpdate(c, nullptr, &written, clear.data(), length(clear)) == 1 &&
      EVP_DecryptUpdate(c, inside.bytes.data(), &written, wrapped.data(), kKeyBytes) == 1 &&
      EVP_CIPHER_CTX_ctrl(c, EVP_CTRL_AEAD_SET_TAG, kTagBytes, tag.data()) == 1 &&
      EVP_DecryptFinal_ex(c, inside.bytes.data() + kKeyBytes, &written) == 1;
  return good ? std::optional{inside} : std::nullopt;
}

}  // namespace skein::identity
