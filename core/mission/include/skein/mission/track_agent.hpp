// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/bounded_queue.hpp"
#include "skein/domain/fence.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/mission/onboard_agent.hpp"
#include "skein/mission/range_budget.hpp"
#include "skein/planning/avoidance.hpp"

namespace skein::mission {

class Flight;

struct TrackAgentConfig {
  VehicleSpec vehicle;
  InstanceId instance;
  planning::AvoidanceParams avoidance{.margin_m = kHazardMargin_m};
  std::vector<Hazard> hazards;     ///< known before the mission
  Fence fence;                     ///< its orbits and ways home keep within it
  double place_tolerance_m = 8.0;  ///< to be in place
  Duration status_period = std::chrono::milliseconds{200};
};

/// All decisions of one plane in a formation. Until it is given a flight it orbits where it
/// started. A flight (TrackFlight) is its whole way, checked by the ground station; it takes it up
/// only where it begins on what it flies then, and flies it to its end and around the orbit there,
/// whatever falls silent. Told to hold, when a hazard comes into its way, and when its pilot takes
/// it, it leaves the formation, for an orbit at its own height.
class TrackAgent final : public OnboardAgent {
 public:
  TrackAgent(const TrackAgentConfig& config, Instant now);
  ~TrackAgent() override;
  TrackAgent(const TrackAgent&) = delete;
  TrackAgent& operator=(const TrackAgent&) = delete;

  void on_state(const VehicleState& state, Instant now) override;
  void on_message(const Message& message, VehicleId sender, Instant now) override;
  void on_timeout(Instant now) override;
  void on_bar(Bar bar, Instant now) override;
  void on_piloted(bool piloted, Instant now) override;
  std::string keep_fence(const Fence& fence, Instant now) override;

  [[nodiscard]] std::optional<Message> poll_message() override { return messages_.pop(); }
  [[nodiscard]] std::optional<Guidance> poll_guidance() override;
  [[nodiscard]] std::optional<MissionEvent> poll_event() override { return events_.pop(); }
  [[nodiscard]] Instant next_timeout() const override { return next_; }
  [[nodiscard]] Telemetry telemetry() const override;
  [[nodiscard]] Counters counters() const override;
  [[nodiscard]] bool range_spent() const override { return range_spent_; }

  /// It is in its place, or has none.
  [[nodiscard]] bool in_place() const { return !flown_ || arrived_; }

 private:
  void on_flight(const TrackFlight& flight, Instant now);
  [[nodiscard]] std::optional<event::ChangeRefusal> why_not(const TrackFlight& flight,
                                                            Instant now) const;
  void on_return_flight(const ReturnFlight& message, Instant now);
  void on_command(const Command& command, Instant now);
  void on_hazard(const HazardReport& told, Instant now);
  void keep_clear(Instant now);
  void step(Instant now);
  void begin(Instant now);
  void leave();
  void watch_range(Instant now);
  void say_status(Instant now);
  [[nodiscard]] double off_m(Instant now) const;
  [[nodiscard]] double range_left_m() const { return range_.left_m(); }
  /// On the track, and not in the orbit at its end.
  [[nodiscard]] bool forming(Instant now) const;
  [[nodiscard]] ActivityDetail detail() const;
  void report(EventBody body, Instant now);

  TrackAgentConfig config_;
  RangeBudget range_;
  std::unique_ptr<Flight> flight_;
  KnownHazards hazards_;
  std::optional<VehicleState> state_;
  std::optional<TrackFlight> next_flight_;  ///< taken up, and not begun yet
  std::optional<TrackFlight> flown_;        ///< none where it has left its formation
  std::uint32_t number_ = 0;                ///< of the newest that was taken up
  std::uint32_t return_plan_ = 0;           ///< of the way home that it flies
  std::uint32_t refused_ = 0;
  CommandFilter commands_;
  bool ordered_ = false;  ///< to hold or to come home
  Bar bar_ = Bar::none;
  bool piloted_ = false;  ///< others fly it
  bool arrived_ = false;
  bool range_spent_ = false;
  Instant now_{};
  Instant next_;
  Instant next_status_;
  Instant next_range_;
  std::uint64_t bad_flights_ = 0;
  BoundedQueue<Message> messages_{64};
  BoundedQueue<MissionEvent> events_{256};
};

}  // namespace skein::mission
