// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/result.hpp"

/// Runs of one experiment that are flown apart, by programs that do not know of each other.
namespace skein::shards {

/// One of so many equal parts of an experiment's draws. Neighbours go to different shards, so that
/// all take about as long, and the first draws of a longer experiment stay where they were.
struct Shard {
  std::size_t number = 1;  ///< 1 to count
  std::size_t count = 1;
  /// Is the draw, counted from 0 in the order of one machine, in this shard?
  [[nodiscard]] bool has(std::uint64_t draw) const { return of(draw) == number; }
  /// The number of the shard that has the draw.
  [[nodiscard]] std::size_t of(std::uint64_t draw) const {
    return static_cast<std::size_t>(draw % count) + 1;
  }
  [[nodiscard]] bool whole() const { return count == 1; }
  bool operator==(const Shard&) const = default;
};

/// Of "3/16". Fails for what is no shard.
[[nodiscard]] Result<Shard> parse_shard(std::string_view text);
[[nodiscard]] std::string to_string(const Shard& shard);

/// "3,7,11-13", as job engines take a list. Precondition: ascending.
[[nodiscard]] std::string ranges(const std::vector<std::size_t>& numbers);

}  // namespace skein::shards
