// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/mavlink/parser.hpp"
#include "vehicle.hpp"

namespace skein::hil {

/// The autopilot's side of a mission's way over MAVLink, as ArduPilot has it: a count is answered
/// by questions for the items, one after another and again each second where one is lost, then by
/// MISSION_ACK; what is stored can be read. The first item is home, which it puts there itself.
class MissionStore {
 public:
  using Answer = std::variant<mavlink::MissionRequest, mavlink::MissionAck, mavlink::MissionCount,
                              mavlink::MissionItemInt>;
  /// Is that packet about a mission? The vehicle then has what it says.
  bool on_packet(const mavlink::Packet& packet, Vehicle& vehicle, Instant now);
  /// To be said to whoever spoke last.
  [[nodiscard]] std::optional<Answer> poll(Instant now);

 private:
  void receive(const mavlink::MissionItemInt& item, Vehicle& vehicle, Instant now);
  void answer(const Answer& answer) { answers_.push_back(answer); }

  std::vector<mavlink::MissionItemInt> items_;  ///< that are flown
  std::vector<mavlink::MissionItemInt> taken_;  ///< of one that is being received
  std::size_t awaited_ = 0;                     ///< items of that; 0: none is
  Instant ask_at_{};
  std::vector<Answer> answers_;
};

}  // namespace skein::hil
