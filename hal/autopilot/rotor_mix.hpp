// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace skein::autopilot {

/// What each rotor gives, as a share of its greatest: tilting moments come first, then the mean
/// thrust, then yaw, each as far as the limits leave room.
template <std::size_t Rotors>
[[nodiscard]] std::array<double, Rotors> fitted_shares(double mean_wanted,
                                                       const std::array<double, Rotors>& tilt,
                                                       const std::array<double, Rotors>& yaw) {
  const auto [least, most] = std::minmax_element(tilt.begin(), tilt.end());
  // More than the whole range of a rotor cannot be had.
  const double scale = std::min(1.0, 1.0 / std::max(*most - *least, 1e-9));
  const double mean = std::clamp(mean_wanted, -scale * *least, 1.0 - scale * *most);
  double room = 1.0;  // share of the yaw moment that fits
  for (std::size_t i = 0; i < Rotors; ++i) {
    const double base = mean + scale * tilt[i];
    if (yaw[i] > 0.0) room = std::min(room, std::max(0.0, 1.0 - base) / yaw[i]);
    if (yaw[i] < 0.0) room = std::min(room, std::max(0.0, base) / -yaw[i]);
  }
  std::array<double, Rotors> shares{};
  for (std::size_t i = 0; i < Rotors; ++i) {
    shares[i] = std::clamp(mean + scale * tilt[i] + room * yaw[i], 0.0, 1.0);
  }
  return shares;
}

}  // namespace skein::autopilot
