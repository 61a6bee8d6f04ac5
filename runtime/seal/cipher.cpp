// SPDX-License-Identifier: Apache-2.0
#include "cipher.hpp"

#include <openssl/core_names.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/kdf.h>
#include <openssl/params.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "skein/base/assert.hpp"

namespace skein::seal {
namespace {

constexpr std::size_t kKeyBytes = 16;
constexpr std::size_t kNonceBytes = 12;
constexpr std::size_t kCounterBytes = 5;
constexpr std::string_view kPurpose = "skein datagram 1";  ///< no other use may make the same key

using StartKey = std::array<std::uint8_t, kKeyBytes>;

/// The clear header without its counter names epoch and start.
std::array<std::uint8_t, kHeaderBytes> identity(std::uint8_t epoch, const SenderStart& start) {
  return to_bytes({.epoch = epoch, .from = start, .counter = 0});
}

StartKey derive(const EpochKey& epoch, const SenderStart& start) {
  EVP_KDF* const kdf = EVP_KDF_fetch(nullptr, "HKDF", nullptr);
  SKEIN_ASSERT(kdf != nullptr);
  EVP_KDF_CTX* const context = EVP_KDF_CTX_new(kdf);
  EVP_KDF_free(kdf);
  SKEIN_ASSERT(context != nullptr);
  // OpenSSL's parameters are not const, and it does not write to them.
  std::array<char, 7> digest{"SHA256"};
  auto secret = epoch.secret;
  auto salt = identity(epoch.epoch, start);
  std::array<char, kPurpose.size()> info{};
  std::copy(kPurpose.begin(), kPurpose.end(), info.begin());
  const std::array<OSSL_PARAM, 5> parameters{
      OSSL_PARAM_construct_utf8_string(OSSL_KDF_PARAM_DIGEST, digest.data(), 0),
      OSSL_PARAM_construct_octet_string(OSSL_KDF_PARAM_KEY, secret.data(), secret.size()),
      OSSL_PARAM_construct_octet_string(OSSL_KDF_PARAM_SALT, salt.data(), salt.size()),
      OSSL_PARAM_construct_octet_string(OSSL_KDF_PARAM_INFO, info.data(), info.size()),
      OSSL_PARAM_construct_end()};
  StartKey key{};
  const int made = EVP_KDF_derive(context, key.data(), key.size(), parameters.data());
  EVP_KDF_CTX_free(context);
  OPENSSL_cleanse(secret.data(), secret.size());
  SKEIN_ASSERT(made == 1);
  return key;
}

std::array<std::uint8_t, kNonceBytes> nonce(std::span<const std::uint8_t> header) {
  std::array<std::uint8_t, kNonceBytes> bytes{};
  const auto counter = header.subspan(kHeaderBytes - kCounterBytes, kCounterBytes);
  std::copy(counter.begin(), counter.end(), bytes.end() - kCounterBytes);
  return bytes;
}

int length(std::span<const std::uint8_t> bytes) { return static_cast<int>(bytes.size()); }

}  // namespace

void Cipher::Free::operator()(evp_cipher_ctx_st* context) const { EVP_CIPHER_CTX_free(context); }

Cipher::Cipher(const EpochKey& key, const SenderStart& start, Direction direction)
    : context_{EVP_CIPHER_CTX_new()} {
  SKEIN_ASSERT(context_ != nullptr);
  StartKey derived = derive(key, start);
  const int made = EVP_CipherInit_ex(context_.get(), EVP_aes_128_gcm(), nullptr, derived.data(),
                                     nullptr, direction == Direction::seal ? 1 : 0);
  OPENSSL_cleanse(derived.data(), derived.size());
  SKEIN_ASSERT(made == 1);
}

void Cipher::seal(const Header& header, std::span<const std::uint8_t> plain,
                  std::span<std::uint8_t> out) {
  SKEIN_ASSERT(out.size() == plain.size() + kOverheadBytes);
  const auto clear = to_bytes(header);
  std::copy(clear.begin(), clear.end(), out.begin());
  const auto iv = nonce(clear);
  EVP_CIPHER_CTX* const c = context_.get();
  std::uint8_t* const body = out.data() + kHeaderBytes;
  int written = 0;
  bool good = EVP_EncryptInit_ex(c, nullptr, nullptr, nullptr, iv.data()) == 1 &&
              EVP_EncryptUpdate(c, nullptr, &written, clear.data(), length(clear)) == 1 &&
              EVP_EncryptUpdate(c, body, &written, plain.data(), length(plain)) == 1 &&
              EVP_EncryptFinal_ex(c, body + written, &written) == 1;
  good = good && EVP_CIPHER_CTX_ctrl(c, EVP_CTRL_AEAD_GET_TAG, kTagBytes, body + plain.size()) == 1;
  SKEIN_ASSERT(good);  // nothing from outside is in it
}

bool Cipher::open(const Header& header, std::span<const std::uint8_t> datagram,
                  std::span<std::uint8_t> plain) {
  SKEIN_ASSERT(datagram.size() == plain.size() + kOverheadBytes);
  const auto clear = to_bytes(header);
  const auto iv = nonce(clear);
  const auto body = datagram.subspan(kHeaderBytes, plain.size());
  std::array<std::uint8_t, kTagBytes> tag{};
  std::copy(datagram.end() - kTagBytes, datagram.end(), tag.begin());
  EVP_CIPHER_CTX* const c = context_.get();
  int written = 0;
  return EVP_DecryptInit_ex(c, nullptr, nullptr, nullptr, iv.data()) == 1 &&
         EVP_DecryptUpdate(c, nullptr, &written, clear.data(), length(clear)) == 1 &&
         EVP_DecryptUpdate(c, plain.data(), &written, body.data(), length(body)) == 1 &&
         EVP_CIPHER_CTX_ctrl(c, EVP_CTRL_AEAD_SET_TAG, kTagBytes, tag.data()) == 1 &&
         EVP_DecryptFinal_ex(c, plain.data() + written, &written) == 1;
}

}  // namespace skein::seal
