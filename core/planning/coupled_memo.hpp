// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace skein::planning::coupled {

/// What has been seen, to drop a partial plan that is nowhere better than another that did the same
/// tasks and left the vehicles at the same places. Bounded: when full it forgets nothing and learns
/// nothing more.
class Memo {
 public:
  /// Every key has `key_size` numbers, every entry `value_size`.
  Memo(std::size_t key_size, std::size_t value_size, std::size_t entries_max);

  /// Is there an entry of this key with no value greater than these? If not, these become one.
  [[nodiscard]] bool dominates(std::span<const std::uint64_t> key, std::span<const double> values);

 private:
  static constexpr std::uint32_t kNobody = 0;

  void grow();
  [[nodiscard]] std::size_t slot_of(std::uint64_t hash) const {
    return static_cast<std::size_t>(hash) & (heads_.size() - 1);
  }

  std::size_t key_size_;
  std::size_t value_size_;
  std::size_t entries_max_;
  std::vector<std::uint32_t> heads_;  ///< by slot: the first entry, counted from 1
  std::vector<std::uint32_t> next_;   ///< by entry
  std::vector<std::uint64_t> hashes_;
  std::vector<std::uint64_t> keys_;
  std::vector<double> values_;
};

}  // namespace skein::planning::coupled
