// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/checks/run_record.hpp"

/// Judges of a recorded mission. They share no code with the planners and agents that they judge:
/// paths are integrated and distances taken here anew. Each is a pure function of the record.
namespace skein::checks {

struct Violation {
  VehicleId vehicle;
  Instant time{};
  std::string sentence;  ///< who, when, by how much, against which limit
};

struct CheckResult {
  std::string name;
  std::string requirement;  ///< the rule with its limit
  std::size_t judged = 0;   ///< how many things: a check that judged nothing proves nothing
  std::string judged_what;  ///< "tracks", "deliveries"
  std::string measured;     ///< the worst figure found, empty where there is none
  std::vector<Violation> violations;
  /// What would be a violation, but was proven to be beyond what the vehicle can do.
  std::vector<Violation> excused = {};
  /// When `measured` was at its worst; of a check without a figure, when the last thing that it
  /// judged began. None where nothing has a time.
  std::optional<Instant> moment = {};
  [[nodiscard]] bool held() const { return violations.empty(); }
};

/// Every vehicle left a track without gaps and at least one plan.
[[nodiscard]] CheckResult check_recordings(const RunRecord& record, const Limits& limits);

/// Plans exactly: no segment and no hold turns tighter than the turn radius. Tracks of planes:
/// heading change over air distance, within Limits::turn_share; of those that an autopilot flew,
/// who rolls past its bank and back, it is measured only.
[[nodiscard]] CheckResult check_turn_radius(const RunRecord& record, const Limits& limits);
/// A plan starts where the one that it replaces is at that time; the first where the vehicle is.
[[nodiscard]] CheckResult check_continuity(const RunRecord& record, const Limits& limits);
/// No vehicle flew, or planned to fly, further than its range, or flew on an empty battery. What it
/// lands with, its last flight, is a glide: as long as its height lets it be, twice its approach,
/// and two laps.
[[nodiscard]] CheckResult check_range(const RunRecord& record, const Limits& limits);
/// No plan and no track enters a hazard from Limits::hazard_reaction_s after it is known on.
/// Excused is who was inside at that moment, or so near that the tightest turn to either side, in
/// the wind that there was from then on, led into it; and only for the time of the shortest way out
/// and Limits::hazard_leaving_s more. Coming back is not excused. Hazards known before the mission
/// excuse nothing.
[[nodiscard]] CheckResult check_hazards(const RunRecord& record, const Limits& limits);

/// Nobody is outside of the fence, to its side or above, until it lands. No result without a fence.
[[nodiscard]] std::optional<CheckResult> check_fence(const RunRecord& record);

/// Survey before deliveries before assessments, with the site's wait between the last two (eq. 14).
/// Not judged is an assessment that began when the operator had been told that the delivery may
/// have been flown, against one who flies it again afterwards.
[[nodiscard]] CheckResult check_precedence(const RunRecord& record, const Limits& limits);
/// Tasks are leased and flown only by vehicles that can do their kind.
[[nodiscard]] CheckResult check_capabilities(const RunRecord& record, const Limits& limits);
/// No vehicle flew more deliveries than it carried loads.
[[nodiscard]] CheckResult check_loads(const RunRecord& record, const Limits& limits);
/// At most one unexpired lease a task, and no vehicle with unexpired leases from two leaders.
[[nodiscard]] CheckResult check_leases(const RunRecord& record, const Limits& limits);
/// A delivery starts only after the ground station authorised its round and site, and the vehicle
/// heard of it.
[[nodiscard]] CheckResult check_authorisation(const RunRecord& record, const Limits& limits);
/// No delivery begins once its vehicle has heard that the operator refuses it, or takes his grant
/// back. No result where nobody has heard such a thing.
[[nodiscard]] std::optional<CheckResult> check_taken_back(const RunRecord& record);
/// A vehicle that was told to hold or to come home takes up nothing until it is told to go on,
/// whatever its program forgets; but where only another vehicle could tell it which orders stand,
/// which may have missed them.
[[nodiscard]] CheckResult check_standing_orders(const RunRecord& record, const Limits& limits);
/// No delivery is flown twice.
[[nodiscard]] CheckResult check_single_delivery(const RunRecord& record, const Limits& limits);
/// Every task of every site is done; what the operator refused, and what waits for it, is excused.
[[nodiscard]] CheckResult check_completion(const RunRecord& record, const Limits& limits);

/// No two vehicles below the horizontal and the vertical limit at once, tracks interpolated.
/// Cost: proportional to the length of the mission and to the pairs that come near each other.
[[nodiscard]] CheckResult check_separation(const RunRecord& record, const Limits& limits);

/// As flown: time, miss distance and bearing of every delivery; simultaneous ones within
/// Limits::arrival_s of each other, spaced ones of their slots.
[[nodiscard]] CheckResult check_deliveries(const RunRecord& record, const Limits& limits);
/// As flown: start, dwell and radius of every arc.
[[nodiscard]] CheckResult check_surveys(const RunRecord& record, const Limits& limits);
[[nodiscard]] CheckResult check_assessments(const RunRecord& record, const Limits& limits);

/// As flown: copters have done a task of each kind of Limits::copters_fly.
[[nodiscard]] CheckResult check_copters(const RunRecord& record, const Limits& limits);

/// Every order to a formation ends with all in their places, unless vehicles were lost.
[[nodiscard]] CheckResult check_orders(const RunRecord& record, const Limits& limits);
/// In each change the vehicles reach their places within Limits::arrival_spread_s of each other.
[[nodiscard]] CheckResult check_arrivals(const RunRecord& record, const Limits& limits);
/// While a formation holds, root mean square distance of each vehicle's track from its place.
[[nodiscard]] CheckResult check_places(const RunRecord& record, const Limits& limits);

/// While planes hold a formation, root mean square distance of each vehicle's track from where its
/// plan has it at that moment.
[[nodiscard]] CheckResult check_moving_places(const RunRecord& record, const Limits& limits);

/// As flown: every route that was planned before the mission ends over the site on its bearing, and
/// all do within Limits::arrival_s of each other, offsets allowed for.
[[nodiscard]] CheckResult check_routes(const RunRecord& record, const Limits& limits);

/// Those of planned routes: of recordings, turns, continuity, range, hazards, separation, and the
/// one above.
[[nodiscard]] std::vector<CheckResult> judge_routes(const RunRecord& record, const Limits& limits);

/// Those of a formation of multirotors.
[[nodiscard]] std::vector<CheckResult> judge_formation(const RunRecord& record,
                                                       const Limits& limits);

/// Those of planes in formation along a track.
[[nodiscard]] std::vector<CheckResult> judge_tracks(const RunRecord& record, const Limits& limits);

/// Those of a coalition: all but the six above, in their order.
[[nodiscard]] std::vector<CheckResult> judge(const RunRecord& record, const Limits& limits);

}  // namespace skein::checks
