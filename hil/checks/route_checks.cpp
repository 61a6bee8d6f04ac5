// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include "motion.hpp"
#include "skein/checks/checks.hpp"

namespace skein::checks {

CheckResult check_routes(const RunRecord& record, const Limits& limits) {
  CheckResult result{"routes",
                     "as flown: over the site within " + fixed(limits.arrival_s, 1) +
                         " s of each other, " + fixed(limits.miss_m, 0) + " m and " +
                         fixed(degrees(limits.bearing_rad), 0) + " deg",
                     0,
                     "routes",
                     "",
                     {}};
  Worst miss;
  double bearing = 0.0;
  std::optional<double> early_s;  // offsets taken away: the earliest, and the latest
  std::optional<double> late_s;
  for (const RouteEnd& end : record.route_ends) {
    ++result.judged;
    const auto violate = [&](const std::string& what) {
      result.violations.push_back({end.vehicle, end.planned, vehicle_name(end.vehicle) + what});
    };
    const auto* recorded = recording_of(record, end.vehicle);
    const auto pass = recorded != nullptr
                          ? nearest_pass(recorded->track, end.site, end.planned, limits)
                          : std::nullopt;
    if (!pass) {
      violate("'s route ends " + at(end.planned) + ", but the track does not show it");
      continue;
    }
    const double off_s = to_seconds(pass->time - end.offset);
    early_s = std::min(early_s.value_or(off_s), off_s);
    late_s = std::max(late_s.value_or(off_s), off_s);
    miss.raise(pass->miss_m, pass->time);
    const double turned = std::abs(wrap_pi(pass->heading_rad - end.heading_rad));
    bearing = std::max(bearing, turned);
    if (pass->miss_m > limits.miss_m) {
      violate(" passed " + at(pass->time) + " " + fixed(pass->miss_m, 1) +
              " m from the site (limit " + fixed(limits.miss_m, 0) + " m)");
    }
    if (turned > limits.bearing_rad) {
      violate(" passed " + at(pass->time) + " " + fixed(degrees(turned), 1) +
              " deg off its bearing (limit " + fixed(degrees(limits.bearing_rad), 0) + " deg)");
    }
  }
  if (!early_s) return result;
  const double spread_s = *late_s - *early_s;
  if (spread_s > limits.arrival_s) {
    result.violations.push_back({kGroundStation, record.route_ends.front().planned,
                                 "the vehicles were over the site " + fixed(spread_s, 2) +
                                     " s apart, offsets allowed for (limit " +
                                     fixed(limits.arrival_s, 1) + " s)"});
  }
  result.measured = "spread " + fixed(spread_s, 2) + " s, worst " + fixed(miss.value, 1) + " m, " +
                    fixed(degrees(bearing), 1) + " deg";
  result.moment = miss.at;
  return result;
}

}  // namespace skein::checks
