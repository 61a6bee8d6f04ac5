// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <variant>
#include <vector>

#include "skein/base/frames.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/fence.hpp"
#include "skein/idl/domain.hpp"
#include "skein/mavlink/enums.hpp"
#include "skein/mavlink/parser.hpp"

namespace skein::ardupilot {

/// The place of the circle in landing_mission(), where it begins.
inline constexpr std::uint16_t kLandFromItem = 2;

/// A plane's landing as a mission: home (which the autopilot puts there itself), DO_LAND_START, the
/// circle on which it comes down to its approach's height (NAV_LOITER_TO_ALT, to the left), and
/// what sets it down: NAV_LAND, or NAV_VTOL_LAND on rotors. Heights are above home.
[[nodiscard]] std::vector<mavlink::MissionItemInt> landing_mission(const Landing& landing,
                                                                   mavlink::Command touch_down_by,
                                                                   const MissionOrigin& origin);

/// A fence's corners, for the autopilot to stay within (NAV_FENCE_POLYGON_VERTEX_INCLUSION).
[[nodiscard]] std::vector<mavlink::MissionItemInt> fence_mission(const Fence& fence,
                                                                 const MissionOrigin& origin);

/// Gives an autopilot a mission or a fence, reads it back and compares. What is lost is said again;
/// where nothing goes on for kPatience, it has failed. https://mavlink.io/en/services/mission.html
class MissionUpload {
 public:
  enum class State : std::uint8_t { idle, sending, reading, verified, failed };
  using Message =
      std::variant<mavlink::MissionCount, mavlink::MissionItemInt, mavlink::MissionRequestList,
                   mavlink::MissionRequestInt, mavlink::MissionAck>;
  static constexpr Duration kPatience = std::chrono::seconds{5};
  enum class Kind : std::uint8_t { mission = 0, fence = 1 };  ///< MAV_MISSION_TYPE

  explicit MissionUpload(Kind kind) : kind_{kind} {}
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

  [[nodiscard]] std::uint8_t type() const { return static_cast<std::uint8_t>(kind_); }
  [[nodiscard]] std::string name() const { return kind_ == Kind::fence ? "fence" : "mission"; }
  [[nodiscard]] bool same(const mavlink::MissionItemInt& read,
                          const mavlink::MissionItemInt& said) const;

  Kind kind_;
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
