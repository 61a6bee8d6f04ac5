// SPDX-License-Identifier: Apache-2.0
#include "skein/base/random.hpp"

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
