// SPDX-License-Identifier: Apache-2.0
#include "skein/route_figures/route_figures.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "parts.hpp"

namespace skein::route_figures {
namespace {

constexpr auto kExperiments = static_cast<std::size_t>(Experiment::count);
constexpr std::array<std::string_view, kExperiments> kNames{
    "maps", "convergence", "weights", "worlds", "cooperative", "quality", "flights", "scale"};

}  // namespace

std::string_view to_string(Experiment experiment) {
  return kNames.at(static_cast<std::size_t>(experiment));
}

Result<std::vector<Experiment>> find_experiments(const std::vector<std::string>& names) {
  std::array<bool, kExperiments> wanted{};
  for (const std::string& name : names) {
    if (name == "all") {
      wanted.fill(true);
      continue;
    }
    const auto* const found = std::find(kNames.begin(), kNames.end(), name);
    if (found == kNames.end()) {
      std::string why = "there is no experiment '" + name + "'; there are ";
      for (const std::string_view one : kNames) why.append(one).append(", ");
      return Error{why.append("and all")};
    }
    wanted.at(static_cast<std::size_t>(found - kNames.begin())) = true;
  }
  std::vector<Experiment> experiments;
  for (std::size_t i = 0; i < kExperiments; ++i) {
    if (wanted.at(i)) experiments.push_back(static_cast<Experiment>(i));
  }
  return experiments;
}

Runs paper_runs() {
  return {.maps = 200,
          .convergence = 200,
          .weights = 20,
          .worlds = 600,
          .known_worlds = 100,
          .quality = 200,
          .best_known = 4,
          .flights = 100,
          .teams = {100, 60, 30}};
}

Runs runs_of(std::size_t number) {
  return {.maps = number,
          .convergence = number,
          .weights = number,
          .worlds = number,
          .known_worlds = number,
          .quality = number,
          .best_known = 1,
          .flights = number,
          .teams = {number, number, number}};
}

std::size_t steps_of(Experiment experiment, const Runs& runs) {
  switch (experiment) {
    case Experiment::maps:
      return 2 * static_cast<std::size_t>(routes::ChaoticMap::count) * runs.maps;
    case Experiment::convergence:
      return 2 * contenders_count() * runs.convergence;
    case Experiment::weights:
      return 2 * routes::paper_weights().size() * runs.weights;
    case Experiment::worlds:
      return 2 * runs.worlds;
    case Experiment::quality:
      return kStarts * (runs.quality + runs.best_known);
    case Experiment::flights:
      return runs.flights;
    case Experiment::scale:
      return std::accumulate(runs.teams.begin(), runs.teams.end(), std::size_t{0});
    default:
      return 1;
  }
}

Result<Figures> draw(Experiment experiment, const Options& options) {
  static constexpr std::array kDraw{&draw_maps,    &draw_convergence, &draw_weights,
                                    &draw_worlds,  &draw_cooperative, &draw_quality,
                                    &draw_flights, &draw_scale};
  static_assert(kDraw.size() == static_cast<std::size_t>(Experiment::count));
  return kDraw.at(static_cast<std::size_t>(experiment))(options);
}

}  // namespace skein::route_figures
