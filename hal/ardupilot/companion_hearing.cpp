// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "companion_impl.hpp"
#include "skein/ardupilot/firmware.hpp"

/// What the companion makes of what it hears.
namespace skein::ardupilot {
namespace {

using mavlink::Command;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kTripMax = seconds{2};  ///< of a question about the time
constexpr Duration kBootMax = std::chrono::hours{2400};
constexpr Duration kBootStep = milliseconds{500};  ///< the clock goes back so far: a reboot

/// The states in which the companion has the aircraft, or asks for it.
bool is_own(Companion::State state) {
  using State = Companion::State;
  return state == State::arming || state == State::climbing || state == State::taking_over ||
         state == State::flying || state == State::landing;
}

}  // namespace

void Companion::Impl::on_packet(const mavlink::Packet& packet, Instant now) {
  if (is_of_transmitter(packet, params_.system_id)) {
    return remote_id_.on_packet(packet, now);
  }
  if (packet.component != mavlink::kComponentAutopilot) return;
  if (packet.system != params_.system_id) return refuse_system(packet, now);
  packet_heard_ = now;
  if (machine_.in(State::lost) || machine_.in(State::silent)) fire(Event::packets_back, now);
  if (const auto heartbeat = mavlink::decode<mavlink::Heartbeat>(packet)) {
    return on_heartbeat(*heartbeat, packet, now);
  }
  if (system_ == 0) return;
  look_at(packet, now);
  if (const auto attitude = mavlink::decode<mavlink::Attitude>(packet)) {
    if (const auto at = measured_at(attitude->time_boot_ms, now)) {
      motion_.on_attitude(*attitude, *at);
    }
  } else if (const auto position = mavlink::decode<mavlink::GlobalPositionInt>(packet)) {
    if (const auto at = measured_at(position->time_boot_ms, now)) {
      motion_.on_position(*position, *at);
    }
  } else if (const auto hud = mavlink::decode<mavlink::VfrHud>(packet)) {
    motion_.on_hud(*hud, now);
  } else if (const auto status = mavlink::decode<mavlink::SysStatus>(packet)) {
    if ((status->onboard_control_sensors_health & mavlink::sensor_prearm_check) != 0) {
      pre_arm_.clear();
    }
  } else if (mavlink::decode<mavlink::ExtendedSysState>(packet)) {
    if (landed_state() != mavlink::LandedState::undefined && airborne()) {
      custody_.fire(Custody::Event::in_use);
    }
  } else if (const auto timesync = mavlink::decode<mavlink::Timesync>(packet)) {
    on_timesync(*timesync, now);
  } else if (const auto version = mavlink::decode<mavlink::AutopilotVersion>(packet)) {
    on_version(*version, now);
  } else if (const auto text = mavlink::decode<mavlink::Statustext>(packet)) {
    on_text(*text, now);
  } else if (const auto parameter = mavlink::decode<mavlink::ParamValue>(packet)) {
    parameters_.on_value(mavlink::text_of(parameter->param_id), parameter->param_value);
  } else if (const auto ack = mavlink::decode<mavlink::CommandAck>(packet)) {
    if (const auto outcome = desk_.on_ack(*ack)) on_outcome(*outcome, now);
  } else {
    upload_.on_packet(packet, now);
    fence_upload_.on_packet(packet, now);
  }
}

void Companion::Impl::refuse_system(const mavlink::Packet& packet, Instant now) {
  if (packet.id != mavlink::Heartbeat::kDefinition.id) return;
  other_heartbeat_ = {packet.system, now};
  if (refused_systems_.test(packet.system)) return;
  refused_systems_.set(packet.system);
  AutopilotNotice other{.news = AutopilotNews::other_system,
                        .number = packet.system,
                        .detail = "system " + std::to_string(params_.system_id)};
  troubles_.on_told(other, now);
  say(true, std::move(other), now);
}

void Companion::Impl::refuse(AutopilotNotice why, Instant now) {
  wrong_ = why;
  troubles_.on_told(why, now);
  say(true, std::move(why), now);
}

void Companion::Impl::on_heartbeat(const mavlink::Heartbeat& heartbeat,
                                   const mavlink::Packet& packet, Instant now) {
  heartbeat_ = {packet.system, now};
  looked_at_.heartbeat = heartbeat;
  mode_ = heartbeat.custom_mode;
  armed_ = (heartbeat.base_mode & mavlink::mode_safety_armed) != 0;
  custody_.fire(armed_ ? Custody::Event::in_use : Custody::Event::disarmed);
  const bool looks_again = machine_.in(State::refused) && firmware_ != Firmware::refused;
  if (machine_.in(State::searching) || looks_again) {
    std::optional<AutopilotNotice> wrong;
    if (heartbeat.autopilot != static_cast<std::uint8_t>(mavlink::Autopilot::ardupilotmega)) {
      wrong = {.news = AutopilotNews::wrong_make, .number = heartbeat.autopilot};
    } else if (!traits_.is_of(heartbeat.type)) {
      wrong = {.news = AutopilotNews::wrong_airframe,
               .number = heartbeat.type,
               .detail = std::string{to_string(params_.vehicle.airframe)}};
    }
    if (!wrong) {
      system_ = packet.system;
      encoder_.emplace(system_, mavlink::kComponentOnboardComputer);
      mavlink::sign_at(params_.signing, *encoder_, parser_, now);
      fire(Event::autopilot_found, now);
    } else if (machine_.in(State::searching)) {
      fire(Event::wrong_autopilot, now);
      refuse(*std::move(wrong), now);
    } else {
      wrong_ = wrong;
    }
    return;
  }
  on_mode(now);
}

void Companion::Impl::on_mode(Instant now) {
  switch (machine_.state()) {
    case State::arming:
      if (armed_ && entry_.arm_asked && mode_ == traits_.takeoff_mode) {
        fire(Event::armed, now);
      } else if (armed_ || airborne() || mode_changed(entry_.mode)) {
        fire(Event::other_mode, now);
      } else if (mode_ == traits_.takeoff_mode) {
        entry_.mode_confirmed = true;
      }
      break;
    case State::climbing:
      if (!armed_) {
        fire(Event::disarmed, now);
      } else if (mode_ != traits_.takeoff_mode) {
        fire(Event::other_mode, now);
      }
      break;
    case State::taking_over:
      if (!armed_) {
        fire(Event::disarmed, now);
      } else if (guided()) {
        fire(Event::guided, now);
      } else if (mode_ != entry_.mode) {
        fire(Event::other_mode, now);
      }
      break;
    case State::flying:
      if (!guided()) {
        fire(Event::other_mode, now);
      } else if (!armed_) {
        fire(Event::disarmed, now);
      }
      break;
    case State::landing:
      if (!armed_) {
        fire(Event::disarmed, now);
      } else if (mode_ == traits_.land_mode) {
        entry_.mode_confirmed = true;
      } else if (entry_.mode_confirmed || !guided()) {
        fire(Event::other_mode, now);
      }
      break;
    case State::checking:
      on_check(now);
      break;
    case State::duplicated:
      // Whoever changes it now is not the companion, which says nothing.
      if (is_own(before_loss_) && mode_ != entry_.mode) {
        custody_.fire(Custody::Event::taken_by_others);
      }
      break;
    default:
      break;
  }
}

bool Companion::Impl::mode_changed(std::uint32_t before) const {
  return mode_ != traits_.takeoff_mode && (entry_.mode_confirmed || mode_ != before);
}

void Companion::Impl::on_check(Instant now) {
  // A HEARTBEAT has no time in it: that of a rebooted autopilot, in its first mode, would pass for
  // the pilot's word. Which boot it is of, the clock says, or the node's uptime.
  if (!entry_.clock_heard) return;
  switch (before_loss_) {
    case State::flying:
    case State::taking_over: {
      const bool as_before = before_loss_ == State::taking_over && mode_ == mode_before_loss_;
      if (!armed_) {
        fire(Event::disarmed, now);
      } else if (guided()) {
        fire(Event::guided, now);
      } else {
        fire(as_before ? Event::not_ours : Event::other_mode, now);
      }
      break;
    }
    case State::climbing:
      if (!armed_) {
        fire(Event::disarmed, now);
      } else {
        const bool still = mode_ == traits_.takeoff_mode;
        fire(still ? Event::still_climbing : Event::other_mode, now);
      }
      break;
    case State::landing:
      // In GUIDED it has not heard of it: where the setpoint stays, it is told again.
      if (!armed_) {
        fire(Event::disarmed, now);
      } else if (mode_ == traits_.land_mode) {
        fire(Event::still_landing, now);
      } else {
        fire(guided() ? Event::guided : Event::other_mode, now);
      }
      break;
    case State::arming: {
      const bool other = armed_ || airborne() || mode_changed(mode_before_loss_);
      fire(other ? Event::other_mode : Event::not_ours, now);
      break;
    }
    case State::piloted:
      fire(Event::other_mode, now);
      break;
    default:
      fire(Event::not_ours, now);
      break;
  }
}

void Companion::Impl::on_timesync(const mavlink::Timesync& timesync, Instant now) {
  const std::int64_t ours = now.time_since_epoch().count();
  if (timesync.tc1 == 0) {
    mavlink::Timesync answer;
    answer.tc1 = ours;
    answer.ts1 = timesync.ts1;
    return send(answer);
  }
  std::erase_if(clock_asked_, [now](Instant asked) { return now - asked > kTripMax; });
  // Anything else is the answer to somebody else's question, or a second one.
  const auto asked =
      std::find(clock_asked_.begin(), clock_asked_.end(), Instant{Duration{timesync.ts1}});
  const Duration boot{timesync.tc1};
  if (asked == clock_asked_.end() || boot < Duration{} || boot >= kBootMax) return;
  const Instant sent = *asked;
  clock_asked_.erase(asked);
  clock_.on_round_trip(sent, now, boot);
}

void Companion::Impl::on_version(const mavlink::AutopilotVersion& version, Instant now) {
  const std::uint32_t firmware = version.flight_sw_version;
  if (firmware_ == Firmware::accepted) return;
  if (!firmware_is_new_enough(firmware)) {
    firmware_ = Firmware::refused;
    refuse({.news = AutopilotNews::old_firmware, .detail = firmware_text(firmware)}, now);
    if (machine_.in(State::preparing)) fire(Event::wrong_autopilot, now);
    return;
  }
  firmware_ = Firmware::accepted;
  say(false, {.news = AutopilotNews::firmware, .detail = firmware_text(firmware)}, now);
}

void Companion::Impl::on_text(const mavlink::Statustext& text, Instant now) {
  const std::string& whole = text_.add(text);
  const bool warning = text.severity <= static_cast<std::uint8_t>(mavlink::Severity::warning);
  if (warning) last_text_at_ = now;
  if (!(waits() || machine_.in(State::arming)) || !PreArmTexts::is_one(whole)) {
    say(false, {.news = AutopilotNews::text, .detail = whole}, now);
  } else if (StatusText::ends(text)) {
    std::string reason = PreArmTexts::reason_of(whole);
    // Who launches it puts it into another mode.
    const bool leaves_mode =
        params_.take_over == TakeOver::from_ground && PreArmTexts::is_of_mode(reason);
    if (!leaves_mode && pre_arm_.add(reason, now)) {
      say(true, {.news = AutopilotNews::pre_arm, .detail = std::move(reason)}, now);
    }
  }
  if (warning && refusal_) report_refusal(now);
}

void Companion::Impl::on_outcome(const Outcome& outcome, Instant now) {
  const auto command = static_cast<Command>(outcome.command.command);
  if (command == Command::set_message_interval) {
    const bool attitude =
        static_cast<std::uint32_t>(outcome.command.param1) == mavlink::Attitude::kDefinition.id;
    if (attitude) streams_granted_ = outcome.answer == Answer::accepted;
  }
  if (command == Command::request_message && outcome.answer != Answer::accepted) {
    firmware_ = Firmware::accepted;
  }
  if (command == Command::do_change_altitude && outcome.answer != Answer::accepted) {
    height_sent_.reset();
  }
  if (command == Command::do_set_mission_current) {
    may_land_ = outcome.answer == Answer::accepted;
    if (!may_land_) not_landed("the autopilot does not begin the mission", now);
  }
  if (command == Command::do_change_speed && outcome.answer == Answer::unanswered) {
    speed_sent_.reset();
  }
  const bool is_only_looked_at =
      command == Command::set_message_interval &&
      std::ranges::find(kOnlyLookedAt, static_cast<std::uint32_t>(outcome.command.param1)) !=
          kOnlyLookedAt.end();
  if (outcome.answer != Answer::refused || command == Command::run_prearm_checks ||
      is_only_looked_at) {
    return;
  }
  if (refusal_) report_refusal(now);
  refusal_ = outcome;
  refusal_at_ = now;
  // The reason comes as a text of its own, before the answer or after it.
  if (last_text_at_ && now - *last_text_at_ <= kReasonWithin) report_refusal(now);
}

void Companion::Impl::report_refusal(Instant now) {
  std::string text =
      name_of_command(refusal_->command.command) + ": " + name_of_result(refusal_->result);
  const auto command = static_cast<Command>(refusal_->command.command);
  if (command == Command::set_message_interval) {
    const auto id = static_cast<std::uint32_t>(refusal_->command.param1);
    const auto* info = mavlink::find_message(id);
    text += " (" + (info != nullptr ? std::string{info->name} : std::to_string(id)) + ")";
  }
  if (last_text_at_ && now - *last_text_at_ <= 2 * kReasonWithin) text += ": " + text_.text();
  refusal_.reset();
  AutopilotNotice refused{.news = AutopilotNews::command_refused, .detail = std::move(text)};
  if (refused == said_refusal_) return;
  said_refusal_ = refused;
  say(true, std::move(refused), now);
}

std::optional<Instant> Companion::Impl::measured_at(std::uint32_t time_boot_ms, Instant now) {
  const Duration boot = milliseconds{time_boot_ms};
  if (boot_ && boot + kBootStep < *boot_) on_reboot(now);
  boot_ = std::max(boot_.value_or(boot), boot);
  entry_.clock_heard = true;
  clock_.on_arrival(now, boot);
  return clock_.mission_time(boot, now);
}

void Companion::Impl::on_reboot(Instant now) {
  reset_link();
  parameters_.begin();  // it may have read others
  firmware_ = Firmware::unknown;
  if (machine_.accepts(Event::rebooted)) fire(Event::rebooted, now);
}

void Companion::Impl::on_duplicate(std::uint8_t node_id, Instant now) {
  duplicate_at_ = now;
  duplicate_node_ = node_id;
  if (machine_.accepts(Event::duplicate)) fire(Event::duplicate, now);
}

void Companion::Impl::reset_link() {
  desk_.clear();
  clock_.restart();
  motion_.forget();
  boot_.reset();
  system_ = 0;
  clock_questions_ = 0;
  clock_asked_.clear();
  streams_asked_at_.reset();
  streams_granted_ = false;
  if (firmware_ == Firmware::accepted) firmware_ = Firmware::unknown;
  refusal_.reset();
  pre_arm_.clear();
  reasons_asked_at_.reset();
  looked_at_ = {};
  remote_id_.forget();
  others_asked_ = 0;
  forget_fence();
}

}  // namespace skein::ardupilot
