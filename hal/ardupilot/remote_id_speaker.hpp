// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "skein/base/frames.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/remote_id.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mavlink/enums.hpp"
#include "skein/mavlink/packet.hpp"
#include "skein/mavlink/remote_id_words.hpp"

namespace skein::ardupilot {

/// Of the aircraft with that system's own transmitter.
[[nodiscard]] inline bool is_of_transmitter(const mavlink::Packet& packet, std::uint8_t system) {
  return packet.system == system && packet.component >= mavlink::kComponentRemoteId1 &&
         packet.component <= mavlink::kComponentRemoteId3;
}

/// Tells an ArduPilot what its transmitter of Remote ID is to say, and hears whether that can.
/// Where the aircraft is the autopilot tells it by itself.
class RemoteIdSpeaker {
 public:
  /// Of each message; an ArduPilot does not arm 3 s after the last SYSTEM.
  static constexpr Duration kPeriod = std::chrono::seconds{1};
  /// Without a word of the transmitter for so long there is none.
  static constexpr Duration kSilence = std::chrono::seconds{3};

  /// `unix_us`: system time at Instant{}.
  RemoteIdSpeaker(RemoteId id, Airframe airframe, std::int64_t unix_us)
      : id_{std::move(id)}, by_airframe_{type_of(airframe)}, unix_us_{unix_us} {}

  /// Of a transmitter's component.
  void on_packet(const mavlink::Packet& packet, Instant now) {
    const auto told = mavlink::decode<mavlink::OpenDroneIdArmStatus>(packet);
    if (!told) return;
    heard_at_ = now;
    error_ = mavlink::text_of(told->error);
    good_ = told->status == 0;
  }
  /// Where the aircraft stands, until it flies.
  void on_place(const Wgs84& place, bool flies) {
    if (!flies || !take_off_) take_off_ = place;
  }
  /// Another transmitter, or another autopilot.
  void forget() { heard_at_.reset(); }

  /// Calls `send(message)` with what is due, a message at a time: a transmitter's line is slow.
  template <class Send>
  void speak(std::uint8_t system, Instant now, Send&& send) {
    if (!id_.exists() || now < next_) return;
    next_ = std::max(next_ + kPeriod / kMessages, now + kPeriod / (2 * kMessages));
    const auto to_autopilot = [&](auto message) {
      message.target_system = system;
      message.target_component = mavlink::kComponentAutopilot;
      send(message);
    };
    switch (turn_++ % kMessages) {
      case 0:
        return to_autopilot(mavlink::basic_id_of(id_, by_airframe_));
      case 1:
        return to_autopilot(
            mavlink::system_of(id_, take_off_, 1000 * unix_us_ + now.time_since_epoch().count()));
      case 2:
        return to_autopilot(mavlink::operator_id_of(id_));
      default:
        return to_autopilot(mavlink::self_id_of(id_));
    }
  }

  [[nodiscard]] bool exists() const { return id_.exists(); }
  [[nodiscard]] bool is_required() const { return id_.required; }
  /// Why the aircraft does not say what it has to; nothing where it does.
  [[nodiscard]] std::optional<std::string> why_not(Instant now) const {
    if (!heard_at_ || now - *heard_at_ > kSilence) {
      return "Remote ID: no transmitter is heard (OPEN_DRONE_ID_ARM_STATUS)";
    }
    if (good_) return std::nullopt;
    return "Remote ID: its transmitter is not ready" + (error_.empty() ? "" : ": " + error_);
  }

 private:
  static constexpr int kMessages = 4;
  [[nodiscard]] static RemoteId::UaType type_of(Airframe airframe) {
    using enum RemoteId::UaType;
    if (airframe == Airframe::copter) return helicopter_or_multirotor;
    return airframe == Airframe::quadplane ? hybrid_lift : aeroplane;
  }

  RemoteId id_;
  RemoteId::UaType by_airframe_;
  std::int64_t unix_us_;
  std::optional<Wgs84> take_off_;
  std::optional<Instant> heard_at_;
  std::string error_;
  bool good_ = false;
  Instant next_ = Instant::min();
  unsigned turn_ = 0;
};

}  // namespace skein::ardupilot
