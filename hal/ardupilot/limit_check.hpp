// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/ardupilot/flight_limits.hpp"
#include "skein/base/time.hpp"

namespace skein::ardupilot {

/// Asks an autopilot for its limits, and compares them with what the vehicle's configuration asks
/// of it: as ParameterCheck does, but one that is never told keeps nobody on the ground.
class LimitCheck {
 public:
  LimitCheck(const VehicleSpec& vehicle, Airframe airframe);

  [[nodiscard]] std::vector<std::string_view> due(Instant now);
  void on_value(std::string_view name, float value);
  [[nodiscard]] bool good() const;
  [[nodiscard]] std::optional<std::string> poll_finding(Instant now);
  [[nodiscard]] std::vector<std::string> findings() const;

 private:
  struct Entry {
    const LimitParameter* parameter = nullptr;
    std::string_view name = {};  ///< by which it has answered
    std::optional<double> value = {};
    int asked = 0;
    std::optional<Instant> asked_at = {};
    std::optional<Instant> told_at = {};
  };
  /// Why nothing is flown with it, or nothing.
  [[nodiscard]] std::optional<std::string> refusal(const Entry& entry) const;

  VehicleSpec vehicle_;
  std::vector<Entry> entries_;
};

}  // namespace skein::ardupilot
