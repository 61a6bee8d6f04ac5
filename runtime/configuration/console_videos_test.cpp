// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "skein/configuration/scenario.hpp"

namespace skein::configuration {
namespace {

using ::testing::HasSubstr;

Result<Scenario> mission_with(const std::string& videos) {
  return parse_scenario(R"(version: 1
title: Two
duration_max_s: 60
origin: {latitude_deg: 31.5, longitude_deg: 105.0}
all: {cruise_speed_mps: 28, speed_min_mps: 23, speed_max_mps: 33, turn_radius_m: 70, range_m: 6000,
      capabilities: [survey], sensor_radius_m: 120, heading_deg: 0, north_m: 0}
vehicles:
  - {id: 1, east_m: 0, height_m: 100}
  - {id: 3, east_m: 50, height_m: 110}
sites: [{id: 1, east_m: 0, north_m: 500, survey: {dwell_s: 5}}]
console: {videos: [)" + videos +
                            "]}\n",
                        "test");
}

TEST(ConsoleVideos, AreAddressesThatPeopleOpen) {
  for (const char* url : {"rtsp://192.168.1.23/stream", "https://camera.example/3?a=1&b=2",
                          "http://[fe80::1]:8080/", "rtsp://user@host:8554/x"}) {
    const auto config = mission_with(std::string{"{vehicle: 3, url: '"} + url + "'}");
    ASSERT_TRUE(config) << config.error().message;
    ASSERT_EQ(config->console.videos.size(), 1U);
    EXPECT_EQ(config->console.videos[0].vehicle, VehicleId{3});
    EXPECT_EQ(config->console.videos[0].url, url);
  }
}

TEST(ConsoleVideos, NothingElseIsTaken) {
  for (const char* url :
       {"javascript:alert(1)", "file:///etc/passwd", "rtsp://", "https:///x", "http://a b",
        "data:text/html,x", "", "HTTP://a", "http://a\"x", "http://<script>"}) {
    const auto config = mission_with(std::string{"{vehicle: 3, url: '"} + url + "'}");
    ASSERT_FALSE(config) << url;
    EXPECT_THAT(config.error().message, HasSubstr("url")) << url;
  }
}

TEST(ConsoleVideos, EachVehicleHasOne) {
  const auto config = mission_with("{vehicle: 3, url: 'rtsp://a'}, {vehicle: 3, url: 'rtsp://b'}");
  ASSERT_FALSE(config);
  EXPECT_THAT(config.error().message, HasSubstr("vehicle"));
}

}  // namespace
}  // namespace skein::configuration
