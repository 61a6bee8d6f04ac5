// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <optional>

#include "skein/base/time.hpp"
#include "skein/domain/traffic_params.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mission/events.hpp"
#include "skein/mission/height_band.hpp"
#include "skein/mission/messages.hpp"

namespace skein::mission {

/// Looks whether an aircraft that is not of the team comes too near, from what the ground station
/// tells of it, and has this vehicle give way by its height. Aircraft are taken to fly straight on,
/// and to go on climbing or to level off at any moment; the vehicle to fly its plan. Where both
/// minima would be broken it leaves the heights that are too near to the aircraft:
///
/// 1. downwards, where that is not below the floor: what is manned comes from above and goes there;
/// 2. else upwards, where that is not above the ceiling;
/// 3. where neither can be reached in time or there is no room, as far away from it as there is
///    room, never through its height, and that is told.
///
/// Other vehicles of the team are not its matter: SeparationWatch brings it there between them.
class TrafficWatch {
 public:
  /// Nothing was heard of it for so long: then it is not looked at any more.
  static constexpr Duration kForgotten = std::chrono::seconds{30};
  /// Without a conflict for so long, it is clear of it.
  static constexpr Duration kClear = std::chrono::seconds{5};
  /// Of one aircraft a new conflict is told of no more often.
  static constexpr Duration kToldEvery = std::chrono::seconds{10};
  static constexpr Duration kLookPeriod = std::chrono::milliseconds{500};
  static constexpr double kRoom_m = 10.0;  ///< beyond the vertical minimum, to where it gives way

  struct Self {
    VehicleState state;
    const FlightPlan* plan = nullptr;  ///< null: it flies straight on
    double layer_m = 0.0;              ///< its height, where nothing is wrong
    /// Of its fence.
    double ceiling_m = std::numeric_limits<double>::infinity();
    bool may_give_way = false;  ///< it flies, by this program, and not in a formation
  };

  explicit TrafficWatch(const TrafficParams& params) : params_{params} {}

  void on_traffic(const Traffic& traffic);
  void step(const Self& self, Instant now);

  /// It knows of aircraft: step() is to be called with every state.
  [[nodiscard]] bool watches() const { return !known_.empty() || target_.has_value(); }
  [[nodiscard]] bool gives_way() const { return target_.has_value(); }
  /// Where it is to fly, and the heights around it that leave no minimum broken; none: its layer.
  [[nodiscard]] std::optional<double> height_m() const { return target_; }
  [[nodiscard]] HeightBand room() const { return room_; }
  /// Some aircraft comes too near: what people read of it.
  struct Conflict {
    std::uint32_t address = 0;
    bool gives_way = false;
  };
  [[nodiscard]] std::optional<Conflict> conflict() const;
  [[nodiscard]] std::optional<EventBody> poll_event();

 private:
  /// While both minima may be broken, as both fly now.
  struct Encounter {
    double enters_s = 0.0;  ///< from now until the horizontal minimum is broken
    HeightBand heights;     ///< at which the vehicle would be too near to it
    double horizontal_m = 0.0;
    double vertical_m = 0.0;  ///< from the vehicle's height, at the least distance to the side
    double closest_s = 0.0;
  };
  struct Known {
    Aircraft aircraft;
    bool conflict = false;
    std::optional<Encounter> encounter;
    Instant clear_since{};
    bool told = false;
    bool told_way = false;
    Instant told_at = Instant::min();
    Instant told_closest = Instant::min();  ///< when they are closest, as it was told
  };
  [[nodiscard]] std::optional<Encounter> encounter(const Self& self, const Aircraft& aircraft,
                                                   double factor, Instant now) const;
  void look(Known& known, const Self& self, Instant now);
  void choose(const Self& self);
  [[nodiscard]] std::optional<double> free_height(double from_m, bool up, double ceiling_m) const;
  [[nodiscard]] bool in_time(const Self& self, const Encounter& encounter, double to_m) const;
  void tell(Known& known, const Self& self, Instant now);

  TrafficParams params_;
  std::map<std::uint32_t, Known> known_;
  std::optional<double> target_;
  HeightBand room_;
  Instant next_look_ = Instant::min();
  std::deque<EventBody> events_;
};

}  // namespace skein::mission
