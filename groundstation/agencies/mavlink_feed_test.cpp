// SPDX-License-Identifier: Apache-2.0
#include "skein/agencies/mavlink_feed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "skein/base/angles.hpp"
#include "skein/mavlink/enums.hpp"

namespace skein::agencies {
namespace {

constexpr std::int64_t kUnix_ns = 1'700'000'010'000'000'000;

std::vector<mavlink::Packet> parsed(const std::vector<mavlink::WireBytes>& datagrams) {
  mavlink::Parser parser;
  std::vector<mavlink::Packet> packets;
  for (const auto& bytes : datagrams) {
    parser.parse(std::span{bytes.begin(), bytes.size()},
                 [&](const mavlink::Packet& packet) { packets.push_back(packet); });
  }
  EXPECT_EQ(parser.statistics().bad_crc, 0U);
  EXPECT_EQ(parser.statistics().lost, 0U);
  return packets;
}

template <class Message>
std::optional<Message> first(const std::vector<mavlink::Packet>& packets) {
  for (const auto& packet : packets) {
    if (const auto message = mavlink::decode<Message>(packet)) return message;
  }
  return std::nullopt;
}

ShownVehicle vehicle(double measured_s, std::uint16_t id = 3) {
  ShownVehicle shown;
  shown.id = {id};
  shown.state.time = at_seconds(measured_s);
  shown.state.z_m = 50.0;
  shown.state.heading_rad = heading_from_compass_deg(90.0);
  shown.state.course_rad = heading_from_compass_deg(180.0);
  shown.state.groundspeed_mps = 20.0;
  shown.state.airspeed_mps = 21.0;
  shown.state.climb_mps = 1.5;
  shown.state.battery_percent = 80;
  shown.state.phase = FlightPhase::flying;
  shown.place = {59.1234567, -17.5, 530.0};
  shown.activity = mission::Activity::executing;
  return shown;
}

TEST(MavlinkFeed, ShowsAVehicleAsASystemOfItsNumber) {
  MavlinkFeed feed;
  Shown shown;
  shown.vehicles = {vehicle(9.9)};
  const auto packets = parsed(feed.update(shown, at_seconds(10.0), kUnix_ns));
  ASSERT_EQ(packets.size(), 8U);
  for (const auto& packet : packets) {
    EXPECT_EQ(packet.version, 2);
    EXPECT_EQ(packet.system, 3);
    EXPECT_EQ(packet.component, mavlink::kComponentAutopilot);
  }
  const auto heartbeat = first<mavlink::Heartbeat>(packets);
  ASSERT_TRUE(heartbeat);
  EXPECT_EQ(heartbeat->type, 1) << "fixed wing";
  EXPECT_EQ(heartbeat->autopilot, 0) << "generic";
  EXPECT_NE(heartbeat->base_mode & mavlink::mode_safety_armed, 0);
  const auto position = first<mavlink::GlobalPositionInt>(packets);
  ASSERT_TRUE(position);
  EXPECT_EQ(position->time_boot_ms, 9900U);
  EXPECT_EQ(position->lat, 591'234'567);
  EXPECT_EQ(position->lon, -175'000'000);
  EXPECT_EQ(position->alt, 530'000);
  EXPECT_EQ(position->relative_alt, 50'000);
  EXPECT_EQ(position->vx, -2000) << "southwards";
  EXPECT_EQ(position->vy, 0);
  EXPECT_EQ(position->vz, -150) << "downwards";
  EXPECT_EQ(position->hdg, 9000);
  const auto attitude = first<mavlink::Attitude>(packets);
  ASSERT_TRUE(attitude);
  EXPECT_NEAR(attitude->yaw, kPi / 2.0, 1e-6);
  const auto hud = first<mavlink::VfrHud>(packets);
  ASSERT_TRUE(hud);
  EXPECT_EQ(hud->heading, 90);
  EXPECT_FLOAT_EQ(hud->airspeed, 21.0F);
  const auto status = first<mavlink::SysStatus>(packets);
  ASSERT_TRUE(status);
  EXPECT_EQ(status->battery_remaining, 80);
  const auto battery = first<mavlink::BatteryStatus>(packets);
  ASSERT_TRUE(battery);
  EXPECT_EQ(battery->battery_remaining, 80);
}

TEST(MavlinkFeed, TellsWhatItDoesInWordsWhenThatChanges) {
  MavlinkFeed feed;
  Shown shown;
  shown.vehicles = {vehicle(9.9)};
  const auto text =
      first<mavlink::Statustext>(parsed(feed.update(shown, at_seconds(10.0), kUnix_ns)));
  ASSERT_TRUE(text);
  EXPECT_EQ(mavlink::text_of(text->text), "executing");
  EXPECT_EQ(text->severity, 6) << "for information";
  EXPECT_FALSE(first<mavlink::Statustext>(parsed(feed.update(shown, at_seconds(12.0), kUnix_ns))));
}

TEST(MavlinkFeed, TellsHowFarItsWayIs) {
  MavlinkFeed feed;
  Shown shown;
  shown.vehicles = {vehicle(9.9)};
  const auto none =
      first<mavlink::MissionCurrent>(parsed(feed.update(shown, at_seconds(10.0), kUnix_ns)));
  ASSERT_TRUE(none);
  EXPECT_EQ(none->total, 65'535) << "there is none";
  EXPECT_EQ(none->mission_state, 1);
  shown.tracks = {{{3}, {{59.0, 17.0, 30.0}, {59.1, 17.0, 30.0}}, 7, 2, 1234.4}};
  const auto packets = parsed(feed.update(shown, at_seconds(11.0), kUnix_ns));
  const auto current = first<mavlink::MissionCurrent>(packets);
  ASSERT_TRUE(current);
  EXPECT_EQ(current->seq, 2);
  EXPECT_EQ(current->total, 7);
  EXPECT_EQ(current->mission_state, 3) << "active";
  const auto output = first<mavlink::NavControllerOutput>(packets);
  ASSERT_TRUE(output);
  EXPECT_EQ(output->wp_dist, 1234);
}

TEST(MavlinkFeed, SaysTheRemoteIdOfWhoHasOne) {
  MavlinkFeed feed;
  Shown shown;
  shown.vehicles = {vehicle(9.9), vehicle(9.9, 4), vehicle(9.9, 5)};
  shown.vehicles[1].state.x_m = 300.4;
  shown.vehicles[1].place.height_m = 560.0;
  RemoteId id;
  id.operator_id = "SWE1234567890abc";
  id.description = "search for a fire";
  id.category = RemoteId::Category::open;
  id.class_eu = 2;
  for (const std::size_t i : {0U, 1U}) {
    id.uas_id = "1ABCD" + std::to_string(i);
    shown.vehicles[i].remote_id = id;
  }
  const auto packets = parsed(feed.update(shown, at_seconds(10.0), kUnix_ns));
  const auto count = std::ranges::count_if(
      packets, [](const auto& packet) { return packet.id >= 12'900 && packet.id < 12'920; });
  EXPECT_EQ(count, 10) << "five of each of both; the third has none";
  const auto basic = first<mavlink::OpenDroneIdBasicId>(packets);
  ASSERT_TRUE(basic);
  EXPECT_EQ(basic->id_type, 1) << "a serial number";
  EXPECT_EQ(basic->ua_type, 1) << "an aeroplane";
  EXPECT_EQ(std::string(basic->uas_id.begin(), basic->uas_id.begin() + 6), "1ABCD0");
  EXPECT_EQ(basic->uas_id[6], 0);
  const auto location = first<mavlink::OpenDroneIdLocation>(packets);
  ASSERT_TRUE(location);
  EXPECT_EQ(location->latitude, 591'234'567);
  EXPECT_EQ(location->longitude, -175'000'000);
  EXPECT_FLOAT_EQ(location->altitude_geodetic, 530.0F);
  EXPECT_EQ(location->direction, 18'000);
  EXPECT_EQ(location->speed_horizontal, 2000);
  EXPECT_EQ(location->speed_vertical, 150);
  EXPECT_EQ(location->status, 2) << "airborne";
  EXPECT_NEAR(location->timestamp, std::fmod(1'700'000'009.9, 3600.0), 0.01);
  const auto system = first<mavlink::OpenDroneIdSystem>(packets);
  ASSERT_TRUE(system);
  EXPECT_EQ(system->operator_location_type, 0) << "where it was first heard";
  EXPECT_EQ(system->operator_latitude, 591'234'567);
  EXPECT_EQ(system->timestamp, 1'700'000'010U - 1'546'300'800U);
  EXPECT_EQ(system->area_count, 2);
  EXPECT_EQ(system->area_radius, 301);
  EXPECT_FLOAT_EQ(system->area_floor, 530.0F);
  EXPECT_FLOAT_EQ(system->area_ceiling, 560.0F);
  EXPECT_EQ(system->classification_type, 1);
  EXPECT_EQ(system->category_eu, 1);
  EXPECT_EQ(system->class_eu, 2);
  EXPECT_EQ(mavlink::text_of(first<mavlink::OpenDroneIdOperatorId>(packets)->operator_id),
            "SWE1234567890abc");
  EXPECT_EQ(mavlink::text_of(first<mavlink::OpenDroneIdSelfId>(packets)->description),
            "search for a fire");
}

TEST(MavlinkFeed, SaysWhatItDoesNotKnow) {
  MavlinkFeed feed;
  Shown shown;
  shown.vehicles = {vehicle(9.9)};
  shown.vehicles[0].copter = true;
  shown.vehicles[0].state.battery_percent = kBatteryNotTold;
  shown.vehicles[0].state.phase = FlightPhase::disarmed;
  const auto packets = parsed(feed.update(shown, at_seconds(10.0), kUnix_ns));
  EXPECT_EQ(first<mavlink::SysStatus>(packets)->battery_remaining, -1);
  const auto heartbeat = first<mavlink::Heartbeat>(packets);
  EXPECT_EQ(heartbeat->type, 2) << "a multirotor";
  EXPECT_EQ(heartbeat->base_mode & mavlink::mode_safety_armed, 0);
}

TEST(MavlinkFeed, BeatsOnceASecondAndNotOfWhoIsSilent) {
  MavlinkFeed feed;
  Shown shown;
  int heartbeats = 0;
  int positions = 0;
  for (int i = 0; i < 100; ++i) {  // ten seconds, telemetry five times a second
    shown.vehicles = {vehicle(10.0 + 0.2 * std::floor(0.5 * i)), vehicle(10.0, 251)};
    const auto packets = parsed(feed.update(shown, at_seconds(10.0 + 0.1 * i), kUnix_ns));
    for (const auto& packet : packets) {
      EXPECT_EQ(packet.system, 3) << "251 and above are no vehicles'";
      heartbeats += packet.id == mavlink::Heartbeat::kDefinition.id ? 1 : 0;
      positions += packet.id == mavlink::GlobalPositionInt::kDefinition.id ? 1 : 0;
    }
  }
  EXPECT_EQ(heartbeats, 10);
  EXPECT_EQ(positions, 50);
  shown.vehicles[0].silent = true;
  EXPECT_TRUE(feed.update(shown, at_seconds(30.0), kUnix_ns).empty());
}

TEST(MavlinkFeed, AnAlarmIsATextInPieces) {
  MavlinkFeed feed;
  const auto one = parsed(feed.alarm({3}, "low battery"));
  ASSERT_EQ(one.size(), 1U);
  const auto text = first<mavlink::Statustext>(one);
  EXPECT_EQ(mavlink::text_of(text->text), "low battery");
  EXPECT_EQ(text->id, 0);
  EXPECT_EQ(text->severity, 4);
  const std::string hundred(100, 'x');
  const auto pieces = parsed(feed.alarm({3}, hundred));
  ASSERT_EQ(pieces.size(), 3U) << "the last piece has the zero that ends it";
  std::string whole;
  for (const auto& piece : pieces) {
    const auto said = mavlink::decode<mavlink::Statustext>(piece);
    EXPECT_EQ(said->id, 1);
    whole += mavlink::text_of(said->text);
  }
  EXPECT_EQ(whole, hundred);
  EXPECT_EQ(feed.alarm({3}, std::string(10'000, 'x')).size(), 5U);
  EXPECT_TRUE(feed.alarm({0}, "of the ground station").empty());
}

}  // namespace
}  // namespace skein::agencies
