// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "avoidance_margin.hpp"
#include "skein/base/result.hpp"
#include "skein/planning/arrival.hpp"

namespace skein::planning {

/// The least length from `length_m` on that path_of_length can fly, whatever the range; nothing
/// where a hazard is in reach of it. Precondition: as surely_flyable.
[[nodiscard]] std::optional<double> least_without_hazards(const AvoidanceParams& params,
                                                          const Transit& transit, double shortest_m,
                                                          double length_m);

/// Which lengths of one transit can be flown around its hazards, for who asks more than once: the
/// way around them is looked for once.
class TransitLengths {
 public:
  /// The hazards of the transit must outlive it; `shortest` is its find_clear_path.
  TransitLengths(const Transit& transit, ClearPath shortest);
  TransitLengths(const TransitLengths&) = delete;
  TransitLengths& operator=(const TransitLengths&) = delete;
  TransitLengths(TransitLengths&& other) noexcept;
  TransitLengths& operator=(TransitLengths&& other) noexcept;
  ~TransitLengths();

  /// As least_length_from.
  [[nodiscard]] Result<double> least_from(double length_m);
  /// `length_m` where it can be flown; else a length, greater by 1e-7 m at least, before which none
  /// from there on can; infinite where none can within the range. It is itself one that can be
  /// flown where that is asked for `exactly`; otherwise perhaps one that was found not to be, for
  /// far less work: whoever comes to it asks again, and hears of a greater one.
  [[nodiscard]] double none_before_m(double length_m, bool exactly);

 private:
  struct Found;

  double length_max_m_;
  std::unique_ptr<Found> found_;
};

}  // namespace skein::planning
