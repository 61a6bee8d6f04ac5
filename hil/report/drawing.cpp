// SPDX-License-Identifier: Apache-2.0
#include "skein/report/drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace skein::report {

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::vector<std::size_t> thinned_points(const std::vector<Vec2>& line, double tolerance) {
  std::vector<bool> kept(line.size(), line.size() < 3);
  if (line.empty()) return {};
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, line.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    const Vec2 chord = line[last] - line[first];
    const double length = chord.norm();
    double farthest = tolerance;
    std::size_t split = first;
    for (std::size_t i = first + 1; i < last; ++i) {
      const Vec2 off = line[i] - line[first];
      // A closed loop has no chord to measure from.
      const double away = length > tolerance ? std::abs(cross(chord, off)) / length : off.norm();
      if (away > farthest) {
        farthest = away;
        split = i;
      }
    }
    if (split == first) continue;
    kept[split] = true;
    open.emplace_back(first, split);
    open.emplace_back(split, last);
  }
  std::vector<std::size_t> points;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (kept[i]) points.push_back(i);
  }
  return points;
}

std::vector<Vec2> thinned(const std::vector<Vec2>& line, double tolerance) {
  std::vector<Vec2> out;
  for (const std::size_t i : thinned_points(line, tolerance)) out.push_back(line[i]);
  return out;
}

std::string timed_points(const std::vector<Vec2>& line, const std::vector<double>& times_s,
                         double tolerance) {
  std::string points;
  std::string times;
  for (const std::size_t i : thinned_points(line, tolerance)) {
    const char* const gap = points.empty() ? "" : " ";
    points += fmt::format("{}{:.1f},{:.1f}", gap, line[i].x(), line[i].y());
    times += fmt::format("{}{:.1f}", gap, times_s[i]);
  }
  return fmt::format(R"~( points="{}" data-times="{}")~", points, times);
}

std::string points_text(const std::vector<Vec2>& line) {
  std::string text;
  for (const Vec2& p : line) {
    text += fmt::format("{}{:.1f},{:.1f}", text.empty() ? "" : " ", p.x(), p.y());
  }
  return text;
}

std::string axis_attribute(std::string_view name, const Axis& axis, std::string_view unit) {
  return fmt::format(R"~( data-{}="{:.6g} {:.6g} {:.6g} {:.6g} {}")~", name, axis.from, axis.to,
                     axis.pixel_from, axis.pixel_to, unit);
}

double round_below(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  const double lead = value / power;
  return power * (lead < 2.0 ? 1.0 : lead < 5.0 ? 2.0 : 5.0);
}

std::vector<double> Axis::ticks(int count) const {
  // Values that differ by rounding only have no round values between them.
  if (to - from <= 1e-12 * std::max(std::abs(from), std::abs(to))) return {};
  const double step = round_below((to - from) / count * 1.5);
  std::vector<double> values;
  for (double i = std::ceil(from / step - 1e-9); i * step <= to + 1e-9 * step; i += 1.0) {
    values.push_back(i * step + 0.0);  // -0 is written as 0
  }
  return values;
}

}  // namespace skein::report
