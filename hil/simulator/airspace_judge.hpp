// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "skein/formation/limits.hpp"
#include "skein/hil/formation_runs.hpp"

namespace skein::hil {

/// Sees the bodies at every control step and nothing else. Between two steps each flies straight on
/// for it: with at most 8 m/s^2 this is true to 0.4 mm at 50 Hz.
class AirspaceJudge {
 public:
  struct Limits {
    formation::Separation separation;
    double ceiling_m = 0.0;
    double tracking_m = 0.0;  ///< what references allow for
  };
  explicit AirspaceJudge(const Limits& limits) : limits_{limits} {}

  /// Always the same bodies.
  void step(const std::vector<SeenBody>& bodies, Instant now);

  [[nodiscard]] std::vector<FormationViolation> take() { return std::move(violations_); }
  [[nodiscard]] double least_m() const { return least_m_; }
  [[nodiscard]] double farthest_m() const { return farthest_m_; }

 private:
  struct Since {
    std::optional<Instant> unled;
    std::optional<Instant> adrift;
  };
  /// One comes down on another, which no program had led for as long.
  [[nodiscard]] bool comes_down_on(std::size_t one, std::size_t other) const {
    return since_[one].adrift && since_[other].unled && *since_[other].unled <= *since_[one].adrift;
  }
  void see_pair(std::size_t a, std::size_t b, const std::vector<SeenBody>& bodies, Instant now);

  Limits limits_;
  std::vector<SeenBody> before_;
  using Pair = std::pair<std::size_t, std::size_t>;
  std::set<Pair> told_;
  std::vector<Since> since_;  ///< of each body
  std::set<Pair> met_unled_;  ///< too near since one came down on the other
  std::vector<FormationViolation> violations_;
  double least_m_ = std::numeric_limits<double>::infinity();
  double farthest_m_ = 0.0;
};

}  // namespace skein::hil
