// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bitset>
#include <cmath>
#include <utility>
#include <variant>
#include <vector>

#include "boot_clock.hpp"
#include "command_desk.hpp"
#include "custody.hpp"
#include "mission_upload.hpp"
#include "parameter_check.hpp"
#include "remote_id_speaker.hpp"
#include "skein/ardupilot/airframe.hpp"
#include "skein/ardupilot/companion.hpp"
#include "skein/ardupilot/flight_limits.hpp"
#include "skein/base/bounded_queue.hpp"
#include "status_text.hpp"
#include "steady_error.hpp"
#include "troubles.hpp"

namespace skein::ardupilot {

/// A refusal and its reason come apart, in any order.
inline constexpr Duration kReasonWithin = std::chrono::milliseconds{500};
/// What nothing is flown by, but checks before a flight look at: an autopilot may refuse them.
inline constexpr std::array kOnlyLookedAt{mavlink::GpsRawInt::kDefinition.id,
                                          mavlink::EkfStatusReport::kDefinition.id,
                                          mavlink::SystemTime::kDefinition.id};
/// What it takes to know where the aircraft is.
inline constexpr std::uint32_t kNavigation = mavlink::sensor_gps | mavlink::sensor_ahrs;
/// After it a mode or arming is asked for again.
inline constexpr Duration kRetryPeriod = std::chrono::seconds{1};

[[nodiscard]] inline mavlink::CommandLong command_of(mavlink::Command command, double p1 = 0.0,
                                                     double p2 = 0.0, double p3 = 0.0) {
  mavlink::CommandLong c;
  c.command = static_cast<std::uint16_t>(command);
  c.param1 = static_cast<float>(p1);
  c.param2 = static_cast<float>(p2);
  c.param3 = static_cast<float>(p3);
  return c;
}

class Companion::Impl {
 public:
  Impl(const CompanionParams& params, const MissionOrigin& origin, Instant now)
      : params_{params},
        traits_{traits_of(params.vehicle.airframe)},
        origin_{origin},
        parser_{mavlink::parser_params(params.signing, now)},
        motion_{origin, params.geoid_height_m, traits_.flies_to_points},
        parameters_{questions_of(params)},
        remote_id_{params.remote_id, params.vehicle.airframe, params.unix_us},
        frame_heard_{now},
        packet_heard_{now},
        heartbeat_at_{now},
        clock_at_{now},
        troubles_at_{now},
        position_good_at_{now} {}

  void on_bytes(std::span<const std::uint8_t> bytes, Instant now) {
    on_frame_heard(now);
    parser_.parse(bytes, [this, now](const mavlink::Packet& packet) { on_packet(packet, now); });
  }
  void on_frame_heard(Instant now) {
    frame_heard_ = now;
    if (machine_.in(State::lost)) fire(Event::autopilot_silent, now);
  }
  [[nodiscard]] std::optional<bool> in_use() const;
  [[nodiscard]] std::string mode() const {
    return system_ == 0 ? std::string{} : traits_.name_of(mode_);
  }
  void on_reboot(Instant now);
  void on_duplicate(std::uint8_t node_id, Instant now);
  void on_link_trouble(std::optional<AutopilotNotice> trouble) {
    link_trouble_ = std::move(trouble);
  }
  [[nodiscard]] const std::vector<AutopilotNotice>& troubles() const { return troubles_.holding(); }
  [[nodiscard]] std::optional<AutopilotFacts> facts(Instant now) const;
  [[nodiscard]] std::optional<Heard> heartbeat() const { return heartbeat_; }
  [[nodiscard]] std::optional<Heard> other_heartbeat() const { return other_heartbeat_; }
  void command(const Demand& demand, Instant now) {
    const auto* point = std::get_if<PositionSetpoint>(&demand);
    if (point != nullptr && (!traits_.flies_to_points || !point->finite())) return;
    demand_ = demand;
    demand_at_ = now;
  }
  bool give_back(Instant now, Instant issued);
  void keep_fence(const Fence& fence);
  void step(Instant now);

  std::optional<mavlink::WireBytes> poll_packet() { return packets_.pop(); }
  std::optional<Notice> poll_notice() { return notices_.pop(); }
  [[nodiscard]] std::optional<MotionSample> sample() const {
    auto sample = motion_.sample();
    if (!sample) return sample;
    sample->state.battery_percent = looked_at_.battery_percent();
    sample->state.phase = phase();
    return sample;
  }
  [[nodiscard]] const StateMachine<State, Event>& machine() const { return machine_; }
  [[nodiscard]] const mavlink::ParserStatistics& parser() const { return parser_.statistics(); }

 private:
  // What comes.
  void on_packet(const mavlink::Packet& packet, Instant now);
  void on_heartbeat(const mavlink::Heartbeat& heartbeat, const mavlink::Packet& packet,
                    Instant now);
  void refuse_system(const mavlink::Packet& packet, Instant now);
  void refuse(AutopilotNotice why, Instant now);
  void on_mode(Instant now);
  void on_check(Instant now);
  /// While arming: neither what it was before nor what was asked for.
  [[nodiscard]] bool mode_changed(std::uint32_t before) const;
  void on_timesync(const mavlink::Timesync& timesync, Instant now);
  void on_version(const mavlink::AutopilotVersion& version, Instant now);
  void on_text(const mavlink::Statustext& text, Instant now);
  void on_outcome(const Outcome& outcome, Instant now);
  void look_at(const mavlink::Packet& packet, Instant now);
  std::optional<Instant> measured_at(std::uint32_t time_boot_ms, Instant now);

  // What is due.
  void watch_silence(Instant now);
  void prepare(Instant now);
  void ask_streams();
  void check_parameters(Instant now);
  void ask_others(Instant now);
  [[nodiscard]] bool others_tried(Instant now) const;
  [[nodiscard]] bool facts_are_known(Instant now) const;
  [[nodiscard]] AutopilotNews parameter_news() const {
    return machine_.in(State::preparing) ? AutopilotNews::parameter_wrong
                                         : AutopilotNews::parameter_changed;
  }
  void watch_troubles(Instant now);
  [[nodiscard]] std::vector<AutopilotNotice> troubles_now(Instant now) const;
  [[nodiscard]] std::string not_told() const;
  /// It hears packets, but none that are signed with its key.
  [[nodiscard]] bool hears_unsigned() const {
    return system_ == 0 && parser_.statistics().bad_signature > 0 &&
           parser_.statistics().packets == 0;
  }
  [[nodiscard]] bool fails_pre_arm() const;
  /// For the pilot, the operator, or what is missing, on the ground or in the air.
  [[nodiscard]] bool waits() const {
    return machine_.in(State::preparing) || machine_.in(State::standing_by);
  }
  [[nodiscard]] static std::vector<ParameterQuestion> questions_of(const CompanionParams& params);
  void stand_by(Instant now);
  void leave_return_on_ground(Instant now);
  void arm(Instant now);
  void ask_for_mode(std::uint32_t mode, Instant now);
  void fly(Instant now);
  [[nodiscard]] FlightPhase phase() const;
  void prepare_landing(const Landing& landing, Instant now);
  void not_landed(std::string why, Instant now);
  void land(Instant now);
  void forget_landing();
  /// True once the autopilot has it, or there is none.
  bool give_fence(Instant now);
  void renew_fence(Instant now);
  void forget_fence();
  void say_upload(MissionUpload& upload, Instant now);
  void fly_to(PositionSetpoint point, const VehicleState& state, double home_z_m, Instant now);
  /// With the time and the autopilot's address in it, when one is due.
  template <class Message>
  void send_target(Message target, Instant now);
  void set_speed(const Setpoint& setpoint, double true_per_equivalent, Instant now);
  void set_height(const Setpoint& setpoint, const VehicleState& state, Instant now);
  void keep_clock(Instant now);
  void say_remote_id(Instant now);
  /// Where it must say who it is, and does not: why.
  [[nodiscard]] std::optional<std::string> lacks_remote_id(Instant now) const {
    return remote_id_.is_required() ? remote_id_.why_not(now) : std::nullopt;
  }
  void report_refusal(Instant now);
  [[nodiscard]] AutopilotNotice why_piloted(State from, Event event) const;
  [[nodiscard]] Given given() const;

  void fire(Event event, Instant now);
  void entered(State from, Event event, Instant now);
  void enter_standing_by(State from, Event event, Instant now);
  void begin_climb(Instant now);
  void finish_climb();
  void leave_hover(Instant now);
  void enter_piloted(State from, Event event, Instant now);
  void enter_loss(State from, std::uint32_t mode_before, Instant now);
  void reset_link();
  [[nodiscard]] mavlink::LandedState landed_state() const {
    return looked_at_.landed ? static_cast<mavlink::LandedState>(looked_at_.landed->landed_state)
                             : mavlink::LandedState::undefined;
  }
  [[nodiscard]] bool airborne() const;
  [[nodiscard]] bool high() const;
  /// A quadplane that its rotors carry.
  [[nodiscard]] bool hovers() const;
  /// So low that it is not flown on its wings from there: on the way to them it sinks.
  [[nodiscard]] bool hovers_low() const { return hovers() && !high(); }
  [[nodiscard]] std::uint16_t taken_over_at() const {
    return static_cast<std::uint16_t>(std::lround(taken_over_at_m(params_.takeoff_height_m)));
  }
  [[nodiscard]] std::optional<AutopilotNotice> hover_trouble(Instant now) const;
  [[nodiscard]] bool navigation_healthy() const {
    // An ArduPilot without a GNSS does not count it among what is enabled.
    return looked_at_.health &&
           (looked_at_.health->onboard_control_sensors_enabled &
            looked_at_.health->onboard_control_sensors_health & kNavigation) == kNavigation;
  }
  [[nodiscard]] bool guided() const { return mode_ == traits_.guided_mode; }
  void ask_parameter(std::string_view name);
  void ask(const mavlink::CommandLong& command, const Patience& patience, bool latest);
  void send_command(const mavlink::CommandLong& command);
  template <class Message>
  void send(const Message& message) {
    if (encoder_) packets_.push(encoder_->encode(message));
  }
  void say(bool warning, AutopilotNotice what, Instant now) {
    notices_.push({now, warning, std::move(what)});
  }

  CompanionParams params_;
  const AirframeTraits& traits_;
  MissionOrigin origin_;
  StateMachine<State, Event> machine_{Companion::table(), State::searching};
  mavlink::Parser parser_;
  std::optional<mavlink::Encoder> encoder_;  ///< once the system's number is known
  CommandDesk desk_;
  BootClock clock_;
  Motion motion_;
  ParameterCheck parameters_;
  RemoteIdSpeaker remote_id_;
  BoundedQueue<mavlink::WireBytes> packets_{64};
  BoundedQueue<Notice> notices_{64};
  Troubles troubles_;
  PreArmTexts pre_arm_;

  // What was heard.
  Instant frame_heard_;
  Instant packet_heard_;
  std::bitset<256> refused_systems_;
  std::optional<Heard> heartbeat_;
  std::optional<Heard> other_heartbeat_;
  std::optional<AutopilotNotice> link_trouble_;
  std::optional<AutopilotNotice> wrong_;  ///< why it is refused
  std::uint32_t mode_ = 0;
  enum class Firmware : std::uint8_t { unknown, accepted, refused };
  Firmware firmware_ = Firmware::unknown;  ///< accepted too where the autopilot does not tell
  std::uint8_t system_ = 0;                ///< once it has been found
  bool armed_ = false;
  bool streams_granted_ = false;
  bool renews_fence_ = false;  ///< in flight: it has another one to keep
  bool climbed_ = false;       ///< by its own launch, and has not been flown since
  bool told_fence_ = false;
  bool told_upload_ = false;
  bool may_land_ = false;  ///< the autopilot has the mission, and stands at its landing
  bool told_too_low_ = false;
  std::optional<Duration> boot_;  ///< the newest time on the autopilot's clock
  StatusText text_;
  std::optional<Instant> last_text_at_;
  AutopilotFacts looked_at_;  ///< what it says of itself, as far as it was told

  // What was asked and done.
  Custody custody_;
  struct SinceEntry {             ///< of the state
    std::uint32_t mode = 0;       ///< when it was entered
    bool mode_confirmed = false;  ///< the one that was asked for has been heard
    bool arm_asked = false;
    bool clock_heard = false;  ///< and not younger than the newest before it
    int retries = 0;
    Instant retry_at;
    Instant at;
  };
  SinceEntry entry_;
  std::uint8_t duplicate_node_ = 0;
  State before_loss_ = State::standing_by;
  std::uint32_t mode_before_loss_ = 0;  ///< when that state was entered
  int clock_questions_ = 0;
  Instant lost_at_{};
  Instant heartbeat_at_;
  Instant clock_at_;
  std::vector<Instant> clock_asked_;  ///< and not yet answered
  std::optional<Instant> streams_asked_at_;
  Instant taken_at_;
  Instant climb_by_;
  std::optional<Instant> duplicate_at_;
  std::optional<Demand> demand_;
  Instant demand_at_;
  Instant target_at_;
  std::optional<Instant> on_ground_since_;  ///< the point that is flown
  std::optional<Instant> sank_at_;          ///< likewise, last
  double sinks_from_m_ = 0.0;               ///< likewise, above home, as far as it matters
  SteadyError height_error_{{}};
  std::optional<Instant> leaves_hover_since_;  ///< a quadplane was told to, and still hovers
  std::optional<Instant> hover_left_at_;       ///< when it was last told to
  std::optional<Instant> flown_at_;            ///< when a plane was last told what to fly
  std::optional<double> speed_sent_;
  Instant speed_at_;
  std::optional<double> height_sent_;
  std::optional<Instant> height_at_;
  MissionUpload fence_upload_{MissionUpload::Kind::fence};
  Instant fence_again_at_ = Instant::min();             ///< after one that failed
  std::string fence_failed_;                            ///< why, while it is so
  MissionUpload upload_{MissionUpload::Kind::mission};  ///< of a plane's landing
  std::optional<Landing> uploads_;                      ///< what that is of
  Instant upload_again_at_ = Instant::min();            ///< after one that failed
  std::optional<Outcome> refusal_;
  Instant refusal_at_;
  std::optional<AutopilotNotice> said_refusal_;
  Instant troubles_at_;
  Instant position_good_at_;
  std::optional<Instant> reasons_asked_at_;  ///< for not arming
  int others_asked_ = 0;                     ///< parameters that are only looked at
  Instant others_at_{Instant::min()};
};

}  // namespace skein::ardupilot
