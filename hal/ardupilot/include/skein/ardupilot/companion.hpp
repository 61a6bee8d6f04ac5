// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "skein/ardupilot/autopilot_facts.hpp"
#include "skein/ardupilot/motion.hpp"
#include "skein/base/frames.hpp"
#include "skein/base/state_table.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/autopilot_notice.hpp"
#include "skein/domain/fence.hpp"
#include "skein/domain/remote_id.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mavlink/enums.hpp"
#include "skein/mavlink/parser.hpp"
#include "skein/mavlink/signed_link.hpp"

namespace skein::ardupilot {

/// When the companion takes the aircraft. It arms and takes off only where that is asked for.
enum class TakeOver : std::uint8_t {
  when_guided,  ///< once the pilot has armed it, has it in the air and switches to GUIDED
  in_flight,    ///< once it is armed and in the air; the companion asks for GUIDED itself
  /// At once: it arms and takes off itself, one time. Not any more once the aircraft has been seen
  /// armed or in the air, or the launch was broken off, until give_back() on the ground.
  from_ground,
  count
};

struct CompanionParams {
  VehicleSpec vehicle;
  std::optional<mavlink::Signing> signing =
      {};                    ///< none: packets are not signed, and any are heeded
  RemoteId remote_id{};      ///< without an id nothing is said
  std::int64_t unix_us = 0;  ///< system time at Instant{}
  Fence fence;  ///< that the autopilot is given before anything is flown, and keeps by itself
  TakeOver take_over = TakeOver::when_guided;
  std::uint8_t system_id = 1;      ///< of the autopilot: SYSID_THISMAV; others are not heeded
  double takeoff_height_m = 40.0;  ///< above the ground, where the companion takes it
  /// The geoid above the ellipsoid at the mission's origin: autopilots count heights from it.
  double geoid_height_m = 0.0;
  double stream_hz = 25.0;  ///< of attitude and position; ArduPlane grants 40 at most
  /// Without a frame (or a packet) for that long, the link (or the autopilot) is lost.
  Duration silence = std::chrono::milliseconds{100};
  /// A setpoint older than that is sent no more.
  Duration setpoint_age_max = std::chrono::milliseconds{250};
};

/// For the log; a warning is for the operator too.
struct Notice {
  Instant time;
  bool warning = false;
  AutopilotNotice what;
};

/// The companion's side of a flight by an ArduPilot (4.5 or newer), over any stream of bytes that
/// carries MAVLink 2. No I/O, no clock: bytes and times come in, bytes and notices go out. What it
/// does in which state, and what brings it to another: docs/ardupilot.md, printed from kTable.
class Companion {
 public:
  enum class State : std::uint8_t {
    searching,    ///< for the HEARTBEAT of an autopilot
    refused,      ///< there is one, and it is not what was configured
    preparing,    ///< asks for firmware, streams, clock and the parameters that safety rests on
    standing_by,  ///< connected; the aircraft is not the companion's
    arming,       ///< has asked for take-off mode and arming
    climbing,     ///< armed by the companion; the autopilot takes off
    taking_over,  ///< has asked for GUIDED
    flying,       ///< GUIDED: setpoints go out
    landing,      ///< a copter's LAND, a plane's mission in AUTO, until the autopilot disarms
    piloted,      ///< others have the aircraft until give_back(), whatever happens in between
    lost,         ///< no frame of the flight controller comes
    silent,       ///< frames come, MAVLink does not
    checking,     ///< MAVLink is back; whose the aircraft is now, the next HEARTBEAT tells
    duplicated,   ///< two nodes have one id, ours or its: nothing is sent until give_back()
    count
  };
  enum class Event : std::uint8_t {
    autopilot_found,
    wrong_autopilot,
    ready,       ///< the streams flow, and the parameters are good
    may_launch,  ///< on the ground, ready to arm, and that was asked for
    armed,
    climbed,   ///< high enough to be taken
    may_take,  ///< in the air, and the companion shall ask for it
    guided,    ///< HEARTBEAT says GUIDED
    /// The setpoint stays at the ground, and the copter is there; or it has a plane's landing, and
    /// the autopilot has that for a mission, read back and compared.
    may_land,
    called_off,  ///< the setpoint of a plane that lands, still high enough, has no landing any more
    other_mode,  ///< HEARTBEAT says a mode that the companion did not ask for
    disarmed,
    not_obeyed,         ///< was asked several times, or does not climb
    still_climbing,     ///< after a loss: as before it
    still_landing,      ///< after a loss: as before it
    not_ours,           ///< after a loss: it was not the companion's before either
    given_back,         ///< by the operator, in the air
    given_back_landed,  ///< by the operator, disarmed on the ground
    link_lost,
    autopilot_silent,
    packets_back,
    rebooted,
    duplicate,
    count
  };
  using Entry = Transition<State, Event>;
  [[nodiscard]] static std::span<const Entry> table();

  Companion(const CompanionParams& params, const MissionOrigin& origin, Instant now);
  ~Companion();
  Companion(const Companion&) = delete;
  Companion& operator=(const Companion&) = delete;

  /// Bytes of the tunnel.
  void on_bytes(std::span<const std::uint8_t> bytes, Instant now);
  /// A frame of the flight controller, of whatever kind.
  void on_frame_heard(Instant now);
  /// Its node has restarted.
  void on_reboot(Instant now);
  /// A sign that two nodes on the bus have that id: ours or the flight controller's.
  void on_duplicate(std::uint8_t node_id, Instant now);
  /// What is wrong between the bus and the autopilot's MAVLink, while it is.
  void on_link_trouble(std::optional<AutopilotNotice> trouble);

  /// Flown while the state is `flying`; the last one stands until it is too old. A position is
  /// flown by a copter, and has no effect on a plane. GUIDED flies it no lower than kHoverFrom_m
  /// above home, and where it sinks to the ground no lower than led_down() has it. Now where the
  /// point stays at home's height or below it for kLandAfter, and the copter
  /// is within kLandWithin_m of it, the autopilot lands it there.
  void command(const Demand& demand, Instant now);
  static constexpr double kHoverFrom_m = 1.0;
  static constexpr double kLandWithin_m = 2.0;  ///< horizontally
  static constexpr Duration kLandAfter = std::chrono::seconds{1};
  /// A plane whose setpoint has a landing is given that as a mission, and flown by the rest of the
  /// setpoint until the autopilot has it; then it is put into AUTO. A setpoint without one, while
  /// the plane is no lower than that above home, has it go around: GUIDED again.
  static constexpr double kGoAroundFrom_m = 10.0;
  /// The operator gives the aircraft (back) to the companion: in the air, to be flown; disarmed on
  /// the ground, to stand by and, where it takes off by itself, to be launched (again). False where
  /// it cannot be given, and where it was taken after the operator's word was `issued`. In
  /// `duplicated` it says that the ids are mended, and no more.
  bool give_back(Instant now, Instant issued);
  /// The autopilot is given that fence, in flight too, reads it back, and keeps it from now on.
  /// What its parameters say of heights stays as its crew has set it.
  void keep_fence(const Fence& fence);

  /// What is due by `now`. To be called every 10 ms or so. Precondition: `now` never decreases.
  void step(Instant now);

  /// The next packet to be sent, whole; or nothing. Those of a duplicated node are withheld.
  [[nodiscard]] std::optional<mavlink::WireBytes> poll_packet();
  [[nodiscard]] std::optional<Notice> poll_notice();
  /// The newest state of the vehicle; nothing before there is one. Its time says how old it is.
  [[nodiscard]] std::optional<MotionSample> sample() const;

  [[nodiscard]] State state() const;
  /// What the autopilot's newest HEARTBEAT says, as its pilots call it: "GUIDED"; empty before one.
  [[nodiscard]] std::string mode() const;
  /// Armed or in the air, by what the autopilot says now; nothing while none is heard.
  [[nodiscard]] std::optional<bool> in_use() const;
  /// What keeps the aircraft from being flown, as it stands; the notices have it too, when it comes
  /// up and each minute from then on.
  [[nodiscard]] const std::vector<AutopilotNotice>& troubles() const;
  /// What the autopilot has said of itself, as checks before a flight look at it; nothing while
  /// that may yet come. Of the link only what troubles tell.
  [[nodiscard]] std::optional<AutopilotFacts> facts(Instant now) const;
  struct Heard {
    std::uint8_t system = 0;
    Instant at;
  };
  /// The newest HEARTBEAT of our autopilot, and of another's.
  [[nodiscard]] std::optional<Heard> heartbeat() const;
  [[nodiscard]] std::optional<Heard> other_heartbeat() const;
  [[nodiscard]] bool may_send() const { return state() != State::duplicated; }
  /// Events that the table had no entry for.
  [[nodiscard]] std::uint64_t protocol_errors() const;
  [[nodiscard]] const mavlink::ParserStatistics& parser() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

[[nodiscard]] std::string_view to_string(Companion::State state);
[[nodiscard]] std::string_view to_string(Companion::Event event);

}  // namespace skein::ardupilot
