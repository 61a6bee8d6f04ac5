// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/mavlink/enums.hpp"
#include "skein/mavlink/messages.hpp"
#include "skein/mavlink/parser.hpp"

namespace skein::hil {

/// The autopilot's side of a mission's way over MAVLink, as ArduPilot has it: a count is answered
/// by questions for the items, one after another and again each second where one is lost, then by
/// MISSION_ACK; what is stored can be read. The first item of a mission is home, which it puts
/// there itself; a fence has none.
class MissionStore {
 public:
  using Load = std::function<mavlink::MissionResult(std::span<const mavlink::MissionItemInt>)>;
  /// `type`: MAV_MISSION_TYPE. `load` says whether what was received can be kept.
  MissionStore(std::uint8_t type, Load load) : type_{type}, load_{std::move(load)} {}

  using Answer = std::variant<mavlink::MissionRequest, mavlink::MissionAck, mavlink::MissionCount,
                              mavlink::MissionItemInt>;
  /// Is that packet about what is stored here?
  bool on_packet(const mavlink::Packet& packet, Instant now);
  /// To be said to whoever spoke last.
  [[nodiscard]] std::optional<Answer> poll(Instant now);

 private:
  void on_count(const mavlink::MissionCount& count, Instant now);
  void receive(const mavlink::MissionItemInt& item, Instant now);
  [[nodiscard]] mavlink::MissionAck ack(mavlink::MissionResult result) const;
  void answer(const Answer& answer) { answers_.push_back(answer); }

  std::uint8_t type_;
  Load load_;
  std::vector<mavlink::MissionItemInt> items_;  ///< that are flown
  std::vector<mavlink::MissionItemInt> taken_;  ///< of one that is being received
  std::size_t awaited_ = 0;                     ///< items of that; 0: none is
  Instant ask_at_{};
  std::vector<Answer> answers_;
};

}  // namespace skein::hil
