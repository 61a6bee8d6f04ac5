// SPDX-License-Identifier: Apache-2.0
// Fig. 13, and 14 and 15: other weights, other worlds.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "parts.hpp"
#include "skein/experiments/plots.hpp"
#include "skein/paper_routes/paper_world.hpp"
#include "world_picture.hpp"

namespace skein::route_figures {
namespace {

using routes::Contender;
using routes::Counting;
using routes::Duel;
using routes::SearchMethod;
using routes::WeightsRun;
using routes::WorldRun;
using routes::WorldSummary;

constexpr double kWorldSide_m = 1000.0;

struct Method {
  std::string_view name;
  std::string_view file;
  Contender contender;
};
constexpr std::array<Method, 2> kMethods{
    {{"CGWO, free points", "weights-paper.svg", {.method = SearchMethod::chaotic_grey_wolf}},
     {"ours", "weights-ours.svg", {.ours = true}}}};

/// One pair of methods, as Wu 2022 compares them.
struct Pair {
  std::string_view name;
  double WorldRun::*one;
  double WorldRun::*other;
  Duel WorldSummary::*duel;
  double paper_wins;  ///< 0: the paper has none
  double paper_difference;
};
constexpr std::array<Pair, 5> kPairs{
    {{"CGWO over GWO", &WorldRun::chaotic, &WorldRun::wolf, &WorldSummary::chaotic_over_wolf, 0.74,
      -0.0129},
     {"CGWO over PSO", &WorldRun::chaotic, &WorldRun::swarm, &WorldSummary::chaotic_over_swarm,
      0.548, -0.0466},
     {"ours over CGWO", &WorldRun::ours, &WorldRun::chaotic, &WorldSummary::ours_over_chaotic, 0.0,
      0.0},
     {"ours over GWO", &WorldRun::ours, &WorldRun::wolf, &WorldSummary::ours_over_wolf, 0.0, 0.0},
     {"ours over PSO", &WorldRun::ours, &WorldRun::swarm, &WorldSummary::ours_over_swarm, 0.0,
      0.0}}};

/// A share of so many, with its 95 % interval (normal approximation).
experiments::Estimate share_of(double share, std::size_t count) {
  const double n = static_cast<double>(count);
  const double deviation = std::sqrt(share * (1.0 - share));
  return {count, 100.0 * share, 100.0 * deviation, 196.0 * deviation / std::sqrt(n)};
}

constexpr int kBins = 17;  // of 5 % each, the middle one around 0, the outer ones open
constexpr int kMiddle = kBins / 2;
constexpr double kBin = 0.05;

/// Fig. 15: how the normalised differences are spread.
std::string histogram(Counting counting, std::span<const WorldRun> worlds) {
  experiments::Plot plot{
      fmt::format("By how much it is better (left) or worse, at equal {}", short_name(counting)),
      "difference over the other's value, %",
      "worlds, %",
      {},
      {}};
  for (int bin = 0; bin < kBins; ++bin) {
    plot.x.push_back(bin % 2 == 0 ? fmt::format("{:g}", 100.0 * kBin * (bin - kMiddle)) : "");
  }
  for (const Pair& pair : std::span{kPairs}.first(3)) {
    std::vector<double> shares(kBins, 0.0);
    for (const WorldRun& world : worlds) {
      const double difference = (world.*pair.one - world.*pair.other) / world.*pair.other;
      const int bin = static_cast<int>(std::lround(difference / kBin)) + kMiddle;
      shares.at(static_cast<std::size_t>(std::clamp(bin, 0, kBins - 1))) +=
          100.0 / static_cast<double>(worlds.size());
    }
    experiments::Series series{std::string{pair.name}, {}};
    for (const double share : shares) series.values.push_back({1, share, 0.0, 0.0});
    plot.series.push_back(std::move(series));
  }
  return experiments::svg(plot, true);
}

}  // namespace

Result<Figures> draw_weights(const Options& options) {
  const std::size_t runs = options.runs.weights;
  const auto weightings = routes::paper_weights();
  const std::size_t cells = kMethods.size() * weightings.size();
  const auto flown = fly_all<WeightsRun>(cells * runs, options, [&](std::size_t i) {
    const std::size_t cell = i % cells;
    return routes::run_weights(kMethods.at(cell / weightings.size()).contender,
                               weightings.at(cell % weightings.size()), options.seed + i / cells);
  });

  Figures figures;
  figures.text = fmt::format(
      "Fig. 13: three weightings, 4,500 evaluations, D = 11, the best of {} runs\n{:<18} {:<15} "
      "{:>9} {:>9} {:>9} {:>9} {:>9}\n",
      runs, "method", "weights", "exposure", "length", "turning", "f", "mean f");
  std::string csv = "method,w1,w2,w3,seed,exposure,length_ratio,turning,value\n";
  for (std::size_t m = 0; m < kMethods.size(); ++m) {
    const Method& method = kMethods.at(m);
    std::vector<Curve> curves;
    for (std::size_t w = 0; w < weightings.size(); ++w) {
      const WeightsRun* best = nullptr;
      std::vector<double> values;
      const routes::CostWeights& weights = weightings.at(w);
      const std::string name =
          fmt::format("({:g}, {:g}, {:g})", weights.exposure, weights.length, weights.turning);
      for (std::size_t run = 0; run < runs; ++run) {
        const WeightsRun& one = flown[run * cells + m * weightings.size() + w];
        if (best == nullptr || one.costs.total < best->costs.total) best = &one;
        values.push_back(one.costs.total);
        csv += fmt::format("\"{}\",{:g},{:g},{:g},{},{:.6f},{:.6f},{:.6f},{:.6f}\n", method.name,
                           weights.exposure, weights.length, weights.turning, options.seed + run,
                           one.costs.exposure, one.costs.length_ratio, one.costs.turning,
                           one.costs.total);
      }
      figures.text +=
          fmt::format("{:<18} {:<15} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f}\n", method.name,
                      name, best->costs.exposure, best->costs.length_ratio, best->costs.turning,
                      best->costs.total, routes::spread_of(values).mean);
      curves.push_back({name, best->curve, {}});
    }
    figures.files.push_back(
        {std::string{method.file},
         world_svg(fmt::format("Weights of exposure, length and turning: {}", method.name),
                   kWorldSide_m, routes::paper_hazards(), curves, routes::paper_site())});
  }
  figures.files.push_back({"weights.csv", csv});
  return figures;
}

Result<Figures> draw_worlds(const Options& options) {
  const std::size_t count = options.runs.worlds;
  const std::size_t known = std::min(count, options.runs.known_worlds);
  // Those with a best known take longest, and so come first.
  const auto flown = fly_all<WorldRun>(2 * count, options, [&](std::size_t i) {
    const bool with_best_known = i < known;
    const std::size_t world = i < count ? i : i - count;
    return routes::run_world(i < count ? Counting::evaluations : Counting::iterations,
                             options.seed + world, with_best_known);
  });
  const std::span<const WorldRun> all{flown};
  const auto at_evaluations = all.first(count);
  const auto at_iterations = all.subspan(count);
  const WorldSummary as_paper = routes::summarise(at_iterations);
  const WorldSummary equal = routes::summarise(at_evaluations);

  std::string csv = "counting,seed,cgwo,gwo,pso,ours,best_known\n";
  for (std::size_t i = 0; i < flown.size(); ++i) {
    const WorldRun& world = flown[i];
    csv += fmt::format("{},{},{:.6f},{:.6f},{:.6f},{:.6f},{}\n",
                       short_name(i < count ? Counting::evaluations : Counting::iterations),
                       options.seed + i % count, world.chaotic, world.wolf, world.swarm, world.ours,
                       world.best_known > 0.0 ? fmt::format("{:.6f}", world.best_known) : "");
  }
  std::string text = fmt::format(
      "Fig. 14 and 15: {} random worlds, population 30, 80 iterations, D = 5; ours: 2,400 "
      "evaluations\n{:<15} {:>17}   {:>17}   {:>17}\n{:<15} {:>8} {:>8}   {:>8} {:>8}   {:>8} "
      "{:>8}\n",
      count, "", "paper", "equal iterations", "equal evaluations", "", "wins", "mean", "wins",
      "mean", "wins", "mean");
  experiments::Plot wins{"Who finds the better route, in random worlds",
                         "",
                         "worlds won, %, with 95 % intervals",
                         {},
                         {{"paper", {}}, {"equal iterations", {}}, {"equal evaluations", {}}}};
  for (const Pair& pair : kPairs) {
    const bool in_paper = pair.paper_wins > 0.0;
    text +=
        fmt::format("{:<15} {:>8} {:>8}   {:>6.1f} % {:>8.4f}   {:>6.1f} % {:>8.4f}\n", pair.name,
                    in_paper ? fmt::format("{:.1f} %", 100.0 * pair.paper_wins) : "",
                    in_paper ? fmt::format("{:.4f}", pair.paper_difference) : "",
                    100.0 * (as_paper.*pair.duel).win_rate, (as_paper.*pair.duel).mean_difference,
                    100.0 * (equal.*pair.duel).win_rate, (equal.*pair.duel).mean_difference);
    wins.x.emplace_back(pair.name);
    wins.series[0].values.push_back(
        in_paper ? experiments::Estimate{1, 100.0 * pair.paper_wins, 0.0, 0.0}
                 : experiments::Estimate{});
    wins.series[1].values.push_back(share_of((as_paper.*pair.duel).win_rate, count));
    wins.series[2].values.push_back(share_of((equal.*pair.duel).win_rate, count));
  }
  if (known > 0) {
    text += fmt::format(
        "ours is {:.2f} % above the best known on average ({} worlds; 240,000 evaluations)\n",
        100.0 * routes::summarise(at_evaluations.first(known)).ours_mean_gap, known);
  }
  return Figures{text,
                 {{"worlds.csv", csv},
                  {"worlds-wins.svg", experiments::svg(wins, true)},
                  {"worlds-iterations.svg", histogram(Counting::iterations, at_iterations)},
                  {"worlds-evaluations.svg", histogram(Counting::evaluations, at_evaluations)}}};
}

}  // namespace skein::route_figures
