// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "commands.hpp"
#include "skein/planning/dubins.hpp"
#include "skein/report/drawing.hpp"
#include "skein/report/palette.hpp"
#include "skein/tours/tour.hpp"

namespace skein::hil {
namespace {

using planning::Tour;
using planning::TourProblem;
using planning::TourStop;

/// "x y radius" a line, in metres; what follows a # is a comment.
Result<std::vector<TourStop>> read_stops(const std::filesystem::path& file) {
  std::ifstream in{file};
  if (!in) return Error{file.string() + ": cannot be read"};
  std::vector<TourStop> stops;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    line.resize(std::min(line.size(), line.find('#')));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    std::istringstream words{line};
    TourStop stop;
    std::string more;
    if (!(words >> stop.centre.x() >> stop.centre.y() >> stop.radius_m) || words >> more) {
      return Error{fmt::format("{}:{}: a stop is three numbers: x, y and radius in metres",
                               file.string(), number)};
    }
    stops.push_back(stop);
  }
  return stops;
}

std::string svg_of(const TourProblem& problem, const Tour& tour) {
  constexpr double kWidth = 800.0;
  constexpr double kMargin = 20.0;
  constexpr double kStepOfRadius = 0.1;
  std::vector<Vec2> line;
  for (std::size_t i = 0; i < tour.visits.size(); ++i) {
    const Pose2& to = tour.visits[(i + 1) % tour.visits.size()].at;
    const Path way =
        planning::shortest_dubins(tour.visits[i].at, to, problem.turn_radius_m).to_path();
    const double step_m = kStepOfRadius * problem.turn_radius_m;
    const auto steps = static_cast<int>(std::ceil(way.length_m() / step_m));
    for (int k = 0; k < steps; ++k) line.push_back(way.pose_at(k * step_m).position());
    line.push_back(way.end().position());
  }
  Vec2 low = line.front();
  Vec2 high = line.front();
  for (const Vec2& at : line) {
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  for (const TourStop& stop : problem.stops) {
    low = low.cwiseMin(stop.centre - Vec2::Constant(stop.radius_m));
    high = high.cwiseMax(stop.centre + Vec2::Constant(stop.radius_m));
  }
  const double scale = (kWidth - 2.0 * kMargin) / std::max((high - low).x(), 1e-9);
  const double height = scale * (high - low).y() + 2.0 * kMargin;
  const auto place = [&](const Vec2& at) {
    return Vec2{kMargin + scale * (at.x() - low.x()),
                height - kMargin - scale * (at.y() - low.y())};
  };
  std::string svg = fmt::format(
      R"~(<svg xmlns="http://www.w3.org/2000/svg" width="{0:.0f}" height="{1:.0f}" viewBox="0 0 {0:.0f} {1:.0f}"><style>{2} svg{{background:var(--paper)}} circle{{fill:var(--d0);stroke:var(--rule)}} polyline{{fill:none;stroke:var(--s1);stroke-width:2}} text{{fill:var(--soft);font:11px sans-serif}}</style>)~",
      kWidth, height, report::kPalette);
  for (std::size_t i = 0; i < problem.stops.size(); ++i) {
    const Vec2 c = place(problem.stops[i].centre);
    svg += fmt::format(
        R"~(<circle cx="{:.1f}" cy="{:.1f}" r="{:.1f}"/><text x="{:.1f}" y="{:.1f}">{}</text>)~",
        c.x(), c.y(), scale * problem.stops[i].radius_m, c.x() + 3.0, c.y() - 3.0, i + 1);
  }
  for (Vec2& at : line) at = place(at);
  return svg + fmt::format("<polyline points=\"{}\"/></svg>\n", report::points_text(line));
}

std::string order_text(const Tour& tour) {
  std::string text;
  for (const auto& visit : tour.visits) {
    text += fmt::format("{}{}", text.empty() ? "" : " ", visit.stop + 1);
  }
  return text;
}

}  // namespace

int tours(const ToursArguments& arguments) {
  fmt::print("file,stops,length_m,seconds,order\n");
  for (const std::filesystem::path& file : arguments.files) {
    const auto stops = read_stops(file);
    if (!stops) return complain(stops.error().message);
    const TourProblem problem{*stops, arguments.radius_m, {}};
    Random random{arguments.seed};
    const auto begun = std::chrono::steady_clock::now();
    const auto tour = planning::plan_tour(problem, random, {arguments.steps, {}});
    if (!tour) return complain(file.string() + ": " + tour.error().message);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
    fmt::print("{},{},{:.5f},{:.2f},{}\n", file.filename().string(), stops->size(), tour->length_m,
               took.count(), order_text(*tour));
    if (arguments.plots.empty()) continue;
    const auto picture = arguments.plots / (file.stem().string() + ".svg");
    if (!(std::ofstream{picture} << svg_of(problem, *tour)).flush().good()) {
      return complain(picture.string() + ": cannot be written; --plots names a folder");
    }
  }
  return kExitHeld;
}

}  // namespace skein::hil
