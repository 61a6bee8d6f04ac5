// SPDX-License-Identifier: Apache-2.0
#include "coupled_memo.hpp"

#include <algorithm>

#include "skein/base/assert.hpp"

namespace skein::planning::coupled {
namespace {

constexpr std::size_t kSlotsAtFirst = 1024;

std::uint64_t hash_of(std::span<const std::uint64_t> key) {
  std::uint64_t hash = 0x9e3779b97f4a7c15U;
  for (const std::uint64_t k : key) {
    hash = (hash ^ k) * 0xff51afd7ed558ccdU;
    hash ^= hash >> 32U;
  }
  return hash;
}

}  // namespace

Memo::Memo(std::size_t key_size, std::size_t value_size, std::size_t entries_max)
    : key_size_{key_size},
      value_size_{value_size},
      entries_max_{entries_max},
      heads_(kSlotsAtFirst, kNobody) {}

bool Memo::dominates(std::span<const std::uint64_t> key, std::span<const double> values) {
  SKEIN_ASSERT(key.size() == key_size_ && values.size() == value_size_);
  const std::uint64_t hash = hash_of(key);
  for (std::uint32_t e = heads_[slot_of(hash)]; e != kNobody; e = next_[e - 1]) {
    if (hashes_[e - 1] != hash) continue;
    const std::uint64_t* its_key = keys_.data() + (e - 1) * key_size_;
    if (!std::equal(key.begin(), key.end(), its_key)) continue;
    double* its_values = values_.data() + (e - 1) * value_size_;
    bool no_worse = true;
    bool no_better = true;
    for (std::size_t i = 0; i < value_size_; ++i) {
      no_worse = no_worse && its_values[i] <= values[i];
      no_better = no_better && its_values[i] >= values[i];
    }
    if (no_worse) return true;
    if (no_better) {
      std::copy(values.begin(), values.end(), its_values);
      return false;
    }
  }
  if (next_.size() == entries_max_) return false;
  if (next_.size() == heads_.size()) grow();
  std::uint32_t& head = heads_[slot_of(hash)];
  next_.push_back(head);
  hashes_.push_back(hash);
  keys_.insert(keys_.end(), key.begin(), key.end());
  values_.insert(values_.end(), values.begin(), values.end());
  head = static_cast<std::uint32_t>(next_.size());
  return false;
}

void Memo::grow() {
  heads_.assign(heads_.size() * 2, kNobody);
  for (std::size_t e = 0; e < next_.size(); ++e) {
    std::uint32_t& head = heads_[slot_of(hashes_[e])];
    next_[e] = head;
    head = static_cast<std::uint32_t>(e + 1);
  }
}

}  // namespace skein::planning::coupled
