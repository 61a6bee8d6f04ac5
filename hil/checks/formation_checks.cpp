// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "motion.hpp"
#include "skein/base/contains.hpp"
#include "skein/checks/checks.hpp"
#include "skein/checks/formation_changes.hpp"

namespace skein::checks {

CheckResult check_orders(const RunRecord& record, const Limits& /*limits*/) {
  CheckResult result{"orders", "every order ends with all in their places", 0, "orders", "", {}};
  for (const FormationChange& change : formation_changes(record)) {
    if (change.correction) continue;
    ++result.judged;
    note_moment(result.moment, change.begun);
    if (change.held || !record.lost.empty()) continue;
    result.violations.push_back({kGroundStation, change.begun,
                                 "the order given " + at(change.begun) + " (change " +
                                     std::to_string(change.number) + ") never held"});
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
  Worst worst;
  for (const FormationChange& change : formation_changes(record)) {
    std::vector<Instant> reached;
    for (const auto& recorded : record.recordings) {
      for (const auto& event : recorded.events) {
        const auto* place = std::get_if<mission::event::PlaceReached>(&event.body);
        if (place != nullptr && place->number == change.number) reached.push_back(event.time);
      }
    }
    if (reached.size() < 2) continue;
    ++result.judged;
    const auto [first, last] = std::minmax_element(reached.begin(), reached.end());
    const double spread = to_seconds(*last - *first);
    worst.raise(spread, *last);
    if (spread <= limits.arrival_spread_s) continue;
    result.violations.push_back({kGroundStation, *last,
                                 "in change " + std::to_string(change.number) +
                                     " the last vehicle was in its place " + at(*last) + ", " +
                                     fixed(spread, 2) + " s after the first (limit " +
                                     fixed(limits.arrival_spread_s, 2) + " s)"});
  }
  result.measured = "largest spread " + fixed(worst.value, 2) + " s";
  result.moment = worst.at;
  return result;
}

namespace {

/// How far vehicles are from their places while formations hold.
class PlaceJudge {
 public:
  PlaceJudge(const Limits& limits, const std::string& place)
      : limit_m_{limits.place_rms_m},
        result_{"places",
                "while a formation holds every vehicle is within " + fixed(limit_m_, 2) +
                    " m rms of " + place,
                0,
                "vehicles in formations",
                "",
                {}} {}

  /// `offset_at` tells how far it is from its place in a state, if it has one then.
  template <class OffsetAt>
  void judge(const FormationChange& change, const recording::Recording& recorded,
             OffsetAt offset_at) {
    double squares = 0.0;
    std::size_t count = 0;
    for (std::size_t i = first_at(recorded.track, *change.held);
         i < recorded.track.size() && recorded.track[i].state.time < change.until; ++i) {
      const std::optional<Vec3> offset = offset_at(recorded.track[i].state);
      if (!offset) continue;
      squares += offset->squaredNorm();
      ++count;
    }
    if (count == 0) return;
    ++result_.judged;
    const double rms = std::sqrt(squares / static_cast<double>(count));
    worst_.raise(rms, *change.held);
    if (rms <= limit_m_) return;
    result_.violations.push_back({recorded.vehicle, *change.held,
                                  vehicle_name(recorded.vehicle) + " was " + fixed(rms, 2) +
                                      " m rms from its place in change " +
                                      std::to_string(change.number) + ", which held from " +
                                      at(*change.held) + " (limit " + fixed(limit_m_, 2) + " m)"});
  }

  CheckResult finish() {
    result_.measured = "worst " + fixed(worst_.value, 2) + " m rms";
    result_.moment = worst_.at;
    return result_;
  }

 private:
  double limit_m_;
  Worst worst_;
  CheckResult result_;
};

}  // namespace

CheckResult check_places(const RunRecord& record, const Limits& limits) {
  PlaceJudge judge{limits, "its place"};
  for (const FormationChange& change : formation_changes(record)) {
    if (!change.held) continue;
    for (const auto& [vehicle, place] : change.places) {
      const auto* recorded = recording_of(record, vehicle);
      if (recorded == nullptr || contains(record.lost, vehicle)) continue;
      judge.judge(change, *recorded, [&place = place](const VehicleState& s) {
        return std::optional<Vec3>{Vec3{s.x_m, s.y_m, s.z_m} - place};
      });
    }
  }
  return judge.finish();
}

CheckResult check_moving_places(const RunRecord& record, const Limits& limits) {
  PlaceJudge judge{limits, "its place, which moves"};
  for (const FormationChange& change : formation_changes(record)) {
    if (!change.held) continue;
    for (const auto& recorded : record.recordings) {
      if (contains(record.lost, recorded.vehicle)) continue;
      judge.judge(change, recorded, [&recorded](const VehicleState& s) -> std::optional<Vec3> {
        const auto* plan = plan_in_force(recorded.plans, s.time);
        if (plan == nullptr) return std::nullopt;
        const Pose2 place = plan_pose(plan->plan, plan_distance_m(plan->plan, s.time));
        return Vec3{s.x_m - place.x_m, s.y_m - place.y_m, 0.0};
      });
    }
  }
  return judge.finish();
}

}  // namespace skein::checks
