// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/bounded_queue.hpp"
#include "skein/base/result.hpp"
#include "skein/domain/fence.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/formation/track_planner.hpp"
#include "skein/mission/barred_vehicles.hpp"
#include "skein/mission/formation_ground.hpp"
#include "skein/mission/messages.hpp"

namespace skein::mission {

struct TrackGroundConfig {
  std::vector<VehicleSpec> planes;
  formation::TrackRules rules;  ///< with the hazards that are known before the mission
  Fence fence{};
  double place_tolerance_m = 8.0;
  Duration settle = std::chrono::seconds{1};  ///< in place for so long, all: the formation holds
  Duration lead = std::chrono::seconds{3};    ///< from an order to when it is begun
  Duration silence = kFormationSilence;
};

struct TrackOrder {
  OrderKind kind = OrderKind::fly_along;  ///< or reshape
  formation::ShapeSpec shape;
  formation::Track track;           ///< of fly_along, as the following
  std::optional<double> speed_mps;  ///< none: the slowest plane's cruise speed
  int laps = 1;
};

/// What an order would do, before anybody flies it.
struct TrackPreview {
  TrackOrder order;
  formation::PlannedTrack planned;
  std::vector<VehicleId> lost;  ///< who is silent or piloted: the others keep to other heights
};

/// The ground station's side of planes in formation, without I/O: plans flights from what the
/// planes say that they fly, checks them, and sends them until they are taken up. Who has taken its
/// flight up needs nobody any more. Gives the order again where a plane has not begun it. Calling
/// rules of OnboardAgent.
class TrackGround {
 public:
  TrackGround(const TrackGroundConfig& config, Instant now);

  /// Fails with what is wrong and what to change.
  [[nodiscard]] Result<TrackPreview> preview(const TrackOrder& order, Instant now) const;
  Result<TrackPreview> command(const TrackOrder& order, Instant now);

  /// While there are any no order is taken.
  [[nodiscard]] BarredVehicles& barred() { return barred_; }
  /// Nobody is led out of that one from now on.
  void set_fence(const Fence& fence) { config_.fence = fence; }

  /// Of who may say it (may_say()), and of telemetry none that is late (Fleet::is_late()).
  void on_message(const Message& message, Instant now);
  void know(const HazardReport& report);
  void on_timeout(Instant now);
  [[nodiscard]] std::optional<Message> poll_message() { return messages_.pop(); }
  [[nodiscard]] std::optional<MissionEvent> poll_event() { return events_.pop(); }
  [[nodiscard]] std::uint64_t dropped() const { return messages_.dropped() + events_.dropped(); }
  [[nodiscard]] Instant next_timeout() const { return next_; }

  struct Member {
    FormationStatus status;
    Instant heard_at{};
    bool lost = false;
    bool piloted = false;  ///< others fly it, by its telemetry
    /// It flies what it is told, as far as this ground station hears.
    [[nodiscard]] bool follows() const { return !lost && !piloted; }
    double range_left_m = 0.0;
    std::optional<Instant> arrived_at;  ///< in its newest place
  };
  [[nodiscard]] const std::map<VehicleId, Member>& members() const { return members_; }
  /// All that fly the newest order have come to their places.
  [[nodiscard]] bool in_place() const { return held_since_.has_value(); }
  /// The newest order leads along a track that is not at its end.
  [[nodiscard]] bool on_track(Instant now) const;

 private:
  [[nodiscard]] Result<formation::TrackRequest> request_of(const TrackOrder& order,
                                                           Instant now) const;
  [[nodiscard]] Result<void> within_fence(const formation::PlannedTrack& planned) const;
  /// What planes fly of what this ground station has ordered: not all may have heard of the newest.
  [[nodiscard]] formation::PlannedTrack present() const;
  void begin(TrackPreview preview, Instant now);
  void on_status(const FormationStatus& status, Instant now);
  /// Of the newest order, for that vehicle; null where it has none.
  [[nodiscard]] const formation::TrackFlightPlan* flight_of(VehicleId vehicle) const;
  /// It has told nothing of the newest order, which is its to fly.
  [[nodiscard]] bool has_not_begun(VehicleId vehicle, const Member& member) const;
  void send(Instant now);
  void find_lost(Instant now);
  void find_not_begun(Instant now);
  void judge_places(Instant now);
  void report(EventBody body, Instant now);

  TrackGroundConfig config_;
  KnownHazards hazards_;
  std::map<VehicleId, Member> members_;
  std::map<VehicleId, FlightPlan> flies_;  ///< what planes have told of
  std::optional<TrackOrder> order_;
  std::map<std::uint32_t, formation::PlannedTrack> sent_;  ///< that somebody may fly yet
  std::uint32_t number_ = 0;                               ///< of the newest; 0: none
  Instant send_next_{};
  std::size_t send_from_ = 0;  ///< of the flights: those before it were told this time
  Instant try_again_{};
  bool told_not_begun_ = false;
  bool told_refused_ = false;  ///< that the order cannot be given again
  std::optional<Instant> near_since_;
  std::optional<Instant> held_since_;
  Instant next_;
  BarredVehicles barred_;
  BoundedQueue<Message> messages_{256};
  BoundedQueue<MissionEvent> events_{256};
};

}  // namespace skein::mission
