// SPDX-License-Identifier: Apache-2.0
#include "skein/routes/optimiser.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "search_counter.hpp"
#include "skein/base/assert.hpp"

namespace skein::routes {

void Box::clamp(std::span<double> point) const {
  for (std::size_t j = 0; j < low.size(); ++j) point[j] = std::clamp(point[j], low[j], high[j]);
}

std::vector<double> uniform_point(const Box& box, Random& random) {
  std::vector<double> point(box.dimension());
  for (std::size_t j = 0; j < point.size(); ++j) {
    point[j] = random.uniform(box.low[j], box.high[j]);
  }
  return point;
}

std::vector<Candidate> first_population(const SearchSpace& space, std::size_t size,
                                        SearchCounter& counter, Random& random) {
  std::vector<Candidate> all;
  all.reserve(size);
  for (std::size_t i = 0; i < size && !counter.spent(); ++i) {
    Candidate candidate;
    if (i < space.seeds.size()) {
      candidate.point = space.seeds[i];
      space.box.clamp(candidate.point);
    } else {
      candidate.point = uniform_point(space.box, random);
    }
    candidate.value = counter(candidate.point);
    all.push_back(std::move(candidate));
  }
  return all;
}

std::string_view to_string(SearchMethod method) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(SearchMethod::count)>
      kNames{"grey wolf", "chaotic grey wolf", "particle swarm", "differential evolution",
             "CMA-ES"};
  return kNames.at(static_cast<std::size_t>(method));
}

SearchResult search(SearchMethod method, const Objective& objective, const SearchSpace& space,
                    std::size_t population, const SearchBudget& budget, Random random) {
  const auto sized = [population](auto params) {
    if (population > 0) params.population = population;
    return params;
  };
  switch (method) {
    case SearchMethod::grey_wolf:
      return grey_wolf(objective, space, sized(GreyWolfParams{}), budget, random);
    case SearchMethod::chaotic_grey_wolf:
      return chaotic_grey_wolf(objective, space, sized(ChaoticGreyWolfParams{}), budget, random);
    case SearchMethod::particle_swarm:
      return particle_swarm(objective, space, sized(ParticleSwarmParams{}), budget, random);
    case SearchMethod::differential_evolution:
      return differential_evolution(objective, space, sized(DifferentialEvolutionParams{}), budget,
                                    random);
    case SearchMethod::cma_es:
      return cma_es(objective, space, sized(CmaEsParams{}), budget, random);
    case SearchMethod::count:
      break;
  }
  SKEIN_ASSERT(false);
  return {};
}

SearchResult particle_swarm(const Objective& objective, const SearchSpace& space,
                            const ParticleSwarmParams& params, const SearchBudget& budget,
                            Random random) {
  SKEIN_ASSERT(params.population > 0);
  SearchCounter counter{objective, budget};
  const Box& box = space.box;
  const std::size_t n = box.dimension();
  std::vector<Candidate> own = first_population(space, params.population, counter, random);
  std::vector<std::vector<double>> at;
  std::vector<std::vector<double>> speed(own.size(), std::vector<double>(n));
  for (std::size_t i = 0; i < own.size(); ++i) {
    at.push_back(own[i].point);
    for (std::size_t j = 0; j < n; ++j) {
      const double most = params.speed_max * (box.high[j] - box.low[j]);
      speed[i][j] = random.uniform(-most, most);
    }
  }
  while (!counter.spent() && counter.go_on()) {
    const double inertia =
        params.inertia_start + (params.inertia_end - params.inertia_start) * counter.share();
    for (std::size_t i = 0; i < own.size() && !counter.spent(); ++i) {
      const std::vector<double>& best = counter.result().best;
      for (std::size_t j = 0; j < n; ++j) {
        const double most = params.speed_max * (box.high[j] - box.low[j]);
        const double own_pull = params.own_pull * random.uniform() * (own[i].point[j] - at[i][j]);
        const double swarm_pull = params.swarm_pull * random.uniform() * (best[j] - at[i][j]);
        speed[i][j] = std::clamp(inertia * speed[i][j] + own_pull + swarm_pull, -most, most);
        at[i][j] += speed[i][j];
        if (at[i][j] < box.low[j] || at[i][j] > box.high[j]) speed[i][j] = 0.0;
      }
      box.clamp(at[i]);
      const double value = counter(at[i]);
      if (value < own[i].value) own[i] = {at[i], value};
    }
  }
  return counter.result();
}

SearchResult differential_evolution(const Objective& objective, const SearchSpace& space,
                                    const DifferentialEvolutionParams& params,
                                    const SearchBudget& budget, Random random) {
  SKEIN_ASSERT(params.population >= 4);
  SearchCounter counter{objective, budget};
  const Box& box = space.box;
  const std::size_t n = box.dimension();
  std::vector<Candidate> all = first_population(space, params.population, counter, random);
  std::vector<double> trial(n);
  while (!counter.spent() && counter.go_on()) {
    for (std::size_t i = 0; i < all.size() && !counter.spent(); ++i) {
      std::size_t a = i;
      std::size_t b = i;
      std::size_t c = i;
      while (a == i) a = random.index(all.size());
      while (b == i || b == a) b = random.index(all.size());
      while (c == i || c == a || c == b) c = random.index(all.size());
      const std::vector<double>& base = params.from_best ? counter.result().best : all[a].point;
      const double scale = random.uniform(params.scale_min, params.scale_max);
      const std::size_t always = random.index(n);
      for (std::size_t j = 0; j < n; ++j) {
        const bool crosses = random.chance(params.crossover) || j == always;
        if (!crosses) {
          trial[j] = all[i].point[j];
          continue;
        }
        trial[j] = base[j] + scale * (all[b].point[j] - all[c].point[j]);
        // Back inside, between the border and where it came from.
        if (trial[j] < box.low[j]) trial[j] = random.uniform(box.low[j], base[j]);
        if (trial[j] > box.high[j]) trial[j] = random.uniform(base[j], box.high[j]);
      }
      const double value = counter(trial);
      if (value <= all[i].value) all[i] = {trial, value};
    }
  }
  return counter.result();
}

}  // namespace skein::routes
