// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/base/time.hpp"

namespace skein::coalition {

/// The numbers of the contract net (Wang 2022, 5.1 and eq. 20-21).
struct ProtocolParams {
  double radio_range_m = 1500.0;  ///< r_n: who leaves it before t_e does not bid
  /// Relay orbits: who has nothing else to do stays this near to a site whose leader lacks
  /// vehicles; 0: it searches on. Less than a radio's range by what both orbits take of it.
  double relay_orbit_m = 0.0;
  Duration message_delay = std::chrono::milliseconds{200};    ///< dt_d, the longest
  Duration allocation_time = std::chrono::milliseconds{500};  ///< t_TA
  Duration margin = std::chrono::milliseconds{300};           ///< delta_t

  Duration lease = std::chrono::seconds{15};               ///< how far a renewal reaches
  Duration heartbeat = std::chrono::seconds{1};            ///< of leader and members
  Duration silence = std::chrono::seconds{5};              ///< after it a member counts as lost
  Duration clock_guard = std::chrono::milliseconds{500};   ///< largest difference of two clocks
  Duration monitoring_interval = std::chrono::seconds{5};  ///< between attempts
  /// The longest that two parts of the team that are both at work may be unable to hear each other.
  /// A leader that has not heard half of its electors for that long starts anew without them, and a
  /// site whose leader was not heard for that long is taken up by another vehicle.
  Duration cut_max = std::chrono::seconds{60};
  Duration authorisation_lead = std::chrono::seconds{8};  ///< what the operator has at least

  // Separation, as all vehicles of a team watch it in flight: both of a pair go by the same.
  double separation_horizontal_m = 20.0;  ///< two vehicles closer than this ...
  double separation_vertical_m = 5.0;     ///< ... are to be at least that far apart in height
  /// So far ahead their ways are looked at; 0: they are not watched.
  Duration separation_look_ahead = std::chrono::seconds{20};
  double separation_floor_m = 30.0;  ///< above the origin; nobody gives way downwards below it
  double separation_ceiling_m = 10'000.0;  ///< nor upwards above this

  /// delta_max (eq. 20): from the announcement to the standing coalition.
  [[nodiscard]] Duration formation_time() const {
    return 3 * message_delay + allocation_time + margin;
  }
  /// The lease of an award. It is short, so that a member whose confirmation was lost frees its
  /// tasks soon; renewals prolong it, once leader and members have heard each other twice.
  [[nodiscard]] Duration first_lease() const {
    return 4 * message_delay + 2 * heartbeat + std::chrono::seconds{1};
  }
  /// How long the members of a lost leader hold its plan, after their leases, for a successor.
  [[nodiscard]] Duration succession_time() const { return 2 * silence + clock_guard; }
};

}  // namespace skein::coalition
