// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "skein/base/assert.hpp"
#include "skein/routes/optimiser.hpp"

namespace skein::routes {

/// The only way from an optimiser to its objective: counts evaluations, keeps the best point.
class SearchCounter {
 public:
  SearchCounter(const Objective& objective, const SearchBudget& budget)
      : objective_{objective}, budget_{budget} {
    result_.value = std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] bool spent() const { return result_.evaluations >= budget_.evaluations; }
  [[nodiscard]] double share() const {
    return static_cast<double>(result_.evaluations) / static_cast<double>(budget_.evaluations);
  }
  /// Precondition: !spent().
  double operator()(std::span<const double> point) { return evaluate(point, 0.0); }
  /// Value plus punishment; the best point is the best without any.
  double evaluate(std::span<const double> point, double punishment) {
    SKEIN_ASSERT(!spent());
    ++result_.evaluations;
    const double value = objective_(point);
    if (value < result_.value) {
      result_.value = value;
      result_.best.assign(point.begin(), point.end());
    }
    return value + punishment;
  }
  /// After every generation: false where the caller wants no more.
  [[nodiscard]] bool go_on() {
    if (!budget_.go_on || budget_.go_on({result_.evaluations, result_.value})) return true;
    result_.cancelled = true;
    return false;
  }
  [[nodiscard]] bool cancelled() const { return result_.cancelled; }
  [[nodiscard]] const SearchResult& result() const { return result_; }

 private:
  const Objective& objective_;
  const SearchBudget& budget_;
  SearchResult result_;
};

/// A point and its value.
struct Candidate {
  std::vector<double> point;
  double value = std::numeric_limits<double>::infinity();
};

/// The space's first seeds, clamped, then uniform points; as far as the budget reaches.
[[nodiscard]] std::vector<Candidate> first_population(const SearchSpace& space, std::size_t size,
                                                      SearchCounter& counter, Random& random);
[[nodiscard]] std::vector<double> uniform_point(const Box& box, Random& random);

}  // namespace skein::routes
