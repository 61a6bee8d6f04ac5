// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace skein {

/// A seeded generator that gives the same numbers with every compiler and library: xoshiro256++
/// (Blackman and Vigna, 2019), seeded by splitmix64. The distributions are ours because the
/// standard library's are implementation-defined.
class Random {
 public:
  explicit Random(std::uint64_t seed);

  [[nodiscard]] std::uint64_t next();
  /// Uniform in [0, 1), 53 bits.
  [[nodiscard]] double uniform();
  [[nodiscard]] double uniform(double low, double high);
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
