// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/atmosphere.hpp"
#include "skein/base/frames.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mavlink/enums.hpp"
#include "skein/mavlink/parser.hpp"

namespace skein::ardupilot {

inline constexpr Wgs84 kTestOrigin{31.522062, 105.044327, 480.0};

/// The MAVLink of an autopilot, for tests: it streams what it is asked for, obeys or refuses, and
/// keeps what it was told. Its aircraft stays where the test puts it.
class AutopilotDouble {
 public:
  explicit AutopilotDouble(Instant booted) : booted_{booted} {}

  VehicleState truth{.x_m = 100.0,
                     .y_m = -50.0,
                     .z_m = 300.0,
                     .heading_rad = 0.5,
                     .course_rad = 0.6,
                     .groundspeed_mps = 52.0,
                     .airspeed_mps = 50.0};
  double bank_rad = 0.0;    ///< of its attitude; what it flies stands in truth
  std::uint32_t mode = 12;  ///< LOITER
  bool armed = true;
  std::uint8_t landed = 2;  ///< in the air
  std::uint8_t vtol = 0;    ///< not told
  double relative_height_m = 300.0;
  std::uint8_t maker = 3;
  std::uint8_t type = 1;
  std::uint32_t firmware = 0x04060300;
  std::uint32_t enabled = 0xFFFFFFFF;  ///< sensors
  std::uint32_t health = 0xFFFFFFFF;
  std::function<bool(std::uint32_t)> armable_in;  ///< by mode; none: as `health` says
  bool mute = false;
  struct Refusal {
    std::uint8_t result = 0;
    std::string text;  ///< said after the answer
  };
  std::map<std::uint16_t, Refusal> refuses;  ///< by command
  std::map<std::uint16_t, int> deaf_to;      ///< by command: so many of them get lost
  std::map<std::string, float> parameters{{"FS_GCS_ENABL", 1.0F},    {"FS_GCS_ENABLE", 1.0F},
                                          {"FS_LONG_ACTN", 1.0F},    {"SYSID_MYGCS", 1.0F},
                                          {"ROLL_LIMIT_DEG", 75.0F}, {"AIRSPEED_MIN", 10.0F},
                                          {"AIRSPEED_MAX", 100.0F},  {"AIRSPEED_CRUISE", 50.0F},
                                          {"TECS_SPDWEIGHT", 0.0F},  {"STALL_PREVENTION", 0.0F}};
  int deaf_to_parameters = 0;  ///< so many questions get lost
  std::vector<mavlink::MissionItemInt> mission;
  std::vector<mavlink::MissionItemInt> fence;
  int deaf_to_mission = 0;             ///< so many messages about it get lost
  std::uint8_t mission_result = 0;     ///< of MISSION_ACK
  std::optional<std::size_t> spoiled;  ///< that item is stored 11 m further north
  std::set<std::uint32_t> stopped;     ///< streams
  std::set<std::uint32_t> refuses_streams;

  std::vector<mavlink::CommandLong> commands;
  std::vector<mavlink::CommandInt> places;
  std::vector<mavlink::SetAttitudeTarget> attitudes;
  std::vector<mavlink::SetPositionTargetLocalNed> velocities;
  std::vector<mavlink::SetPositionTargetGlobalInt> points;
  std::vector<Instant> target_times;
  std::vector<mavlink::Packet> remote_ids;  ///< OPEN_DRONE_ID_*
  int heartbeats = 0;

  /// From now on it signs, and heeds nothing that is not signed.
  void sign_with(const mavlink::SigningKey& key, mavlink::SigningTime time) {
    parser_ = mavlink::Parser{{.key = key, .now = time, .accept_unsigned = false}};
    encoder_.sign_with({key, 0, time});
  }
  [[nodiscard]] std::uint64_t bad_signatures() const { return parser_.statistics().bad_signature; }
  void hear(std::span<const std::uint8_t> bytes, Instant now) {
    parser_.parse(bytes, [this, now](const mavlink::Packet& packet) { on_packet(packet, now); });
  }

  /// What it has to say by `now`.
  [[nodiscard]] std::vector<std::uint8_t> speak(Instant now) {
    if (!mute) {
      due(0, now, [&] { return heartbeat(); });
      due(30, now, [&] { return attitude(now); });
      due(33, now, [&] { return position(now); });
      due(74, now, [&] { return hud(); });
      due(1, now, [&] { return status(); });
      due(245, now,
          [&] { return mavlink::ExtendedSysState{.vtol_state = vtol, .landed_state = landed}; });
      due(mavlink::GpsRawInt::kDefinition.id, now, [] {
        mavlink::GpsRawInt gnss;
        gnss.fix_type = 3;
        gnss.satellites_visible = 12;
        return gnss;
      });
      due(mavlink::EkfStatusReport::kDefinition.id, now, [] {
        mavlink::EkfStatusReport filter;
        filter.flags = 0x33F;
        return filter;
      });
      due(mavlink::SystemTime::kDefinition.id, now, [] {
        mavlink::SystemTime time;
        time.time_unix_usec = 1'760'000'000'000'000;
        return time;
      });
    }
    std::vector<std::uint8_t> said;
    said.swap(out_);
    if (mute) said.clear();
    return said;
  }

  /// As one that somebody sets: all who listen are told.
  void set_parameter(const std::string& name, float value) {
    parameters[name] = value;
    tell_parameter(name);
  }
  void say(const std::string& text, mavlink::Severity severity) {
    mavlink::Statustext message;
    message.severity = static_cast<std::uint8_t>(severity);
    message.text = mavlink::field_of<50>(text);
    send(message);
  }

  void reboot(Instant now) {
    booted_ = now;
    intervals_ = {{0, std::chrono::seconds{1}}};
    next_.clear();
    mode = 12;
  }

  [[nodiscard]] int count(mavlink::Command command) const {
    int n = 0;
    for (const auto& c : commands) n += c.command == static_cast<std::uint16_t>(command) ? 1 : 0;
    return n;
  }
  [[nodiscard]] std::optional<mavlink::CommandLong> last(mavlink::Command command) const {
    const auto found = std::find_if(commands.rbegin(), commands.rend(), [&](const auto& c) {
      return c.command == static_cast<std::uint16_t>(command);
    });
    return found != commands.rend() ? std::optional{*found} : std::nullopt;
  }

 private:
  template <class Message>
  void send(const Message& message) {
    for (const std::uint8_t byte : encoder_.encode(message)) out_.push_back(byte);
  }
  template <class Make>
  void due(std::uint32_t id, Instant now, const Make& make) {
    const auto interval = intervals_.find(id);
    if (interval == intervals_.end() || stopped.contains(id)) return;
    auto& next = next_.try_emplace(id, now).first->second;
    if (now < next) return;
    next += interval->second;
    send(make());
  }
  [[nodiscard]] std::uint32_t boot_ms(Instant now) const {
    return static_cast<std::uint32_t>(
        std::chrono::duration_cast<std::chrono::milliseconds>(now - booted_).count());
  }
  [[nodiscard]] mavlink::Heartbeat heartbeat() const {
    mavlink::Heartbeat h;
    h.custom_mode = mode;
    h.type = type;
    h.autopilot = maker;
    h.base_mode = static_cast<std::uint8_t>(mavlink::mode_custom_enabled |
                                            (armed ? mavlink::mode_safety_armed : 0));
    return h;
  }
  [[nodiscard]] mavlink::Attitude attitude(Instant now) const {
    mavlink::Attitude a;
    a.time_boot_ms = boot_ms(now);
    a.yaw = static_cast<float>(yaw_from_heading(truth.heading_rad));
    a.roll = static_cast<float>(bank_rad);
    return a;
  }
  [[nodiscard]] mavlink::GlobalPositionInt position(Instant now) const {
    const auto origin = MissionOrigin::make(kTestOrigin).value();
    const Wgs84 at = origin.to_wgs84({truth.x_m, truth.y_m, truth.z_m});
    mavlink::GlobalPositionInt p;
    p.time_boot_ms = boot_ms(now);
    p.lat = static_cast<std::int32_t>(std::lround(at.latitude_deg * 1e7));
    p.lon = static_cast<std::int32_t>(std::lround(at.longitude_deg * 1e7));
    p.alt = static_cast<std::int32_t>(std::lround(at.height_m * 1e3));
    p.relative_alt = static_cast<std::int32_t>(std::lround(relative_height_m * 1e3));
    p.vx = static_cast<std::int16_t>(
        std::lround(truth.groundspeed_mps * std::sin(truth.course_rad) * 100.0));
    p.vy = static_cast<std::int16_t>(
        std::lround(truth.groundspeed_mps * std::cos(truth.course_rad) * 100.0));
    return p;
  }
  [[nodiscard]] mavlink::VfrHud hud() const {
    mavlink::VfrHud h;
    h.airspeed = static_cast<float>(truth.airspeed_mps /
                                    true_per_equivalent_airspeed(kTestOrigin.height_m + truth.z_m));
    return h;
  }
  [[nodiscard]] mavlink::SysStatus status() const {
    mavlink::SysStatus s;
    s.onboard_control_sensors_enabled = enabled;
    s.onboard_control_sensors_health = health;
    if (armable_in && !armable_in(mode)) {
      s.onboard_control_sensors_health &= ~mavlink::sensor_prearm_check;
    }
    return s;
  }

  void on_packet(const mavlink::Packet& packet, Instant now) {
    if (mavlink::decode<mavlink::Heartbeat>(packet)) ++heartbeats;
    if (packet.id >= 12'900 && packet.id < 12'920) remote_ids.push_back(packet);
    if (const auto question = mavlink::decode<mavlink::Timesync>(packet)) {
      mavlink::Timesync answer;
      answer.ts1 = question->ts1;
      answer.tc1 = (now - booted_).count();
      send(answer);
    }
    if (const auto target = mavlink::decode<mavlink::SetAttitudeTarget>(packet)) {
      attitudes.push_back(*target);
      target_times.push_back(now);
    }
    if (const auto target = mavlink::decode<mavlink::SetPositionTargetLocalNed>(packet)) {
      velocities.push_back(*target);
      target_times.push_back(now);
    }
    if (const auto target = mavlink::decode<mavlink::SetPositionTargetGlobalInt>(packet)) {
      points.push_back(*target);
      target_times.push_back(now);
    }
    if (const auto command = mavlink::decode<mavlink::CommandLong>(packet)) obey(*command, now);
    if (const auto place = mavlink::decode<mavlink::CommandInt>(packet)) {
      places.push_back(*place);
      mavlink::CommandAck ack;
      ack.command = place->command;
      send(ack);
    }
    on_mission(packet);
    if (const auto asked = mavlink::decode<mavlink::ParamRequestRead>(packet)) {
      if (deaf_to_parameters > 0) {
        --deaf_to_parameters;
      } else {
        tell_parameter(mavlink::text_of(asked->param_id));
      }
    }
  }
  void on_mission(const mavlink::Packet& packet) {
    if (mavlink::decode<mavlink::MissionClearAll>(packet)) mission.clear();
    const auto count = mavlink::decode<mavlink::MissionCount>(packet);
    auto item = mavlink::decode<mavlink::MissionItemInt>(packet);
    const auto list = mavlink::decode<mavlink::MissionRequestList>(packet);
    const auto asked = mavlink::decode<mavlink::MissionRequestInt>(packet);
    const bool any = count || item || list || asked;
    if (!any) return;
    if (deaf_to_mission > 0) {
      --deaf_to_mission;
      return;
    }
    const std::uint8_t kind = count  ? count->mission_type
                              : item ? item->mission_type
                              : list ? list->mission_type
                                     : asked->mission_type;
    auto& stored = kind == 1 ? fence : mission;
    const auto ask = [this, kind](std::size_t seq) {
      send(mavlink::MissionRequest{.seq = static_cast<std::uint16_t>(seq), .mission_type = kind});
    };
    if (count) {
      stored.clear();
      to_come_ = count->count;
      ask(0);
    } else if (item && item->seq == stored.size()) {
      if (spoiled == stored.size()) item->x += 1000;
      item->param2 = std::trunc(item->param2);
      stored.push_back(*item);
      if (stored.size() < to_come_) return ask(stored.size());
      mavlink::MissionAck ack;
      ack.type = mission_result;
      ack.mission_type = kind;
      send(ack);
    } else if (list) {
      send(mavlink::MissionCount{.count = static_cast<std::uint16_t>(stored.size()),
                                 .mission_type = kind});
    } else if (asked && asked->seq < stored.size()) {
      send(stored[asked->seq]);
    }
  }
  /// Of one that it does not know it says nothing.
  void tell_parameter(const std::string& name) {
    const auto known = parameters.find(name);
    if (known == parameters.end()) return;
    mavlink::ParamValue value;
    value.param_value = known->second;
    value.param_count = static_cast<std::uint16_t>(parameters.size());
    value.param_index = 0xFFFF;
    value.param_id = mavlink::field_of<16>(name);
    value.param_type = 2;  // of 8 bits
    send(value);
  }
  void obey(const mavlink::CommandLong& command, Instant /*now*/) {
    if (auto& lost = deaf_to[command.command]; lost > 0) {
      --lost;
      return;
    }
    commands.push_back(command);
    mavlink::CommandAck ack;
    ack.command = command.command;
    if (const auto refusal = refuses.find(command.command); refusal != refuses.end()) {
      ack.result = refusal->second.result;
      send(ack);
      if (!refusal->second.text.empty()) {
        say(refusal->second.text, mavlink::Severity::critical);
      }
      return;
    }
    if (static_cast<mavlink::Command>(command.command) == mavlink::Command::set_message_interval &&
        refuses_streams.contains(static_cast<std::uint32_t>(command.param1))) {
      ack.result = static_cast<std::uint8_t>(mavlink::CommandResult::failed);
      return send(ack);
    }
    send(ack);
    switch (static_cast<mavlink::Command>(command.command)) {
      case mavlink::Command::set_message_interval:
        intervals_[static_cast<std::uint32_t>(command.param1)] =
            std::chrono::microseconds{std::lround(command.param2)};
        next_.erase(static_cast<std::uint32_t>(command.param1));
        break;
      case mavlink::Command::request_message: {
        mavlink::AutopilotVersion version;
        version.flight_sw_version = firmware;
        send(version);
        break;
      }
      case mavlink::Command::do_set_mode:
        mode = static_cast<std::uint32_t>(command.param2);
        break;
      case mavlink::Command::component_arm_disarm:
        armed = command.param1 > 0.5F;
        break;
      default:
        break;
    }
  }

  Instant booted_;
  std::size_t to_come_ = 0;  ///< items of a mission
  mavlink::Encoder encoder_{1, 1};
  mavlink::Parser parser_;
  std::map<std::uint32_t, Duration> intervals_{{0, std::chrono::seconds{1}}};
  std::map<std::uint32_t, Instant> next_;
  std::vector<std::uint8_t> out_;
};

}  // namespace skein::ardupilot
