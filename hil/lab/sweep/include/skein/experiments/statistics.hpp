// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

namespace skein::experiments {

/// Mean of a sample and how well it is known.
struct Estimate {
  std::size_t count = 0;
  double mean = 0.0;        ///< 0 where there is no value
  double deviation = 0.0;   ///< sample standard deviation (count - 1); 0 for less than two values
  double half_width = 0.0;  ///< of the 95 % confidence interval; 0 for less than two values
};

/// By Student's t: mean +- t(0.975, count - 1) * deviation / sqrt(count).
[[nodiscard]] Estimate estimate(std::span<const double> values);

/// The two-sided 95 % point of Student's t. Precondition: degrees >= 1. Error below 1e-9.
[[nodiscard]] double student_t_95(std::size_t degrees);

}  // namespace skein::experiments
