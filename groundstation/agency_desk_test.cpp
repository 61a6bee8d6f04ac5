// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/agency_desk.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>

#include "skein/mission/ground_node.hpp"

namespace skein::groundstation {
namespace {

using ::testing::HasSubstr;

MissionOrigin origin() { return *MissionOrigin::make({59.0, 17.0, 100.0}); }

mission::Telemetry telemetry(double time_s, double x_m) {
  mission::Telemetry t;
  t.vehicle = {2};
  t.instance = {1};
  t.state.time = at_seconds(time_s);
  t.state.x_m = x_m;
  t.state.z_m = 50.0;
  t.range_left_m = 5000.0;
  return t;
}

mission::PlanReport plan(std::uint32_t number, double length_m) {
  mission::PlanReport report;
  report.vehicle = {2};
  report.plan.number = number;
  report.plan.timed.start_time = at_seconds(0.0);
  report.plan.timed.speed_mps = 20.0;
  EXPECT_TRUE(report.plan.timed.path.append(Segment{0.0, length_m}));
  EXPECT_TRUE(report.plan.timed.path.append(Segment{0.01, 100.0}));
  return report;
}

struct ShownTest : ::testing::Test {
  void hear(const mission::Message& message, double now_s) {
    fleet.on_message(message, at_seconds(now_s));
    picture.on_message(message, {2}, at_seconds(now_s));
  }
  agencies::Shown at(double now_s) {
    fleet.on_timeout(at_seconds(now_s));
    return shown_of(picture, fleet, origin(), remote_ids, tracks, at_seconds(now_s));
  }
  mission::Fleet fleet{{.expected = {{1}, {2}}}};
  console::Picture picture{{.expected = {{1}, {2}}, .hazards = {{{4}, {100.0, 200.0}, 30.0}}}};
  ShownTracks tracks{origin()};
  configuration::TeamRemoteId remote_ids;
};

TEST_F(ShownTest, HasWhoWasHeardAndWhereItGoes) {
  EXPECT_TRUE(at(1.0).vehicles.empty()) << "nothing is known of who was never heard";
  hear(telemetry(1.0, 1000.0), 1.1);
  hear(plan(7, 400.0), 1.1);
  const auto shown = at(1.2);
  ASSERT_EQ(shown.vehicles.size(), 1U);
  const auto& vehicle = shown.vehicles[0];
  EXPECT_EQ(vehicle.id, VehicleId{2});
  EXPECT_FALSE(vehicle.silent);
  EXPECT_NEAR((origin().to_enu(vehicle.place) - Position<MissionEnu>{1000.0, 0.0, 50.0}).norm(),
              0.0, 1e-3);
  ASSERT_EQ(shown.tracks.size(), 1U);
  const auto& points = shown.tracks[0].points;
  ASSERT_EQ(points.size(), 6U) << "a line, and an arc of 1 rad in steps of 0.3";
  EXPECT_NEAR(origin().to_enu(points[1]).x(), 400.0, 1e-3);
  EXPECT_NEAR(origin().to_enu(points[1]).z(), 50.0, 1e-3);
  EXPECT_EQ(shown.tracks[0].legs, 2);
  EXPECT_EQ(shown.tracks[0].leg, 0);
  EXPECT_NEAR(shown.tracks[0].left_m, 500.0 - 1.2 * 20.0, 0.1);
  hear(telemetry(20.9, 1000.0), 21.0);
  EXPECT_EQ(at(21.0).tracks.at(0).leg, 1);
  ASSERT_EQ(shown.hazards.size(), 1U);
  EXPECT_EQ(shown.hazards[0].radius_m, 30.0);
  EXPECT_FALSE(vehicle.remote_id.exists());
  remote_ids.ids = {{VehicleId{2}, "1ABCD9"}};
  EXPECT_EQ(at(1.2).vehicles[0].remote_id.uas_id, "1ABCD9");
}

TEST_F(ShownTest, LeavesOutPlansThatAreOverAndWhatIsOutOfTheMission) {
  hear(telemetry(1.0, 1000.0), 1.1);
  hear(plan(7, 400.0), 1.1);
  EXPECT_TRUE(at(30.0).tracks.empty());
  EXPECT_TRUE(at(30.0).vehicles.at(0).silent);
  fleet.set_revoked({{2}});
  EXPECT_TRUE(at(30.1).vehicles.empty());
}

TEST_F(ShownTest, HasSitesUntilTheyAreWithdrawn) {
  mission::SiteReport report;
  report.site.id = {9};
  report.site.position = {10.0, 20.0};
  picture.on_message(report, kGroundStation, at_seconds(1.0));
  const auto shown = at(1.0);
  ASSERT_EQ(shown.sites.size(), 1U);
  EXPECT_THAT(shown.sites[0].state, HasSubstr("not surveyed"));
  EXPECT_NEAR(shown.sites[0].place.height_m, 100.0, 1e-3);
  report.withdrawn = true;
  picture.on_message(report, kGroundStation, at_seconds(2.0));
  EXPECT_TRUE(at(2.0).sites.empty());
}

TEST_F(ShownTest, ATrackIsMadeAnewWithItsPlan) {
  const auto first = tracks.of({2}, plan(7, 400.0).plan, 50.0);
  EXPECT_EQ(tracks.of({2}, plan(7, 400.0).plan, 60.0).points[0].height_m, first.points[0].height_m)
      << "not because it climbs";
  EXPECT_EQ(tracks.of({2}, plan(8, 500.0).plan, 60.0).points.size(), 6U);
  EXPECT_NEAR(origin().to_enu(tracks.of({2}, plan(8, 500.0).plan, 60.0).points[1]).x(), 500.0,
              1e-3);
  auto long_one = plan(9, 100.0);
  for (int i = 0; i < 60; ++i) EXPECT_TRUE(long_one.plan.timed.path.append(Segment{0.01, 600.0}));
  EXPECT_EQ(tracks.of({2}, long_one.plan, 50.0).points.size(), ShownTracks::kPointsMax);
}

configuration::GroundConfig config(const std::string& agencies) {
  const auto parsed = configuration::parse_ground_config(
      "version: 1\norigin: {latitude_deg: 59.0, longitude_deg: 17.0, height_m: 100}\n"
      "vehicles: [1, 2]\nnetwork: {port: 7410}\ntime: {epoch_unix_ns: 1700000000000000000}\n" +
          agencies,
      "ground.yaml");
  EXPECT_TRUE(parsed.ok()) << (parsed ? "" : parsed.error().message);
  return parsed ? *parsed : configuration::GroundConfig{};
}

std::optional<std::string> wait_for(agencies::Inlet& inlet, const std::function<void()>& go_on) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds{20};
  while (std::chrono::steady_clock::now() < end) {
    go_on();
    if (auto datagram = inlet.poll(65'000)) return datagram;
    std::this_thread::yield();
  }
  return std::nullopt;
}

TEST_F(ShownTest, IsSentWhereTheConfigurationSays) {
  auto cot = agencies::Inlet::open("127.0.0.1", 0, "");
  auto watcher = agencies::Inlet::open("127.0.0.1", 0, "");
  ASSERT_TRUE(cot.ok() && watcher.ok());
  AgencyDesk desk{
      config("agencies:\n  team: alpha\n  cot: [{address: 127.0.0.1, port: " +
             std::to_string(cot->port()) + "}]\n  mavlink: [{address: 127.0.0.1, port: " +
             std::to_string(watcher->port()) + "}]\n"),
      origin()};
  hear(telemetry(1.0, 1000.0), 1.1);
  desk.on_timeout(picture, fleet, at_seconds(1.2));
  const auto event = wait_for(*cot, [] {});
  ASSERT_TRUE(event);
  EXPECT_THAT(*event, HasSubstr("uid=\"alpha-vehicle-2\""));
  const auto packet = wait_for(*watcher, [] {});
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->front(), '\xFD') << "MAVLink 2";
}

TEST(AgencyDesk, ReadsTheFileThatAReceiverWrites) {
  const std::string file = ::testing::TempDir() + "agency_desk_aircraft.json";
  const auto unix_s =
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  std::ofstream{file} << "{\"now\": " << std::to_string(unix_s)
                      << R"(, "aircraft": [{"hex": "4ca2d6", "lat": 59.01, "lon": 17.0,
      "alt_geom": 2000, "gs": 100, "track": 180, "seen_pos": 1.0}]})";
  AgencyDesk desk{config("agencies: {adsb: {file: " + file + "}}\n"), origin()};
  const auto seen = desk.next_aircraft(at_seconds(10.0));
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->aircraft.address, 0x4ca2d6U);
  EXPECT_NEAR(seen->aircraft.height_m, 2000.0 * 0.3048 - 100.0, 1e-6);
  EXPECT_NEAR(to_seconds(seen->aircraft.time.time_since_epoch()), 9.0, 0.5);
  EXPECT_FALSE(desk.next_aircraft(at_seconds(10.5)));
  EXPECT_TRUE(desk.next_aircraft(at_seconds(11.5))) << "it is read again";
  EXPECT_EQ(desk.receiver_trouble(), "");
  std::ofstream{file} << "{\"now\": " << std::to_string(unix_s - 60.0) << R"(, "aircraft": []})";
  EXPECT_FALSE(desk.next_aircraft(at_seconds(13.0)));
  EXPECT_THAT(desk.receiver_trouble(), HasSubstr("is not written any more"));
  std::filesystem::remove(file);
  EXPECT_FALSE(desk.next_aircraft(at_seconds(15.0)));
  EXPECT_THAT(desk.receiver_trouble(), HasSubstr("cannot be read"));
}

TEST(AgencyDesk, SaysThatItsReceiverIsNotThere) {
  AgencyDesk desk{config("agencies: {adsb: {address: 127.0.0.1, port: 9}}\n"), origin()};
  EXPECT_FALSE(desk.next_aircraft(at_seconds(10.0)));
  EXPECT_THAT(desk.receiver_trouble(), HasSubstr("no connection"));
}

TEST(AgencyDesk, WithoutConfigurationItDoesNothing) {
  EXPECT_FALSE((AgencyDesk{config(""), origin()}.next_aircraft(at_seconds(1.0))));
  AgencyDesk desk{config(""), origin()};
  EXPECT_FALSE(desk.next_marker(at_seconds(1.0)));
  EXPECT_EQ(desk.receiver_trouble(), "");
  desk.on_timeout(console::Picture{{}}, mission::Fleet{{}}, at_seconds(1.0));
}

}  // namespace
}  // namespace skein::groundstation
