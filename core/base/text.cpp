// SPDX-License-Identifier: Apache-2.0
#include "skein/base/text.hpp"

#include <algorithm>
#include <optional>

namespace skein {
namespace {

constexpr bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20U || c == 0x7F; }

/// How many bytes follow the first of a character of UTF-8; none where it begins none.
std::optional<std::size_t> bytes_after(unsigned char lead) {
  if (lead < 0x80U) return 0;
  if (lead >= 0xC2U && lead < 0xE0U) return 1;
  if (lead >= 0xE0U && lead < 0xF0U) return 2;
  if (lead >= 0xF0U && lead < 0xF5U) return 3;
  return std::nullopt;
}

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

}  // namespace

bool is_text(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto more = bytes_after(static_cast<unsigned char>(text[i]));
    if (!more || text.size() - i <= *more || is_control(text[i])) return false;
    for (std::size_t k = 1; k <= *more; ++k) {
      if (!continues(text[i + k])) return false;
    }
    i += *more + 1;
  }
  return true;
}

std::string as_text(std::string_view text, std::size_t bytes_max) {
  std::size_t size = std::min(text.size(), bytes_max);
  while (size > 0 && size < text.size() && continues(text[size])) --size;
  std::string made{text.substr(0, size)};
  std::replace_if(made.begin(), made.end(), is_control, ' ');
  return made;
}

}  // namespace skein
