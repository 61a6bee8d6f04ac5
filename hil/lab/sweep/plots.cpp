// SPDX-License-Identifier: Apache-2.0
#include "skein/experiments/plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "skein/base/geometry.hpp"
#include "skein/report/drawing.hpp"
#include "skein/report/palette.hpp"

namespace skein::experiments {
namespace {

constexpr double kWidth = 680.0;
constexpr double kHeight = 380.0;
constexpr double kLeft = 62.0;
constexpr double kRight = 490.0;  // right of it is the legend
constexpr double kTop = 54.0;
constexpr double kBottom = kHeight - 44.0;
constexpr double kLetter = 6.5;  // as wide as one is, about

constexpr std::string_view kStyle = R"(
.paper{fill:var(--paper)}text{font:12px system-ui,sans-serif;fill:var(--soft)}.title{font-size:14px;font-weight:600;fill:var(--ink)}
.mid{text-anchor:middle}.end{text-anchor:end}.grid{stroke:var(--rule)}
.line{fill:none;stroke:var(--c);stroke-width:2}.bar{fill:var(--c)}.dot{fill:var(--c)}.error{fill:none;stroke:var(--c);stroke-width:1.3}
.bar+.error{stroke:var(--ink)}
)";

/// With room at both ends, but for bars at 0. low > high: there is no value at all.
report::Axis value_axis(double low, double high, bool bars) {
  if (low > high) low = high = 0.0;
  // All the same, but for the rounding of their means.
  const bool flat = high - low <= 1e-9 * std::max(std::abs(low), std::abs(high));
  const double room = flat ? 1.0 : 0.06 * (high - low);
  return {low < 0.0 || !bars ? low - room : low, high + room, kBottom, kTop};
}

report::Axis value_axis(const Plot& plot, bool bars) {
  double low = bars ? 0.0 : std::numeric_limits<double>::infinity();
  double high = bars ? 0.0 : -std::numeric_limits<double>::infinity();
  for (const Series& series : plot.series) {
    for (const Estimate& e : series.values) {
      if (e.count == 0) continue;
      low = std::min(low, e.mean - e.half_width);
      high = std::max(high, e.mean + e.half_width);
    }
  }
  return value_axis(low, high, bars);
}

/// What both kinds begin with: everything but x's labels and the values. `below` is the room that
/// those labels take beyond their line.
template <class AnyPlot>
std::string frame(const AnyPlot& plot, const report::Axis& value, double below) {
  std::string text = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0:.0f} {1:.0f}" width="{0:.0f}" height="{1:.0f}">{2}<rect class="paper" width="{0:.0f}" height="{1:.0f}"/><text class="title" x="12" y="20">{3}</text><text x="12" y="40">{4}</text>)",
      kWidth, kHeight + below, plot_style(), report::escaped(plot.title),
      report::escaped(plot.y_label));
  for (const double v : value.ticks(6)) {
    text += fmt::format(
        R"(<path class="grid" d="M{0:.0f} {1:.1f}H{2:.0f}"/><text class="end" x="{3:.0f}" y="{4:.1f}">{5:g}</text>)",
        kLeft, value(v), kRight, kLeft - 6.0, value(v) + 4.0, v);
  }
  text +=
      fmt::format(R"(<text class="mid" x="{:.0f}" y="{:.0f}">{}</text>)", 0.5 * (kLeft + kRight),
                  kBottom + 36.0 + below, report::escaped(plot.x_label));
  return text;
}

/// Names beside their colours; one series needs none.
template <class AnySeries>
std::string legend(const std::vector<AnySeries>& series) {
  std::string text;
  for (std::size_t s = 0; s < series.size() && series.size() > 1; ++s) {
    const double y = kTop + 12.0 + 20.0 * static_cast<double>(s);
    text += fmt::format(
        R"(<rect class="bar c{}" x="{:.0f}" y="{:.1f}" width="12" height="12" rx="2"/><text x="{:.0f}" y="{:.1f}">{}</text>)",
        s % report::kSeriesColours, kRight + 14.0, y - 10.0, kRight + 32.0, y,
        report::escaped(series[s].name));
  }
  return text;
}

/// The interval around a mean.
std::string error_bar(const report::Axis& value, const Estimate& e, double x) {
  if (e.count < 2) return "";
  return fmt::format(
      R"(<path class="error" d="M{0:.1f} {1:.1f}V{2:.1f}M{3:.1f} {1:.1f}H{4:.1f}M{3:.1f} {2:.1f}H{4:.1f}"/>)",
      x, value(e.mean - e.half_width), value(e.mean + e.half_width), x - 3.0, x + 3.0);
}

std::string lines_of(const Plot& plot, const report::Axis& value, double step) {
  std::string text;
  for (std::size_t s = 0; s < plot.series.size(); ++s) {
    // Beside each other, so that no interval hides another.
    const double aside =
        6.0 * (static_cast<double>(s) - 0.5 * static_cast<double>(plot.series.size() - 1));
    std::vector<Vec2> line;
    std::string marks;
    for (std::size_t i = 0; i < plot.x.size(); ++i) {
      const Estimate& e = plot.series[s].values.at(i);
      if (e.count == 0) continue;
      const double x = kLeft + step * (static_cast<double>(i) + 0.5) + aside;
      line.emplace_back(x, value(e.mean));
      marks += error_bar(value, e, x);
      marks += fmt::format(
          R"(<circle class="dot" cx="{:.1f}" cy="{:.1f}" r="3.5"><title>{}, {}: {:.4g} +- {:.2g}, {} runs</title></circle>)",
          x, value(e.mean), report::escaped(plot.series[s].name), report::escaped(plot.x[i]),
          e.mean, e.half_width, e.count);
    }
    text += fmt::format(R"(<g class="c{}"><polyline class="line" points="{}"/>{}</g>)",
                        s % report::kSeriesColours, report::points_text(line), marks);
  }
  return text;
}

std::string bars_of(const Plot& plot, const report::Axis& value, double step) {
  std::string text;
  const double width = 0.8 * step / static_cast<double>(plot.series.size());
  for (std::size_t s = 0; s < plot.series.size(); ++s) {
    text += fmt::format(R"(<g class="c{}">)", s % report::kSeriesColours);
    for (std::size_t i = 0; i < plot.x.size(); ++i) {
      const Estimate& e = plot.series[s].values.at(i);
      if (e.count == 0) continue;
      const double x =
          kLeft + step * (static_cast<double>(i) + 0.1) + width * static_cast<double>(s);
      const double top = std::min(value(e.mean), value(0.0));
      const double height = std::max(value(e.mean), value(0.0)) - top;
      text += fmt::format(
          R"(<rect class="bar" x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}"><title>{}, {}: {:.4g} +- {:.2g}, {} runs</title></rect>)",
          x, top, 0.9 * width, height, report::escaped(plot.series[s].name),
          report::escaped(plot.x[i]), e.mean, e.half_width, e.count);
      text += error_bar(value, e, x + 0.45 * width);
    }
    text += "</g>";
  }
  return text;
}

}  // namespace

std::string svg(const Plot& plot, bool bars) {
  const report::Axis value = value_axis(plot, bars);
  const double step = (kRight - kLeft) / static_cast<double>(plot.x.size());
  double longest = 0.0;
  for (const std::string& label : plot.x) {
    longest = std::max(longest, kLetter * static_cast<double>(label.size()));
  }
  const bool slanted = longest > step;
  std::string text = frame(plot, value, slanted ? 0.6 * longest : 0.0);
  for (std::size_t i = 0; i < plot.x.size(); ++i) {
    const double x = kLeft + step * (static_cast<double>(i) + 0.5);
    text +=
        slanted
            ? fmt::format(
                  R"svg(<text class="end" transform="translate({:.1f} {:.0f})rotate(-40)">{}</text>)svg",
                  x + 4.0, kBottom + 14.0, report::escaped(plot.x[i]))
            : fmt::format(R"(<text class="mid" x="{:.1f}" y="{:.0f}">{}</text>)", x, kBottom + 18.0,
                          report::escaped(plot.x[i]));
  }
  text += bars ? bars_of(plot, value, step) : lines_of(plot, value, step);
  return text + legend(plot.series) + "</svg>\n";
}

std::string svg(const LinePlot& plot) {
  constexpr double kNothing = std::numeric_limits<double>::infinity();
  Vec2 low{kNothing, kNothing};
  Vec2 high{-kNothing, -kNothing};
  for (const Line& line : plot.lines) {
    for (const Vec2& point : line.points) {
      low = low.cwiseMin(point);
      high = high.cwiseMax(point);
    }
  }
  if (low.x() > high.x()) low = high = Vec2{0.0, 0.0};
  const report::Axis value = value_axis(low.y(), high.y(), false);
  const report::Axis along{low.x(), high.x() > low.x() ? high.x() : low.x() + 1.0, kLeft, kRight};
  std::string text = frame(plot, value, 0.0);
  for (const double x : along.ticks(6)) {
    text += fmt::format(R"(<text class="mid" x="{:.1f}" y="{:.0f}">{:g}</text>)", along(x),
                        kBottom + 18.0, x);
  }
  for (std::size_t s = 0; s < plot.lines.size(); ++s) {
    std::vector<Vec2> line;
    for (const Vec2& point : plot.lines[s].points) {
      line.emplace_back(along(point.x()), value(point.y()));
    }
    text += fmt::format(R"(<polyline class="line c{}" points="{}"><title>{}</title></polyline>)",
                        s % report::kSeriesColours, report::points_text(report::thinned(line, 0.2)),
                        report::escaped(plot.lines[s].name));
  }
  return text + legend(plot.lines) + "</svg>\n";
}

std::string plot_style() {
  return fmt::format("<style>{}{}{}</style>", report::kPalette, report::kSeries, kStyle);
}

}  // namespace skein::experiments
