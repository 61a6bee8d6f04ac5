// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

namespace skein::console {

/// What a page says on the socket (docs/console-socket.md, from the client).
struct ResumeText {
  std::uint64_t next_seq = 0;
};
struct PingText {
  std::int64_t id = 0;
};
struct LineText {
  std::int64_t id = 0;
  std::string line;   ///< of the prompt; or
  std::string order;  ///< as JSON, not looked into here
};
using PageText = std::variant<ResumeText, PingText, LineText>;

/// None for what no page of ours says. Any bytes are safe.
[[nodiscard]] std::optional<PageText> parse_page_text(const std::string& text);

}  // namespace skein::console
