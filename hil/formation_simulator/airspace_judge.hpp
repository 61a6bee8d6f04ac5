// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "skein/base/attitude.hpp"
#include "skein/formation/limits.hpp"
#include "skein/hil/formation_simulator.hpp"

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
  AirspaceJudge(const Limits& limits, std::vector<VehicleId> vehicles);

  struct Body {
    Vec3 position_m = Vec3::Zero();
    bool airborne = false;
    double off_m = 0.0;  ///< from its reference
  };
  void step(const std::vector<Body>& bodies, Instant now);

  [[nodiscard]] std::vector<FormationViolation> take() { return std::move(violations_); }
  [[nodiscard]] double least_m() const { return least_m_; }
  [[nodiscard]] double farthest_m() const { return farthest_m_; }

 private:
  void see_pair(std::size_t a, std::size_t b, const std::vector<Body>& bodies, Instant now);
  [[nodiscard]] std::string name(std::size_t i) const;

  Limits limits_;
  std::vector<VehicleId> vehicles_;
  std::vector<Body> before_;
  std::set<std::pair<std::size_t, std::size_t>> told_;
  std::vector<FormationViolation> violations_;
  double least_m_;
  double farthest_m_ = 0.0;
};

}  // namespace skein::hil
