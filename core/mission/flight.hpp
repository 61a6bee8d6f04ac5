// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "fence_way.hpp"
#include "skein/domain/fence.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/path.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mission/vehicle_agent.hpp"

namespace skein::mission {

/// The plan that the vehicle is following, and the ways to change it. Every new plan continues the
/// old one from where that is now, so control never sees a jump.
class Flight {
 public:
  Flight(const VehicleSpec& vehicle, planning::AvoidanceParams avoidance, std::vector<Vec2> search);

  /// The first plan: from where the vehicle is, which is its home, along the search route.
  void start(const Pose2& pose, const std::vector<Hazard>& hazards, double range_m, Instant now);
  /// The first plan is that path, from its own start time on; where it begins is home.
  void start_route(const TimedPath& route);
  /// A path that begins where this plan is then.
  void fly(const TimedPath& timed);
  /// Straight on from there, wherever the plan is.
  void begin_at(const Pose2& pose, Instant now);
  /// The same of a way onto a route and the route.
  void fly_route(const TimedPath& timed, Instant now);
  [[nodiscard]] bool en_route(Instant t) const { return en_route_ && t < plan_.timed.end_time(); }
  [[nodiscard]] bool started() const { return plan_.number > 0; }

  /// Where the plan has the vehicle at `t`. Precondition of these: started().
  [[nodiscard]] Pose2 pose_at(Instant t) const { return plan_.timed.pose_at(t); }
  [[nodiscard]] const FlightPlan& plan() const { return plan_; }

  /// Of the turns of all plans from now on; the vehicle's own to begin with. Not below its turn
  /// radius.
  void set_planning_radius(double radius_m);

  /// Searches, holds and ways home keep within it where they can; there is none to begin with.
  void set_fence(const Fence& fence) { fence_ = fence; }

  /// Of all plans from now on but those that were planned by somebody else: their times count with
  /// that wind (TimedPath::wind_east_mps).
  void set_wind(const Vec2& wind_mps) { wind_mps_ = wind_mps; }

  /// The first plan goes straight on for so long: an autopilot that circled while it waited levels
  /// out and has turned to nothing yet.
  void set_lead_in(Duration lead_in) { lead_in_ = lead_in; }

  /// A new path starts so far ahead: time for control to take it over and to roll, before it turns.
  void set_handover(Duration handover) { handover_ = handover; }
  [[nodiscard]] Duration handover() const { return handover_; }

  /// How a path is flown: `speed_mps` is over the ground as far as `on_time_m`, where it arrives as
  /// if there were no wind; beyond it, where a wind is set, through the air.
  struct Pace {
    double speed_mps = 0.0;
    double on_time_m = 0.0;                  ///< along `next`
    std::optional<Instant> on_time_at = {};  ///< then; without it as the mean speed has it
  };
  /// The present plan until `at`, then `next` (which starts at pose_at(at)), then `tail`; at
  /// cruise speed where no pace is given. False, and nothing changed, when that has too many
  /// pieces.
  bool continue_with(Instant at, const Path& next, double tail_curvature_per_m, Instant now,
                     const std::optional<Pace>& pace = std::nullopt);
  /// The same without a next path: an orbit from here on, or from where there is room for one.
  void hold(const std::vector<Hazard>& hazards, Instant now);
  /// What is flown stays as it is, but for the orbit at its end, or from here on: by turns as they
  /// are planned now.
  void orbit_anew(const std::vector<Hazard>& hazards, Instant now);
  /// Along what is left of the search route, as far as `range_m` lasts there and home again, then
  /// an orbit where that ends.
  void search(const std::vector<Hazard>& hazards, double range_m, Instant now);
  void fly_home(const std::vector<Hazard>& hazards, Instant now);
  /// Home by that way, which begins where this plan is then. False, and nothing changed, when that
  /// has too many pieces.
  bool return_along(const TimedPath& way, Instant now);
  /// The plan's height from now on goes to that, from the vehicle's layer; its path and times stay,
  /// and whatever is planned next is flown there, too.
  void change_height(double offset_m, Instant now);
  /// It is there already, or is to climb there as fast as it can.
  void climb_from(double offset_m);
  /// Where the first plan began, which is home.
  [[nodiscard]] const Pose2& first_pose() const { return first_pose_; }
  [[nodiscard]] Vec2 home() const { return first_pose_.position(); }
  /// It is in its orbit at home.
  [[nodiscard]] bool at_home(Instant t) const {
    return homing_ && tries_home_at_ == Instant::max() && t >= plan_.timed.end_time();
  }
  /// When fly_home() is to be tried again, as hazards have left no way: where it is, it orbits
  /// until then.
  [[nodiscard]] Instant tries_home_at() const { return tries_home_at_; }
  /// The same plan, from which it lands.
  void land(const Landing& landing);
  [[nodiscard]] bool landing() const { return plan_.lands; }
  /// An orbit at that place, where it can be reached clear of hazards and `range_m` lasts there and
  /// home again; else, and without a place, here. The search goes on from there later.
  void stand_by(SiteId site, const std::optional<Vec2>& place, const std::vector<Hazard>& hazards,
                double range_m, Instant now);
  [[nodiscard]] bool searching() const { return searching_; }
  /// When search() is to be called again, as a plan has no room for the whole of the route.
  [[nodiscard]] Instant search_goes_on_at() const { return search_goes_on_at_; }
  [[nodiscard]] bool homing() const { return homing_; }
  /// Nobody counts with what is flown: a search, an orbit of hold() or stand_by(), the vehicle's
  /// own way home.
  [[nodiscard]] bool at_will() const { return at_will_; }
  /// A hazard may lie on the orbit that this plan ends in, though not on its way there. Asked for
  /// once.
  void set_orbit_barred() { orbit_barred_ = true; }
  [[nodiscard]] bool poll_orbit_barred() { return std::exchange(orbit_barred_, false); }
  /// The site that stand_by() was told of, while that is flown.
  [[nodiscard]] std::optional<SiteId> stands_by() const { return stands_by_; }
  /// The length of the way from there to where the first plan began, clear of hazards and within
  /// the fence where it can be; 0 where the vehicle needs not come home.
  [[nodiscard]] double way_home_m(const Pose2& from, const std::vector<Hazard>& hazards) const;

  /// The curvature of an orbit at that pose that keeps its distance from the hazards and the fence,
  /// to the left where it can; where none does, of the one that keeps most, or leads out least.
  [[nodiscard]] double hold_curvature(const Pose2& at, const std::vector<Hazard>& hazards) const;

  /// The curvature of the orbit after an arc around a site: the arc's own where hazards and the
  /// fence leave room for a whole lap on it, else one that `path` is led on to; none where hazards
  /// leave room for none.
  [[nodiscard]] std::optional<double> orbit_after(Path& path, double arc_curvature_per_m,
                                                  const std::vector<Hazard>& hazards) const;

  /// Does what is left of the plan, one lap of its orbit included, stay outside the safety circles
  /// of the hazards?
  [[nodiscard]] bool keeps_clear(const std::vector<Hazard>& hazards, Instant now) const;

  /// Does that way stay outside the safety circles of the hazards, or as far outside the hazards as
  /// where it begins?
  [[nodiscard]] bool keeps_off(const Path& way, const std::vector<Hazard>& hazards) const;
  /// Need the vehicle enter no hazard from there, turning at the planning radius?
  [[nodiscard]] bool misses(const Pose2& from, const std::vector<Hazard>& hazards) const;

  /// The newest plan, once.
  [[nodiscard]] std::optional<FlightPlan> poll_plan();

 private:
  struct Orbit {
    double curvature_per_m = 0.0;
    double clearance_m = 0.0;  ///< from the nearest hazard or the fence, as far as it matters
  };
  /// Does an orbit of that curvature from there stay outside the safety circles of the hazards?
  [[nodiscard]] bool orbit_keeps_clear(const Pose2& from, double curvature_per_m,
                                       const std::vector<Hazard>& hazards) const;
  /// The way to where there is room for an orbit, where there is none at the path's end, if the
  /// path then has no more than `pieces_max`. The orbit's curvature.
  [[nodiscard]] double append_hold(Path& path, const std::vector<Hazard>& hazards,
                                   std::size_t pieces_max = kPathSegmentsMax) const;
  [[nodiscard]] Orbit best_orbit(const Pose2& at, const std::vector<Hazard>& hazards) const;
  /// Where the vehicle is inside a hazard that has just become known, or no turn misses it: the
  /// tightest turn to either side, and straight on, that is inside for the shortest. Empty
  /// elsewhere.
  [[nodiscard]] Path forced_way(const Pose2& from, const std::vector<Hazard>& hazards) const;
  /// To that point, around corners of the fence where it must, passing on in the direction of
  /// `next`. None where hazards leave no way.
  [[nodiscard]] std::optional<FenceWay> way_to(const Pose2& from, const Vec2& point,
                                               const std::optional<Vec2>& next,
                                               const std::vector<Hazard>& hazards) const;
  /// The same over these points.
  [[nodiscard]] std::optional<FenceWay> way_over(const std::vector<Vec2>& points, const Pose2& from,
                                                 const std::optional<Vec2>& next,
                                                 const std::vector<Hazard>& hazards) const;
  [[nodiscard]] bool stays_in(const FenceWay& way) const;
  // The new path takes over from the present plan at `at`.
  void hold_from(Instant at, const std::vector<Hazard>& hazards, Instant now);
  void search_from(Instant at, const std::vector<Hazard>& hazards, double range_m, Instant now);
  struct Followed {
    bool reaches_last = false;  ///< the plan leads to the last waypoint
    bool full = false;          ///< it has no room for more of them
  };
  Followed follow(Instant at, const std::vector<Vec2>& waypoints,
                  const std::vector<Hazard>& hazards, double range_m, Instant now);
  /// How many pieces a path may have that begins at `at`.
  [[nodiscard]] std::size_t pieces_after(Instant at, Instant now) const;
  /// The present plan until `way` begins, then `way` at its own times, with which others count: in
  /// the wind that it was planned with; where with none, over the ground, from the present plan's
  /// mean speed on, and the wind that was set is its hold's alone. As continue_with().
  bool continue_as_told(const TimedPath& way, Instant now);
  /// A plan without a path yet, in the wind that was set.
  [[nodiscard]] TimedPath begun(Instant start, double speed_mps, double tail_curvature_per_m) const;
  void take_up(const TimedPath& timed, Instant now);
  void replace(const TimedPath& timed);
  void pass_waypoints(Instant now);

  VehicleSpec vehicle_;
  planning::AvoidanceParams avoidance_;
  Fence fence_;
  std::vector<Vec2> search_;  ///< what is left of the route; its last point is never dropped
  std::vector<double>
      search_marks_;  ///< distances along the search plan at which a point is passed
  Pose2 first_pose_;
  Vec2 wind_mps_{0.0, 0.0};
  Duration handover_ = std::chrono::milliseconds{200};
  Duration lead_in_{};
  FlightPlan plan_;
  bool searching_ = false;
  Instant search_goes_on_at_ = Instant::max();
  bool homing_ = false;
  bool at_will_ = false;
  Instant tries_home_at_ = Instant::max();
  std::optional<SiteId> stands_by_;
  bool en_route_ = false;
  bool orbit_barred_ = false;
  bool fresh_ = false;
};

}  // namespace skein::mission
