// SPDX-License-Identifier: Apache-2.0
#include "skein/agencies/adsb_intake.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "skein/base/random.hpp"

namespace skein::agencies {
namespace {

constexpr Wgs84 kOrigin{53.0, -1.5, 120.0};

struct AdsbIntakeTest : ::testing::Test {
  AdsbIntake intake{*MissionOrigin::make(kOrigin), {}};
  std::optional<mission::SeenAircraft> line(const std::string& text, double now_s = 1.0) {
    return intake.take_sbs(text, at_seconds(now_s));
  }
  std::vector<mission::SeenAircraft> file(const std::string& text, double unix_s = 1000.0) {
    return intake.take_json(text, unix_s, at_seconds(50.0));
  }
};

// In the form of what dump1090 says on its port 30003.
constexpr const char* kPosition =
    "MSG,3,1,1,4CA2D6,1,2026/06/01,10:20:30.123,2026/06/"
    "01,10:20:30.160,,2000,,,53.05000,-1.50000,,,"
    "0,,0,0";
constexpr const char* kVelocity =
    "MSG,4,1,1,4CA2D6,1,2026/06/01,10:20:30.223,2026/06/01,10:20:30.260,,,120,90,,,-640,,,,,0";
constexpr const char* kCallsign =
    "MSG,1,1,1,4CA2D6,1,2026/06/01,10:20:30.323,2026/06/01,10:20:30.360,RYR12  ,,,,,,,,,,,0";

TEST_F(AdsbIntakeTest, PutsTheLinesOfAnAircraftTogether) {
  EXPECT_FALSE(line(kVelocity)) << "nobody knows where it is";
  EXPECT_FALSE(line(kCallsign));
  const auto seen = line(kPosition, 2.0);
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->aircraft.address, 0x4ca2d6U);
  EXPECT_EQ(seen->callsign, "RYR12");
  EXPECT_NEAR(seen->aircraft.position.x(), 0.0, 1.0);
  EXPECT_NEAR(seen->aircraft.position.y(), 5565.0, 10.0);
  EXPECT_NEAR(seen->aircraft.height_m, 2000.0 * 0.3048 - 120.0, 1e-6);
  EXPECT_TRUE(seen->barometric);
  EXPECT_FALSE(seen->on_ground);
  EXPECT_NEAR(seen->aircraft.east_mps, 120.0 * 1852.0 / 3600.0, 1e-9);
  EXPECT_NEAR(seen->aircraft.north_mps, 0.0, 1e-9);
  EXPECT_NEAR(seen->aircraft.climb_mps, -640.0 * 0.00508, 1e-9);
  EXPECT_EQ(seen->aircraft.time, at_seconds(2.0));
  const auto turned =
      line("MSG,4,1,1,4CA2D6,1,2026/06/01,10:20:31.223,2026/06/01,10:20:31.260,,,120,180,,,0,,,,,0",
           3.0);
  ASSERT_TRUE(turned);
  EXPECT_LT(turned->aircraft.north_mps, -60.0);
  EXPECT_EQ(turned->aircraft.time, at_seconds(2.0)) << "of its place";
  EXPECT_EQ(intake.unreadable(), 0U);
}

TEST_F(AdsbIntakeTest, HeightsFromPressureAreCorrected) {
  AdsbIntake high{*MissionOrigin::make(kOrigin), {.qnh_hpa = 1033.25, .geoid_height_m = 48.0}};
  const auto seen = high.take_sbs(kPosition, at_seconds(1.0));
  ASSERT_TRUE(seen);
  // Twenty hectopascals above the standard: 27.3 feet each, near the sea.
  EXPECT_NEAR(seen->aircraft.height_m, 2000.0 * 0.3048 + 20.0 * 8.3 + 48.0 - 120.0, 4.0);
}

TEST_F(AdsbIntakeTest, WhatRollsNeedsNoHeight) {
  const auto seen = line(
      "MSG,2,1,1,40621D,1,2026/06/01,10:20:30.123,2026/06/"
      "01,10:20:30.160,,,12,270,53.01,-1.51,,,,,,"
      "-1");
  ASSERT_TRUE(seen);
  EXPECT_TRUE(seen->on_ground);
}

TEST_F(AdsbIntakeTest, WhatIsNoLineIsCountedAndNothingElse) {
  for (const char* const text : {"MSG", "MSG,3,1,1,XYZ,1,,,,,,2000,,,53.0,-1.5", "nonsense",
                                 "MSG,3,1,1,000000,1", "MSG,3,1,1,4CA2D61,1,,,,,,1,,,53.0,-1.5"}) {
    EXPECT_FALSE(line(text)) << text;
  }
  EXPECT_EQ(intake.unreadable(), 5U);
  EXPECT_FALSE(line(""));
  EXPECT_FALSE(line("STA,,5,179,400AE7,10103,2026/06/01,10:20:30.1,2026/06/01,10:20:30.1,RM"));
  EXPECT_FALSE(line("MSG,3,1,1,4CA2D6,1,,,,,,1e99,,,91.0,-1.5")) << "no place, no height";
  EXPECT_FALSE(line("MSG,3,1,1,4CA2D6,1,,,,,,nan,,,nan,inf"));
  EXPECT_EQ(intake.unreadable(), 5U);
  EXPECT_FALSE(line("MSG,3,1,1,4CA2D6,1,,,,,,2000,,,43.0,-1.5")) << "a thousand kilometres away";
  EXPECT_EQ(intake.far_away(), 1U);
}

TEST_F(AdsbIntakeTest, PartsThatAreOldAreNotPutTogether) {
  EXPECT_FALSE(line(kVelocity, 1.0));
  const auto seen = line(kPosition, 100.0);
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->aircraft.east_mps, 0.0);
}

TEST_F(AdsbIntakeTest, MoreThanItKnowsAreNotTaken) {
  std::array<char, 8> hex{};
  for (int i = 1; i <= 2000; ++i) {
    std::snprintf(hex.data(), hex.size(), "%06X", static_cast<unsigned>(i));
    (void)line("MSG,3,1,1," + std::string{hex.data()} + ",1,,,,,,2000,,,53.05,-1.5,,,0,,0,0");
  }
  EXPECT_FALSE(line("MSG,3,1,1,FFFFFF,1,,,,,,2000,,,53.05,-1.5,,,0,,0,0"));
  EXPECT_TRUE(line("MSG,3,1,1,FFFFFF,1,,,,,,2000,,,53.05,-1.5,,,0,,0,0", 100.0));
}

TEST_F(AdsbIntakeTest, ReadsAircraftJson) {
  const auto all = file(R"({"now": 998.0, "messages": 1, "aircraft": [
    {"hex": "4ca2d6", "flight": "RYR12   ", "alt_baro": 1000, "alt_geom": 1200, "gs": 100.5,
     "track": 180.0, "baro_rate": 64, "geom_rate": -128, "lat": 53.05, "lon": -1.5, "seen_pos": 1.0},
    {"hex": "40621d", "alt_baro": "ground", "gs": 4, "track": 1, "lat": 53.0, "lon": -1.5},
    {"hex": "400001", "altitude": 3000, "speed": 200, "track": 0, "vert_rate": 0, "lat": 53.1, "lon": -1.5},
    {"hex": "~2a4c1b", "alt_baro": 1, "lat": 53.0, "lon": -1.5},
    {"hex": "400002", "alt_baro": 9000}, {"hex": 7}, 8, {}]})");
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0].callsign, "RYR12");
  EXPECT_FALSE(all[0].barometric) << "its satellites' height is better";
  EXPECT_NEAR(all[0].aircraft.height_m, 1200.0 * 0.3048 - 120.0, 1e-6);
  EXPECT_NEAR(all[0].aircraft.climb_mps, -128.0 * 0.00508, 1e-9);
  EXPECT_NEAR(all[0].aircraft.north_mps, -100.5 * 1852.0 / 3600.0, 1e-6);
  EXPECT_EQ(all[0].aircraft.time, at_seconds(47.0)) << "of a file that is 2 s old";
  EXPECT_TRUE(all[1].on_ground);
  EXPECT_TRUE(all[2].barometric);
  EXPECT_EQ(intake.unreadable(), 3U);
}

TEST_F(AdsbIntakeTest, APlaceThatIsTooOldIsNoneOfNow) {
  const auto all = file(R"({"now": 1000.0, "aircraft": [
    {"hex": "400001", "alt_geom": 1200, "lat": 53.05, "lon": -1.5, "seen_pos": 29.0},
    {"hex": "400002", "alt_geom": 1200, "lat": 53.05, "lon": -1.5, "seen_pos": 45.0},
    {"hex": "400003", "alt_geom": 1200, "lat": 53.05, "lon": -1.5, "seen_pos": -1}]})");
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].aircraft.address, 0x400001U);
  EXPECT_TRUE(line("MSG,3,1,1,4CA2D6,1,,,,,,2000,,,53.05,-1.5,,,0,,0,0", 10.0));
  EXPECT_TRUE(line("MSG,4,1,1,4CA2D6,1,,,,,,,100,90,,,0,,,,,0", 39.0));
  EXPECT_FALSE(line("MSG,4,1,1,4CA2D6,1,,,,,,,100,90,,,0,,,,,0", 41.0)) << "heard, and not where";
}

TEST_F(AdsbIntakeTest, AHeightIsCarriedToTheTimeOfItsPlace) {
  ASSERT_TRUE(line("MSG,3,1,1,4CA2D6,1,,,,,,2000,,,53.05,-1.5,,,0,,0,0", 10.0));
  const auto climbs = line("MSG,4,1,1,4CA2D6,1,,,,,,,100,90,,,1200,,,,,0", 10.0);
  ASSERT_TRUE(climbs);
  const auto later = line("MSG,5,1,1,4CA2D6,1,,,,,,2200,,,,,,,0,,0,0", 20.0);
  ASSERT_TRUE(later);
  EXPECT_NEAR(later->aircraft.height_m, climbs->aircraft.height_m, 1.0) << "200 ft in 10 s";
}

TEST_F(AdsbIntakeTest, WhatIsNoFileIsCounted) {
  EXPECT_TRUE(file("{").empty());
  EXPECT_TRUE(file("[]").empty());
  EXPECT_TRUE(file("{\"aircraft\": 3}").empty());
  EXPECT_TRUE(file(std::string(3'000'000, ' ')).empty());
  EXPECT_EQ(intake.unreadable(), 4U);
  EXPECT_TRUE(
      file(
          R"({"now": 900.0, "aircraft": [{"hex": "4ca2d6", "alt_geom": 1, "lat": 53.0, "lon": -1.5}]})")
          .empty())
      << "it is not written any more";
}

TEST_F(AdsbIntakeTest, AnyBytesAreTaken) {
  Random random{5};
  for (int i = 0; i < 3000; ++i) {
    std::string text = kPosition;
    for (int k = 0; k < 6; ++k) {
      text[random.index(text.size())] = static_cast<char>(random.index(256));
    }
    const auto seen = line(text, 1.0 + i);
    if (!seen) continue;
    EXPECT_TRUE(std::isfinite(seen->aircraft.height_m) && seen->aircraft.position.allFinite());
    EXPECT_LE(seen->callsign.size(), 8U);
  }
}

}  // namespace
}  // namespace skein::agencies
