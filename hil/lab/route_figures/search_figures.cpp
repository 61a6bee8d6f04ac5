// SPDX-License-Identifier: Apache-2.0
// Runs of an optimiser in the paper's world: tables 2 and 3, fig. 12, and ours against the best
// known.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>

#include "parts.hpp"
#include "skein/experiments/plots.hpp"
#include "skein/paper_routes/paper_world.hpp"

namespace skein::route_figures {
namespace {

using routes::ChaoticMap;
using routes::Contender;
using routes::ConvergenceRun;
using routes::Counting;
using routes::CurveForm;
using routes::MapUse;
using routes::SearchMethod;
using routes::Spread;

constexpr auto kMaps = static_cast<std::size_t>(ChaoticMap::count);
constexpr auto kUses = static_cast<std::size_t>(MapUse::count);
constexpr auto kCountings = static_cast<std::size_t>(Counting::count);
constexpr std::array<std::string_view, kUses> kUseNames{"start", "a"};

// Table 2, 3: the least and the largest mean of a map.
constexpr std::array<std::array<double, 2>, kUses> kPaperMeans{{{1.186, 1.546}, {1.214, 1.271}}};

/// What the results of one place say of the maps.
std::string map_finding(std::size_t use, const std::vector<std::vector<double>>& values) {
  std::vector<experiments::Estimate> means;
  means.reserve(values.size());
  for (const auto& of_map : values) means.push_back(experiments::estimate(of_map));
  const auto less = [](const auto& a, const auto& b) { return a.mean < b.mean; };
  const auto best = std::min_element(means.begin(), means.end(), less);
  const auto worst = std::max_element(means.begin(), means.end(), less);
  const auto& chosen = means.at(static_cast<std::size_t>(ChaoticMap::intermittency));
  const auto rank = 1 + std::count_if(means.begin(), means.end(),
                                      [&](const auto& one) { return one.mean < chosen.mean; });
  const auto equals = std::count_if(means.begin(), means.end(), [&](const auto& one) {
    return one.mean - one.half_width <= best->mean + best->half_width;
  });
  return fmt::format(
      "{:<5} means from {:.3f} ({}) to {:.3f}; paper {:.3f} to {:.3f}. Its choice, intermittency, "
      "is number {} of {};\n      the 95 % intervals of {} reach that of the best\n",
      kUseNames.at(use), best->mean,
      routes::to_string(static_cast<ChaoticMap>(best - means.begin())), worst->mean,
      kPaperMeans.at(use)[0], kPaperMeans.at(use)[1], rank, kMaps, equals);
}

/// The three that the paper compares.
std::optional<double> paper_value(const Contender& contender) {
  if (contender.ours || contender.form != CurveForm::free_points) return std::nullopt;
  switch (contender.method) {
    case SearchMethod::particle_swarm:
      return 1.35;
    case SearchMethod::grey_wolf:
      return 1.21;
    case SearchMethod::chaotic_grey_wolf:
      return 1.18;
    default:
      return std::nullopt;
  }
}

/// Those that fig. 12 shows; all of them would hide each other.
std::string drawn_name(const Contender& contender) {
  if (contender.ours) return "ours";
  if (contender.form == CurveForm::free_points) {
    switch (contender.method) {
      case SearchMethod::particle_swarm:
        return "PSO";
      case SearchMethod::grey_wolf:
        return "GWO";
      case SearchMethod::chaotic_grey_wolf:
        return "CGWO (the paper's)";
      case SearchMethod::differential_evolution:
        return "DE";
      default:
        return "";
    }
  }
  if (contender.form == CurveForm::turns_and_legs) {
    if (contender.method == SearchMethod::chaotic_grey_wolf) return "CGWO, turns and legs";
    if (contender.method == SearchMethod::differential_evolution) return "DE, turns and legs";
  }
  return "";
}

constexpr std::size_t kConvergenceSteps = 75;
constexpr double kPaperIterations = 150.0;

/// Mean of the best values so far, over the share of the budget. Its first steps are left out: they
/// tell of chance only, and would hide the rest.
std::vector<Vec2> mean_progress(const std::vector<const ConvergenceRun*>& runs, double budget) {
  std::vector<Vec2> line;
  for (std::size_t step = 3; step <= kConvergenceSteps; ++step) {
    const double share = static_cast<double>(step) / static_cast<double>(kConvergenceSteps);
    double sum = 0.0;
    for (const ConvergenceRun* run : runs) {
      double best = run->progress.front().best;
      for (const auto& at : run->progress) {
        if (static_cast<double>(at.evaluations) > share * static_cast<double>(run->evaluations)) {
          break;
        }
        best = at.best;
      }
      sum += step == kConvergenceSteps ? run->value : best;
    }
    line.emplace_back(share * budget, sum / static_cast<double>(runs.size()));
  }
  return line;
}

}  // namespace

std::size_t contenders_count() { return routes::contenders().size(); }

Result<Figures> draw_maps(const Options& options) {
  const std::size_t runs = options.runs.maps;
  constexpr std::size_t kCells = kUses * kMaps;
  const auto flown = fly_all<double>(kCells * runs, options, [&](std::size_t i) {
    const std::size_t cell = i % kCells;
    return routes::run_map(static_cast<MapUse>(cell / kMaps), static_cast<ChaoticMap>(cell % kMaps),
                           Counting::iterations, options.seed + i / kCells);
  });

  std::array<std::vector<std::vector<double>>, kUses> values;
  for (auto& of_use : values) of_use.resize(kMaps);
  std::string csv = "used_for,map,seed,value\n";
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    for (std::size_t run = 0; run < runs; ++run) {
      const double value = flown[run * kCells + cell];
      values.at(cell / kMaps)[cell % kMaps].push_back(value);
      csv += fmt::format("{},{},{},{:.6f}\n", kUseNames.at(cell / kMaps),
                         routes::to_string(static_cast<ChaoticMap>(cell % kMaps)),
                         options.seed + run, value);
    }
  }

  experiments::Plot plot{"Chaotic grey wolf: which map for the start, which for a",
                         "",
                         "mean of f with its 95 % interval",
                         {},
                         {{"start (table 2)", {}}, {"a (table 3)", {}}}};
  std::string text = fmt::format(
      "Tables 2 and 3: chaotic maps, population 30, 200 iterations, D = 5, {} runs a map\n"
      "{:<14} {:>8} {:>8} {:>8}   {:>8} {:>8} {:>8}\n",
      runs, "map", "start", "", "", "a", "", "");
  text += fmt::format("{:<14} {:>8} {:>8} {:>8}   {:>8} {:>8} {:>8}\n", "", "max", "min", "mean",
                      "max", "min", "mean");
  for (std::size_t map = 0; map < kMaps; ++map) {
    plot.x.emplace_back(routes::to_string(static_cast<ChaoticMap>(map)));
    text += fmt::format("{:<14}", plot.x.back());
    for (std::size_t use = 0; use < kUses; ++use) {
      const Spread spread = routes::spread_of(values.at(use)[map]);
      text += fmt::format(" {:>8.3f} {:>8.3f} {:>8.3f}{}", spread.most, spread.least, spread.mean,
                          use == 0 ? "  " : "\n");
      plot.series.at(use).values.push_back(experiments::estimate(values.at(use)[map]));
    }
  }
  for (std::size_t use = 0; use < kUses; ++use) text += map_finding(use, values.at(use));
  return Figures{text, {{"maps.csv", csv}, {"maps.svg", experiments::svg(plot, false)}}};
}

Result<Figures> draw_convergence(const Options& options) {
  const std::size_t runs = options.runs.convergence;
  const std::vector<Contender> contenders = routes::contenders();
  const std::size_t cells = kCountings * contenders.size();
  const auto flown = fly_all<ConvergenceRun>(cells * runs, options, [&](std::size_t i) {
    const std::size_t cell = i % cells;
    return routes::run_convergence(contenders[cell % contenders.size()],
                                   static_cast<Counting>(cell / contenders.size()), 0,
                                   options.seed + i / cells);
  });

  Figures figures;
  std::string rows = "counting,optimiser,seed,evaluations,value\n";
  std::string curves = "counting,optimiser,x,mean_best\n";
  std::array<std::vector<Spread>, kCountings> spreads;
  std::array<std::vector<std::uint64_t>, kCountings> spent;
  for (std::size_t counting = 0; counting < kCountings; ++counting) {
    const std::string_view counted = short_name(static_cast<Counting>(counting));
    const bool iterations = static_cast<Counting>(counting) == Counting::iterations;
    experiments::LinePlot plot{
        iterations ? "Convergence as the paper counts: equal iterations"
                   : "Convergence at equal evaluations",
        iterations ? "iterations (of ours: share of its 7,550 evaluations)" : "evaluations",
        fmt::format("f, mean of {} runs", runs),
        {}};
    for (std::size_t c = 0; c < contenders.size(); ++c) {
      std::vector<const ConvergenceRun*> of_cell;
      std::vector<double> values;
      const std::string name = routes::name_of(contenders[c]);
      for (std::size_t run = 0; run < runs; ++run) {
        of_cell.push_back(&flown[run * cells + counting * contenders.size() + c]);
        values.push_back(of_cell.back()->value);
        rows += fmt::format("{},\"{}\",{},{},{:.6f}\n", counted, name, options.seed + run,
                            of_cell.back()->evaluations, values.back());
      }
      spent.at(counting).push_back(of_cell.front()->evaluations);
      spreads.at(counting).push_back(routes::spread_of(values));
      const auto line =
          mean_progress(of_cell, iterations ? kPaperIterations
                                            : static_cast<double>(of_cell.front()->evaluations));
      for (const Vec2& at : line) {
        curves += fmt::format("{},\"{}\",{:g},{:.6f}\n", counted, name, at.x(), at.y());
      }
      if (const std::string drawn = drawn_name(contenders[c]); !drawn.empty()) {
        plot.lines.push_back({drawn, line});
      }
    }
    figures.files.push_back({fmt::format("convergence-{}.svg", counted), experiments::svg(plot)});
  }
  figures.files.push_back({"convergence.csv", rows});
  figures.files.push_back({"convergence-curves.csv", curves});

  figures.text = fmt::format(
      "Fig. 12: population 50, 150 iterations, D = 5, {} runs; at equal iterations the chaotic "
      "wolf evaluates four times as often\n{:<40} {:>6}   {:>26}   {:>17}\n{:<40} {:>6}   {:>8} "
      "{:>8} {:>8}   {:>8} {:>8}\n",
      runs, "", "", "equal iterations", "equal evaluations", "optimiser", "paper", "mean", "median",
      "evals", "mean", "median");
  for (std::size_t c = 0; c < contenders.size(); ++c) {
    const auto paper = paper_value(contenders[c]);
    figures.text +=
        fmt::format("{:<40} {:>6}   {:>8.3f} {:>8.3f} {:>8}   {:>8.3f} {:>8.3f}\n",
                    routes::name_of(contenders[c]), paper ? fmt::format("{:.2f}", *paper) : "",
                    spreads[0][c].mean, spreads[0][c].median, spent[0][c], spreads[1][c].mean,
                    spreads[1][c].median);
  }
  return figures;
}

Result<Figures> draw_quality(const Options& options) {
  constexpr std::uint64_t kEvaluations = 7'500;
  constexpr std::uint64_t kLarge = 100 * kEvaluations;
  const std::size_t runs = options.runs.quality;
  // The long ones first, so that none is left over at the end.
  const std::size_t searches = kStarts * options.runs.best_known;
  const auto flown = fly_all<double>(searches + kStarts * runs, options, [&](std::size_t i) {
    const bool large = i < searches;
    const std::size_t k = large ? i : i - searches;
    return routes::run_quality(k % kStarts, large ? kLarge : kEvaluations,
                               options.seed + k / kStarts);
  });

  std::string csv = "start_x,start_y,evaluations,seed,value,gap\n";
  std::string text = fmt::format(
      "Quality: ours, 7,500 evaluations, {} runs a start, against the best known ({} searches with "
      "100 times as many)\n{:<12} {:>10} {:>9} {:>12} {:>12} {:>12} {:>10}\n",
      runs, options.runs.best_known, "start", "best known", "median", "median gap", "largest gap",
      "within 0.1 %", "within 1 %");
  experiments::LinePlot plot{"Ours against the best known, by start",
                             "share of the runs, %",
                             "gap to the best known, %, at most",
                             {}};
  for (std::size_t start = 0; start < kStarts; ++start) {
    double best = std::numeric_limits<double>::infinity();
    std::vector<double> values;
    for (std::size_t i = start; i < flown.size(); i += kStarts) {
      best = std::min(best, flown[i]);
      if (i >= searches) values.push_back(flown[i]);
    }
    const Vec2 from = routes::paper_starts().at(start);
    for (std::size_t i = start; i < flown.size(); i += kStarts) {
      const bool large = i < searches;
      csv += fmt::format(
          "{:g},{:g},{},{},{:.6f},{:.6f}\n", from.x(), from.y(), large ? kLarge : kEvaluations,
          options.seed + (large ? i : i - searches) / kStarts, flown[i], flown[i] / best - 1.0);
    }
    const Spread spread = routes::spread_of(values);
    const auto within = [&](double share) {
      return 100.0 *
             static_cast<double>(
                 std::count_if(values.begin(), values.end(),
                               [&](double v) { return v <= best * (1.0 + share); })) /
             static_cast<double>(values.size());
    };
    const std::string name = fmt::format("({:g}, {:g})", from.x(), from.y());
    text +=
        fmt::format("{:<12} {:>10.4f} {:>9.4f} {:>10.3f} % {:>10.3f} % {:>10.1f} % {:>8.1f} %\n",
                    name, best, spread.median, 100.0 * (spread.median / best - 1.0),
                    100.0 * (spread.most / best - 1.0), within(0.001), within(0.01));
    std::sort(values.begin(), values.end());
    experiments::Line line{name, {}};
    for (std::size_t i = 0; i < values.size(); ++i) {
      line.points.emplace_back(100.0 * static_cast<double>(i + 1) / static_cast<double>(runs),
                               100.0 * (values[i] / best - 1.0));
    }
    plot.lines.push_back(std::move(line));
  }
  return Figures{text, {{"quality.csv", csv}, {"quality.svg", experiments::svg(plot)}}};
}

Result<Figures> draw_flights(const Options& options) {
  const auto worlds = fly_all<routes::FlightRun>(options.runs.flights, options, [&](std::size_t i) {
    return routes::run_flight(options.seed + i);
  });
  std::string csv = "world,run,value,best_known,gap\n";
  std::vector<double> gaps;
  std::size_t refused = 0;
  for (std::size_t w = 0; w < worlds.size(); ++w) {
    for (std::size_t run = 0; run < worlds[w].values.size(); ++run) {
      const auto& value = worlds[w].values[run];
      if (!value) {
        ++refused;
        continue;
      }
      gaps.push_back(*value / worlds[w].best_known - 1.0);
      csv += fmt::format("{},{},{:.6f},{:.6f},{:.6f}\n", options.seed + w, run, *value,
                         worlds[w].best_known, gaps.back());
    }
  }
  const Spread spread = routes::spread_of(gaps);
  const auto within = std::count_if(gaps.begin(), gaps.end(), [](double g) { return g <= 0.01; });
  return Figures{
      fmt::format("Flights: ours, 7,500 evaluations, exposure by length, keep-outs closed; {} "
                  "random worlds, {} runs, {} refused\nwithin 1 % of the best known: {:.1f} %; "
                  "median gap {:.3f} %, largest {:.2f} %\n",
                  worlds.size(), gaps.size() + refused, refused,
                  gaps.empty()
                      ? 0.0
                      : 100.0 * static_cast<double>(within) / static_cast<double>(gaps.size()),
                  100.0 * spread.median, 100.0 * spread.most),
      {{"flights.csv", csv}}};
}

}  // namespace skein::route_figures
