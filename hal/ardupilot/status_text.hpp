// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include "skein/mavlink/messages.hpp"

namespace skein::ardupilot {

/// What an autopilot says in words. A long one comes in chunks with one id.
class StatusText {
 public:
  /// What it has said so far, with this chunk.
  const std::string& add(const mavlink::Statustext& chunk) {
    if (chunk.id == 0 || chunk.chunk_seq == 0 || chunk.id != id_) text_.clear();
    text_ += mavlink::text_of(chunk.text);
    text_.resize(std::min(text_.size(), kBytesMax));
    id_ = chunk.id;
    return text_;
  }
  /// None is to follow.
  [[nodiscard]] static bool ends(const mavlink::Statustext& chunk) {
    return chunk.id == 0 || chunk.text.back() == '\0';
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  static constexpr std::size_t kBytesMax = 400;  ///< in however many chunks
  std::string text_;
  std::uint16_t id_ = 0;
};

}  // namespace skein::ardupilot
