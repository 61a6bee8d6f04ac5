// SPDX-License-Identifier: Apache-2.0
#include "mavlink_endpoint.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "skein/base/angles.hpp"

namespace skein::hil {
namespace {

using namespace std::chrono_literals;
using mavlink::Command;
using mavlink::CommandResult;

constexpr Duration kStreamInterval = 1s;
constexpr Duration kTimesyncInterval = 10s;
constexpr Duration kRefusalInterval = 30s;
/// From the answer to the restart.
constexpr Duration kRestartDelay = 200ms;
/// A message may be sent in at most this share of the periods of the main loop.
constexpr double kRateShareMax = 0.8;
constexpr float kForce = 21196.0F;                ///< COMPONENT_ARM_DISARM, param2
constexpr std::int32_t kForceRestart = 20190226;  ///< PREFLIGHT_REBOOT_SHUTDOWN, param6
constexpr std::uint8_t kUnaskedFrame =
    static_cast<std::uint8_t>(mavlink::Frame::global_relative_alt);
/// What radios are told before anything else.
constexpr std::string_view kGreeting = "0 0 0 ";

/// The nearest integer; 0 for what is no number.
std::int32_t to_int(double value) {
  if (!std::isfinite(value)) return 0;
  return static_cast<std::int32_t>(std::llround(std::clamp(value, -2147483648.0, 2147483647.0)));
}
std::uint32_t to_unsigned(float value) {
  return static_cast<std::uint32_t>(std::max(0, to_int(static_cast<double>(value))));
}

bool has_place(std::uint16_t command) {
  return static_cast<Command>(command) == Command::do_reposition ||
         static_cast<Command>(command) == Command::do_set_home;
}

/// ArduPlane 4.6.3 called DO_REPOSITION as COMMAND_LONG unsupported.
bool may_be_floats(std::uint16_t command, Airframe airframe) {
  return airframe == Airframe::copter || static_cast<Command>(command) != Command::do_reposition;
}

/// ArduPilot turns every other COMMAND_LONG to a COMMAND_INT; places lose precision in the floats.
mavlink::CommandInt as_int(const mavlink::CommandLong& c) {
  const double unit = has_place(c.command) ? 1e7 : 1.0;
  mavlink::CommandInt out;
  out.param1 = c.param1;
  out.param2 = c.param2;
  out.param3 = c.param3;
  out.param4 = c.param4;
  out.x = to_int(static_cast<double>(c.param5) * unit);
  out.y = to_int(static_cast<double>(c.param6) * unit);
  out.z = c.param7;
  out.command = c.command;
  out.target_system = c.target_system;
  out.target_component = c.target_component;
  out.frame = kUnaskedFrame;
  return out;
}

std::optional<mavlink::Signing> signing_of(const EmulatorConfig& config) {
  if (!config.signing_key) return std::nullopt;
  return mavlink::Signing{*config.signing_key, config.unix_us};
}

}  // namespace

MavlinkEndpoint::MavlinkEndpoint(const EmulatorConfig& config, const Earth& earth, Vehicle& vehicle,
                                 const Battery& battery, dronecan::TunnelPort& port, Instant booted,
                                 Instant now)
    : config_{config},
      earth_{earth},
      vehicle_{vehicle},
      battery_{battery},
      port_{port},
      booted_{booted},
      signing_{signing_of(config)},
      parser_{mavlink::parser_params(signing_, now)},
      encoder_{config.system_id, mavlink::kComponentAutopilot},
      fence_{config.fence_height_m},
      mission_{0, [this](auto items) { return vehicle_.load_mission(items); }},
      fence_store_{1, [this](auto items) { return fence_.load(items, earth_); }},
      timesync_at_{now + kTimesyncInterval},
      refusal_told_at_{now} {
  for (const std::uint32_t id : telemetry_ids()) {
    streams_.push_back({id, default_interval(id), now});
  }
  if (config_.remote_id) remote_id_.emplace(config_.system_id);
  mavlink::sign_at(signing_, encoder_, parser_, now);
  std::array<std::uint8_t, kGreeting.size()> greeting{};
  std::copy(kGreeting.begin(), kGreeting.end(), greeting.begin());
  (void)port_.write(greeting);
  (void)send_once(mavlink::Heartbeat::kDefinition.id, now);
  say(mavlink::Severity::info, "ArduPilot Ready");
}

Duration MavlinkEndpoint::default_interval(std::uint32_t id) const {
  if (id == mavlink::Heartbeat::kDefinition.id) return kStreamInterval;
  return vehicle_.streams_unasked() && is_streamed_unasked(id) ? kStreamInterval : Duration{};
}

void MavlinkEndpoint::step(Instant now) {
  mavlink::sign_at(signing_, encoder_, parser_, now);
  std::array<std::uint8_t, 256> bytes{};
  while (const std::size_t size = port_.read(bytes)) {
    parser_.parse(std::span{bytes}.first(size),
                  [&](const mavlink::Packet& packet) { on_packet(packet, now); });
  }
  while (const auto notice = vehicle_.poll_notice()) {
    say(static_cast<mavlink::Severity>(notice->severity), notice->text);
  }
  say_mission(mission_, now);
  say_mission(fence_store_, now);
  if (const auto breach = fence_.news(vehicle_.report())) {
    say(mavlink::Severity::notice, std::string{*breach});
    (void)vehicle_.select_mode(mode_named(config_.airframe, "RTL").value());
  }
  for (Stream& stream : streams_) {
    if (stream.interval == Duration{} || now < stream.due) continue;
    stream.due = std::max(stream.due + stream.interval, now);
    (void)send_once(stream.id, now);
  }
  if (const auto word = remote_id_ ? remote_id_->poll(now) : std::nullopt) send(*word);
  if (now >= timesync_at_) {
    timesync_at_ = now + kTimesyncInterval;
    mavlink::Timesync question;
    question.ts1 = (now - booted_).count();
    send(encoder_.encode(question));
  }
  if (refusal_ && !vehicle_.report().armed && now >= refusal_told_at_) {
    refusal_told_at_ = now + kRefusalInterval;
    say(mavlink::Severity::critical, "PreArm: " + *refusal_);
  }
}

void MavlinkEndpoint::on_packet(const mavlink::Packet& packet, Instant now) {
  if (packet.system == config_.system_id && packet.component == mavlink::kComponentAutopilot) {
    return;
  }
  if (packet.id == mavlink::Heartbeat::kDefinition.id) {
    if (packet.system == config_.companion_system) vehicle_.companion_heard(now);
  } else if (const auto command = mavlink::decode<mavlink::CommandInt>(packet)) {
    if (for_us(command->target_system, command->target_component)) {
      acknowledge(*command, obey(*command, now), packet);
    }
  } else if (const auto floats = mavlink::decode<mavlink::CommandLong>(packet)) {
    if (for_us(floats->target_system, floats->target_component)) {
      const mavlink::CommandInt whole = as_int(*floats);
      const bool known = may_be_floats(floats->command, config_.airframe);
      acknowledge(whole, known ? obey(whole, now) : CommandResult::unsupported, packet);
    }
  } else if (const auto asked = mavlink::decode<mavlink::ParamRequestRead>(packet)) {
    if (for_us(asked->target_system, asked->target_component)) {
      tell_parameter(mavlink::text_of(asked->param_id));
    }
  } else if (const auto question = mavlink::decode<mavlink::Timesync>(packet)) {
    on_timesync(*question, packet, now);
  } else if (const auto attitude = mavlink::decode<mavlink::SetAttitudeTarget>(packet)) {
    if (for_us(attitude->target_system, attitude->target_component)) {
      vehicle_.on_attitude_target(*attitude, now);
    }
  } else if (const auto local = mavlink::decode<mavlink::SetPositionTargetLocalNed>(packet)) {
    if (for_us(local->target_system, local->target_component)) {
      vehicle_.on_position_target(*local, now);
    }
  } else if (const auto global = mavlink::decode<mavlink::SetPositionTargetGlobalInt>(packet)) {
    if (for_us(global->target_system, global->target_component)) {
      vehicle_.on_position_target(*global, now);
    }
  } else if (remote_id_ && remote_id_->on_packet(packet, now)) {
    return;
  } else if (mission_.on_packet(packet, now) || fence_store_.on_packet(packet, now)) {
    mission_system_ = packet.system;
    mission_component_ = packet.component;
  }
}

void MavlinkEndpoint::say_mission(MissionStore& store, Instant now) {
  while (auto answer = store.poll(now)) {
    std::visit(
        [this](auto& said) {
          said.target_system = mission_system_;
          said.target_component = mission_component_;
          send(encoder_.encode(said));
        },
        *answer);
  }
}

bool MavlinkEndpoint::for_us(std::uint8_t system, std::uint8_t component) const {
  return (system == 0 || system == config_.system_id) &&
         (component == 0 || component == mavlink::kComponentAutopilot);
}

void MavlinkEndpoint::acknowledge(const mavlink::CommandInt& command, CommandResult result,
                                  const mavlink::Packet& packet) {
  mavlink::CommandAck ack;
  ack.command = command.command;
  ack.result = static_cast<std::uint8_t>(result);
  ack.target_system = packet.system;
  ack.target_component = packet.component;
  send(encoder_.encode(ack));
}

CommandResult MavlinkEndpoint::obey(const mavlink::CommandInt& command, Instant now) {
  switch (static_cast<Command>(command.command)) {
    case Command::do_set_mode:
      return set_mode(command);
    case Command::component_arm_disarm:
      return arm_or_disarm(command);
    case Command::run_prearm_checks:
      if (vehicle_.report().armed) return CommandResult::temporarily_rejected;
      refusal_told_at_ = now;
      return CommandResult::accepted;
    case Command::set_message_interval:
      return set_interval(command, now);
    case Command::get_message_interval:
      return tell_interval(command);
    case Command::request_message:
      return send_once(to_unsigned(command.param1), now);
    case Command::request_autopilot_capabilities:
      return command.param1 == 1.0F ? send_once(mavlink::AutopilotVersion::kDefinition.id, now)
                                    : CommandResult::denied;
    case Command::get_home_position:
      return send_once(mavlink::HomePosition::kDefinition.id, now);
    case Command::preflight_reboot_shutdown:
      return restart(command, now);
    default:
      return vehicle_.command(command);
  }
}

CommandResult MavlinkEndpoint::set_mode(const mavlink::CommandInt& command) {
  if ((to_unsigned(command.param1) & mavlink::mode_custom_enabled) == 0) {
    return CommandResult::denied;
  }
  return on_wire(vehicle_.select_mode(to_unsigned(command.param2)));
}

CommandResult MavlinkEndpoint::arm() {
  if (refusal_ && !vehicle_.report().armed) {
    say(mavlink::Severity::critical, "Arm: " + *refusal_);
    return CommandResult::failed;
  }
  return on_wire(vehicle_.arm());
}

CommandResult MavlinkEndpoint::arm_or_disarm(const mavlink::CommandInt& command) {
  if (command.param1 == 1.0F) return arm();
  if (command.param1 == 0.0F) return on_wire(vehicle_.disarm(command.param2 == kForce));
  return CommandResult::unsupported;
}

MavlinkEndpoint::Stream* MavlinkEndpoint::find_stream(std::uint32_t id) {
  const auto found = std::find_if(streams_.begin(), streams_.end(),
                                  [id](const Stream& stream) { return stream.id == id; });
  return found == streams_.end() ? nullptr : &*found;
}

CommandResult MavlinkEndpoint::set_interval(const mavlink::CommandInt& command, Instant now) {
  Stream* const stream = find_stream(to_unsigned(command.param1));
  if (stream == nullptr) return CommandResult::failed;
  const Duration wanted = std::chrono::microseconds{to_int(static_cast<double>(command.param2))};
  if (wanted < Duration{}) {
    stream->interval = Duration{};
  } else if (wanted == Duration{}) {
    stream->interval = default_interval(stream->id);
  } else if (to_seconds(vehicle_.period()) > kRateShareMax * to_seconds(wanted)) {
    return CommandResult::denied;
  } else {
    stream->interval = wanted;
  }
  stream->due = now;
  return CommandResult::accepted;
}

CommandResult MavlinkEndpoint::tell_interval(const mavlink::CommandInt& command) {
  const std::uint32_t id = to_unsigned(command.param1);
  const Stream* const stream = find_stream(id);
  mavlink::MessageInterval answer;
  answer.message_id = static_cast<std::uint16_t>(id);
  if (stream != nullptr) {
    answer.interval_us =
        stream->interval == Duration{}
            ? -1
            : static_cast<std::int32_t>(stream->interval / std::chrono::microseconds{1});
  }
  send(encoder_.encode(answer));
  return CommandResult::accepted;
}

CommandResult MavlinkEndpoint::send_once(std::uint32_t id, Instant now) {
  const auto bytes = telemetry(id, encoder_, situation(now));
  if (!bytes) return CommandResult::failed;
  send(*bytes);
  return CommandResult::accepted;
}

CommandResult MavlinkEndpoint::restart(const mavlink::CommandInt& command, Instant now) {
  if (command.param1 != 1.0F) return CommandResult::unsupported;
  if (vehicle_.report().armed && command.y != kForceRestart) return CommandResult::failed;
  restart_at_ = now + kRestartDelay;
  return CommandResult::accepted;
}

/// Those that it keeps to; of others it says nothing, as ArduPilot of those that it does not know.
void MavlinkEndpoint::tell_parameter(std::string_view name) {
  const bool is_plane = config_.airframe != Airframe::copter;
  const double failsafe = config_.companion_failsafe ? 1.0 : 0.0;
  struct Parameter {
    std::string_view name;
    double value = 0.0;
    mavlink::ParamType type = mavlink::ParamType::int8;
  };
  constexpr auto kReal = mavlink::ParamType::real32;
  const bool fenced = fence_.enabled();
  const bool is_quadplane = config_.airframe == Airframe::quadplane;
  const std::array<Parameter, 21> parameters{{
      {"SYSID_THISMAV", static_cast<double>(config_.system_id)},
      {"SYSID_MYGCS", static_cast<double>(config_.companion_system)},
      {is_plane ? "FS_GCS_ENABL" : "FS_GCS_ENABLE", failsafe},
      {is_plane ? "FS_LONG_ACTN" : "", failsafe},  // RTL, or none
      {is_plane ? "" : "WPNAV_SPEED_UP", 100.0 * config_.climb_mps, kReal},
      {is_plane ? "" : "WPNAV_SPEED_DN", 100.0 * config_.climb_mps, kReal},
      {is_plane ? "ROLL_LIMIT_DEG" : "", is_plane ? degrees(bank_limit_rad(config_)) : 0.0, kReal},
      {is_plane ? "AIRSPEED_MIN" : "", config_.airspeed_min_mps, kReal},
      {is_plane ? "AIRSPEED_MAX" : "", config_.airspeed_max_mps, kReal},
      {is_plane ? "AIRSPEED_CRUISE" : "", config_.airspeed_mps, kReal},
      {is_plane ? "TECS_SPDWEIGHT" : "", 0.0, kReal},
      {is_plane ? "STALL_PREVENTION" : "", 0.0},  // nor does it
      {is_quadplane ? "Q_ENABLE" : "", 1.0},
      {is_quadplane ? "Q_GUIDED_MODE" : "", 0.0},
      {is_quadplane ? "Q_ASSIST_SPEED" : "", -1.0, kReal},  // off
      {"FENCE_ENABLE", fenced ? 1.0 : 0.0},
      {"FENCE_ACTION", 1.0},
      {"FENCE_TYPE", 5.0},
      {"FENCE_ALT_MAX", config_.fence_height_m, kReal},
      {config_.remote_id ? "DID_ENABLE" : "", 1.0},
      {config_.remote_id ? "DID_OPTIONS" : "", 1.0},
  }};
  const auto known = std::ranges::find(parameters, name, &Parameter::name);
  if (name.empty() || known == parameters.end() ||
      std::ranges::find(config_.unknown_parameters, name) != config_.unknown_parameters.end()) {
    return;
  }
  mavlink::ParamValue answer;
  answer.param_value = static_cast<float>(known->value);
  answer.param_count = static_cast<std::uint16_t>(parameters.size());
  answer.param_index = 0xFFFF;  // it was asked for by its name
  answer.param_id = mavlink::field_of<16>(name);
  answer.param_type = static_cast<std::uint8_t>(known->type);
  send(encoder_.encode(answer));
}

void MavlinkEndpoint::on_timesync(const mavlink::Timesync& question, const mavlink::Packet& packet,
                                  Instant now) {
  if (question.tc1 != 0) return;  // an answer to ours
  mavlink::Timesync answer;
  answer.tc1 = (now - booted_).count();
  answer.ts1 = question.ts1;
  answer.target_system = packet.system;
  answer.target_component = packet.component;
  send(encoder_.encode(answer));
}

Situation MavlinkEndpoint::situation(Instant now) const {
  return {.flight = vehicle_.report(),
          .earth = earth_,
          .battery = battery_,
          .type = vehicle_.type(),
          .since_boot = now - booted_,
          .unix_us = config_.unix_us + now.time_since_epoch() / std::chrono::microseconds{1},
          .position = position_,
          .may_arm = !refusal_,
          .ekf_origin_m = ned_from_enu({config_.start.x_m, config_.start.y_m, 0.0})};
}

void MavlinkEndpoint::say(mavlink::Severity severity, std::string_view text) {
  mavlink::Statustext line;
  line.severity = static_cast<std::uint8_t>(severity);
  line.text = mavlink::field_of<50>(text);
  send(encoder_.encode(line));
}

}  // namespace skein::hil
