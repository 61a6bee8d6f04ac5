// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

/// JSON to text and back, compiled once: the library's parser and writer are templates that cost
/// every source which calls them a second of the compiler.
namespace skein::codec {

/// What we write: members stay in their order.
using Json = nlohmann::ordered_json;
/// What others wrote: a member is found fast, however many there are.
using ParsedJson = nlohmann::json;

/// On one line, or on many with that indentation. What others sent may be no UTF-8: such bytes are
/// replaced.
[[nodiscard]] std::string json_text(const Json& json, int indent = -1);
/// is_discarded() where `text` is no JSON.
[[nodiscard]] ParsedJson parse_json(std::string_view text);
/// The same for text of our own, whose order stays.
[[nodiscard]] Json parse_own_json(std::string_view text);

}  // namespace skein::codec
