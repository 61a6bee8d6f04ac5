// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "search_counter.hpp"
#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"
#include "skein/routes/optimiser.hpp"

namespace skein::routes {
namespace {

constexpr double kWidth = 0.1;  ///< of the distributions that scale and crossover are drawn from

/// What scales and crossovers have led to something better: the means to draw the next from.
class History {
 public:
  explicit History(std::size_t entries) : scale_(entries, 0.5), crossover_(entries, 0.5) {}

  struct Draw {
    double scale;
    double crossover;
  };
  [[nodiscard]] Draw draw(Random& random) const {
    const std::size_t entry = random.index(scale_.size());
    Draw drawn{};
    drawn.crossover = std::clamp(random.normal(crossover_[entry], kWidth), 0.0, 1.0);
    do {  // of a Cauchy distribution
      drawn.scale = scale_[entry] + kWidth * std::tan(kPi * (random.uniform() - 0.5));
    } while (drawn.scale <= 0.0);
    drawn.scale = std::min(drawn.scale, 1.0);
    return drawn;
  }

  void succeeded(const Draw& draw, double gain) {
    // What left a keep-out has gained a thousand: it tells no more than another success.
    const double weight = std::min(gain, 1.0);
    weights_ += weight;
    scales_ += weight * draw.scale;
    scales_squared_ += weight * draw.scale * draw.scale;
    crossovers_ += weight * draw.crossover;
    crossovers_squared_ += weight * draw.crossover * draw.crossover;
  }
  /// Lehmer means of a generation's successes take the place of the oldest entry.
  void end_generation() {
    if (weights_ > 0.0) {
      scale_[oldest_] = scales_squared_ / scales_;
      crossover_[oldest_] = crossovers_ > 0.0 ? crossovers_squared_ / crossovers_ : 0.0;
      oldest_ = (oldest_ + 1) % scale_.size();
    }
    weights_ = scales_ = scales_squared_ = crossovers_ = crossovers_squared_ = 0.0;
  }

 private:
  std::vector<double> scale_;
  std::vector<double> crossover_;
  std::size_t oldest_ = 0;
  double weights_ = 0.0;
  double scales_ = 0.0;
  double scales_squared_ = 0.0;
  double crossovers_ = 0.0;
  double crossovers_squared_ = 0.0;
};

void rank(std::vector<Candidate>& all) {
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.value < b.value; });
}

/// The population by rank, and those whom a better one has replaced.
class Generations {
 public:
  Generations(const Box& box, std::vector<Candidate> first, const SuccessHistoryParams& params,
              Random& random)
      : box_{box},
        all_{std::move(first)},
        history_{params.memory},
        best_share_{params.best_share},
        random_{random} {
    rank(all_);
  }

  void advance(SearchCounter& counter) {
    std::vector<Candidate> next = all_;
    for (std::size_t i = 0; i < all_.size() && !counter.spent(); ++i) {
      const History::Draw draw = history_.draw(random_);
      make_trial(i, draw);
      const double value = counter(trial_);
      if (value > all_[i].value) continue;
      if (value < all_[i].value) {
        history_.succeeded(draw, all_[i].value - value);
        replaced_.push_back(all_[i].point);
      }
      next[i] = {trial_, value};
    }
    all_ = std::move(next);
    rank(all_);
    history_.end_generation();
  }

  void shrink_to(std::size_t size) {
    if (all_.size() > size) all_.resize(size);
    while (replaced_.size() > all_.size()) {
      std::swap(replaced_[random_.index(replaced_.size())], replaced_.back());
      replaced_.pop_back();
    }
  }

 private:
  /// Towards one of the best, and along the difference of two others (current-to-pbest/1).
  void make_trial(std::size_t i, const History::Draw& draw) {
    const auto of_best = static_cast<std::size_t>(best_share_ * static_cast<double>(all_.size()));
    const std::vector<double>& best = all_[random_.index(std::max<std::size_t>(2, of_best))].point;
    std::size_t a = i;
    while (a == i) a = random_.index(all_.size());
    std::size_t b = i;
    while (b == i || b == a) b = random_.index(all_.size() + replaced_.size());
    const std::vector<double>& other = b < all_.size() ? all_[b].point : replaced_[b - all_.size()];
    const std::vector<double>& own = all_[i].point;
    const std::size_t always = random_.index(own.size());
    trial_ = own;
    for (std::size_t j = 0; j < own.size(); ++j) {
      if (j != always && !random_.chance(draw.crossover)) continue;
      trial_[j] += draw.scale * (best[j] - own[j] + all_[a].point[j] - other[j]);
      // Back inside, halfway to where it came from.
      if (trial_[j] < box_.low[j]) trial_[j] = 0.5 * (box_.low[j] + own[j]);
      if (trial_[j] > box_.high[j]) trial_[j] = 0.5 * (box_.high[j] + own[j]);
    }
  }

  const Box& box_;
  std::vector<Candidate> all_;
  std::vector<std::vector<double>> replaced_;
  History history_;
  double best_share_;
  Random& random_;
  std::vector<double> trial_;
};

}  // namespace

SearchResult success_history_evolution(const Objective& objective, const SearchSpace& space,
                                       const SuccessHistoryParams& params,
                                       const SearchBudget& budget, Random random) {
  constexpr std::size_t kPopulationMin = 4;
  SKEIN_ASSERT(params.population >= kPopulationMin && params.memory > 0);
  SearchCounter counter{objective, budget};
  std::vector<Candidate> first = first_population(space, params.population, counter, random);
  const std::size_t begun = counter.result().evaluations;
  if (first.size() < kPopulationMin) return counter.result();
  Generations generations{space.box, std::move(first), params, random};
  while (!counter.spent() && counter.go_on()) {
    generations.advance(counter);
    const double share = static_cast<double>(counter.result().evaluations - begun) /
                         static_cast<double>(budget.evaluations - begun);
    const double lost = share * static_cast<double>(params.population - kPopulationMin);
    generations.shrink_to(params.population - static_cast<std::size_t>(lost));
  }
  return counter.result();
}

}  // namespace skein::routes
