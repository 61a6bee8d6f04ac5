// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/geometry.hpp"

namespace skein::report {

/// For text and attribute values of HTML and SVG.
[[nodiscard]] std::string escaped(std::string_view text);

/// The points of a line that can be told apart on a screen: Douglas and Peucker (1973), to
/// `tolerance` in the units of the points.
[[nodiscard]] std::vector<Vec2> thinned(const std::vector<Vec2>& line, double tolerance);
/// Which of them that are: ascending, the ends included.
[[nodiscard]] std::vector<std::size_t> thinned_points(const std::vector<Vec2>& line,
                                                      double tolerance);

/// The attributes of a polyline that has a time at each of its points, thinned.
[[nodiscard]] std::string timed_points(const std::vector<Vec2>& line,
                                       const std::vector<double>& times_s, double tolerance);

/// "x,y x,y ..." of a polyline.
[[nodiscard]] std::string points_text(const std::vector<Vec2>& line);

/// A linear scale from values to pixels.
struct Axis {
  double from = 0.0;
  double to = 1.0;
  double pixel_from = 0.0;
  double pixel_to = 1.0;

  [[nodiscard]] double operator()(double value) const {
    return pixel_from + (value - from) / (to - from) * (pixel_to - pixel_from);
  }
  /// About `count` round values within; none where from and to differ by no more than rounding.
  [[nodiscard]] std::vector<double> ticks(int count) const;
};

/// An attribute of an svg: the scale of an axis, for what moves in the page.
[[nodiscard]] std::string axis_attribute(std::string_view name, const Axis& axis,
                                         std::string_view unit);

/// The round number (1, 2, 5 times a power of ten) nearest below. Precondition: value > 0.
[[nodiscard]] double round_below(double value);

}  // namespace skein::report
