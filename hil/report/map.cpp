// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "charts.hpp"
#include "skein/report/drawing.hpp"

namespace skein::report {
namespace {

constexpr double kWidth = 900.0;
constexpr double kLegendHeight = 58.0;
// Half a pixel: nobody sees the points between.
constexpr double kThinning = 0.35;

/// Metres to pixels, north up.
struct View {
  Vec2 low{1e12, 1e12};
  Vec2 high{-1e12, -1e12};
  double scale = 1.0;

  void include(const Vec2& point, double around_m) {
    low = low.cwiseMin(point - Vec2{around_m, around_m});
    high = high.cwiseMax(point + Vec2{around_m, around_m});
  }
  void fit() {
    const double margin = 0.03 * (high - low).maxCoeff();
    low -= Vec2{margin, margin};
    high += Vec2{margin, margin};
    // A mission along a line still gets a map, not a stripe.
    const double lacking = 0.5 * (high.x() - low.x()) - (high.y() - low.y());
    if (lacking > 0.0) {
      low.y() -= 0.5 * lacking;
      high.y() += 0.5 * lacking;
    }
    scale = kWidth / (high.x() - low.x());
  }
  [[nodiscard]] double height() const { return scale * (high.y() - low.y()); }
  [[nodiscard]] Vec2 operator()(const Vec2& metres) const {
    return {scale * (metres.x() - low.x()), scale * (high.y() - metres.y())};
  }
};

Vec2 position(const recording::TrackPoint& point) { return {point.state.x_m, point.state.y_m}; }

View view_of(const checks::RunRecord& record) {
  View view;
  for (const auto& recorded : record.recordings) {
    for (const auto& point : recorded.track) view.include(position(point), 0.0);
  }
  for (const Site& site : record.sites) view.include(site.position, 300.0);
  for (const auto& known : record.hazards) view.include(known.hazard.centre, known.hazard.radius_m);
  if (view.low.x() > view.high.x()) view.include({0.0, 0.0}, 1000.0);
  view.fit();
  return view;
}

std::string draw_grid(const View& view) {
  std::string svg;
  const double step = round_below((view.high.x() - view.low.x()) / 4.0);
  for (double i = std::ceil(view.low.x() / step); i * step < view.high.x(); i += 1.0) {
    const double px = view({i * step, 0.0}).x();
    svg += fmt::format(R"~(<path class="grid" d="M{0:.1f} 0V{1:.1f}"/>)~", px, view.height());
  }
  for (double i = std::ceil(view.low.y() / step); i * step < view.high.y(); i += 1.0) {
    const double py = view({0.0, i * step}).y();
    svg += fmt::format(R"~(<path class="grid" d="M0 {0:.1f}H{1:.1f}"/>)~", py, kWidth);
  }
  return svg;
}

std::string draw_hazards(const checks::RunRecord& record, const View& view) {
  std::string svg;
  for (const auto& known : record.hazards) {
    const Vec2 c = view(known.hazard.centre);
    svg += fmt::format(
        R"~(<circle class="hazard" cx="{:.1f}" cy="{:.1f}" r="{:.1f}"><title>hazard {}, radius {:.0f} m, known from {:.0f} s</title></circle>)~",
        c.x(), c.y(), view.scale * known.hazard.radius_m, known.hazard.id.value,
        known.hazard.radius_m, to_seconds(known.known_from));
  }
  return svg;
}

/// One line a stretch of time for one site, so that colour follows the coalition.
std::string draw_track(const checks::RunRecord& record, const recording::Recording& recorded,
                       const Story& story, const View& view) {
  std::string work;
  std::string free;
  std::size_t first = 0;
  auto site = site_at(story, recorded.track.front().state.time);
  for (std::size_t i = 1; i <= recorded.track.size(); ++i) {
    const bool last = i == recorded.track.size();
    const auto here = last ? site : site_at(story, recorded.track[i].state.time);
    if (!last && here == site) continue;
    std::vector<Vec2> line;
    std::vector<double> times_s;
    for (std::size_t k = first; k < std::min(i + 1, recorded.track.size()); ++k) {
      line.push_back(view(position(recorded.track[k])));
      times_s.push_back(to_seconds(recorded.track[k].state.time));
    }
    (site ? work : free) += fmt::format(
        R"~(<polyline class="track {}s{}" data-series="{}vehicle {}"{}><title>vehicle {}{}</title></polyline>)~",
        site ? "" : "free ",
        record.places.empty() ? colour_of(record, site) : colour_of(recorded.vehicle),
        site                    ? fmt::format("site {}|", site->value)
        : record.places.empty() ? "searching|"
                                : "",
        recorded.vehicle.value, timed_points(line, times_s, kThinning), recorded.vehicle.value,
        site                    ? fmt::format(", working for site {}", site->value)
        : record.places.empty() ? ", searching"
                                : "");
    first = i;
    site = here;
  }
  return free + work;
}

std::string draw_ends(const recording::Recording& recorded, const View& view) {
  const Vec2 start = view(position(recorded.track.front()));
  const Vec2 end = view(position(recorded.track.back()));
  const double course = -degrees(recorded.track.back().state.course_rad);
  return fmt::format(
      R"~(<g data-series="vehicle {4}"><circle class="start" cx="{0:.1f}" cy="{1:.1f}" r="3.2"/><text class="id" x="{2:.1f}" y="{3:.1f}">{4}</text><path class="end" d="M5 0L-4 3.5V-3.5Z" transform="translate({5:.1f} {6:.1f}) rotate({7:.0f})"><title>vehicle {4}, end</title></path></g>)~",
      start.x(), start.y(), start.x() + 5.0, start.y() - 4.0, recorded.vehicle.value, end.x(),
      end.y(), course);
}

std::string draw_site(const checks::RunRecord& record, const Site& site, const View& view) {
  const Vec2 c = view(site.position);
  std::string svg = fmt::format(R"~(<g class="s{}">)~", colour_of(record, site.id));
  for (const DeliveryRequirement& delivery : site.deliveries) {
    const Vec2 from = Vec2{-std::cos(delivery.bearing_rad), std::sin(delivery.bearing_rad)};
    const Vec2 a = c + 34.0 * from;
    const Vec2 b = c + 14.0 * from;
    svg += fmt::format(
        R"~(<path class="bearing" d="M{:.1f} {:.1f}L{:.1f} {:.1f}"><title>delivery bearing {:.0f} deg (compass)</title></path>)~",
        a.x(), a.y(), b.x(), b.y(), compass_deg_from_heading(delivery.bearing_rad));
    svg += fmt::format(
        R"~(<path class="tip" d="M4 0L-4 3.6V-3.6Z" transform="translate({:.1f} {:.1f}) rotate({:.1f})"/>)~",
        b.x(), b.y(), -degrees(delivery.bearing_rad));
  }
  svg += fmt::format(
      R"~(<circle class="site" cx="{0:.1f}" cy="{1:.1f}" r="5"/><text class="name" x="{0:.1f}" y="{2:.1f}">site {3}</text></g>)~",
      c.x(), c.y(), c.y() - 42.0, site.id.value);
  return svg;
}

std::string draw_legend(const checks::RunRecord& record, const View& view) {
  double x = 16.0;
  const double y = view.height() + 22.0;
  std::string svg;
  const auto entry = [&](const std::string& mark, const std::string& text) {
    svg += fmt::format(
        R"~(<g transform="translate({:.0f} {:.0f})">{}<text x="28" y="4">{}</text></g>)~", x, y,
        mark, text);
    x += 44.0 + 6.6 * static_cast<double>(text.size());
  };
  for (const Site& site : record.sites) {
    entry(fmt::format(R"~(<path class="track s{}" d="M0 0H22"/>)~", colour_of(record, site.id)),
          fmt::format("coalition of site {}", site.id.value));
  }
  if (record.places.empty()) {
    entry(R"~(<path class="track free s0" d="M0 0H22"/>)~", "searching");
  }
  entry(R"~(<circle class="start" cx="14" cy="0" r="3.2"/>)~", "start");
  entry(R"~(<path class="end" d="M5 0L-4 3.5V-3.5Z" transform="translate(14 0)"/>)~", "end");
  if (!record.hazards.empty()) {
    entry(R"~(<circle class="hazard" cx="14" cy="0" r="8"/>)~", "hazard");
  }
  const double metres = round_below(0.2 * (view.high.x() - view.low.x()));
  const double length = view.scale * metres;
  svg += fmt::format(
      R"~(<path class="scale" d="M{0:.1f} {1:.1f}v5h{2:.1f}v-5"/><text x="{3:.1f}" y="{4:.1f}">{5:.0f} m, north up</text>)~",
      16.0, view.height() + 40.0, length, 24.0 + length, view.height() + 47.0, metres);
  return svg;
}

}  // namespace

std::string map(const checks::RunRecord& record, const std::vector<Story>& stories,
                std::string_view attributes, std::string_view style) {
  const View view = view_of(record);
  std::string svg = fmt::format(
      R"~(<svg {} viewBox="0 0 {:.0f} {:.0f}" role="img" aria-label="Map of the flown tracks"{}{}>{})~",
      attributes, kWidth, view.height() + kLegendHeight,
      axis_attribute("east", {view.low.x(), view.high.x(), 0.0, kWidth}, "m"),
      axis_attribute("north", {view.low.y(), view.high.y(), view.height(), 0.0}, "m"), style);
  svg +=
      R"~(<defs><pattern id="hatch" width="7" height="7" patternUnits="userSpaceOnUse" patternTransform="rotate(45)"><path class="hatch" d="M0 0V7"/></pattern></defs>)~";
  svg += fmt::format(R"~(<rect class="ground" width="{:.0f}" height="{:.1f}"/>)~", kWidth,
                     view.height());
  svg += draw_grid(view) + draw_hazards(record, view);
  for (const Story& story : stories) {
    for (const auto& recorded : record.recordings) {
      if (recorded.vehicle == story.vehicle) svg += draw_track(record, recorded, story, view);
    }
  }
  for (const Site& site : record.sites) svg += draw_site(record, site, view);
  for (const auto& recorded : record.recordings) {
    if (!recorded.track.empty()) svg += draw_ends(recorded, view);
  }
  return svg + draw_legend(record, view) + "</svg>\n";
}

}  // namespace skein::report
