// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cmath>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/coalition/protocol_params.hpp"
#include "skein/domain/path.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mission/events.hpp"
#include "skein/mission/height_band.hpp"
#include "skein/mission/messages.hpp"

namespace skein::mission {

/// That other one is, or is about to be, nearer than the minima.
struct SeparationConflict {
  VehicleId other;
  VehicleId gives_way;  ///< 0: nobody can
};

/// Looks in flight whether others come too near, from what they tell of themselves, and has this
/// vehicle give way by its height where the rule says so (docs/protocol.md). Others are taken to
/// fly straight on at their height. Who gives way is worked out from what both sides know:
///
/// 1. a vehicle that a pilot flies, that is silent, or that does not watch keeps its height;
/// 2. one that executes a task keeps it before one that does not;
/// 3. else the lower number does.
///
/// Where the other one does not begin to within kPatience, this one gives way after all. Nothing is
/// known of vehicles in other layers while nothing is wrong: then this costs nothing, and messages
/// of theirs need not even be brought here (concerns()). Precondition of step(): the vehicle flies.
class SeparationWatch {
 public:
  /// Not heard for so long, a vehicle is taken not to hear either.
  static constexpr Duration kSilent = std::chrono::seconds{2};
  /// It is not looked at any more, then; later where it is in a conflict.
  static constexpr Duration kForgotten = std::chrono::seconds{5};
  static constexpr Duration kForgottenInConflict = std::chrono::seconds{15};
  static constexpr Duration kPatience = std::chrono::seconds{5};
  /// Without a conflict for so long, two are clear of each other.
  static constexpr Duration kClear = std::chrono::seconds{2};
  /// Of one other vehicle a new conflict is told of no more often.
  static constexpr Duration kToldEvery = std::chrono::seconds{10};
  static constexpr std::size_t kVehiclesMax = 64;
  /// Beyond the vertical minimum: what is left when a vehicle has given way; how far away another
  /// one's height is looked at while nothing is wrong, which is less than two layers are apart.
  static constexpr double kRoom_m = 2.0;

  /// Who is on the way to another height waits so much farther from others that come towards it.
  static constexpr double kWaits_m = 8.0;

  struct Self {
    VehicleState state;
    Activity activity = Activity::searching;
    /// Where it is to fly in place of its layer, and the heights that it may give way to from there
    /// (TrafficWatch). On the way there, and back, it waits for others that are between; and it
    /// goes on beyond for those that follow it.
    std::optional<double> height_m = {};
    HeightBand room = {};
    bool piloted = false;  ///< others fly it
    /// What it flies; null: it turns as now, as far as anybody knows.
    const TimedPath* way = nullptr;
  };

  /// `layer_m`: the vehicle's own height, above the origin. Another program under its number is
  /// another vehicle.
  SeparationWatch(const coalition::ProtocolParams& params, VehicleId self, InstanceId instance,
                  double layer_m);

  /// Who lands, comes down through the heights of others: it is looked at from so much farther
  /// above them.
  static constexpr double kLands_m = 100.0;

  /// Whether the watch of one vehicle wants to hear of another that does that, so far above it
  /// (below: negative), though it knows of none.
  [[nodiscard]] static bool concerns(const coalition::ProtocolParams& params, double above_m,
                                     Activity activity) {
    const double lands_m = activity == Activity::landing && above_m > 0.0 ? kLands_m : 0.0;
    return params.separation_look_ahead > Duration{} &&
           std::abs(above_m) < params.separation_vertical_m + kRoom_m + lands_m;
  }

  void on_telemetry(const Telemetry& other, const VehicleState& own, Instant now);
  void step(const Self& self, Instant now);

  /// It is about to come down, and looks at who is below, until it is told that it is not.
  void look_below(bool looks) { looks_below_ = looks; }
  enum class Turns : std::uint8_t {
    whatever,  ///< however both turn
    as_now,    ///< as both turn now
    soon       ///< the same, of who would have no time to give way
  };
  /// Came it down now, nobody through whose height it then passes within seconds can be near. Of
  /// those that it has heard of since it looks below.
  [[nodiscard]] bool is_free_below(const VehicleState& own, Turns turns, Instant now) const;

  /// It does not land after all: it climbs to `least_m` at once, and back to its layer as one does
  /// that gave way to aircraft. False where others are not watched.
  bool climb_back(const VehicleState& own, double least_m, Instant now);

  /// It knows of others: step() is to be called with every state.
  [[nodiscard]] bool watches() const {
    return !known_.empty() || target_.has_value() || off_layer_ || looks_below_;
  }
  [[nodiscard]] bool off_layer() const { return off_layer_; }
  /// From its layer, to which the vehicle is to change its height; 0: it flies there.
  [[nodiscard]] double offset_m() const { return target_.value_or(way_m_) - layer_m_; }
  [[nodiscard]] std::optional<SeparationConflict> conflict() const;
  [[nodiscard]] std::optional<EventBody> poll_event();

 private:
  struct Other {
    InstanceId instance;
    VehicleState state;
    Activity activity = Activity::searching;
    Instant heard{};
    Duration delay{};            ///< of its state, when it was heard
    double climb_mps = 0.0;      ///< from one state to the next
    double turn_radps = 0.0;     ///< over the last states
    bool gives_way_too = false;  ///< to the same aircraft, perhaps
    bool piloted = false;
    bool conflict = false;
    bool yields = false;  ///< this one, to it
    VehicleId gives_way;
    Instant since{};     ///< the conflict began
    double apart_m = 0;  ///< in height, then
    Instant clear_since{};
    bool told = false;
    Instant told_at = Instant::min();
  };
  /// Of both when they are closest, as they fly now. Towards who lands it looks along its own way.
  struct Approach {
    double horizontal_m = 0.0;
    double vertical_m = 0.0;
    double in_s = 0.0;
    double height_m = 0.0;  ///< of the other, then
    double around_m = 0.0;  ///< and so much higher and lower about then
    double margin_m = 0.0;  ///< of what is not known of the way until then
    double height_margin_m = 0.0;
  };
  [[nodiscard]] Approach approach(const Self& self, const Other& other, Instant now) const;
  [[nodiscard]] double closest_s(const Self& self, const Other& other, const Vec2& apart) const;
  template <class Apart, class Above>
  [[nodiscard]] double nearest_s(const Apart& apart_at, const Above& above_at) const;
  [[nodiscard]] bool breaks(const Approach& a) const;
  [[nodiscard]] bool still_breaks(const Approach& a, const Self& self, const Other& other) const;
  [[nodiscard]] bool passes_near(const Approach& a) const;
  void look(VehicleId id, Other& other, const Self& self, Instant now);
  void begin(Other& other, const Approach& a, Instant now);
  void end_when_clear(VehicleId id, Other& other, bool breaks, Instant now);
  void decide(VehicleId id, Other& other, const Self& self, const Approach& a, Instant now);
  [[nodiscard]] bool must_yield(VehicleId id, const Other& other, const Self& self,
                                Instant now) const;
  void tell(VehicleId id, Other& other, const Approach& a, Instant now);
  [[nodiscard]] std::optional<double> height_for(VehicleId id, const Other& other, const Self& self,
                                                 Instant now) const;
  [[nodiscard]] std::optional<double> free_height(const Other& other, bool up, const Self& self,
                                                  Instant now) const;
  void keep_free(const Self& self, Instant now);
  void go_on(const Self& self, Instant now);
  [[nodiscard]] double with_room_for_others(const Self& self) const;
  [[nodiscard]] bool may_be_near(const Self& self, const Other& other, Instant now) const;
  [[nodiscard]] double below_all(const Self& self, double height_m, Instant now) const;
  void look_along_way(const Self& self, Instant now);
  [[nodiscard]] const Vec2& own_at(double seconds) const;
  [[nodiscard]] bool may_come(const Self& self, const Other& other, double within_s,
                              Instant now) const;
  [[nodiscard]] bool has_taken_off(const VehicleState& own) const;
  [[nodiscard]] bool on_the_way(const VehicleState& own, const VehicleState& other) const;
  [[nodiscard]] bool any_conflict() const;
  [[nodiscard]] bool can_be_below(const VehicleState& own, const Other& other, Turns turns,
                                  Instant now) const;

  coalition::ProtocolParams params_;
  VehicleId self_;
  InstanceId instance_;
  double layer_m_;
  std::map<VehicleId, Other> known_;
  std::optional<double> target_;  ///< height, to give way
  double asked_m_;                ///< where it is to fly: its layer, or Self::height_m
  double base_m_;                 ///< the same, with room for those that follow
  double way_m_;                  ///< as far as nobody is in the way there
  bool looks_below_ = false;
  std::optional<VehicleState> last_;  ///< its own
  double turn_radps_ = 0.0;           ///< over the last of them
  bool off_layer_ = false;    ///< by Self::height_m or a landing, or not back from there yet
  bool climbs_back_ = false;  ///< from a landing
  Instant climbs_since_{};
  std::vector<Vec2> own_ahead_;  ///< while somebody lands
  HeightBand room_;
  Instant next_way_ = Instant::min();
  Instant chosen_at_ = Instant::min();
  std::deque<EventBody> events_;
};

}  // namespace skein::mission
