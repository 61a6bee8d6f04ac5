// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "skein/base/geometry.hpp"

namespace skein::hil::radio {

/// Where many nodes are, side by side: who is near is asked for with every message that is sent.
class Positions {
 public:
  explicit Positions(std::size_t count) : x_m_(count), y_m_(count) {}

  void set(std::size_t node, const Vec2& position) {
    x_m_[node] = position.x();
    y_m_[node] = position.y();
  }
  /// Those within that range of a node, itself among them, in order.
  void find_near(std::size_t node, double range_m, std::vector<std::uint32_t>& near) const {
    near.resize(x_m_.size());
    std::size_t found = 0;
    for (std::size_t i = 0; i < x_m_.size(); ++i) {
      const double dx_m = x_m_[i] - x_m_[node];
      const double dy_m = y_m_[i] - y_m_[node];
      near[found] = static_cast<std::uint32_t>(i);  // no branch: it could not be foretold
      found += static_cast<std::size_t>(dx_m * dx_m + dy_m * dy_m <= range_m * range_m);
    }
    near.resize(found);
  }

 private:
  std::vector<double> x_m_;
  std::vector<double> y_m_;
};

}  // namespace skein::hil::radio
