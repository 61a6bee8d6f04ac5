// SPDX-License-Identifier: Apache-2.0
#include "skein/experiments/statistics.hpp"

#include <cmath>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"

namespace skein::experiments {
namespace {

/// P(|T| <= t): the finite sums of Abramowitz and Stegun (1964), 26.7.3 and 26.7.4.
double within(double t, std::size_t degrees) {
  const double angle = std::atan(t / std::sqrt(static_cast<double>(degrees)));
  const double cos2 = std::cos(angle) * std::cos(angle);
  const bool odd = degrees % 2 == 1;
  double term = odd ? std::cos(angle) : 1.0;
  double sum = degrees > 1 ? term : 0.0;
  for (std::size_t k = odd ? 3 : 2; k < degrees; k += 2) {
    const auto n = static_cast<double>(k);
    term *= cos2 * (n - 1.0) / n;
    sum += term;
  }
  return odd ? 2.0 / kPi * (angle + std::sin(angle) * sum) : std::sin(angle) * sum;
}

}  // namespace

double student_t_95(std::size_t degrees) {
  SKEIN_ASSERT(degrees >= 1);
  double low = 1.9;    // the normal distribution's is 1.96
  double high = 13.0;  // of one degree: 12.71
  while (high - low > 1e-11) {
    const double middle = 0.5 * (low + high);
    (within(middle, degrees) < 0.95 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Estimate estimate(std::span<const double> values) {
  Estimate e;
  e.count = values.size();
  if (values.empty()) return e;
  const auto n = static_cast<double>(e.count);
  for (const double value : values) e.mean += value / n;
  if (e.count < 2) return e;
  double squares = 0.0;
  for (const double value : values) squares += (value - e.mean) * (value - e.mean);
  e.deviation = std::sqrt(squares / (n - 1.0));
  e.half_width = student_t_95(e.count - 1) * e.deviation / std::sqrt(n);
  return e;
}

}  // namespace skein::experiments
