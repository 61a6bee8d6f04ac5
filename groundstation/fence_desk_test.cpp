// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/fence_desk.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "fence_file.hpp"
#include "skein/groundstation/prompt.hpp"

namespace skein::groundstation {
namespace {

MissionOrigin origin() { return *MissionOrigin::make({47.0, 8.0, 400.0}); }

TEST(FenceFile, ReadsGeoJsonAndPlansOfQGroundControl) {
  const auto geo = fence_in(
      R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":
         {"type":"Polygon","coordinates":[[[8.0,47.0],[8.01,47.0],[8.01,47.01],[8.0,47.0]]]}}]})",
      origin());
  ASSERT_TRUE(geo.ok()) << geo.error().message;
  ASSERT_EQ(geo->size(), 3U) << "the ring ends where it begins";
  // A hundredth of a degree on WGS84 at 47 N: 760.6 m east, 1111.8 m north.
  EXPECT_NEAR((*geo)[1].x(), 760.6, 0.5);
  EXPECT_NEAR((*geo)[2].y(), 1111.8, 0.5);
  const auto plan = fence_in(
      R"({"fileType":"Plan","geoFence":{"circles":[],"polygons":[{"inclusion":true,"polygon":
         [[47.0,8.0],[47.0,8.01],[47.01,8.01]],"version":1}],"version":2}})",
      origin());
  ASSERT_TRUE(plan.ok()) << plan.error().message;
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(((*plan)[i] - (*geo)[i]).norm(), 1e-6) << i;
}

TEST(FenceFile, WhatIsNoFenceIsRefused) {
  for (
      const char* text :
      {"", "[]", "{}", R"({"type":"Polygon","coordinates":[]})",
       R"({"type":"Polygon","coordinates":[[["a",1],[1,2],[3,4]]]})",
       R"({"type":"Polygon","coordinates":[[[8,47],[8.1,47],[8,47.1]],[[8,47],[8.1,47],[8,48]]]})",
       R"({"type":"Polygon","coordinates":[[[8,91],[8.1,47],[8,47.1]]]})",
       R"({"type":"Polygon","coordinates":[[[8,49],[8.1,47],[8,47.1]]]})",
       R"({"geoFence":{"polygons":[]}})", R"({"geoFence":7})",
       R"({"geoFence":{"polygons":[{"inclusion":false,"polygon":[[47,8],[47,8.1],[47.1,8]]}]}})"}) {
    EXPECT_FALSE(fence_in(text, origin()).ok()) << text;
  }
}

TEST(FenceWords, AreReadAndSaidAlike) {
  for (const std::string line :
       {"fence 0,0 900,0 900,700 height 100", "preview fence 0,0 900,0 900,700.5 height 80",
        "fence area.geojson height 120", "fence"}) {
    const auto input = parse_input(line);
    ASSERT_TRUE(input.ok()) << line << input.error().message;
    EXPECT_EQ(line_of(*input), line);
  }
  for (const std::string line : {"fence 0,0 900", "fence height 100", "preview fence",
                                 "fence 0,0 1,0 1,1 height -1", "fence a,b", "fence x 0,0"}) {
    EXPECT_FALSE(parse_input(line).ok()) << line;
  }
  const auto order = read_order(
      R"({"kind":"fence","preview":true,"corners":[[0,0],[900,0],[900,700]],"height_m":100})");
  ASSERT_TRUE(order.ok()) << order.error().message;
  EXPECT_EQ(line_of(*order), "preview fence 0,0 900,0 900,700 height 100");
  for (const char* text :
       {R"({"kind":"fence","preview":true,"corners":[[0,0],[900]],"height_m":1})",
        R"({"kind":"fence","preview":true,"corners":7,"height_m":1})",
        R"({"kind":"fence","preview":true,"corners":[[0,1e9]],"height_m":1})",
        R"({"kind":"fence","corners":[[0,0],[1,0],[1,1]],"height_m":10})"}) {
    EXPECT_FALSE(read_order(text).ok()) << text;
  }
}

TEST(FenceDesk, OrdersWhatIsTypedOrInAFile) {
  mission::GroundNode node{{}, {}};
  const MissionOrigin at = origin();
  FenceDesk desk{node, at};
  NewFence order{{{{0.0, 0.0}, {1000.0, 0.0}, {1000.0, 500.0}}, 100.0}, {}, true};
  EXPECT_EQ(desk.answer(order, {}).text, "can be ordered: 3 corners, 0.25 km2, up to 100 m\n");
  EXPECT_FALSE(node.fence().ordered());
  order.preview = false;
  EXPECT_TRUE(desk.answer(order, {}).done);
  EXPECT_EQ(node.fence().fence(), order.fence);
  NewFence missing;
  missing.file = "/nonexistent/fence.geojson";
  EXPECT_EQ(desk.answer(missing, {}).text, "/nonexistent/fence.geojson: cannot be read\n");
  const auto file = std::filesystem::temp_directory_path() / "skein_fence_desk_test.geojson";
  std::ofstream{file} << R"({"type":"Polygon","coordinates":[[[8,47],[8.01,47],[8,47.01]]]})";
  missing.file = file;
  EXPECT_TRUE(desk.answer(missing, {}).done);
  EXPECT_EQ(node.fence().fence().corners.size(), 3U);
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace skein::groundstation
