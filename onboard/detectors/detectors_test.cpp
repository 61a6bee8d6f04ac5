// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "skein/detectors/detection_text.hpp"
#include "skein/detectors/detector_socket.hpp"

namespace skein::detectors {
namespace {

int shell(const std::string& line) {
  // One thread, and our own example:
  // NOLINTNEXTLINE(concurrency-mt-unsafe,bugprone-command-processor)
  return std::system(line.c_str());
}

using ::testing::HasSubstr;

MissionOrigin origin() { return *MissionOrigin::make({59.0, 17.0, 0.0}); }

std::string trouble_with(std::string_view text) {
  const auto read = read_detection(text, origin());
  EXPECT_FALSE(read.ok()) << text;
  return read ? "" : read.error().message;
}

TEST(DetectionText, IsReadInMetresAndInDegrees) {
  const auto in_metres = read_detection(
      R"({"kind":"flood","east_m":10.5,"north_m":-20,"confidence":0.5,"detector":"camera"})",
      origin());
  ASSERT_TRUE(in_metres.ok());
  EXPECT_EQ(in_metres->kind, mission::IncidentKind::flood);
  EXPECT_EQ(in_metres->position, (Vec2{10.5, -20.0}));
  EXPECT_EQ(in_metres->confidence, 0.5);
  EXPECT_EQ(in_metres->detector, "camera");
  EXPECT_EQ(in_metres->vehicle, VehicleId{}) << "the vehicle says whose it is";
  const auto in_degrees =
      read_detection(R"({"kind":"fire","latitude_deg":59.01,"longitude_deg":17.0})", origin());
  ASSERT_TRUE(in_degrees.ok());
  EXPECT_NEAR(in_degrees->position.y(), 1114.0, 5.0);
}

TEST(DetectionText, IsRefusedWithWhatIsWrong) {
  EXPECT_THAT(trouble_with(""), HasSubstr("JSON object"));
  EXPECT_THAT(trouble_with("[1]"), HasSubstr("JSON object"));
  EXPECT_THAT(trouble_with(std::string(2000, ' ')), HasSubstr("1024 bytes"));
  EXPECT_THAT(trouble_with(R"({"kind":"person","east_m":1,"north_m":2})"),
              HasSubstr("one of fire, smoke, flood"));
  EXPECT_THAT(trouble_with(R"({"kind":"fire"})"), HasSubstr("a place is"));
  EXPECT_THAT(trouble_with(R"({"kind":"fire","east_m":1})"), HasSubstr("north_m"));
  EXPECT_THAT(trouble_with(R"({"kind":"fire","east_m":1e9,"north_m":0})"), HasSubstr("east_m"));
  EXPECT_THAT(trouble_with(R"({"kind":"fire","latitude_deg":-33,"longitude_deg":17})"),
              HasSubstr("100 km"));
  EXPECT_THAT(trouble_with(R"({"kind":"fire","east_m":1,"north_m":2,"confidence":2})"),
              HasSubstr("confidence"));
  EXPECT_THAT(trouble_with(R"({"kind":"fire","east_m":1,"north_m":2,"detector":"a\nb"})"),
              HasSubstr("ASCII"));
}

TEST(DetectorSocket, TakesWhatTheExampleSendsAndPassesOverWhatCannotBeRead) {
  const std::string path = ::testing::TempDir() + "skein-detections-" + std::to_string(::getpid());
  auto socket = DetectorSocket::open(path, origin());
  ASSERT_TRUE(socket.ok()) << socket.error().message;
  EXPECT_FALSE(socket->poll());
  EXPECT_FALSE(DetectorSocket::open(path, origin()).ok()) << "somebody listens there";
  struct stat file {};
  ASSERT_EQ(::stat(path.c_str(), &file), 0);
  EXPECT_EQ(file.st_mode & S_IRWXO, 0U) << "not for everybody";

  const std::string example = "python3 " SKEIN_DETECTOR_EXAMPLE " " + path;
  ASSERT_EQ(shell(example + " fire 59.6 90.0"), 0);  // far away
  ASSERT_EQ(shell(example + " spill 59.001 17.0 --confidence 0.7 --name nose"), 0);
  const auto seen = socket->poll();
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->kind, mission::IncidentKind::spill);
  EXPECT_EQ(seen->confidence, 0.7);
  EXPECT_EQ(seen->detector, "nose");
  EXPECT_EQ(socket->unreadable(), 1U);
  EXPECT_THAT(socket->poll_trouble().value_or(""), HasSubstr("100 km"));
  EXPECT_FALSE(socket->poll_trouble());
  EXPECT_FALSE(socket->poll());
}

TEST(DetectorSocket, TakesOverTheFileOfAProcessThatIsGone) {
  const std::string path = ::testing::TempDir() + "skein-left-" + std::to_string(::getpid());
  // A process that is killed leaves its file: one that binds it and ends without a word.
  ASSERT_EQ(shell("python3 -c \"import socket; socket.socket(socket.AF_UNIX, "
                  "socket.SOCK_DGRAM).bind('" +
                  path + "')\""),
            0);
  EXPECT_TRUE(DetectorSocket::open(path, origin()).ok());
  EXPECT_FALSE(DetectorSocket::open("/no/such/folder/socket", origin()).ok());
  EXPECT_FALSE(DetectorSocket::open(std::string(200, 'x'), origin()).ok());
}

}  // namespace
}  // namespace skein::detectors
