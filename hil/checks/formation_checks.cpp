// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "motion.hpp"
#include "skein/base/contains.hpp"
#include "skein/checks/checks.hpp"

namespace skein::checks {
namespace {

using mission::EventKind;

/// A change of formation, as the ground station's events tell it.
struct Ordered {
  std::uint32_t number = 0;
  Instant begun{};
  std::optional<Instant> held;     ///< from then on all are in place
  Instant until = Instant::max();  ///< when the next one begins
  bool correction = false;         ///< of drift: the places are those before it
};

std::vector<Ordered> ordered(const RunRecord& record) {
  std::vector<Ordered> all;
  for (const auto& event : record.ground_events) {
    if (event.vehicle != kGroundStation) continue;
    if (event.kind == EventKind::change_begun) {
      if (!all.empty()) all.back().until = event.time;
      const bool correction = event.text.starts_with("correction");
      all.push_back({static_cast<std::uint32_t>(event.value), event.time, {}, {}, correction});
      all.back().until = Instant::max();
    } else if (event.kind == EventKind::formation_held && !all.empty() && !all.back().held) {
      all.back().held = event.time;
    }
  }
  return all;
}

std::map<VehicleId, Vec3> places_of(const RunRecord& record, std::uint32_t change) {
  std::map<VehicleId, Vec3> places;
  for (const auto& place : record.places) {
    if (place.change == change) places[place.vehicle] = place.place_m;
  }
  return places;
}

}  // namespace

CheckResult check_orders(const RunRecord& record, const Limits& /*limits*/) {
  CheckResult result{"orders", "every order ends with all in their places", 0, "orders", "", {}};
  for (const Ordered& order : ordered(record)) {
    if (order.correction) continue;
    ++result.judged;
    if (order.held || !record.lost.empty()) continue;
    result.violations.push_back({kGroundStation, order.begun,
                                 "the order given " + at(order.begun) + " (change " +
                                     std::to_string(order.number) + ") never held"});
  }
  return result;
}

CheckResult check_arrivals(const RunRecord& record, const Limits& limits) {
  CheckResult result{"arrivals",
                     "in each change all reach their places within " +
                         fixed(limits.arrival_spread_s, 2) + " s of each other",
                     0,
                     "changes",
                     "",
                     {}};
  double worst = 0.0;
  for (const Ordered& order : ordered(record)) {
    const auto places = places_of(record, order.number);
    std::vector<Instant> reached;
    for (const auto& [vehicle, place] : places) {
      const auto* recorded = recording_of(record, vehicle);
      if (recorded == nullptr) continue;
      for (const auto& event : recorded->events) {
        if (event.kind == EventKind::place_reached &&
            static_cast<std::uint32_t>(event.value) == order.number) {
          reached.push_back(event.time);
        }
      }
    }
    if (reached.size() < 2) continue;
    ++result.judged;
    const auto [first, last] = std::minmax_element(reached.begin(), reached.end());
    const double spread = to_seconds(*last - *first);
    worst = std::max(worst, spread);
    if (spread <= limits.arrival_spread_s) continue;
    result.violations.push_back({kGroundStation, *last,
                                 "in change " + std::to_string(order.number) +
                                     " the last vehicle was in its place " + at(*last) + ", " +
                                     fixed(spread, 2) + " s after the first (limit " +
                                     fixed(limits.arrival_spread_s, 2) + " s)"});
  }
  result.measured = "largest spread " + fixed(worst, 2) + " s";
  return result;
}

CheckResult check_places(const RunRecord& record, const Limits& limits) {
  CheckResult result{"places",
                     "while a formation holds every vehicle is within " +
                         fixed(limits.place_rms_m, 2) + " m rms of its place",
                     0,
                     "vehicles in formations",
                     "",
                     {}};
  double worst = 0.0;
  std::map<VehicleId, Vec3> places;
  for (const Ordered& order : ordered(record)) {
    if (!order.correction) places = places_of(record, order.number);
    if (!order.held) continue;
    for (const auto& [vehicle, place] : places) {
      const auto* recorded = recording_of(record, vehicle);
      if (recorded == nullptr || contains(record.lost, vehicle)) continue;
      double squares = 0.0;
      std::size_t count = 0;
      for (std::size_t i = first_at(recorded->track, *order.held);
           i < recorded->track.size() && recorded->track[i].state.time < order.until; ++i) {
        const VehicleState& s = recorded->track[i].state;
        squares += (Vec3{s.x_m, s.y_m, s.z_m} - place).squaredNorm();
        ++count;
      }
      if (count == 0) continue;
      ++result.judged;
      const double rms = std::sqrt(squares / static_cast<double>(count));
      worst = std::max(worst, rms);
      if (rms <= limits.place_rms_m) continue;
      result.violations.push_back(
          {vehicle, *order.held,
           vehicle_name(vehicle) + " was " + fixed(rms, 2) + " m rms from its place in change " +
               std::to_string(order.number) + ", which held from " + at(*order.held) + " (limit " +
               fixed(limits.place_rms_m, 2) + " m)"});
    }
  }
  result.measured = "worst " + fixed(worst, 2) + " m rms";
  return result;
}

}  // namespace skein::checks
