// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "skein/base/time.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/hal/flight_controller.hpp"
#include "skein/mission/guidance.hpp"
#include "skein/onboard/latest_value.hpp"
#include "skein/onboard/spsc_ring.hpp"
#include "skein/planning/path_follower.hpp"
#include "skein/recording/recording.hpp"

namespace skein::onboard {

/// What control shares with the other threads. Every slot and ring has one writer and one reader.
struct ControlPorts {
  LatestValue<mission::Guidance> guidance;  ///< agent to control
  LatestValue<VehicleState> state;          ///< control to agent
  /// Control to recorder: how it flies, 20 times a second from mission time 0, and every plan at
  /// the moment that it is first followed.
  SpscRing<recording::TrackPoint, 256> track;
  SpscRing<recording::PlanRecord, 16> plans;
  std::atomic<std::uint32_t> periods{0};
  std::atomic<std::uint32_t> overruns{0};      ///< periods that were missed
  std::atomic<std::uint32_t> stale_states{0};  ///< periods without a fresh state
  std::atomic<hal::Airborne> airborne{hal::Airborne::unknown};
};

/// When the periods of a thread start. Pure.
class PeriodicSchedule {
 public:
  PeriodicSchedule(Instant first, Duration period) : next_{first}, period_{period} {}
  [[nodiscard]] Instant next() const { return next_; }
  /// Moves on from a period whose work was done at `now`; the number of periods that passed
  /// unserved.
  [[nodiscard]] std::uint32_t advance(Instant now);

 private:
  Instant next_;
  Duration period_;
};

/// The real-time part of a vehicle: each step reads the flight controller, follows the newest
/// guidance and commands the flight controller. step() allocates nothing, takes no lock, makes
/// no system call and ends in bounded time. When nothing new ever comes, it flies the last into
/// its hold. A flight controller that has told nothing new for mission::kFlightControllerSilence
/// gets no commands: it is left to its failsafe.
class ControlLoop {
 public:
  static constexpr Duration kTrackPeriod = std::chrono::milliseconds{50};

  /// Both must outlive this object.
  ControlLoop(const VehicleSpec& vehicle, hal::FlightController& flight_controller,
              ControlPorts& ports, const planning::PathFollowerParams& follower = {});

  void step(Instant now);

 private:
  VehicleSpec vehicle_;
  planning::PathFollowerParams follower_;
  hal::FlightController* flight_controller_;
  ControlPorts* ports_;
  std::optional<mission::HeldGuidance> guidance_;
  Instant next_track_{};
  Instant recorded_ = Instant::min();
};

}  // namespace skein::onboard
