// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "skein/base/geometry.hpp"
#include "skein/report/drawing.hpp"
#include "skein/report/palette.hpp"
#include "skein/swap/swap.hpp"

namespace skein::swap {
namespace {

constexpr double kSide = 640.0;
constexpr double kHead = 32.0;
constexpr double kMargin = 20.0;

constexpr std::string_view kStyle = R"(
.paper{fill:var(--paper)}text{font:13px system-ui,sans-serif;fill:var(--ink)}
polyline{fill:none;stroke:var(--c);stroke-width:1.3;opacity:.8}.start{fill:var(--paper);stroke:var(--c);stroke-width:1.5}
.end{fill:var(--c)}
)";

}  // namespace

std::string swap_svg(const std::string& title, const SwapRun& run) {
  double reach = 1.0;
  for (const auto& track : run.tracks) {
    for (const Vec3& at : track) reach = std::max(reach, at.head<2>().cwiseAbs().maxCoeff());
  }
  const double scale = (0.5 * kSide - kMargin) / reach;
  const auto pixel = [&](const Vec3& at) {
    return Vec2{0.5 * kSide + scale * at.x(), kHead + 0.5 * kSide - scale * at.y()};
  };
  std::string text = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0:.0f} {1:.0f}" width="{0:.0f}" height="{1:.0f}"><style>{2}{3}{4}</style><rect class="paper" width="{0:.0f}" height="{1:.0f}"/><text x="12" y="22">{5}</text>)",
      kSide, kSide + kHead, report::kPalette, report::kSeries, kStyle, report::escaped(title));
  for (std::size_t i = 0; i < run.tracks.size(); ++i) {
    if (run.tracks[i].empty()) continue;
    std::vector<Vec2> line;
    for (const Vec3& at : run.tracks[i]) line.push_back(pixel(at));
    text += fmt::format(
        R"(<g class="c{}"><polyline points="{}"/><circle class="start" cx="{:.1f}" cy="{:.1f}" r="3.5"/><circle class="end" cx="{:.1f}" cy="{:.1f}" r="2"/></g>)",
        i % report::kSeriesColours, report::points_text(report::thinned(line, 0.3)),
        line.front().x(), line.front().y(), line.back().x(), line.back().y());
  }
  return text + "</svg>\n";
}

}  // namespace skein::swap
