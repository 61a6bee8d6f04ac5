// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/identity/keys.hpp"

namespace skein::identity {

/// Bytes as a line of capitals, digits, '-' and ':', which a QR code holds as such: the prefix,
/// then base32 (RFC 4648, without '=') of the bytes and of the first 4 of the SHA-256 of prefix and
/// bytes.
struct TextForm {
  std::string_view prefix;
  const char* what;  ///< for people
  std::size_t bytes_max;
};

[[nodiscard]] std::string to_text(const TextForm& form, Span bytes);
/// White space around it is no part of it. Nothing is decoded that would be longer than bytes_max.
[[nodiscard]] Result<Bytes> bytes_from_text(const TextForm& form, std::string_view text);

[[nodiscard]] std::string base32(Span bytes);
/// Without the empty ones.
/// None where it is anything else.
[[nodiscard]] std::optional<std::uint16_t> whole_number(std::string_view digits);
[[nodiscard]] std::vector<std::string_view> lines_of(std::string_view text);
[[nodiscard]] std::string_view without_space_around(std::string_view text);

}  // namespace skein::identity
