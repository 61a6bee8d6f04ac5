// SPDX-License-Identifier: Apache-2.0
#include "formation_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "skein/base/attitude.hpp"
#include "skein/checks/formation_changes.hpp"
#include "skein/report/drawing.hpp"
#include "story.hpp"

namespace skein::report {
namespace {

using checks::FormationChange;

constexpr double kWidth = 860.0;
constexpr double kHeight = 240.0;
constexpr double kLeft = 50.0;
constexpr double kBottom = kHeight - 26.0;

Vec3 position(const VehicleState& s) { return {s.x_m, s.y_m, s.z_m}; }

/// Those that held; what is between is flown.
std::vector<FormationChange> held_of(const checks::RunRecord& record) {
  auto changes = checks::formation_changes(record);
  std::erase_if(changes, [](const FormationChange& change) { return !change.held; });
  return changes;
}

struct TimeSpan {
  double begin_s = 0.0;
  double end_s = 1.0;
};

TimeSpan span_of(const checks::RunRecord& record) {
  TimeSpan span{1e12, 0.0};
  for (const auto& r : record.recordings) {
    if (r.track.empty()) continue;
    span.begin_s = std::min(span.begin_s, to_seconds(r.track.front().state.time));
    span.end_s = std::max(span.end_s, to_seconds(r.track.back().state.time));
  }
  return span;
}

/// The frame of a chart over time: bands where formations held, grid, the limit's line.
std::string frame(std::string_view label, const Axis& time, const Axis& value, double limit,
                  const std::vector<FormationChange>& held) {
  std::string svg = fmt::format(
      R"~(<svg viewBox="0 0 {:.0f} {:.0f}" role="img" aria-label="{}"{}{}>)~", kWidth, kHeight,
      label, axis_attribute("time", time, "s"), axis_attribute("value", value, "m"));
  for (const FormationChange& h : held) {
    const double from = time(to_seconds(*h.held));
    const double until = std::min(time(time.to), time(to_seconds(h.until)));
    svg += fmt::format(
        R"~(<rect class="allowed" x="{:.1f}" y="10" width="{:.1f}" height="{:.1f}"><title>{} holds</title></rect>)~",
        from, std::max(0.0, until - from), kBottom - 10.0, escaped(h.order));
  }
  for (const double t : time.ticks(10)) {
    svg += fmt::format(
        R"~(<path class="grid" d="M{0:.1f} 10V{1:.1f}"/><text class="tick mid" x="{0:.1f}" y="{2:.1f}">{3:g} s</text>)~",
        time(t), kBottom, kBottom + 15.0, t);
  }
  for (const double v : value.ticks(5)) {
    svg += fmt::format(
        R"~(<path class="grid" d="M{0:.0f} {1:.1f}H{2:.0f}"/><text class="tick end" x="{3:.0f}" y="{4:.1f}">{5:g} m</text>)~",
        kLeft, value(v), kWidth - 10.0, kLeft - 6.0, value(v) + 4.0, v);
  }
  svg += fmt::format(
      R"~(<path class="curve" style="--c:var(--bad);stroke-dasharray:6 4" d="M{0:.0f} {1:.1f}H{2:.0f}"><title>limit {3:g} m</title></path>)~",
      kLeft, value(limit), kWidth - 10.0, limit);
  return svg;
}

std::string line(const std::vector<Vec2>& points, const Axis& time, const Axis& value,
                 std::size_t colour, const std::string& title) {
  std::vector<Vec2> pixels;
  pixels.reserve(points.size());
  for (const Vec2& p : points) pixels.emplace_back(time(p.x()), value(std::min(p.y(), value.to)));
  return fmt::format(
      R"~(<polyline class="curve s{0}" data-series="{2}" points="{1}"><title>{2}</title></polyline>)~",
      colour, points_text(thinned(pixels, 0.3)), escaped(title));
}

}  // namespace

std::string separation_chart(const checks::RunRecord& record, const checks::Limits& limits) {
  // On a grid of the first track's times: all are recorded at the same rate.
  std::map<std::int64_t, std::vector<Vec3>> at;
  constexpr std::int64_t kGrid_ns = 100'000'000;
  for (const auto& r : record.recordings) {
    std::int64_t last = std::numeric_limits<std::int64_t>::min();
    for (const auto& point : r.track) {
      const std::int64_t slot = point.state.time.time_since_epoch().count() / kGrid_ns;
      if (slot == last) continue;
      last = slot;
      at[slot].push_back(position(point.state));
    }
  }
  std::vector<Vec2> least;
  for (const auto& [slot, positions] : at) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < positions.size(); ++i) {
      for (std::size_t j = i + 1; j < positions.size(); ++j)
        nearest = std::min(nearest, (positions[i] - positions[j]).norm());
    }
    if (std::isfinite(nearest)) least.emplace_back(static_cast<double>(slot) * 0.1, nearest);
  }
  if (least.empty()) return "";
  double most = 2.0 * limits.separation_horizontal_m;
  for (const Vec2& p : least) most = std::max(most, p.y());
  const TimeSpan span = span_of(record);
  const Axis time{span.begin_s, span.end_s, kLeft, kWidth - 10.0};
  const Axis value{0.0, 1.05 * most, kBottom, 10.0};
  return frame("Least distance of any two vehicles over time", time, value,
               limits.separation_horizontal_m, held_of(record)) +
         line(least, time, value, 1, "the two nearest vehicles") + "</svg>";
}

std::string place_chart(const checks::RunRecord& record, const checks::Limits& limits) {
  const std::vector<FormationChange> held = held_of(record);
  if (held.empty()) return "";
  const TimeSpan span = span_of(record);
  const Axis time{span.begin_s, span.end_s, kLeft, kWidth - 10.0};
  const Axis value{0.0, 2.0 * limits.place_rms_m, kBottom, 10.0};
  std::string svg =
      frame("Distance of each vehicle from its place", time, value, limits.place_rms_m, held);
  for (const FormationChange& h : held) {
    for (const auto& [vehicle, place] : h.places) {
      const auto* recorded = recording_of(record, vehicle);
      if (recorded == nullptr) continue;
      std::vector<Vec2> errors;
      for (const auto& point : recorded->track) {
        if (point.state.time < *h.held || point.state.time >= h.until) continue;
        errors.emplace_back(to_seconds(point.state.time), (position(point.state) - place).norm());
      }
      svg +=
          line(errors, time, value, colour_of(vehicle), fmt::format("vehicle {}", vehicle.value));
    }
  }
  return svg + "</svg>";
}

std::vector<std::pair<std::string, std::string>> formation_pictures(
    const checks::RunRecord& record) {
  constexpr double kSide = 260.0;
  constexpr double kMargin = 26.0;
  std::vector<std::pair<std::string, std::string>> pictures;
  for (const FormationChange& h : held_of(record)) {
    if (h.places.empty()) continue;
    Vec2 low{1e12, 1e12};
    Vec2 high{-1e12, -1e12};
    for (const auto& [vehicle, place] : h.places) {
      low = low.cwiseMin(Vec2{place.x(), place.y()});
      high = high.cwiseMax(Vec2{place.x(), place.y()});
    }
    const Vec2 middle = 0.5 * (low + high);
    const double half = std::max(2.0, 0.5 * (high - low).maxCoeff()) + 1.0;
    const Axis east{middle.x() - half, middle.x() + half, kMargin, kSide - kMargin};
    const Axis north{middle.y() - half, middle.y() + half, kSide - kMargin, kMargin};
    std::string svg = fmt::format(
        R"~(<svg viewBox="0 0 {0:.0f} {0:.0f}" role="img" aria-label="{1} from above"{2}{3}><rect class="ground" width="{0:.0f}" height="{0:.0f}"/>)~",
        kSide, escaped(h.order), axis_attribute("east", east, "m"),
        axis_attribute("north", north, "m"));
    for (const auto& [vehicle, place] : h.places) {
      const std::size_t colour = colour_of(vehicle);
      std::vector<Vec2> pixels;
      std::vector<double> times_s;
      if (const auto* recorded = recording_of(record, vehicle)) {
        for (const auto& point : recorded->track) {
          if (point.state.time < *h.held || point.state.time >= h.until) continue;
          pixels.emplace_back(east(point.state.x_m), north(point.state.y_m));
          times_s.push_back(to_seconds(point.state.time));
        }
      }
      svg += fmt::format(
          R"~(<g data-series="vehicle {4}"><circle class="pass s{0}" cx="{1:.1f}" cy="{2:.1f}" r="9"/><text class="id mid" x="{1:.1f}" y="{3:.1f}">{4}</text></g>)~",
          colour, east(place.x()), north(place.y()), north(place.y()) - 13.0, vehicle.value);
      svg += fmt::format(R"~(<polyline class="curve s{}" data-series="vehicle {}"{}/>)~", colour,
                         vehicle.value, timed_points(pixels, times_s, 0.1));
    }
    pictures.emplace_back(fmt::format("{}, from {:.1f} s", h.order, to_seconds(*h.held)),
                          svg + "</svg>");
  }
  return pictures;
}

}  // namespace skein::report
