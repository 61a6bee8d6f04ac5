// SPDX-License-Identifier: Apache-2.0
#include "world_picture.hpp"

#include <fmt/format.h>

#include <string_view>

#include "skein/experiments/plots.hpp"
#include "skein/report/drawing.hpp"
#include "skein/report/palette.hpp"

namespace skein::route_figures {
namespace {

constexpr double kSide = 560.0;
constexpr double kHead = 34.0;
constexpr double kMargin = 14.0;
constexpr double kLegend = 190.0;

constexpr std::string_view kStyle = R"(<style>
.world{fill:none;stroke:var(--rule)}.grey{fill:#7a838d;stroke:#7a838d}.amber{fill:#d09a20;stroke:#d09a20}
.grey circle,.amber circle{fill-opacity:.22;stroke-opacity:.6}.site{stroke:var(--ink);stroke-width:2;fill:none}
</style>)";

}  // namespace

std::string world_svg(const std::string& title, double side_m,
                      const std::vector<routes::RouteHazard>& hazards,
                      const std::vector<Curve>& curves, const Vec2& site) {
  Vec2 low{0.0, 0.0};
  Vec2 high{side_m, side_m};
  for (const Curve& curve : curves) {  // routes may leave the world
    for (const Vec2& at : curve.points) {
      low = low.cwiseMin(at);
      high = high.cwiseMax(at);
    }
  }
  const double scale = kSide / (high.x() - low.x());
  const double bottom = kHead + scale * (high.y() - low.y());
  const auto pixel = [&](const Vec2& at) {
    return Vec2{kMargin + scale * (at.x() - low.x()), bottom - scale * (at.y() - low.y())};
  };
  const Vec2 corner = pixel({0.0, side_m});
  const double width = kSide + 2.0 * kMargin + kLegend;
  const double height = bottom + kMargin;
  std::string text = fmt::format(
      R"svg(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0:.0f} {1:.0f}" width="{0:.0f}" height="{1:.0f}">{2}{3}<rect class="paper" width="{0:.0f}" height="{1:.0f}"/><text class="title" x="12" y="20">{4}</text><clipPath id="world"><rect x="{5:.1f}" y="{6:.1f}" width="{7:.1f}" height="{7:.1f}"/></clipPath><rect class="world" x="{5:.1f}" y="{6:.1f}" width="{7:.1f}" height="{7:.1f}"/><g clip-path="url(#world)">)svg",
      width, height, experiments::plot_style(), kStyle, report::escaped(title), corner.x(),
      corner.y(), scale * side_m);
  for (const routes::RouteHazard& hazard : hazards) {
    const Vec2 at = pixel(hazard.centre);
    text += fmt::format(R"(<g class="{}"><title>{} {}</title>)",
                        hazard.kind == routes::HazardKind::keep_out ? "grey" : "amber",
                        routes::to_string(hazard.kind), hazard.id.value);
    for (const double radius : {hazard.radius_m, hazard.inner_radius_m}) {
      if (radius <= 0.0) continue;
      text += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="{:.1f}"/>)", at.x(), at.y(),
                          scale * radius);
    }
    text += "</g>";
  }
  text += "</g>";
  for (std::size_t i = 0; i < curves.size(); ++i) {
    std::vector<Vec2> line;
    for (const Vec2& at : curves[i].points) line.push_back(pixel(at));
    text +=
        fmt::format(R"(<g class="c{}"><polyline class="line" points="{}"/>)",
                    i % report::kSeriesColours, report::points_text(report::thinned(line, 0.1)));
    if (!line.empty()) {
      text += fmt::format(R"(<circle class="dot" cx="{:.1f}" cy="{:.1f}" r="4.5"/>)",
                          line.front().x(), line.front().y());
    }
    for (const Vec2& mark : curves[i].marks) {
      text += fmt::format(R"(<circle class="dot" cx="{:.1f}" cy="{:.1f}" r="2.2"/>)",
                          pixel(mark).x(), pixel(mark).y());
    }
    const double y = kHead + 14.0 + 20.0 * static_cast<double>(i);
    text += fmt::format(
        R"(<rect class="bar" x="{:.0f}" y="{:.1f}" width="12" height="12" rx="2"/></g><text x="{:.0f}" y="{:.1f}">{}</text>)",
        kSide + 2.0 * kMargin, y - 10.0, kSide + 2.0 * kMargin + 18.0, y,
        report::escaped(curves[i].name));
  }
  const Vec2 at = pixel(site);
  return text + fmt::format(R"(<path class="site" d="M{:.1f} {:.1f}m-7 0h14m-7 -7v14"/></svg>)"
                            "\n",
                            at.x(), at.y());
}

}  // namespace skein::route_figures
