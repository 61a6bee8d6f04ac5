// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "search_counter.hpp"
#include "skein/base/assert.hpp"
#include "skein/routes/optimiser.hpp"

namespace skein::routes {
namespace {

constexpr std::size_t kLeaders = 3;

/// Alpha, beta and delta: the best three points seen so far.
class Leaders {
 public:
  void see(const Candidate& candidate) {
    std::size_t rank = 0;
    while (rank < kLeaders && candidate.value >= best_[rank].value) ++rank;
    if (rank == kLeaders) return;
    for (std::size_t k = kLeaders - 1; k > rank; --k) std::swap(best_[k], best_[k - 1]);
    best_[rank] = candidate;
  }
  /// Where fewer than three points were seen, the worst of them.
  [[nodiscard]] const Candidate& operator[](std::size_t rank) const {
    while (rank > 0 && best_[rank].point.empty()) --rank;
    return best_[rank];
  }

 private:
  std::array<Candidate, kLeaders> best_;
};

/// Eq. 12-15: a step towards a leader, or past it.
double pull(double leader, double at, double a, Random& random) {
  const double big_a = 2.0 * a * random.uniform() - a;
  const double c = 2.0 * random.uniform();
  return leader - big_a * std::abs(c * leader - at);
}

std::vector<Candidate> chaotic_population(const SearchSpace& space,
                                          const ChaoticGreyWolfParams& params,
                                          SearchCounter& counter, Random& random) {
  if (!params.chaotic_start) return first_population(space, params.population, counter, random);
  ChaoticSequence sequence{params.start, random.fork()};
  const Box& box = space.box;
  std::vector<Candidate> all;
  for (std::size_t i = 0; i < 2 * params.population && !counter.spent(); ++i) {
    Candidate candidate;
    candidate.point.resize(box.dimension());
    for (std::size_t j = 0; j < box.dimension(); ++j) {
      candidate.point[j] = box.low[j] + sequence.next() * (box.high[j] - box.low[j]);
    }
    if (i < space.seeds.size()) candidate.point = space.seeds[i];
    box.clamp(candidate.point);
    candidate.value = counter(candidate.point);
    all.push_back(std::move(candidate));
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.value < b.value; });
  std::vector<Candidate> odd;
  for (std::size_t i = 0; i < all.size(); i += 2) odd.push_back(std::move(all[i]));
  return odd;
}

class ChaoticPack {
 public:
  ChaoticPack(const SearchSpace& space, const ChaoticGreyWolfParams& params, SearchCounter& counter,
              Random& random)
      : box_{space.box},
        params_{params},
        counter_{counter},
        random_{random},
        convergence_{params.convergence, random.fork()},
        local_{params.local, random.fork()},
        wolves_{chaotic_population(space, params, counter, random)},
        own_{wolves_} {
    for (const Candidate& wolf : wolves_) leaders_.see(wolf);
  }

  void hunt() {
    const double a =
        2.0 * (params_.chaotic_convergence ? convergence_.next() : 1.0 - counter_.share());
    const Leaders leaders = leaders_;
    for (std::size_t i = 0; i < wolves_.size() && !counter_.spent(); ++i) {
      Candidate moved = move(i, leaders, a);
      moved.value = counter_(moved.point);
      search_around(moved);
      const bool greedy = random_.chance(counter_.share());
      if (!greedy || moved.value < wolves_[i].value) wolves_[i] = moved;
      if (moved.value < own_[i].value) own_[i] = moved;
      leaders_.see(moved);
    }
  }

 private:
  [[nodiscard]] Candidate move(std::size_t i, const Leaders& leaders, double a) {
    const std::array<const Candidate*, kLeaders + 1> pulls = {&leaders[0], &leaders[1], &leaders[2],
                                                              &own_[i]};
    const std::size_t count = params_.own_best_pull ? kLeaders + 1 : kLeaders;
    double sum = 0.0;
    for (std::size_t k = 0; k < count; ++k) sum += pulls[k]->value;
    Candidate moved;
    moved.point.assign(box_.dimension(), 0.0);
    for (std::size_t k = 0; k < count; ++k) {
      const double weight = params_.own_best_pull && sum > 0.0 ? (1.0 - pulls[k]->value / sum) / 3.0
                                                               : 1.0 / static_cast<double>(count);
      for (std::size_t j = 0; j < box_.dimension(); ++j) {
        moved.point[j] += weight * pull(pulls[k]->point[j], wolves_[i].point[j], a, random_);
      }
    }
    box_.clamp(moved.point);
    return moved;
  }

  /// Eq. 19-21: chaotic steps within a small box around the wolf; the best is kept.
  void search_around(Candidate& wolf) {
    Candidate trial;
    const std::vector<double> centre = wolf.point;
    for (std::size_t step = 0; step < params_.local_steps && !counter_.spent(); ++step) {
      trial.point = centre;
      for (std::size_t j = 0; j < centre.size(); ++j) {
        const double span = params_.local_span * (box_.high[j] - box_.low[j]);
        trial.point[j] += span * (2.0 * local_.next() - 1.0);
      }
      box_.clamp(trial.point);
      trial.value = counter_(trial.point);
      if (trial.value < wolf.value) wolf = trial;
    }
  }

  const Box& box_;
  const ChaoticGreyWolfParams& params_;
  SearchCounter& counter_;
  Random& random_;
  ChaoticSequence convergence_;
  ChaoticSequence local_;
  std::vector<Candidate> wolves_;
  std::vector<Candidate> own_;
  Leaders leaders_;
};

}  // namespace

SearchResult grey_wolf(const Objective& objective, const SearchSpace& space,
                       const GreyWolfParams& params, const SearchBudget& budget, Random random) {
  SKEIN_ASSERT(params.population > 0);
  SearchCounter counter{objective, budget};
  const Box& box = space.box;
  std::vector<Candidate> wolves = first_population(space, params.population, counter, random);
  Leaders leaders;
  for (const Candidate& wolf : wolves) leaders.see(wolf);
  while (!counter.spent() && counter.go_on()) {
    const double a = 2.0 * (1.0 - counter.share());
    const Leaders now = leaders;
    for (std::size_t i = 0; i < wolves.size() && !counter.spent(); ++i) {
      std::vector<double>& at = wolves[i].point;
      for (std::size_t j = 0; j < at.size(); ++j) {
        double sum = 0.0;
        for (std::size_t k = 0; k < kLeaders; ++k) sum += pull(now[k].point[j], at[j], a, random);
        at[j] = sum / static_cast<double>(kLeaders);
      }
      box.clamp(at);
      wolves[i].value = counter(at);
      leaders.see(wolves[i]);
    }
  }
  return counter.result();
}

SearchResult chaotic_grey_wolf(const Objective& objective, const SearchSpace& space,
                               const ChaoticGreyWolfParams& params, const SearchBudget& budget,
                               Random random) {
  SKEIN_ASSERT(params.population > 0);
  SearchCounter counter{objective, budget};
  ChaoticPack pack{space, params, counter, random};
  while (!counter.spent() && counter.go_on()) pack.hunt();
  return counter.result();
}

}  // namespace skein::routes
