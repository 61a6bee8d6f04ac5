// SPDX-License-Identifier: Apache-2.0
#include "page_text.hpp"

#include <utility>

#include "skein/codec/json_text.hpp"

namespace skein::console {
namespace {

using Json = codec::ParsedJson;

/// Null where there is none of that name.
const Json* member(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found == object.end() ? nullptr : &*found;
}

}  // namespace

std::optional<PageText> parse_page_text(const std::string& text) {
  const Json json = codec::parse_json(text);
  if (!json.is_object()) return std::nullopt;
  const Json* type = member(json, "type");
  if (type == nullptr || !type->is_string()) return std::nullopt;
  if (*type == "resume") {
    const Json* next = member(json, "next_seq");
    if (next == nullptr || !next->is_number_unsigned()) return std::nullopt;
    return ResumeText{next->get<std::uint64_t>()};
  }
  const Json* id = member(json, "id");
  if (id == nullptr || !id->is_number_integer()) return std::nullopt;
  const auto number = id->get<std::int64_t>();
  if (*type == "ping") return PingText{number};
  const Json* line = member(json, "line");
  if (*type == "line" && line != nullptr && line->is_string()) {
    return LineText{number, line->get<std::string>(), {}};
  }
  const Json* order = member(json, "order");
  if (*type == "order" && order != nullptr && order->is_object()) {
    return LineText{number, {}, codec::json_text(codec::Json(*order))};
  }
  return std::nullopt;
}

}  // namespace skein::console
