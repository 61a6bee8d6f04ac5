// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "skein/base/result.hpp"

namespace skein::shards {

/// A line with its end; fields with commas or quotes are quoted. Precondition: no line ends within.
[[nodiscard]] std::string csv_line(const std::vector<std::string>& fields);
/// The fields of a line without its end.
[[nodiscard]] std::vector<std::string> csv_fields(std::string_view line);

/// One field of several texts, whatever is in them; no line ends are within it.
[[nodiscard]] std::string joined(const std::vector<std::string>& texts);
/// The texts of joined().
[[nodiscard]] std::vector<std::string> parted(std::string_view field);

/// The whole text as one number.
template <class T>
[[nodiscard]] std::optional<T> number_of(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return {};
  return value;
}

/// For a stream that has failed just now.
[[nodiscard]] Error not_written(const std::string& file);

}  // namespace skein::shards
