// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/groundstation/orders.hpp"

/// The words of a typed line.
namespace skein::groundstation {

/// Bytes of why the command is taken.
inline constexpr std::size_t kReasonMax = 80;

/// The whole word as a number.
[[nodiscard]] inline std::optional<double> number_of(std::string_view word) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

/// A number from 1 up, as sites and vehicles have.
[[nodiscard]] inline std::optional<std::uint16_t> id_of(std::string_view word) {
  std::uint16_t id = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), id);
  if (error != std::errc{} || end != word.data() + word.size() || id == 0) return std::nullopt;
  return id;
}

/// "3,5-9": ascending, none twice; nothing where it is no such list.
[[nodiscard]] inline std::optional<std::vector<VehicleId>> ids_of(std::string_view word) {
  std::set<VehicleId> all;
  for (std::size_t begin = 0; begin <= word.size();) {
    const auto comma = std::min(word.find(',', begin), word.size());
    const auto part = word.substr(begin, comma - begin);
    begin = comma + 1;
    const auto hyphen = part.find('-');
    const auto first = id_of(part.substr(0, hyphen));
    const auto last = hyphen == std::string_view::npos ? first : id_of(part.substr(hyphen + 1));
    if (!first || !last || *last < *first) return std::nullopt;
    if (all.size() + (*last - *first) >= kVehiclesPerOrderMax) return std::nullopt;
    for (int id = *first; id <= *last; ++id) all.insert({static_cast<std::uint16_t>(id)});
  }
  return std::vector<VehicleId>{all.begin(), all.end()};
}

/// A number after a keyword.
[[nodiscard]] inline Result<double> number_after(std::string_view keyword, std::string_view word,
                                                 const Limit& limit) {
  const auto value = number_of(word);
  if (!value || !limit.has(*value)) {
    return Error{fmt::format("'{}' needs a number from {} to {}, not '{}'", keyword, limit.low,
                             limit.high, word)};
  }
  return *value;
}

/// EAST,NORTH in metres.
[[nodiscard]] inline Result<Vec2> place_of(std::string_view word) {
  const auto comma = word.find(',');
  if (comma == std::string_view::npos) {
    return Error{fmt::format("'{}' is no corner EAST,NORTH in metres, such as 120,-40", word)};
  }
  const auto east = number_after("EAST of a corner", word.substr(0, comma), kCoordinate_m);
  const auto north = number_after("NORTH of a corner", word.substr(comma + 1), kCoordinate_m);
  if (!east) return east.error();
  if (!north) return north.error();
  return Vec2{*east, *north};
}

}  // namespace skein::groundstation
