// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace skein::ardupilot {

/// What has to be asked for beside the setpoint so that an error that lasts goes away: its integral
/// over time, slow against the autopilot's own loop, and limited.
class SteadyError {
 public:
  struct Params {
    double time_s = 8.0;        ///< an error that lasts that long is asked for whole
    double most = 5.0;          ///< of what is asked for, unit of the error
    double small_enough = 4.0;  ///< a greater one does not last: the autopilot is on its way
  };
  explicit SteadyError(const Params& params) : params_{params} {}

  /// `error`: of the setpoint less what is flown. Returns what to add to the setpoint.
  double step(double error, double seconds) {
    if (std::abs(error) <= params_.small_enough) {
      integral_ =
          std::clamp(integral_ + error * seconds / params_.time_s, -params_.most, params_.most);
    }
    return integral_;
  }
  void reset() { integral_ = 0.0; }

 private:
  Params params_;
  double integral_ = 0.0;
};

}  // namespace skein::ardupilot
