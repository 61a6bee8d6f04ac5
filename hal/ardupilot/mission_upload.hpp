// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <variant>
#include <vector>

#include "skein/base/frames.hpp"
#include "skein/base/time.hpp"
#include "skein/idl/domain.hpp"
#include "skein/mavlink/enums.hpp"
#include "skein/mavlink/parser.hpp"

namespace skein::ardupilot {

/// The place of the circle in landing_mission(), where it begins.
inline constexpr std::uint16_t kLandFromItem = 2;

/// A plane's landing as a mission: home (which the autopilot puts there itself), DO_LAND_START, the
/// circle on which it comes down to its approach's height (NAV_LOITER_TO_ALT, to the left), and
/// NAV_LAND. Heights are above home.
[[nodiscard]] std::vector<mavlink::MissionItemInt> landing_mission(const Landing& landing,
                                                                   const MissionOrigin& origin);

/// Gives an autopilot a mission, reads it back and compares. What is lost is said again; where
/// nothing goes on for kPatience, it has failed. https://mavlink.io/en/services/mission.html
class MissionUpload {
 public:
  enum class State : std::uint8_t { idle, sending, reading, verified, failed };
  using Message =
      std::variant<mavlink::MissionCount, mavlink::MissionItemInt, mavlink::MissionRequestList,
                   mavlink::MissionRequestInt, mavlink::MissionAck>;
  static constexpr Duration kPatience = std::chrono::seconds{5};

  void begin(std::vector<mavlink::MissionItemInt> items, Instant now);
  void clear();
  void on_packet(const mavlink::Packet& packet, Instant now);
  void step(Instant now);

  /// To be sent; who it is for is not in it yet.
  [[nodiscard]] std::optional<Message> poll();
  [[nodiscard]] State state() const { return state_; }
  /// For people, of one that has failed.
  [[nodiscard]] const std::string& why() const { return why_; }

 private:
  void say(const Message& message, Instant now);
  void go_on(Instant now) { progress_at_ = now; }
  void fail(std::string why);
  void on_request(std::uint16_t seq, Instant now);
  void on_ack(const mavlink::MissionAck& ack, Instant now);
  void on_count(const mavlink::MissionCount& count, Instant now);
  void on_item(const mavlink::MissionItemInt& item, Instant now);
  void read(Instant now);

  State state_ = State::idle;
  std::vector<mavlink::MissionItemInt> items_;
  bool requested_ = false;  ///< the autopilot asks for items, and asks again by itself
  bool counted_ = false;    ///< how many it has
  std::uint16_t next_ = 0;  ///< to be read
  Instant progress_at_{};
  Instant again_at_{};
  std::string why_;
  std::deque<Message> out_;
};

}  // namespace skein::ardupilot
