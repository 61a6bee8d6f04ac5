// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/preflight.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>

#include "link_params.hpp"
#include "skein/ardupilot/flight_limits.hpp"
#include "skein/codec/json_text.hpp"
#include "skein/mavlink/enums.hpp"

namespace skein::onboard {
namespace {

using ardupilot::AutopilotFacts;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr std::int64_t kNow_s = 1'760'000'000;

configuration::VehicleConfig config() {
  configuration::VehicleConfig c;
  c.vehicle.id = {7};
  c.vehicle.cruise_speed_mps = 20.0;
  c.vehicle.speed_min_mps = 15.0;
  c.vehicle.speed_max_mps = 25.0;
  c.vehicle.turn_radius_m = 60.0;
  c.flight_controller.kind = configuration::FlightControllerKind::ardupilot;
  c.flight_controller.ardupilot.can = "can0";
  return c;
}

/// An ArduPlane that nothing is wrong with.
AutopilotFacts good() {
  AutopilotFacts f;
  f.nodes = {10};
  f.frames = 1000;
  f.node_heard = f.serial_heard = true;
  f.heartbeat.emplace();
  f.heartbeat->type = static_cast<std::uint8_t>(mavlink::VehicleType::fixed_wing);
  f.heartbeat->autopilot = static_cast<std::uint8_t>(mavlink::Autopilot::ardupilotmega);
  f.firmware = 0x04060300;
  f.health.emplace();
  f.health->onboard_control_sensors_enabled = f.health->onboard_control_sensors_health = 0xFFFFFFFF;
  f.health->voltage_battery = 12600;
  f.health->battery_remaining = 99;
  f.gnss.emplace();
  f.gnss->fix_type = 3;
  f.gnss->satellites_visible = 12;
  f.filter.emplace();
  f.filter->flags = 0x33F;
  f.time.emplace();
  f.time->time_unix_usec = std::uint64_t{kNow_s} * 1'000'000;
  f.landed.emplace();
  f.landed->landed_state = static_cast<std::uint8_t>(mavlink::LandedState::on_ground);
  f.safety = {{"FS_GCS_ENABL", 1.0, {}}, {"FS_LONG_ACTN", 1.0, {}}, {"SYSID_MYGCS", 1.0, {}}};
  f.parameters = {{"ROLL_LIMIT_DEG", 45.0},  {"AIRSPEED_MIN", 12.0},  {"AIRSPEED_MAX", 30.0},
                  {"AIRSPEED_CRUISE", 20.0}, {"TECS_SPDWEIGHT", 0.0}, {"STALL_PREVENTION", 0.0},
                  {"FENCE_ENABLE", 1.0}};
  return f;
}

/// The one of that name, among those of the autopilot.
Check check_of(const std::string& what, const AutopilotFacts& facts,
               const configuration::VehicleConfig& c = config()) {
  const Checks all = check_autopilot(c, facts, kNow_s);
  const auto found = std::ranges::find(all, what, &Check::what);
  if (found != all.end()) return *found;
  ADD_FAILURE() << what << " is not among\n" << text_of(all);
  return {};
}

TEST(Preflight, NothingIsFoundWithAGoodAutopilot) {
  const Checks all = check_autopilot(config(), good(), kNow_s);
  EXPECT_GE(all.size(), 20U);
  EXPECT_TRUE(std::ranges::all_of(all, [](const Check& c) { return c.verdict == Verdict::ok; }))
      << text_of(all);
}

TEST(Preflight, ATurnThatTheBankLimitForbidsFailsAndNamesBothNumbers) {
  AutopilotFacts facts = good();
  facts.parameters["ROLL_LIMIT_DEG"] = 30.0;  // 400 / (9.81 tan 30) = 70.6 m
  const Check roll = check_of("ROLL_LIMIT_DEG", facts);
  EXPECT_EQ(roll.verdict, Verdict::fail);
  EXPECT_EQ(roll.found, "ROLL_LIMIT_DEG is 30: at 20 m/s it turns within 71 m");
  EXPECT_THAT(roll.remedy,
              HasSubstr("turn_radius_m is 60: set ROLL_LIMIT_DEG to 40.0 (35.0 at least)"));
  EXPECT_THAT(roll.remedy, HasSubstr("turn_radius_m to 71 or more"));
}

TEST(Preflight, WithAKeySignaturesAreLookedAt) {
  configuration::VehicleConfig c = config();
  c.flight_controller.ardupilot.signing_key = "/etc/skein/mavlink.key";
  EXPECT_EQ(check_of("MAVLink signing", good(), c).verdict, Verdict::ok);
  AutopilotFacts facts = good();
  facts.heartbeat.reset();
  facts.trouble = AutopilotNotice{AutopilotNews::not_signed};
  const Check check = check_of("MAVLink signing", facts, c);
  EXPECT_EQ(check.verdict, Verdict::fail);
  EXPECT_THAT(check.remedy, HasSubstr("give the autopilot that key"));
}

class SigningKeyFile : public testing::Test {
 protected:
  SigningKeyFile() { c_.flight_controller.ardupilot.signing_key = file_; }
  void TearDown() override { std::filesystem::remove(file_); }
  void write(const std::string& text, std::filesystem::perms mode) const {
    std::ofstream{file_} << text;
    std::filesystem::permissions(file_, mode);
  }
  static constexpr auto kOwn = std::filesystem::perms::owner_read;

  std::string file_ = testing::TempDir() + "skein-signing-" + std::to_string(::getpid());
  configuration::VehicleConfig c_ = config();
};

TEST_F(SigningKeyFile, IsReadWhereNobodyElseMay) {
  write("open sesame\n", kOwn);
  const auto params = can_params(c_, 5);
  ASSERT_TRUE(params) << params.error().message;
  ASSERT_TRUE(params->companion.signing);
  EXPECT_EQ(params->companion.signing->key, mavlink::key_of("open sesame"));
  EXPECT_EQ(params->companion.signing->unix_us, 5);
}

TEST_F(SigningKeyFile, IsRefusedWithItsNameAndWhatToDo) {
  EXPECT_THAT(can_params(c_, 0).error().message,
              AllOf(HasSubstr("flight_controller.signing_key"), HasSubstr(file_)));
  write("open sesame", kOwn | std::filesystem::perms::group_read);
  EXPECT_THAT(can_params(c_, 0).error().message, HasSubstr("chmod 600 " + file_));
  std::filesystem::remove(file_);
  write(" \n", kOwn);
  EXPECT_THAT(can_params(c_, 0).error().message, HasSubstr("is empty"));
}

TEST(Preflight, AnOlderNameIsToldInItsOwnUnit) {
  AutopilotFacts facts = good();
  facts.parameters.erase("ROLL_LIMIT_DEG");
  facts.parameters["LIM_ROLL_CD"] = 3000.0;
  EXPECT_THAT(check_of("LIM_ROLL_CD", facts).remedy,
              HasSubstr("set LIM_ROLL_CD to 4000 (3500 at least)"));
  facts.parameters.erase("AIRSPEED_CRUISE");
  facts.parameters["TRIM_ARSPD_CM"] = 2000.0;
  EXPECT_EQ(check_of("TRIM_ARSPD_CM", facts).verdict, Verdict::ok);
}

TEST(Preflight, SpeedsBeyondTheAutopilotsFail) {
  AutopilotFacts facts = good();
  facts.parameters["AIRSPEED_MIN"] = 17.0;
  EXPECT_THAT(check_of("AIRSPEED_MIN", facts).remedy,
              HasSubstr("speed_min_mps is 15: set AIRSPEED_MIN to 15.0 or less"));
  facts.parameters["AIRSPEED_MAX"] = 22.0;
  EXPECT_THAT(check_of("AIRSPEED_MAX", facts).remedy, HasSubstr("speed_max_mps to 22 or less"));
  facts.parameters["AIRSPEED_CRUISE"] = 16.0;
  EXPECT_EQ(check_of("AIRSPEED_CRUISE", facts).verdict, Verdict::warn);
  facts.parameters["TECS_SPDWEIGHT"] = 1.0;
  EXPECT_EQ(check_of("TECS_SPDWEIGHT", facts).verdict, Verdict::warn);
  EXPECT_THAT(check_of("TECS_SPDWEIGHT", facts).remedy, HasSubstr("set TECS_SPDWEIGHT to 0"));
}

TEST(Preflight, AModeThatForbidsArmingIsNoFaultWhereTheCompanionLaunches) {
  AutopilotFacts facts = good();
  facts.health->onboard_control_sensors_health &= ~mavlink::sensor_prearm_check;
  facts.pre_arm = {"RTL mode not armable (switch to another mode)"};
  configuration::VehicleConfig c = config();
  EXPECT_EQ(check_of("arming", facts, c).verdict, Verdict::fail);
  c.flight_controller.ardupilot.take_over = configuration::TakeOverKind::from_ground;
  EXPECT_EQ(check_of("arming", facts, c).verdict, Verdict::ok);
  facts.pre_arm.emplace_back("GPS 1: Bad fix");
  EXPECT_EQ(check_of("arming", facts, c).verdict, Verdict::fail);
}

struct Fault {
  const char* what;
  void (*make)(AutopilotFacts&);
  Verdict verdict;
  const char* said;
};

TEST(Preflight, EachFaultIsFoundWithItsRemedy) {
  for (const Fault& fault : {
           Fault{"GNSS", [](AutopilotFacts& f) { f.gnss->fix_type = 1; }, Verdict::fail,
                 "open sky"},
           Fault{"satellites", [](AutopilotFacts& f) { f.gnss->satellites_visible = 4; },
                 Verdict::warn, "antenna"},
           Fault{"filter", [](AutopilotFacts& f) { f.filter->flags = 0x400; }, Verdict::fail,
                 "settled"},
           Fault{"battery", [](AutopilotFacts& f) { f.health->battery_remaining = 20; },
                 Verdict::warn, "charge"},
           Fault{"arming",
                 [](AutopilotFacts& f) {
                   f.health->onboard_control_sensors_health &= ~mavlink::sensor_prearm_check;
                   f.pre_arm = {"Compass not calibrated"};
                 },
                 Verdict::fail, "mend what it names"},
           Fault{"armed",
                 [](AutopilotFacts& f) { f.heartbeat->base_mode = mavlink::mode_safety_armed; },
                 Verdict::warn, "keep clear"},
           Fault{"geofence",
                 [](AutopilotFacts& f) {
                   f.parameters["FENCE_ENABLE"] = 0.0;
                   f.health->onboard_control_sensors_enabled = 0x7FFFFFF & ~0x100000U;
                 },
                 Verdict::warn, "FENCE_ENABLE 1"},
           Fault{"GNSS time", [](AutopilotFacts& f) { f.time->time_unix_usec -= 60'000'000; },
                 Verdict::fail, "clock"},
           Fault{"firmware", [](AutopilotFacts& f) { f.firmware = 0x04040000; }, Verdict::fail,
                 "older than 4.5"},
           Fault{"airframe", [](AutopilotFacts& f) { f.heartbeat->type = 2; }, Verdict::fail,
                 "mend the airframe"},
           Fault{"autopilot's make", [](AutopilotFacts& f) { f.heartbeat->autopilot = 12; },
                 Verdict::fail, "not an ArduPilot"},
           Fault{"FS_LONG_ACTN", [](AutopilotFacts& f) { f.safety.at(1).finding = "set it to 1"; },
                 Verdict::fail, "set it to 1"},
           Fault{"companion's node id", [](AutopilotFacts& f) { f.own_id_taken = true; },
                 Verdict::fail, "end the skein-onboard that runs"},
       }) {
    AutopilotFacts facts = good();
    fault.make(facts);
    const Check check = check_of(fault.what, facts);
    EXPECT_EQ(check.verdict, fault.verdict) << fault.what << ": " << check.found;
    EXPECT_THAT(check.remedy, HasSubstr(fault.said)) << fault.what;
  }
}

TEST(Preflight, OfASilentLinkTheLowestThatIsMissingFails) {
  AutopilotFacts facts;
  EXPECT_THAT(check_of("CAN frames", facts).remedy, HasSubstr("bit rate"));
  EXPECT_EQ(check_of("flight controller's node", facts).verdict, Verdict::warn);
  facts.frames = 10;
  facts.trouble =
      AutopilotNotice{.news = AutopilotNews::node_missing, .number = 10, .detail = "11"};
  EXPECT_EQ(check_of("CAN frames", facts).verdict, Verdict::ok);
  EXPECT_THAT(check_of("flight controller's node", facts).remedy, HasSubstr("heard are: 11"));
  EXPECT_EQ(check_of("GNSS", facts).verdict, Verdict::warn);
}

TEST(Preflight, TheEpochMayBeNeitherFarAheadNorLongAgo) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  const configuration::TimeConfig time{.epoch_unix_ns = kNow_s * kSecond};
  const auto at = [&time](std::int64_t s) { return check_epoch(time, (kNow_s + s) * kSecond); };
  EXPECT_EQ(at(60).verdict, Verdict::ok);
  EXPECT_EQ(at(-60).found, "the mission begins in 60 s");
  EXPECT_EQ(at(-7200).verdict, Verdict::warn);
  EXPECT_EQ(at(std::int64_t{30} * 86400).found, "the mission began 30 days ago");
}

TEST(Preflight, TheInterfaceOfABusIsJudged) {
  can::InterfaceFacts facts;
  facts.name = "can0";
  EXPECT_FALSE(is_good(check_interface(facts)));
  facts.is_there = true;
  EXPECT_THAT(text_of(check_interface(facts)), HasSubstr("ip link set can0 up type can"));
  facts.is_up = true;
  facts.bitrate = 1'000'000;
  facts.state = can::State::error_active;
  EXPECT_TRUE(is_good(check_interface(facts)));
  facts.state = can::State::error_passive;
  EXPECT_THAT(text_of(check_interface(facts)), HasSubstr("terminators"));
}

TEST(Preflight, ThisMachineIsLookedAtAndNothingStaysBehind) {
  const auto folder = std::filesystem::temp_directory_path() /
                      ("skein-preflight-" + std::to_string(std::random_device{}()));
  configuration::VehicleConfig c = config();
  c.time.epoch_unix_ns = kNow_s * 1'000'000'000;
  c.recording_folder = folder / "recording";
  c.detections_socket = folder / "detections.sock";
  c.network.address = "192.0.2.7";  // nobody's (RFC 5737)
  c.network.keys = folder / "keys";
  const Checks all = check_host(c, kNow_s * 1'000'000'000);
  EXPECT_GE(all.size(), 16U);
  for (const char* what :
       {"detectors", "keys", "certificate", "network interface", "route to the group"}) {
    const auto check = std::ranges::find(all, what, &Check::what);
    ASSERT_NE(check, all.end()) << what;
    EXPECT_EQ(check->verdict, Verdict::fail) << what << ": " << check->found;
    EXPECT_FALSE(check->remedy.empty()) << what;
  }
  EXPECT_FALSE(std::filesystem::exists(folder));
}

TEST(Preflight, EveryGroupIsLookedAtAndOfARunningVehicleNoPort) {
  configuration::VehicleConfig c = config();
  c.time.epoch_unix_ns = kNow_s * 1'000'000'000;
  Checks all = check_host_of_running(c, kNow_s * 1'000'000'000);
  EXPECT_EQ(std::ranges::find(all, "port", &Check::what), all.end());
  EXPECT_EQ(std::ranges::find(all, "other skein-onboard", &Check::what), all.end());
  for (const Check& check : check_interface({})) all.push_back(check);
  for (const Check& check : check_autopilot(c, good(), kNow_s)) all.push_back(check);
  for (std::size_t group = 0; group < static_cast<std::size_t>(CheckGroup::count); ++group) {
    const auto wanted = static_cast<CheckGroup>(group);
    EXPECT_NE(std::ranges::find(all, wanted, &Check::group), all.end()) << to_string(wanted);
  }
  EXPECT_EQ(std::ranges::find(all, "route", &Check::what)->group, CheckGroup::configuration);
}

TEST(Preflight, ASearchThatWindWouldShortenIsWarnedOf) {
  configuration::VehicleConfig c = config();
  const double radius_m = c.vehicle.planning_radius_m();
  const auto of_search = [&c](const Vec2& point) {
    c.search = {point};
    const Checks all = check_host_of_running(c, kNow_s * 1'000'000'000);
    return *std::ranges::find(all, "search", &Check::what);
  };
  EXPECT_EQ(of_search({0.0, 0.0}).verdict, Verdict::ok) << "there is no fence";
  const double half_m = 10.0 * radius_m;
  c.fence.corners = {{-half_m, -half_m}, {half_m, -half_m}, {half_m, half_m}, {-half_m, half_m}};
  EXPECT_EQ(of_search({half_m - 5.0, 0.0}).verdict, Verdict::ok);
  const Check warned = of_search({half_m - 0.35 * radius_m, half_m - 0.35 * radius_m});
  EXPECT_EQ(warned.verdict, Verdict::warn);
  EXPECT_NE(warned.found.find("narrow part of the fence"), std::string::npos);
}

TEST(Preflight, InFlightNothingIsSaidOfArming) {
  AutopilotFacts facts = good();
  facts.heartbeat->base_mode = mavlink::mode_safety_armed;
  facts.in_flight = true;
  const Checks all = check_autopilot(config(), facts, kNow_s);
  for (const char* what : {"arming", "armed", "mode"}) {
    EXPECT_EQ(std::ranges::find(all, what, &Check::what), all.end()) << what;
  }
  EXPECT_NE(std::ranges::find(all, "geofence", &Check::what), all.end());
}

TEST(Preflight, ItIsWrittenForPeopleAndForPrograms) {
  const Checks all{{"mode", Verdict::ok, "FBWA", {}, CheckGroup::arming},
                   {"GNSS", Verdict::fail, "no fix", "wait", CheckGroup::gnss},
                   {"geofence", Verdict::warn, "off", "set it", CheckGroup::arming}};
  EXPECT_EQ(text_of(all),
            "ok    mode: FBWA\nFAIL  GNSS: no fix; wait\nwarn  geofence: off; set it\n");
  const auto json = codec::parse_json(json_of(all));
  EXPECT_FALSE(json.at("good").get<bool>());
  EXPECT_EQ(json.at("checks").at(1).at("verdict"), "fail");
  EXPECT_EQ(json.at("checks").at(1).at("remedy"), "wait");
  EXPECT_EQ(json.at("checks").at(1).at("group"), "gnss");
}

}  // namespace
}  // namespace skein::onboard
