// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "skein/base/time.hpp"

namespace skein {

/// How a vehicle keeps clear of aircraft that are not of the team (docs/protocol.md). Each works it
/// out by itself; the numbers are the same for all of a team, since people are to know them.
struct TrafficParams {
  double horizontal_m = 600.0;  ///< closer than this to the side ...
  double vertical_m = 150.0;    ///< ... an aircraft is to be at least that far apart in height
  /// So far ahead that is looked at; 0: it is not.
  Duration look_ahead = std::chrono::seconds{90};
  double floor_m = 30.0;        ///< above the origin: nobody gives way downwards below it
  double ceiling_m = 10'000.0;  ///< nor upwards above this
};

}  // namespace skein
