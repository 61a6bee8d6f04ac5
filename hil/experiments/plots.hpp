// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "skein/experiments/statistics.hpp"

namespace skein::experiments {

struct Series {
  std::string name;
  std::vector<Estimate> values;  ///< one for each place along the plot
};

struct Plot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<std::string> x;  ///< places, evenly spaced
  std::vector<Series> series;
};

/// Means with their 95 % intervals, as an SVG file for light and dark pages: a line a series, or
/// groups of bars from 0. Places without a value are left out.
[[nodiscard]] std::string svg(const Plot& plot, bool bars);

}  // namespace skein::experiments
