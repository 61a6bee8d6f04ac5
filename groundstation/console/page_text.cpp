// SPDX-License-Identifier: Apache-2.0
#include "page_text.hpp"

#include <nlohmann/json.hpp>
#include <utility>

namespace skein::console {
namespace {

using Json = nlohmann::json;

/// Null where there is none of that name.
const Json* member(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found == object.end() ? nullptr : &*found;
}

std::optional<PageText> line_text(const Json& json, std::int64_t id) {
  const Json* line = member(json, "line");
  if (line == nullptr || !line->is_string()) return std::nullopt;
  LineText text{id, line->get<std::string>(), {}};
  const Json* coalition = member(json, "coalition");
  const Json* round = member(json, "round");
  if (coalition == nullptr && round == nullptr) return text;
  if (coalition == nullptr || round == nullptr || !coalition->is_string() ||
      !round->is_number_unsigned() || round->get<std::uint64_t>() > UINT32_MAX) {
    return std::nullopt;
  }
  text.seen = {coalition->get<std::string>(), round->get<std::uint32_t>()};
  return text;
}

}  // namespace

std::optional<PageText> parse_page_text(const std::string& text) {
  const Json json = Json::parse(text, nullptr, false);
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
  if (*type == "line") return line_text(json, number);
  return std::nullopt;
}

}  // namespace skein::console
