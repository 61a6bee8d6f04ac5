// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "skein/base/geometry.hpp"
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
/// groups of bars from 0. Places without a value are left out; labels that are too long for their
/// place are slanted.
[[nodiscard]] std::string svg(const Plot& plot, bool bars);

struct Line {
  std::string name;
  std::vector<Vec2> points;
};

/// Lines over numbers.
struct LinePlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Line> lines;
};

/// As an SVG file of the same looks. All coordinates are finite.
[[nodiscard]] std::string svg(const LinePlot& plot);

/// The style of these plots, for other pictures of the same looks: class `paper` of the background,
/// `title`, and c0 ... c6 which set the colour --c of a series.
[[nodiscard]] std::string plot_style();

}  // namespace skein::experiments
