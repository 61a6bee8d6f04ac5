// SPDX-License-Identifier: Apache-2.0
#include "skein/experiments/statistics.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "skein/base/assert.hpp"

namespace skein::experiments {
double student_t_95(std::size_t degrees) {
  SKEIN_ASSERT(degrees >= 1);
  const boost::math::students_t distribution{static_cast<double>(degrees)};
  return boost::math::quantile(boost::math::complement(distribution, 0.025));
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
