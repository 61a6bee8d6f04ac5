// SPDX-License-Identifier: Apache-2.0
#include "skein/configuration/track_file.hpp"

#include <gtest/gtest.h>

namespace skein::configuration {
namespace {

constexpr std::string_view kLap = R"(version: 1
title: a lap
turn_radius_m: 200
waypoints: [[0, 0], [2000, 0], [2000, 2000]]
)";

TEST(TrackFile, IsReadAndWrittenAlike) {
  const auto lap = parse_track(kLap, "lap.yaml");
  ASSERT_TRUE(lap.ok()) << lap.error().message;
  EXPECT_TRUE(lap->track.closed);
  EXPECT_EQ(lap->track.turn_radius_m, 200.0);
  ASSERT_EQ(lap->track.waypoints.size(), 3U);
  EXPECT_EQ(lap->track.waypoints[2], (Vec2{2000.0, 2000.0}));
  const auto again = parse_track(to_yaml(*lap), "again.yaml");
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(to_yaml(*again), to_yaml(*lap));
}

TEST(TrackFile, SaysWhatIsWrong) {
  const auto two = parse_track("version: 1\ntitle: x\nwaypoints: [[0, 0], [1, 0]]\n", "two.yaml");
  ASSERT_FALSE(two.ok());
  EXPECT_NE(two.error().message.find("a closed track needs three"), std::string::npos)
      << two.error().message;
  EXPECT_TRUE(
      parse_track("version: 1\ntitle: x\noutline: open\nwaypoints: [[0, 0], [1, 0]]\n", "o").ok());
}

TEST(TrackFile, ThoseThatAreShippedCanBeFlown) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator{
           std::filesystem::path{SKEIN_SOURCE_DIR} / "scenarios" / "tracks"}) {
    const auto file = load_track(entry.path());
    ASSERT_TRUE(file.ok()) << file.error().message;
    const auto path = formation::track_path(file->track);
    EXPECT_TRUE(path.ok()) << entry.path() << ": " << path.error().message;
    ++count;
  }
  EXPECT_GE(count, 1U);
}

}  // namespace
}  // namespace skein::configuration
