// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "check_makers.hpp"
#include "skein/ardupilot/airframe.hpp"
#include "skein/ardupilot/firmware.hpp"
#include "skein/ardupilot/flight_limits.hpp"
#include "skein/mavlink/enums.hpp"
#include "skein/wording/wording.hpp"

/// What a bus and its autopilot are judged by. No I/O.
namespace skein::onboard {
namespace {

using ardupilot::AutopilotFacts;

constexpr std::uint8_t kSatellitesMin = 6;
constexpr int kBatteryMin_percent = 50;
constexpr std::int64_t kClocksApartMax_s = 1;
/// EKF_STATUS_REPORT: attitude, horizontal velocity, absolute horizontal position; and what says
/// that it has none, or that its GNSS is at fault.
constexpr std::uint16_t kFilterNeeds = 0x01 | 0x02 | 0x10;
constexpr std::uint16_t kFilterWithout = 0x80 | 0x400;
constexpr std::uint32_t kSensorFence = 0x100000;

/// What is not known while it is not heard.
constexpr std::array<std::pair<CheckGroup, const char*>, 14> kOfAutopilot{{
    {CheckGroup::firmware, "autopilot's make"},
    {CheckGroup::firmware, "airframe"},
    {CheckGroup::firmware, "firmware"},
    {CheckGroup::parameters, "failsafe parameters"},
    {CheckGroup::parameters, "limits"},
    {CheckGroup::gnss, "GNSS"},
    {CheckGroup::gnss, "satellites"},
    {CheckGroup::gnss, "GNSS time"},
    {CheckGroup::filter, "filter"},
    {CheckGroup::battery, "battery"},
    {CheckGroup::arming, "arming"},
    {CheckGroup::arming, "mode"},
    {CheckGroup::arming, "armed"},
    {CheckGroup::arming, "geofence"},
}};

Check not_told(std::string what, std::string_view message) {
  return warn(std::move(what), fmt::format("the autopilot did not tell ({})", message),
              "ask again; if it stays so, its firmware lacks it");
}

class Judge {
 public:
  Judge(const configuration::VehicleConfig& config, const AutopilotFacts& facts)
      : config_{config},
        fc_{config.flight_controller.ardupilot},
        traits_{ardupilot::traits_of(config.vehicle.airframe)},
        facts_{facts} {}

  [[nodiscard]] Checks link() const {
    Checks all;
    const bool frames = facts_.frames > 0;
    all.push_back(frames ? ok("CAN frames", fmt::format("{} heard", facts_.frames))
                         : fail("CAN frames", "none heard", why(AutopilotNews::no_bus_traffic)));
    all.push_back(
        facts_.own_id_taken
            ? fail("companion's node id",
                   fmt::format("somebody sends as node {}", fc_.companion_node_id),
                   "end the skein-onboard that runs, or give companion_node_id (and "
                   "CAN_D1_UC_S1_NOD) a number of its own; the autopilot was not asked")
            : ok("companion's node id", fmt::format("{}, nobody else's", fc_.companion_node_id)));
    layer(all, frames, facts_.node_heard, "flight controller's node",
          fmt::format("node {} is on the bus", fc_.node_id),
          fmt::format("node {} is not on the bus", fc_.node_id), AutopilotNews::node_missing);
    layer(all, facts_.node_heard, facts_.serial_heard, "serial port over CAN",
          fmt::format("port {} is for us", fc_.serial_id), "no byte came for us",
          AutopilotNews::no_serial_port);
    layer(all, facts_.serial_heard, facts_.heartbeat.has_value(), "HEARTBEAT", "heard",
          "none heard", AutopilotNews::no_heartbeat);
    const bool is_unsigned = facts_.trouble && facts_.trouble->news == AutopilotNews::not_signed;
    if (!fc_.signing_key.empty()) {
      layer(all, facts_.heartbeat.has_value() || is_unsigned, !is_unsigned, "MAVLink signing",
            "signed with our key", "not signed with our key", AutopilotNews::not_signed);
    }
    const bool other = facts_.trouble && facts_.trouble->news == AutopilotNews::other_system;
    layer(all, facts_.heartbeat.has_value() || other, !other, "system id",
          fmt::format("{}", fc_.system_id),
          other ? fmt::format("system {} is heard", facts_.trouble->number) : std::string{},
          AutopilotNews::other_system);
    return all;
  }

  [[nodiscard]] Checks autopilot(std::int64_t unix_s_at_gnss) const {
    if (!facts_.heartbeat) return unknown();
    Checks all = in_group(CheckGroup::firmware, {make(), airframe(), firmware()});
    Checks parameters;
    for (const auto& parameter : facts_.safety) parameters.push_back(safety(parameter));
    for (const auto& limit : traits_.limits) {
      parameters.push_back(of_limit(limit));
    }
    if (fc_.take_over == configuration::TakeOverKind::from_ground && !traits_.is_lifted) {
      parameters.push_back(takeoff_height());
    }
    append(all, in_group(CheckGroup::parameters, std::move(parameters)));
    append(all, in_group(CheckGroup::gnss, {gnss(), satellites(), gnss_time(unix_s_at_gnss)}));
    append(all, in_group(CheckGroup::filter, {filter()}));
    append(all, in_group(CheckGroup::battery, {battery()}));
    Checks arming;
    if (!facts_.in_flight) arming = {pre_arm(), mode(), armed()};
    if (facts_.remote_id) arming.push_back(remote_id());
    arming.push_back(fence());
    append(all, in_group(CheckGroup::arming, std::move(arming)));
    return all;
  }

 private:
  /// The sentence of the link's trouble where it is the one that is looked for.
  [[nodiscard]] std::string why(AutopilotNews news) const {
    if (facts_.trouble) return wording::text_of(*facts_.trouble);
    return wording::text_of(
        AutopilotNotice{.news = news, .number = fc_.node_id, .detail = fc_.can});
  }
  void layer(Checks& all, bool below, bool heard, std::string what, std::string good,
             std::string bad, AutopilotNews news) const {
    if (heard && below) {
      all.push_back(ok(std::move(what), std::move(good)));
    } else if (!below || facts_.own_id_taken) {
      all.push_back(warn(std::move(what), "not known", "see above"));
    } else {
      all.push_back(fail(std::move(what), std::move(bad), why(news)));
    }
  }
  [[nodiscard]] static Checks unknown() {
    Checks all;
    for (const auto& [group, what] : kOfAutopilot) {
      append(all, in_group(group, {warn(what, "not known", "the autopilot must be heard first")}));
    }
    return all;
  }

  [[nodiscard]] Check make() const {
    const auto number = facts_.heartbeat->autopilot;
    if (number == static_cast<std::uint8_t>(mavlink::Autopilot::ardupilotmega)) {
      return ok("autopilot's make", "ArduPilot");
    }
    return fail(
        "autopilot's make", fmt::format("{}", number),
        wording::text_of(AutopilotNotice{.news = AutopilotNews::wrong_make, .number = number}));
  }
  [[nodiscard]] Check airframe() const {
    const std::string wanted{to_string(config_.vehicle.airframe)};
    const auto type = facts_.heartbeat->type;
    if (traits_.is_of(type)) {
      return ok("airframe", fmt::format("{} (MAV_TYPE {})", wanted, type));
    }
    return fail("airframe", fmt::format("MAV_TYPE {}", type),
                wording::text_of(AutopilotNotice{
                    .news = AutopilotNews::wrong_airframe, .number = type, .detail = wanted}));
  }
  [[nodiscard]] Check firmware() const {
    if (!facts_.firmware) return not_told("firmware", "AUTOPILOT_VERSION");
    const std::string version = ardupilot::firmware_text(*facts_.firmware);
    if (ardupilot::firmware_is_new_enough(*facts_.firmware)) return ok("firmware", version);
    return fail(
        "firmware", version,
        wording::text_of(AutopilotNotice{.news = AutopilotNews::old_firmware, .detail = version}));
  }
  [[nodiscard]] static Check safety(const ardupilot::TestedParameter& parameter) {
    if (parameter.finding.empty()) {
      return ok(parameter.name, fmt::format("{:g}", parameter.value.value_or(0.0)));
    }
    return fail(parameter.name,
                parameter.value ? fmt::format("{:g}", *parameter.value) : "not told",
                parameter.finding);
  }
  [[nodiscard]] Check of_limit(const ardupilot::LimitParameter& limit) const {
    for (const std::string_view name : {limit.name, limit.older_name}) {
      const auto told = facts_.parameters.find(std::string{name});
      if (told == facts_.parameters.end()) continue;
      const auto stall = facts_.parameters.find(std::string{ardupilot::kStallPrevention.name});
      auto finding = ardupilot::judge_limit(
          config_.vehicle, limit, name, told->second,
          stall == facts_.parameters.end() ? std::nullopt : std::optional{stall->second});
      using Finding = ardupilot::LimitFinding::Verdict;
      const Verdict verdict = finding.verdict == Finding::refused   ? Verdict::fail
                              : finding.verdict == Finding::differs ? Verdict::warn
                                                                    : Verdict::ok;
      return {std::string{name}, verdict, std::move(finding.found), std::move(finding.remedy),
              kAnyGroup};
    }
    return not_told(std::string{limit.name}, limit.older_name);
  }
  [[nodiscard]] Check takeoff_height() const {
    const auto told = facts_.parameters.find("TKOFF_ALT");
    if (told == facts_.parameters.end()) return not_told("TKOFF_ALT", "PARAM_VALUE");
    const std::string found = fmt::format("{:g} m", told->second);
    if (told->second >= ardupilot::taken_over_at_m(fc_.takeoff_height_m))
      return ok("TKOFF_ALT", found);
    return fail("TKOFF_ALT", found,
                fmt::format("the companion waits until it is near takeoff_height_m {:g}: set "
                            "TKOFF_ALT to that or more",
                            fc_.takeoff_height_m));
  }
  [[nodiscard]] Check gnss() const {
    if (!facts_.gnss) return not_told("GNSS", "GPS_RAW_INT");
    static constexpr std::array kFixes{"no receiver", "no fix",    "2D",       "3D",
                                       "DGPS",        "RTK float", "RTK fixed"};
    const std::size_t fix = facts_.gnss->fix_type;
    const std::string found = fix < kFixes.size() ? kFixes.at(fix) : fmt::format("fix {}", fix);
    if (fix >= static_cast<std::size_t>(mavlink::GpsFix::fix_3d)) return ok("GNSS", found);
    return fail("GNSS", found,
                "the aircraft is taken with a 3D fix only: wait under open sky; without a receiver "
                "see GPS1_TYPE and its cable");
  }
  [[nodiscard]] Check satellites() const {
    if (!facts_.gnss) return not_told("satellites", "GPS_RAW_INT");
    const auto seen = facts_.gnss->satellites_visible;
    const std::string found = seen == 255 ? std::string{"not told"} : fmt::format("{}", seen);
    if (seen >= kSatellitesMin) return ok("satellites", found);
    return warn("satellites", found,
                fmt::format("{} or more are good: wait, or move the antenna", kSatellitesMin));
  }
  [[nodiscard]] Check filter() const {
    constexpr const char* kRemedy =
        "wait until it has settled, with the aircraft still; then see the autopilot's messages";
    if (!facts_.filter) {
      if (!facts_.health) return not_told("filter", "EKF_STATUS_REPORT");
      const bool healthy =
          (facts_.health->onboard_control_sensors_health & mavlink::sensor_ahrs) != 0;
      return healthy ? ok("filter", "healthy (SYS_STATUS)")
                     : fail("filter", "not healthy (SYS_STATUS)", kRemedy);
    }
    const std::uint16_t flags = facts_.filter->flags;
    const std::string found = fmt::format("EKF_STATUS_REPORT 0x{:03x}", flags);
    const bool is_good = (flags & kFilterNeeds) == kFilterNeeds && (flags & kFilterWithout) == 0;
    const bool knows = !facts_.health ||
                       (facts_.health->onboard_control_sensors_health & mavlink::sensor_ahrs) != 0;
    if (is_good && knows) return ok("filter", found);
    return fail("filter", found + ", no attitude, velocity or position to rely on", kRemedy);
  }
  [[nodiscard]] Check battery() const {
    if (!facts_.health) return not_told("battery", "SYS_STATUS");
    const auto& health = *facts_.health;
    const bool monitored = (health.onboard_control_sensors_enabled & mavlink::sensor_battery) != 0;
    const bool known = health.voltage_battery != 0xFFFF && health.voltage_battery != 0;
    if (!monitored || !known) {
      return warn("battery", "not measured", "set BATT_MONITOR; an empty one shows in flight only");
    }
    const int percent{health.battery_remaining};  // -1: not told
    const std::string found = fmt::format("{:.1f} V{}", health.voltage_battery / 1e3,
                                          percent < 0 ? "" : fmt::format(", {} %", percent));
    if ((health.onboard_control_sensors_health & mavlink::sensor_battery) == 0) {
      return fail("battery", found + ", its failsafe acts", "charge or change it");
    }
    if (percent >= 0 && percent < kBatteryMin_percent) {
      return warn("battery", found, "charge or change it, if the flight is a long one");
    }
    return ok("battery", found);
  }
  [[nodiscard]] Check pre_arm() const {
    if (!facts_.health) return not_told("arming", "SYS_STATUS");
    const bool armed = is_armed();
    if (armed || (facts_.prearm_good() && facts_.pre_arm.empty())) {
      return ok("arming", armed ? "it is armed" : "it would arm");
    }
    if (facts_.prearm_good()) {
      return warn(
          "arming",
          "it would arm, though it has said: " + fmt::format("{}", fmt::join(facts_.pre_arm, "; ")),
          "see to it");
    }
    if (facts_.only_mode_forbids_arming() &&
        fc_.take_over == configuration::TakeOverKind::from_ground) {
      return ok("arming", "it would arm in the mode that the companion asks for");
    }
    if (facts_.pre_arm.empty()) {
      return fail("arming", "it would not arm, and does not say why",
                  "see its messages (PreArm) at a ground station, and ARMING_CHECK");
    }
    return fail("arming", fmt::format("it would not arm: {}", fmt::join(facts_.pre_arm, "; ")),
                "mend what it names");
  }
  [[nodiscard]] bool is_armed() const {
    return (facts_.heartbeat->base_mode & mavlink::mode_safety_armed) != 0;
  }
  [[nodiscard]] Check mode() const {
    const std::string mode = traits_.name_of(facts_.heartbeat->custom_mode);
    if (mode == "GUIDED" && fc_.take_over == configuration::TakeOverKind::when_guided &&
        !is_armed()) {
      return warn(
          "mode", mode,
          "the companion takes it as soon as it is armed and in the air: another mode keeps "
          "it the pilot's until the switch");
    }
    return ok("mode", mode);
  }
  [[nodiscard]] Check armed() const {
    const bool in_air =
        facts_.landed &&
        facts_.landed->landed_state != static_cast<std::uint8_t>(mavlink::LandedState::undefined) &&
        facts_.landed->landed_state != static_cast<std::uint8_t>(mavlink::LandedState::on_ground);
    if (in_air) return warn("armed", "it is in the air", "this is a check before a flight");
    if (!is_armed()) return ok("armed", "no, on the ground");
    if (fc_.take_over == configuration::TakeOverKind::from_ground) {
      return fail("armed", "yes, on the ground",
                  "disarm it: the companion launches none that was seen armed since it started");
    }
    return warn("armed", "yes, on the ground", "keep clear of it");
  }
  [[nodiscard]] Check remote_id() const {
    if (facts_.remote_id->empty()) return ok("Remote ID", "its transmitter is ready");
    constexpr const char* kRemedy =
        "see its power and line, DID_MAVPORT and SERIALn_PROTOCOL 2, and remote_id in the "
        "configuration";
    const std::string found = facts_.remote_id->substr(facts_.remote_id->find(": ") + 2);
    return config_.remote_id.required ? fail("Remote ID", found, kRemedy)
                                      : warn("Remote ID", found, kRemedy);
  }
  [[nodiscard]] Check fence() const {
    const auto enabled = facts_.parameters.find("FENCE_ENABLE");
    const bool is_on =
        facts_.health && (facts_.health->onboard_control_sensors_enabled & kSensorFence) != 0;
    if (is_on || (enabled != facts_.parameters.end() && enabled->second != 0.0)) {
      return ok("geofence", "enabled");
    }
    return warn("geofence", enabled == facts_.parameters.end() ? "FENCE_ENABLE is not told" : "off",
                "with FENCE_ENABLE 1 the autopilot keeps within its own bounds, whatever it is "
                "asked");
  }
  [[nodiscard]] Check gnss_time(std::int64_t unix_s_at_gnss) const {
    if (!facts_.time || facts_.time->time_unix_usec == 0) {
      return warn("GNSS time", "the autopilot knows none yet", "wait for a fix");
    }
    const auto theirs = static_cast<std::int64_t>(facts_.time->time_unix_usec / 1'000'000);
    const std::int64_t off = unix_s_at_gnss - theirs;
    const std::string found = fmt::format("this machine's clock is {} s off", std::abs(off));
    if (std::abs(off) <= kClocksApartMax_s) return ok("GNSS time", found);
    return fail("GNSS time", found + (off > 0 ? ", ahead" : ", behind"),
                "set this machine's clock (chrony, GNSS): missions and keys go by it");
  }

  const configuration::VehicleConfig& config_;
  const configuration::ArdupilotConfig& fc_;
  const ardupilot::AirframeTraits& traits_;
  const AutopilotFacts& facts_;
};

Checks interface_checks(const can::InterfaceFacts& facts) {
  Checks all;
  const std::string& name = facts.name;
  if (!facts.is_there) {
    all.push_back(fail("CAN interface", name + " is not there",
                       "see 'ip link'; name it in flight_controller.can, load its driver"));
    return all;
  }
  all.push_back(ok("CAN interface", name + (facts.over_udp ? ", frames over UDP" : "")));
  all.push_back(facts.is_up ? ok("CAN interface up", "yes")
                            : fail("CAN interface up", "no",
                                   fmt::format("'ip link set {} up type can bitrate 1000000 "
                                               "restart-ms 100' (docs/can.md)",
                                               name)));
  all.push_back(facts.bitrate ? ok("CAN bit rate", fmt::format("{} bit/s", *facts.bitrate))
                              : ok("CAN bit rate", "none: no wire is driven"));
  if (facts.bitrate && *facts.bitrate != 1'000'000) {
    all.back() = warn("CAN bit rate", fmt::format("{} bit/s", *facts.bitrate),
                      "CAN_P1_BITRATE must be the same; 1000000 is usual");
  }
  const std::string errors =
      fmt::format("{} received, {} sent in error", facts.receive_errors, facts.transmit_errors);
  if (facts.state && *facts.state != can::State::error_active) {
    all.push_back(fail("CAN errors", fmt::format("{}; {}", to_string(*facts.state), errors),
                       "check bit rate, cable, terminators (120 ohm at both ends)"));
  } else if (facts.receive_errors + facts.transmit_errors > 0) {
    all.push_back(warn("CAN errors", errors,
                       "since the interface came up; if they grow, check cable and terminators"));
  } else {
    all.push_back(ok("CAN errors", "none"));
  }
  return all;
}

}  // namespace

Checks check_interface(const can::InterfaceFacts& facts) {
  return in_group(CheckGroup::bus, interface_checks(facts));
}

Checks check_autopilot(const configuration::VehicleConfig& config,
                       const ardupilot::AutopilotFacts& facts, std::int64_t unix_s_at_gnss) {
  const Judge judge{config, facts};
  Checks all = in_group(CheckGroup::bus, judge.link());
  append(all, judge.autopilot(unix_s_at_gnss));
  return all;
}

}  // namespace skein::onboard
