// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "field_visitor.hpp"

namespace skein::configuration {

/// The shortest decimal that reads back as the same number.
[[nodiscard]] std::string number_text(double value);
/// "10 to 2000 m"
[[nodiscard]] std::string range_text(const Range& range);
/// The one of `known` that `word` was probably meant to be; empty where none is near.
template <class Words>
[[nodiscard]] std::string nearest_word(std::string_view word, const Words& known);
/// Insertions, removals, replacements and swaps of neighbours.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

template <class Words>
std::string nearest_word(std::string_view word, const Words& known) {
  std::string best;
  std::size_t best_distance = word.size() / 3 + 2;
  for (const auto& candidate : known) {
    const std::size_t d = edit_distance(word, candidate);
    if (d < best_distance && d < candidate.size()) {
      best_distance = d;
      best = candidate;
    }
  }
  return best;
}

}  // namespace skein::configuration
