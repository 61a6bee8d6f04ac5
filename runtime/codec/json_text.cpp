// SPDX-License-Identifier: Apache-2.0
#include "skein/codec/json_text.hpp"

namespace skein::codec {

std::string json_text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

ParsedJson parse_json(std::string_view text) { return ParsedJson::parse(text, nullptr, false); }
Json parse_own_json(std::string_view text) { return Json::parse(text, nullptr, false); }

}  // namespace skein::codec
