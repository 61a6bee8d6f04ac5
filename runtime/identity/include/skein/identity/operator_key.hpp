// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "skein/base/result.hpp"
#include "skein/identity/certificate.hpp"
#include "skein/identity/keys.hpp"
#include "skein/identity/signing.hpp"

namespace skein::identity {

/// An operator's key as it lies on the disk: wrapped (AES-256-GCM) with what scrypt (RFC 7914)
/// makes of his password, with his certificate. Each guess takes 32 MB and some 0.1 s.
struct LockedKey {
  static constexpr std::size_t kWrappedBytes = kKeyBytes + 16;
  std::array<std::uint8_t, 16> salt{};
  std::array<std::uint8_t, kWrappedBytes> wrapped{};
  Certificate certificate;
  friend bool operator==(const LockedKey&, const LockedKey&) = default;
};
inline constexpr std::size_t kLockedKeyBytesMax = 1 + 16 + 48 + 1 + kCertificateBytesMax;

/// Version (1), salt (16), wrapped (48), length (1) and certificate.
[[nodiscard]] Bytes to_bytes(const LockedKey& key);
[[nodiscard]] Result<LockedKey> locked_key_from(Span bytes);
/// "SKEIN-OPERATOR-1:..."
[[nodiscard]] std::string to_text(const LockedKey& key);
[[nodiscard]] Result<LockedKey> locked_key_from_text(std::string_view text);

[[nodiscard]] LockedKey lock(const Secret& sign_key, const Certificate& certificate,
                             std::string_view password);
/// Fails where the password is another, or the file was changed.
[[nodiscard]] Result<Signer> unlock(const LockedKey& key, std::string_view password);

/// The first line of a file that nobody else may read.
[[nodiscard]] Result<std::string> read_password(const std::filesystem::path& file);

/// Of the operator with that name, in a mission's folder.
[[nodiscard]] std::filesystem::path operator_file(const std::filesystem::path& folder,
                                                  std::string_view name);
[[nodiscard]] Result<LockedKey> read_operator_key(const std::filesystem::path& folder,
                                                  std::string_view name);

}  // namespace skein::identity
