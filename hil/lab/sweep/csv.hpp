// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "skein/base/result.hpp"

namespace skein::experiments {

/// A line with its end; fields with commas or quotes are quoted. Precondition: no line ends within.
[[nodiscard]] std::string csv_line(const std::vector<std::string>& fields);
/// The fields of a line without its end.
[[nodiscard]] std::vector<std::string> csv_fields(std::string_view line);

/// For a stream that has failed just now.
[[nodiscard]] Error not_written(const std::string& file);

}  // namespace skein::experiments
