// SPDX-License-Identifier: Apache-2.0
#include "skein/routes/chaos.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"

namespace skein::routes {
namespace {

bool is_signed(ChaoticMap map) {
  return map == ChaoticMap::iterative || map == ChaoticMap::chebyshev;
}

double piecewise(double x) {
  constexpr double kBend = 0.3;
  const double low = std::min(x, 1.0 - x);  // the map is the same from both ends
  return low < kBend ? low / kBend : (low - kBend) / (0.5 - kBend);
}

double liebovitch(double x) {
  constexpr double kFirst = 0.3;
  constexpr double kSecond = 0.8;
  const double alpha = kSecond / kFirst * (1.0 - (kSecond - kFirst));
  const double beta = 1.0 / (kSecond - 1.0) * ((kSecond - 1.0) - kFirst * (kSecond - kFirst));
  if (x <= kFirst) return alpha * x;
  if (x <= kSecond) return (kSecond - x) / (kSecond - kFirst);
  return 1.0 - beta * (1.0 - x);
}

double intermittency(double x) {
  constexpr double kStep = 0.1;
  constexpr double kBend = 0.5;
  constexpr double kCurve = (1.0 - kStep - kBend) / (kBend * kBend);
  return x <= kBend ? kStep + x + kCurve * x * x : (x - kBend) / (1.0 - kBend);
}

double step(ChaoticMap map, double x) {
  switch (map) {
    case ChaoticMap::logistic:
      return 4.0 * x * (1.0 - x);
    case ChaoticMap::circle: {
      const double y = x + 0.2 - 0.5 / kTwoPi * std::sin(kTwoPi * x);
      return y - std::floor(y);
    }
    case ChaoticMap::gauss: {
      if (x == 0.0) return 0.0;
      const double y = 1.0 / x;
      return y - std::floor(y);
    }
    case ChaoticMap::iterative:
      return x == 0.0 ? 0.0 : std::sin(0.85 * kPi / x);
    case ChaoticMap::tent:
      return x < 0.7 ? x / 0.7 : 10.0 / 3.0 * (1.0 - x);
    case ChaoticMap::sinusoidal:
      return 2.3 * x * x * std::sin(kPi * x);
    case ChaoticMap::singer:
      return 1.07 * (7.86 * x - 23.31 * x * x + 28.75 * x * x * x - 13.302875 * x * x * x * x);
    case ChaoticMap::sine:
      return std::sin(kPi * x);
    case ChaoticMap::piecewise:
      return piecewise(x);
    case ChaoticMap::chebyshev:
      return std::cos(4.0 * std::acos(x));
    case ChaoticMap::liebovitch:
      return liebovitch(x);
    case ChaoticMap::intermittency:
      return intermittency(x);
    case ChaoticMap::count:
      break;
  }
  SKEIN_ASSERT(false);
  return 0.0;
}

}  // namespace

std::string_view to_string(ChaoticMap map) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(ChaoticMap::count)> kNames{
      "logistic", "circle", "gauss",     "iterative", "tent",       "sinusoidal",
      "singer",   "sine",   "piecewise", "chebyshev", "liebovitch", "intermittency"};
  return kNames.at(static_cast<std::size_t>(map));
}

ChaoticSequence::ChaoticSequence(ChaoticMap map, Random random) : map_{map}, random_{random} {
  restart();
}

void ChaoticSequence::restart() {
  // Below 0.46 the sinusoidal map falls to 0.
  const bool high = map_ == ChaoticMap::sinusoidal;
  start_at(random_.uniform(high ? 0.5 : 0.01, high ? 0.9 : 0.99));
}

void ChaoticSequence::start_at(double x) { x_ = is_signed(map_) ? 2.0 * x - 1.0 : x; }

double ChaoticSequence::next() {
  const double low = is_signed(map_) ? -1.0 : 0.0;
  const double before = x_;
  x_ = std::clamp(step(map_, before), low, 1.0);
  // 0 and 1 lie on the way to fixed points of most maps.
  if (x_ == before || x_ == 0.0 || x_ == 1.0 || x_ == low) restart();
  return is_signed(map_) ? 0.5 * (x_ + 1.0) : x_;
}

}  // namespace skein::routes
