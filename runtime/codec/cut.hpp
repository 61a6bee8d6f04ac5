// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "skein/coalition/messages.hpp"

namespace skein::codec {

/// Cut at a character of UTF-8, so that the receiver still finds it valid.
inline std::string cut(const std::string& text) {
  std::size_t size = text.size();
  if (size > coalition::kReasonMax) {
    size = coalition::kReasonMax;
    while (size > 0 && (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U) --size;
  }
  return text.substr(0, size);
}

}  // namespace skein::codec
