// SPDX-License-Identifier: Apache-2.0
// Fig. 16 and 17, and larger teams: several vehicles over one site at one time.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include "parts.hpp"
#include "skein/experiments/plots.hpp"
#include "skein/paper_routes/paper_world.hpp"
#include "skein/routes/cooperative.hpp"
#include "skein/routes/fly_by.hpp"
#include "skein/routes/route_check.hpp"
#include "world_picture.hpp"

namespace skein::route_figures {
namespace {

using routes::CooperativePlan;
using routes::RouteProblem;
using routes::ScaleRun;

constexpr double kWorldSide_m = 1000.0;
constexpr double kPaperLength_m = 1755.7;
constexpr std::array<std::size_t, 3> kSizes{5, 10, 20};
constexpr std::size_t kHazards = 30;
/// Of a world with that many hazards, as random_team() has it.
double scale_side_m() { return kWorldSide_m * std::sqrt(static_cast<double>(kHazards) / 10.0); }

/// Positions of one vehicle every `kStep_s`, until it arrives.
constexpr double kStep_s = 0.5;
std::vector<Vec2> track_of(const routes::RouteVehicle& vehicle, const routes::PlannedRoute& route) {
  std::vector<Vec2> track;
  const auto path = routes::fly_by_path(route.waypoints, vehicle.turn_radius_m);
  if (!path) return track;  // the checker says why
  for (std::size_t k = 0;; ++k) {
    const double flown_m = vehicle.speed_mps * kStep_s * static_cast<double>(k);
    track.push_back(path->pose_at(flown_m).position());
    if (flown_m >= path->length_m()) return track;
  }
}

std::vector<std::vector<Vec2>> tracks_of(const RouteProblem& problem, const CooperativePlan& plan) {
  std::vector<std::vector<Vec2>> tracks;
  for (std::size_t i = 0; i < plan.routes.size(); ++i) {
    tracks.push_back(track_of(problem.vehicles[i], plan.routes[i]));
  }
  return tracks;
}

/// Fig. 17: distances of each pair while both fly.
std::string distances_svg(const RouteProblem& problem,
                          const std::vector<std::vector<Vec2>>& tracks) {
  experiments::LinePlot plot{
      "Distances between the vehicles, until both have arrived", "time, s", "distance, m", {}};
  double end_s = 0.0;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    for (std::size_t k = i + 1; k < tracks.size(); ++k) {
      experiments::Line line{fmt::format("vehicles {} and {}", problem.vehicles[i].id.value,
                                         problem.vehicles[k].id.value),
                             {}};
      for (std::size_t t = 0; t < std::min(tracks[i].size(), tracks[k].size()); ++t) {
        end_s = std::max(end_s, kStep_s * static_cast<double>(t));
        line.points.emplace_back(kStep_s * static_cast<double>(t),
                                 (tracks[i][t] - tracks[k][t]).norm());
      }
      plot.lines.push_back(std::move(line));
    }
  }
  const double asked = problem.rules.separation_m;
  plot.lines.push_back({"asked for", {{0.0, asked}, {end_s, asked}}});
  return experiments::svg(plot);
}

std::vector<Curve> curves_of(const CooperativePlan& plan,
                             const std::vector<std::vector<Vec2>>& tracks, bool with_lengths) {
  std::vector<Curve> curves;
  for (std::size_t i = 0; i < plan.routes.size(); ++i) {
    const routes::PlannedRoute& route = plan.routes[i];
    curves.push_back({with_lengths
                          ? fmt::format("vehicle {}: {:.1f} m", route.id.value, route.length_m)
                          : fmt::format("vehicle {}", route.id.value),
                      tracks[i],
                      {route.waypoints.begin() + 1, route.waypoints.end() - 1}});
  }
  return curves;
}

struct TimedScaleRun {
  ScaleRun run{};
  std::size_t size = 0;  ///< which of kSizes
  std::uint64_t seed = 0;
  double seconds = 0.0;      ///< of a processor, for the planning; in tables for people only
  bool slow_solves = false;  ///< what the planner did not, its slow search did
};

double processor_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The value that a share of them does not exceed; they are in order.
double quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return 0.0;
  const auto n = static_cast<double>(sorted.size());
  const auto rank = static_cast<std::size_t>(std::ceil(share * n));
  return sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1];
}

TimedScaleRun run_team(std::size_t size, std::uint64_t seed) {
  TimedScaleRun timed;
  timed.size = size;
  timed.seed = seed;
  const double start_s = processor_seconds();
  timed.run = routes::run_scale(kSizes.at(size), kHazards, false, seed);
  timed.seconds = processor_seconds() - start_s;
  if (!timed.run.checked) {
    timed.slow_solves = routes::run_scale(kSizes.at(size), kHazards, true, seed).checked;
  }
  return timed;
}

/// A team that can be planned, drawn.
std::string team_svg(std::size_t vehicles, std::uint64_t seed) {
  const RouteProblem problem = routes::random_team(vehicles, kHazards, Random{seed});
  const auto plan = routes::plan_routes(problem, {}, Random{seed});
  SKEIN_ASSERT(plan.ok());
  return world_svg(fmt::format("{} vehicles among {} hazards, together after {:.1f} s", vehicles,
                               kHazards, plan->arrival_s),
                   scale_side_m(), problem.hazards,
                   curves_of(*plan, tracks_of(problem, *plan), false), problem.site);
}

}  // namespace

Result<Figures> draw_cooperative(const Options& options) {
  const RouteProblem problem = routes::paper_team();
  const auto plan = routes::plan_routes(problem, {}, Random{options.seed});
  if (options.on_done) options.on_done();
  if (!plan) return plan.error();
  const auto report = routes::check_routes(problem, *plan);
  const auto tracks = tracks_of(problem, *plan);

  const double speed = problem.vehicles.front().speed_mps;  // the same for all
  const double common_m = plan->arrival_s * speed;
  const double bound_m = plan->bound_s * speed;
  std::string text = fmt::format(
      "Fig. 16 and 17: three vehicles over (990, 990) at once, all hazards closed\n"
      "{:<8} {:>10} {:>10} {:>12} {:>11} {:>11} {:>13} {:>10}\n",
      "vehicle", "length m", "own bound", "arrival err", "bearing", "bearing err", "last straight",
      "clearance");
  std::string csv =
      "vehicle,length_m,bound_m,arrival_error_s,bearing_deg,bearing_error_deg,last_straight_m,"
      "clearance_m\n";
  for (std::size_t i = 0; i < report.routes.size(); ++i) {
    const auto& measures = report.routes[i];
    // As the paper has it: of the point of entry, as seen from the site.
    const double bearing =
        std::remainder(degrees(problem.vehicles[i].approach_heading_rad) + 180.0, 360.0);
    const double seen = bearing < 0.0 ? bearing + 360.0 : bearing;
    text += fmt::format(
        "{:<8} {:>10.2f} {:>10.2f} {:>10.1e} s {:>7.1f} deg {:>7.0e} deg {:>11.1f} m {:>8.2f} m\n",
        measures.id.value, measures.length_m, plan->routes[i].bound_m, measures.arrival_error_s,
        seen, degrees(measures.bearing_error_rad), measures.last_straight_m, measures.clearance_m);
    csv += fmt::format("{},{:.4f},{:.4f},{:.6f},{:.4f},{:.6f},{:.4f},{:.4f}\n", measures.id.value,
                       measures.length_m, plan->routes[i].bound_m, measures.arrival_error_s, seen,
                       degrees(measures.bearing_error_rad), measures.last_straight_m,
                       measures.clearance_m);
  }
  text += fmt::format(
      "common length {:.2f} m: {:.3f} % above the exact lower bound {:.2f}; the paper's {:.1f} is "
      "{:.3f} % above\nleast distance {:.2f} m (asked for {:g}), arrival spread {:.1e} s; the "
      "independent checker finds {}\n",
      common_m, 100.0 * (common_m / bound_m - 1.0), bound_m, kPaperLength_m,
      100.0 * (kPaperLength_m / bound_m - 1.0), report.separation_m, problem.rules.separation_m,
      report.arrival_spread_s, report.ok() ? "nothing broken" : report.violations.front().message);
  std::string track_rows = "vehicle,t_s,x_m,y_m\n";
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    for (std::size_t t = 0; t < tracks[i].size(); ++t) {
      track_rows +=
          fmt::format("{},{:g},{:.3f},{:.3f}\n", plan->routes[i].id.value,
                      kStep_s * static_cast<double>(t), tracks[i][t].x(), tracks[i][t].y());
    }
  }
  return Figures{
      text,
      {{"cooperative.csv", csv},
       {"cooperative-tracks.csv", track_rows},
       {"cooperative.svg",
        world_svg(fmt::format("Three vehicles over the site at once, after {:.1f} m", common_m),
                  kWorldSide_m, problem.hazards, curves_of(*plan, tracks, true), problem.site)},
       {"cooperative-distances.svg", distances_svg(problem, tracks)}}};
}

Result<Figures> draw_scale(const Options& options) {
  std::vector<std::pair<std::size_t, std::uint64_t>> teams;
  for (std::size_t size = kSizes.size(); size-- > 0;) {  // the largest first: they take longest
    for (std::size_t k = 0; k < options.runs.teams.at(size); ++k) {
      teams.emplace_back(size, options.seed + k);
    }
  }
  const auto flown = fly_all<TimedScaleRun>(teams.size(), options, [&](std::size_t i) {
    return run_team(teams[i].first, teams[i].second);
  });

  Figures figures;
  figures.text = fmt::format(
      "Scale: random teams among {} hazards, all closed; ours. Solvable: by this search, or by one "
      "with 10 times the\nevaluations. Seconds of one processor for a plan: median, 95 %, most\n"
      "{:<9} {:>6} {:>9} {:>7} {:>8} {:>11} {:>9} {:>12} {:>8} {:>7} {:>7}\n",
      kHazards, "vehicles", "teams", "solvable", "solved", "share", "over bound", "at most",
      "least dist.", "median", "95 %", "most");
  std::string csv =
      "vehicles,seed,planned,checked,slow_solves,over_bound,separation_m,evaluations,reason\n";
  experiments::Plot plot{"Common time above its lower bound, by team size",
                         "vehicles",
                         "above the bound, %, mean with its 95 % interval",
                         {},
                         {{"over bound", {}}}};
  std::string picture;
  for (std::size_t size = 0; size < kSizes.size(); ++size) {
    std::size_t solvable = 0;
    std::vector<double> over;
    std::vector<double> distances;
    std::vector<double> seconds;
    for (const TimedScaleRun& timed : flown) {
      if (timed.size != size) continue;
      const ScaleRun& run = timed.run;
      solvable += run.checked || timed.slow_solves ? 1 : 0;
      seconds.push_back(timed.seconds);
      if (run.checked) {
        over.push_back(100.0 * run.over_bound);
        distances.push_back(run.separation_m);
        if (kSizes.at(size) == kSizes.back() && picture.empty()) {
          picture = team_svg(kSizes.at(size), timed.seed);
        }
      }
      std::string reason = run.reason;
      std::replace(reason.begin(), reason.end(), '"', '\'');
      csv += fmt::format("{},{},{:d},{:d},{:d},{:.6f},{:.4f},{},\"{}\"\n", kSizes.at(size),
                         timed.seed, run.planned, run.checked, timed.slow_solves, run.over_bound,
                         run.separation_m, run.evaluations, reason);
    }
    if (seconds.empty()) continue;
    std::sort(seconds.begin(), seconds.end());
    const auto spread = routes::spread_of(over);
    const double share =
        solvable > 0 ? 100.0 * static_cast<double>(over.size()) / static_cast<double>(solvable)
                     : 0.0;
    figures.text += fmt::format(
        "{:<9} {:>6} {:>9} {:>7} {:>6.1f} % {:>9.2f} % {:>7.2f} % {:>10.2f} m {:>8.2f} {:>7.2f} "
        "{:>7.2f}\n",
        kSizes.at(size), seconds.size(), solvable, over.size(), share, spread.mean, spread.most,
        routes::spread_of(distances).least, quantile(seconds, 0.5), quantile(seconds, 0.95),
        seconds.back());
    plot.x.push_back(fmt::format("{}", kSizes.at(size)));
    plot.series[0].values.push_back(experiments::estimate(over));
  }
  figures.files = {{"scale.csv", csv}, {"scale.svg", experiments::svg(plot, false)}};
  if (!picture.empty()) figures.files.push_back({"scale-20.svg", picture});
  return figures;
}

}  // namespace skein::route_figures
