// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/can/frame.hpp"
#include "skein/hil/emulator_config.hpp"

namespace skein::hil {

/// A flight controller with its aircraft, as an ArduPilot with a DroneCAN serial port is on the
/// bus: NodeStatus, GetNodeInfo, and MAVLink 2 in uavcan.tunnel.Targetted to one companion. No I/O:
/// frames and times come in, frames go out. Time never decreases. Same configuration, frames and
/// times, same bytes.
class EmulatedFlightController {
 public:
  /// Switched on at `now`; it is on the bus at once. Fails as check() does.
  [[nodiscard]] static Result<EmulatedFlightController> make(const EmulatorConfig& config,
                                                             Instant now);
  ~EmulatedFlightController();
  EmulatedFlightController(EmulatedFlightController&&) noexcept;
  EmulatedFlightController& operator=(EmulatedFlightController&&) noexcept;
  EmulatedFlightController(const EmulatedFlightController&) = delete;
  EmulatedFlightController& operator=(const EmulatedFlightController&) = delete;

  void on_frame(const can::Frame& frame, Instant now);
  /// Flies and speaks until `now`. Commands are obeyed in the next period of the main loop.
  void step(Instant now);
  [[nodiscard]] Instant next_timeout() const;

  /// The frames of the transfer that is to be sent next, or none; send all of them, then pop().
  [[nodiscard]] std::span<const can::Frame> front();
  void pop();

  /// What the aircraft really does: a packet with MAVLink's SIM_STATE, as simulators of ArduPilot
  /// send it. Of no use to the companion, which is to fly by what the autopilot believes.
  [[nodiscard]] std::vector<std::uint8_t> truth();

  /// What the companion cannot do; a line of words:
  ///   mode NAME             the pilot's switch, with ArduPilot's name of the mode
  ///   arm, disarm           the pilot's sticks; disarm works in flight, too
  ///   reboot                the autopilot restarts: 1.2 s off the bus, MAVLink after 5.2 s
  ///   silent on|off         it sends nothing, but hears and flies on
  ///   position lost|good    the navigation filter
  ///   prearm REASON         it would not arm, and says why; without a reason: it would again
  ///   battery PERCENT       so much is left of it from now on, as its gauge tells, too
  /// Fails with what is wrong with the line, or what the autopilot refused.
  [[nodiscard]] Result<void> interfere(std::string_view line, Instant now);

 private:
  struct State;
  explicit EmulatedFlightController(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace skein::hil
