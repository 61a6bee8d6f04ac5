// SPDX-License-Identifier: Apache-2.0
#include "skein/report/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "skein/base/assert.hpp"
#include "skein/base/geometry.hpp"
#include "skein/report/drawing.hpp"
#include "skein/report/palette.hpp"

namespace skein::report {
namespace {

constexpr double kSide = 210.0;
constexpr double kHead = 30.0;
constexpr double kFoot = 24.0;
constexpr double kMargin = 20.0;
constexpr double kLargestDot = 9.0;

constexpr std::string_view kShapeStyle = R"(
:root{--c:var(--s1)}
.paper{fill:var(--paper)}.ground{fill:var(--ground)}text{font:12px system-ui,sans-serif;fill:var(--soft)}
.title{font-size:13px;font-weight:600;fill:var(--ink)}.dot{fill:var(--c);stroke:var(--c);stroke-width:1.4}
.ring{fill:var(--ground);stroke:var(--c);stroke-width:1.4}.mid{text-anchor:middle;font-size:9px}
.on{fill:var(--paper);font-weight:650}.bar{stroke:var(--ink);stroke-width:1.3;fill:none}
)";

std::string draw_panel(const ShapePanel& panel, double spacing_m, const Vec2& corner) {
  SKEIN_ASSERT(!panel.places.empty());
  // On paper: right is the track's right, up is ahead.
  Vec2 low{1e18, 1e18};
  Vec2 high{-1e18, -1e18};
  std::vector<Vec2> at;
  for (const Vec3& place : panel.places) {
    at.emplace_back(-place.y(), place.x());
    low = low.cwiseMin(at.back());
    high = high.cwiseMax(at.back());
  }
  const double room = kSide - 2.0 * kMargin;
  const double extent = std::max({(high - low).maxCoeff(), 2.0 * spacing_m});
  const double scale = room / extent;
  const double dot = std::min(kLargestDot, 0.35 * scale * spacing_m);
  const Vec2 middle = 0.5 * (low + high);
  const auto pixel = [&](const Vec2& p) {
    return Vec2{corner.x() + 0.5 * kSide + scale * (p.x() - middle.x()),
                corner.y() + kHead + 0.5 * kSide - scale * (p.y() - middle.y())};
  };
  std::string svg = fmt::format(
      R"(<rect class="ground" x="{:.0f}" y="{:.0f}" width="{:.0f}" height="{:.0f}" rx="6"/><text class="title" x="{:.0f}" y="{:.0f}">{}</text>)",
      corner.x() + 4.0, corner.y() + 4.0, kSide - 8.0, kHead + kSide + kFoot - 8.0,
      corner.x() + 14.0, corner.y() + 22.0, escaped(panel.title));
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Vec2 p = pixel(at[i]);
    const bool full = i < panel.first;
    svg += fmt::format(R"(<circle class="{}" cx="{:.1f}" cy="{:.1f}" r="{:.1f}"/>)",
                       full ? "dot" : "ring", p.x(), p.y(), dot);
    if (dot < 6.0) continue;
    svg += fmt::format(R"(<text class="mid{}" x="{:.1f}" y="{:.1f}">{}</text>)", full ? " on" : "",
                       p.x(), p.y() + 3.2, i + 1);
  }
  const double foot = corner.y() + kHead + kSide + kFoot - 16.0;
  return svg +
         fmt::format(
             R"(<path class="bar" d="M{0:.1f} {1:.1f}v6m0 -3h{2:.1f}m0 -3v6"/><text x="{3:.1f}" y="{4:.1f}">s</text>)",
             corner.x() + 14.0, foot - 3.0, scale * spacing_m,
             corner.x() + 20.0 + scale * spacing_m, foot + 4.0);
}

}  // namespace

std::string shapes_svg(const std::vector<ShapePanel>& panels, double spacing_m,
                       std::size_t columns) {
  SKEIN_ASSERT(columns > 0 && spacing_m > 0.0);
  const std::size_t rows = (panels.size() + columns - 1) / columns;
  const double width = kSide * static_cast<double>(columns);
  const double panel_height = kHead + kSide + kFoot;
  const double height = panel_height * static_cast<double>(rows);
  std::string svg = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0:.0f} {1:.0f}" width="{0:.0f}" height="{1:.0f}"><style>{2}{3}</style><rect class="paper" width="{0:.0f}" height="{1:.0f}"/>)",
      width, height, kPalette, kShapeStyle);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const std::size_t row = i / columns;
    const std::size_t column = i % columns;
    svg.append("\n").append(
        draw_panel(panels[i], spacing_m,
                   {kSide * static_cast<double>(column), panel_height * static_cast<double>(row)}));
  }
  return svg + "</svg>\n";
}

}  // namespace skein::report
