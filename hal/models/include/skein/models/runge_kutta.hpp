// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace skein::models {

/// One step of the classical Runge-Kutta method of order four: the state after `seconds` of
/// dx/dt = f(x), with all inputs of f held. Precondition: seconds > 0.
template <class Vector, class Derivative>
[[nodiscard]] Vector runge_kutta_step(const Vector& x, double seconds, const Derivative& f) {
  const Vector k1 = f(x);
  const Vector k2 = f(Vector{x + (0.5 * seconds) * k1});
  const Vector k3 = f(Vector{x + (0.5 * seconds) * k2});
  const Vector k4 = f(Vector{x + seconds * k3});
  return x + (seconds / 6.0) * (k1 + 2.0 * (k2 + k3) + k4);
}

}  // namespace skein::models
