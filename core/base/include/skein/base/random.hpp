// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace skein {

/// A seeded generator that gives the same numbers with every compiler and library: xoshiro256++
/// (Blackman and Vigna, 2019), seeded by splitmix64. The distributions are ours because the
/// standard library's are implementation-defined.
class Random {
 public:
  explicit Random(std::uint64_t seed);

  [[nodiscard]] std::uint64_t next() {
    const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
    const std::uint64_t t = state_[1] << 17U;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = std::rotl(state_[3], 45);
    return result;
  }
  /// Uniform in [0, 1), 53 bits.
  [[nodiscard]] double uniform() { return static_cast<double>(next() >> 11U) * 0x1.0p-53; }
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform in [0, count). Precondition: count > 0. Unbiased.
  [[nodiscard]] std::uint64_t index(std::uint64_t count);
  /// Normal, by Marsaglia's polar method.
  [[nodiscard]] double normal(double mean, double standard_deviation);
  [[nodiscard]] bool chance(double probability) { return uniform() < probability; }
  /// An independent generator, for a part that must not disturb this one's sequence.
  [[nodiscard]] Random fork();

 private:
  std::array<std::uint64_t, 4> state_{};
};

}  // namespace skein
