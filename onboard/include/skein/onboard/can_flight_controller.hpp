// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "skein/ardupilot/can_link.hpp"
#include "skein/hal/flight_controller.hpp"
#include "skein/onboard/latest_value.hpp"
#include "skein/onboard/spsc_ring.hpp"

namespace skein::onboard {

/// A flight controller on a CAN bus, with the bus in a thread of its own: control reads and writes
/// slots, so that it neither waits for the bus nor allocates.
class CanFlightController final : public hal::FlightController {
 public:
  CanFlightController(std::unique_ptr<can::Bus> bus, const ardupilot::CanLinkParams& params,
                      const MissionOrigin& origin, Instant now)
      : link_{std::move(bus), params, origin, now} {}

  // Of the control thread.
  [[nodiscard]] std::optional<VehicleState> state(Instant now) override;
  void command(const Demand& demand, Instant now) override;
  [[nodiscard]] hal::Airborne airborne() const override {
    return airborne_.load(std::memory_order_relaxed);
  }

  // Of the CAN thread.
  void step(Instant now);
  /// Until a frame comes, and not longer than that.
  void wait(Duration at_most) const;
  [[nodiscard]] const ardupilot::CanLink& link() const { return link_; }

  // Of the agent's thread.
  /// The operator gives the aircraft (back) to the companion, by a word that was issued then.
  void give_back(Instant issued);
  /// The autopilot is given that fence, to keep it from now on.
  void keep_fence(const Fence& fence);
  [[nodiscard]] std::optional<ardupilot::Notice> poll_notice() { return notices_.pop(); }
  [[nodiscard]] std::uint64_t notices_dropped() const { return notices_.dropped(); }
  /// The autopilot's mode, and what the companion is about where it does not fly: "LOITER,
  /// piloted".
  [[nodiscard]] std::string mode();
  /// What keeps the aircraft from being flown now, as sentences.
  [[nodiscard]] std::vector<std::string> problems() const;

  // Of any thread.
  /// What the autopilot says of itself, half a second old at most; nothing while it is not known.
  [[nodiscard]] std::optional<ardupilot::AutopilotFacts> facts() const;

 private:
  struct Mode {
    std::array<char, 64> text{};  ///< ends with a zero
    friend bool operator==(const Mode&, const Mode&) = default;
  };
  struct Command {
    Demand demand;
    Instant at;
  };
  LatestValue<ardupilot::MotionSample> sample_;  ///< CAN to control
  LatestValue<Command> command_;                 ///< control to CAN
  SpscRing<ardupilot::Notice, 64> notices_;      ///< CAN to agent
  LatestValue<Mode> mode_;                       ///< CAN to agent
  Mode told_mode_;                               ///< CAN's
  Mode newest_mode_;                             ///< the agent's
  void take_fence();
  void tell_mode();
  void tell_troubles();
  void tell_facts(Instant now);
  mutable std::mutex troubles_mutex_;  ///< CAN to agent, of a copy that seldom changes
  std::vector<AutopilotNotice> troubles_;
  mutable std::mutex facts_mutex_;  ///< CAN, which does not wait for it, to whoever looks
  std::optional<ardupilot::AutopilotFacts> facts_;
  Instant facts_at_{Instant::min()};                             ///< CAN's: when they are due
  std::atomic<hal::Airborne> airborne_{hal::Airborne::unknown};  ///< CAN to control
  static constexpr Instant::rep kNothing = std::numeric_limits<Instant::rep>::min();
  std::atomic<Instant::rep> given_back_{kNothing};  ///< when the operator's word was issued
  std::mutex fence_mutex_;                          ///< agent to CAN, seldom
  std::optional<Fence> fence_;                      ///< that the autopilot is to be given
  std::optional<ardupilot::MotionSample> newest_;   ///< control's
  ardupilot::CanLink link_;
};

}  // namespace skein::onboard
