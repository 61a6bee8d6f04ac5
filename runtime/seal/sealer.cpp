// SPDX-License-Identifier: Apache-2.0
#include "skein/seal/sealer.hpp"

#include "cipher.hpp"

namespace skein::seal {

Sealer::Sealer(const SenderStart& start, const EpochKey& key)
    : start_{start},
      cipher_{std::make_unique<Cipher>(key, start, Cipher::Direction::seal)},
      epoch_{key.epoch} {}

Sealer::~Sealer() = default;

void Sealer::change(const EpochKey& key) {
  auto cipher = std::make_unique<Cipher>(key, start_, Cipher::Direction::seal);
  const std::lock_guard lock{mutex_};
  cipher_ = std::move(cipher);
  epoch_ = key.epoch;
}

bool Sealer::seal(std::span<const std::uint8_t> plain, std::vector<std::uint8_t>& out) {
  out.resize(plain.size() + kOverheadBytes);
  const std::lock_guard lock{mutex_};
  if (next_ > kCounterMax) return false;
  // Counted on over a change of keys: the same counter twice under one key would be the end of it.
  cipher_->seal({.epoch = epoch_, .from = start_, .counter = next_++}, plain, out);
  return true;
}

}  // namespace skein::seal
