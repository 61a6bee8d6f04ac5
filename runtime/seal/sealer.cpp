// SPDX-License-Identifier: Apache-2.0
#include "skein/seal/sealer.hpp"

#include <algorithm>

#include "cipher.hpp"

namespace skein::seal {

Sealer::Sealer(const SenderStart& start, const EpochKey& key, CounterRange counters)
    : start_{start},
      cipher_{std::make_unique<Cipher>(key, start, Cipher::Direction::seal)},
      epoch_{key.epoch},
      left_{counters.first, std::min(counters.end, kCounterMax + 1)} {}

Sealer::~Sealer() = default;

void Sealer::change(const EpochKey& key) {
  auto cipher = std::make_unique<Cipher>(key, start_, Cipher::Direction::seal);
  const std::lock_guard lock{mutex_};
  cipher_ = std::move(cipher);
  epoch_ = key.epoch;
}

void Sealer::extend(std::uint64_t end) {
  const std::lock_guard lock{mutex_};
  left_.end = std::clamp(end, left_.end, kCounterMax + 1);
}

std::uint64_t Sealer::next() const {
  const std::lock_guard lock{mutex_};
  return left_.first;
}

bool Sealer::seal(std::span<const std::uint8_t> plain, std::vector<std::uint8_t>& out) {
  out.resize(plain.size() + kOverheadBytes);
  const std::lock_guard lock{mutex_};
  if (left_.first >= left_.end) return false;
  // Counted on over a change of keys: the same counter twice under one key would be the end of it.
  cipher_->seal({.epoch = epoch_, .from = start_, .counter = left_.first++}, plain, out);
  return true;
}

}  // namespace skein::seal
