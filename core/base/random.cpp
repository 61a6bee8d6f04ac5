// SPDX-License-Identifier: Apache-2.0
#include "skein/base/random.hpp"

#include <bit>
#include <cmath>

#include "skein/base/assert.hpp"

namespace skein {

Random::Random(std::uint64_t seed) {
  for (auto& word : state_) {  // splitmix64
    seed += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = seed;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    word = z ^ (z >> 31U);
  }
}

std::uint64_t Random::next() {
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

double Random::uniform() { return static_cast<double>(next() >> 11U) * 0x1.0p-53; }

double Random::uniform(double low, double high) { return low + (high - low) * uniform(); }

std::uint64_t Random::index(std::uint64_t count) {
  SKEIN_ASSERT(count > 0);
  // Numbers below 2^64 mod count would make the low remainders likelier: draw again.
  const std::uint64_t biased = (0 - count) % count;
  for (;;) {
    const std::uint64_t r = next();
    if (r >= biased) return r % count;
  }
}

double Random::normal(double mean, double standard_deviation) {
  for (;;) {
    const double u = uniform(-1.0, 1.0);
    const double v = uniform(-1.0, 1.0);
    const double s = u * u + v * v;
    if (s > 0.0 && s < 1.0)
      return mean + standard_deviation * u * std::sqrt(-2.0 * std::log(s) / s);
  }
}

Random Random::fork() { return Random{next()}; }

}  // namespace skein
