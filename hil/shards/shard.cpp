// SPDX-License-Identifier: Apache-2.0
#include "skein/shards/shard.hpp"

#include <fmt/format.h>

#include <string>

#include "skein/shards/csv.hpp"

namespace skein::shards {

Result<Shard> parse_shard(std::string_view text) {
  const auto slash = text.find('/');
  if (slash != std::string_view::npos) {
    const auto number = number_of<std::size_t>(text.substr(0, slash));
    const auto count = number_of<std::size_t>(text.substr(slash + 1));
    if (number && count && *number >= 1 && *number <= *count) return Shard{*number, *count};
  }
  return Error{fmt::format(
      "'{}' is no shard; give its number and how many there are, from 1/4 to 4/4", text)};
}

std::string to_string(const Shard& shard) {
  return fmt::format("{}/{}", shard.number, shard.count);
}

std::string ranges(const std::vector<std::size_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    if (i > 0) text += ',';
    text += std::to_string(numbers[i]);
    if (last > i) text += fmt::format("-{}", numbers[last]);
    i = last + 1;
  }
  return text;
}

}  // namespace skein::shards
