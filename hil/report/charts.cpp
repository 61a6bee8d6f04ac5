// SPDX-License-Identifier: Apache-2.0
#include "charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "skein/checks/flown.hpp"
#include "skein/report/drawing.hpp"

namespace skein::report {
namespace {

constexpr std::array<std::string_view, 7> kDoingNames{
    "searching", "leading, monitoring", "bidding",  "flying to a task",
    "surveying", "delivering",          "assessing"};
static_assert(kDoingNames.size() == static_cast<std::size_t>(Doing::count));

std::string open_svg(double width, double height, std::string_view label,
                     std::string_view attributes = "") {
  return fmt::format(R"~(<svg viewBox="0 0 {:.0f} {:.0f}" role="img" aria-label="{}"{}>)~", width,
                     height, label, attributes);
}

/// Vertical grid lines with times under them.
std::string time_axis(const Axis& time, double top, double bottom, int ticks) {
  std::string svg;
  for (const double t : time.ticks(ticks)) {
    svg += fmt::format(
        R"~(<path class="grid" d="M{0:.1f} {1:.1f}V{2:.1f}"/><text class="tick mid" x="{0:.1f}" y="{3:.1f}">{4:g} s</text>)~",
        time(t), top, bottom, bottom + 15.0, t);
  }
  return svg;
}

/// What was flown at a site, by vehicle.
struct Curve {
  VehicleId vehicle;
  bool delivers = false;
  Instant from{};
  Instant until{};
};

std::vector<Curve> members_of(const std::vector<Story>& stories, SiteId site) {
  std::vector<Curve> curves;
  for (const Story& story : stories) {
    Curve curve{story.vehicle, false, Instant::max(), Instant::min()};
    for (const Span& span : story.spans) {
      if (span.site != site || span.doing == Doing::bidding || span.doing == Doing::surveying ||
          span.doing == Doing::leading) {
        continue;
      }
      curve.delivers = curve.delivers || span.doing == Doing::delivering;
      curve.from = std::min(curve.from, span.from);
      curve.until = std::max(curve.until, span.until);
    }
    if (curve.from < curve.until) curves.push_back(curve);
  }
  return curves;
}

/// Time and distance from the site, in seconds and metres.
std::vector<Vec2> distances(const checks::RunRecord& record, const Curve& curve, const Site& site) {
  std::vector<Vec2> line;
  for (const auto& point : recording_of(record, curve.vehicle)->track) {
    const VehicleState& s = point.state;
    if (s.time < curve.from || s.time > curve.until) continue;
    line.emplace_back(to_seconds(s.time), (Vec2{s.x_m, s.y_m} - site.position).norm());
  }
  return line;
}

/// Heights of labels moved apart so that none lies on another.
std::vector<double> spread(std::vector<double> wanted, double apart, double lowest) {
  std::vector<std::size_t> order(wanted.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return wanted[a] > wanted[b]; });
  double limit = lowest;
  for (const std::size_t i : order) {
    wanted[i] = std::min(wanted[i], limit);
    limit = wanted[i] - apart;
  }
  return wanted;
}

}  // namespace

std::string distance_curves(const checks::RunRecord& record, const checks::Limits& limits,
                            const std::vector<Story>& stories, const Site& site) {
  constexpr double kWidth = 430.0;
  constexpr double kHeight = 300.0;
  const std::vector<Curve> curves = members_of(stories, site.id);
  if (curves.empty()) return "";
  std::vector<std::vector<Vec2>> lines;
  double begin = 1e12;
  double end = 0.0;
  double far = 100.0;
  for (const Curve& curve : curves) {
    lines.push_back(distances(record, curve, site));
    for (const Vec2& p : lines.back()) far = std::max(far, p.y());
    begin = std::min(begin, to_seconds(curve.from));
    end = std::max(end, to_seconds(curve.until));
  }
  const Axis time{begin, end, 76.0, kWidth - 10.0};
  const Axis distance{0.0, 1.03 * far, kHeight - 26.0, 10.0};
  const std::size_t colour = colour_of(record, site.id);

  std::string svg =
      open_svg(kWidth, kHeight, "Distance from the site over time",
               axis_attribute("time", time, "s") + axis_attribute("value", distance, "m"));
  svg += time_axis(time, 10.0, kHeight - 26.0, 5);
  for (const double d : distance.ticks(5)) {
    svg += fmt::format(
        R"~(<path class="grid" d="M76 {0:.1f}H{1:.0f}"/><text class="tick end" x="40" y="{2:.1f}">{3:g}{4}</text>)~",
        distance(d), kWidth - 10.0, distance(d) + 4.0, d, d > 0.0 ? " m" : "");
  }
  std::vector<double> label_heights;
  label_heights.reserve(lines.size());
  for (const auto& line : lines)
    label_heights.push_back(distance(line.empty() ? 0.0 : line.front().y()));
  label_heights = spread(label_heights, 10.0, kHeight - 26.0);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    std::vector<Vec2> pixels;
    for (const Vec2& p : lines[i]) pixels.emplace_back(time(p.x()), distance(p.y()));
    svg += fmt::format(
        R"~(<polyline class="curve s{}{}" data-series="vehicle {}" points="{}"><title>vehicle {}, {}</title></polyline>)~",
        colour, curves[i].delivers ? "" : " assessor", curves[i].vehicle.value,
        points_text(thinned(pixels, 0.3)), curves[i].vehicle.value,
        curves[i].delivers ? "delivers" : "assesses");
    if (pixels.empty()) continue;
    svg += fmt::format(
        R"~(<text class="id end" data-series="vehicle {0}" x="{1:.1f}" y="{2:.1f}">{0}</text>)~",
        curves[i].vehicle.value, pixels.front().x() - 4.0, label_heights[i] + 3.0);
  }
  for (const auto& d : checks::deliveries_flown(record, limits)) {
    if (d.run.task.site != site.id || !d.seen) continue;
    svg += fmt::format(
        R"~(<circle class="pass s{0}" data-series="vehicle {3}" cx="{1:.1f}" cy="{2:.1f}" r="4"><title>vehicle {3} passes at {4:.2f} s, planned {5:.2f} s</title></circle>)~",
        colour, time(to_seconds(d.time)), distance(d.miss_m), d.run.vehicle.value,
        to_seconds(d.time), to_seconds(*d.run.planned));
  }
  return svg + "</svg>\n";
}

std::string time_line(const checks::RunRecord& record, const std::vector<Story>& stories) {
  constexpr double kWidth = 1240.0;
  constexpr double kRow = 17.0;
  constexpr double kTop = 30.0;
  double end = 1.0;
  for (const Story& story : stories) end = std::max(end, to_seconds(story.spans.front().until));
  const double bottom = kTop + kRow * static_cast<double>(stories.size());
  const Axis time{0.0, end, 34.0, kWidth - 12.0};

  std::string svg = open_svg(kWidth, bottom + 22.0, "What every vehicle did over time");
  double x = 34.0;
  for (std::size_t i = 0; i < kDoingNames.size(); ++i) {
    svg += fmt::format(
        R"~(<rect class="d{0}" x="{1:.0f}" y="4" width="14" height="12" rx="2"/><text x="{2:.0f}" y="14">{3}</text>)~",
        i, x, x + 19.0, kDoingNames[i]);
    x += 44.0 + 6.6 * static_cast<double>(kDoingNames[i].size());
  }
  svg += time_axis(time, kTop, bottom, 14);
  for (std::size_t row = 0; row < stories.size(); ++row) {
    const Story& story = stories[row];
    const double y = kTop + kRow * static_cast<double>(row);
    svg += fmt::format(R"~(<text class="id end" x="28" y="{:.1f}">{}</text>)~", y + 12.0,
                       story.vehicle.value);
    for (const Span& span : story.spans) {
      const double left = time(to_seconds(span.from));
      const double right = std::max(time(to_seconds(span.until)), left + 1.0);
      const std::string site = span.site ? fmt::format(", site {}", span.site->value) : "";
      svg += fmt::format(
          R"~(<rect class="d{0}" data-series="{6}|vehicle {5}" x="{1:.1f}" y="{2:.1f}" width="{3:.1f}" height="{4:.0f}"><title>vehicle {5}: {6}{7}, {8:.1f} s to {9:.1f} s</title></rect>)~",
          static_cast<int>(span.doing), left, y + 2.0, right - left, kRow - 4.0,
          story.vehicle.value, kDoingNames[static_cast<std::size_t>(span.doing)], site,
          to_seconds(span.from), to_seconds(span.until));
      if (span.doing == Doing::flying && span.site) {
        // The number of the site in the colour of its coalition, where the span begins.
        svg += fmt::format(
            R"~(<g data-series="{7}|vehicle {8}"><rect class="f{0}" x="{1:.1f}" y="{2:.1f}" width="13" height="{3:.0f}"/><text class="badge" x="{4:.1f}" y="{5:.1f}">{6}</text></g>)~",
            colour_of(record, span.site), left, y + 2.0, kRow - 4.0, left + 6.5, y + 12.0,
            span.site->value, kDoingNames[static_cast<std::size_t>(span.doing)],
            story.vehicle.value);
      }
    }
  }
  return svg + "</svg>\n";
}

namespace {

struct Mark {
  std::size_t colour = 0;
  bool arc = false;
  double value = 0.0;
  std::string title;
  SiteId site;
};

/// One kind of error, a mark a task, with the band that is allowed.
std::string error_strip(const std::vector<Mark>& marks, double limit, bool has_sign,
                        std::string_view unit, std::string_view name, double top) {
  constexpr double kWidth = 1240.0;
  constexpr double kHeight = 96.0;
  double most = limit;
  for (const Mark& mark : marks) most = std::max(most, std::abs(mark.value));
  const Axis value{has_sign ? -1.2 * most : 0.0, 1.2 * most, top + kHeight, top + 20.0};
  std::string svg = fmt::format(
      R"~(<text class="label" x="0" y="{:.0f}">{}</text><rect class="allowed" x="64" y="{:.1f}" width="{:.0f}" height="{:.1f}"/><path class="axis" d="M64 {:.1f}H{:.0f}"/>)~",
      top + 12.0, name, value(limit), kWidth - 76.0, value(has_sign ? -limit : 0.0) - value(limit),
      value(0.0), kWidth - 12.0);
  for (const double v : {has_sign ? -limit : limit, 0.0, limit}) {
    svg += fmt::format(R"~(<text class="tick end" x="58" y="{:.1f}">{:g} {}</text>)~",
                       value(v) + 4.0, v, unit);
  }
  const double step =
      (kWidth - 100.0) / static_cast<double>(std::max<std::size_t>(marks.size(), 1));
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const double x = 76.0 + step * (static_cast<double>(i) + 0.5);
    const double y = value(marks[i].value);
    svg += fmt::format(
        R"~(<g data-series="site {}"><path class="stem s{}" d="M{:.1f} {:.1f}V{:.1f}"/>)~",
        marks[i].site.value, marks[i].colour, x, value(0.0), y);
    svg += marks[i].arc
               ? fmt::format(R"~(<rect class="f{}" x="{:.1f}" y="{:.1f}" width="7" height="7">)~",
                             marks[i].colour, x - 3.5, y - 3.5)
               : fmt::format(R"~(<circle class="f{}" cx="{:.1f}" cy="{:.1f}" r="4">)~",
                             marks[i].colour, x, y);
    svg +=
        fmt::format("<title>{}</title></{}></g>", marks[i].title, marks[i].arc ? "rect" : "circle");
  }
  return svg;
}

}  // namespace

std::string errors(const checks::RunRecord& record, const checks::Limits& limits) {
  std::vector<Mark> times;
  std::vector<Mark> misses;
  std::vector<Mark> bearings;
  for (const auto& d : checks::deliveries_flown(record, limits)) {
    if (!d.seen) continue;
    const std::size_t colour = colour_of(record, d.run.task.site);
    const std::string who =
        fmt::format("{} by vehicle {}", to_string(d.run.task), d.run.vehicle.value);
    times.push_back({colour, false, d.time_error_s(),
                     fmt::format("{}: planned {:.2f} s, flown {:.2f} s", who,
                                 to_seconds(*d.run.planned), to_seconds(d.time)),
                     d.run.task.site});
    misses.push_back(
        {colour, false, d.miss_m, fmt::format("{}: {:.1f} m", who, d.miss_m), d.run.task.site});
    const double off = degrees(d.bearing_error_rad);
    bearings.push_back(
        {colour, false, off, fmt::format("{}: {:+.1f} deg", who, off), d.run.task.site});
  }
  for (const auto& arc : checks::arcs_flown(record, TaskKind::assess, limits)) {
    if (!arc.start || !arc.run.planned) continue;
    times.push_back(
        {colour_of(record, arc.run.task.site), true, arc.time_error_s(),
         fmt::format("{} by vehicle {}: planned {:.2f} s, began {:.2f} s", to_string(arc.run.task),
                     arc.run.vehicle.value, to_seconds(*arc.run.planned), to_seconds(*arc.start)),
         arc.run.task.site});
  }
  if (times.empty()) return "";
  std::string svg = open_svg(1240.0, 344.0, "Flown against planned");
  svg += error_strip(times, limits.arrival_s, true, "s",
                     "time: flown less planned (circle: delivery, square: start of an assessment)",
                     0.0);
  if (!misses.empty()) {
    svg +=
        error_strip(misses, limits.miss_m, false, "m", "deliveries: distance from the site", 116.0);
    svg += error_strip(bearings, degrees(limits.bearing_rad), true, "deg",
                       "deliveries: bearing, flown less required", 232.0);
  }
  return svg + "</svg>\n";
}

}  // namespace skein::report
