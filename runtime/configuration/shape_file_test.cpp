// SPDX-License-Identifier: Apache-2.0
#include "skein/configuration/shape_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "skein/formation/shapes.hpp"

namespace skein::configuration {
namespace {

using ::testing::HasSubstr;

constexpr auto kStairs = R"(version: 1
title: Stairs
outline: open
points:
  - {dx_m: 0, dy_m: 1}
  - {dx_m: -2.5, dy_m: 1, dz_m: 3}
)";

std::string error_of(const std::string& yaml) {
  const auto shape = parse_shape(yaml, "s.yaml");
  return shape.ok() ? "no error" : shape.error().message;
}

std::string error_of(const std::string& from, const std::string& to) {
  std::string text = kStairs;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return error_of(text.replace(at, from.size(), to));
}

TEST(ShapeFile, IsReadAndWrittenAlike) {
  const auto shape = parse_shape(kStairs, "s.yaml");
  ASSERT_TRUE(shape.ok()) << shape.error().message;
  EXPECT_EQ(shape->title, "Stairs");
  EXPECT_FALSE(shape->closed);
  ASSERT_EQ(shape->points.size(), 2U);
  EXPECT_EQ(shape->points[0], Vec3(0.0, 1.0, 0.0));
  EXPECT_EQ(shape->points[1], Vec3(-2.5, 1.0, 3.0));
  const auto again = parse_shape(to_yaml(*shape), "again.yaml");
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(again->points, shape->points);
  EXPECT_EQ(to_yaml(*again), to_yaml(*shape));
}

TEST(ShapeFile, SaysWhereItIsWrongAndWhatToDo) {
  EXPECT_THAT(error_of("dx_m: -2.5", "dx_m: left"),
              HasSubstr("s.yaml:6: points[2].dx_m: is \"left\", not a number"));
  EXPECT_THAT(error_of("dy_m: 1}", "dy: 1}"), HasSubstr("points[1].dy_m: is missing; add it"));
  EXPECT_THAT(error_of("outline: open", "outline: opn"), HasSubstr("did you mean open?"));
  EXPECT_THAT(error_of("dz_m: 3", "dz_m: 2e6"), HasSubstr("outside"));
  EXPECT_THAT(error_of("version: 1\ntitle: Nothing\npoints: []\n"),
              HasSubstr("s.yaml:3: points: is empty; give it one point at least"));
}

TEST(ShapeFile, ThoseThatAreShippedHavePlacesForAnyNumberOfVehicles) {
  std::size_t files = 0;
  const std::filesystem::path folder =
      std::filesystem::path{SKEIN_SOURCE_DIR} / "scenarios" / "shapes";
  for (const auto& entry : std::filesystem::directory_iterator{folder}) {
    const auto file = load_shape(entry.path());
    ASSERT_TRUE(file.ok()) << file.error().message;
    formation::ShapeSpec shape;
    shape.kind = formation::ShapeKind::free;
    shape.points = file->points;
    shape.closed = file->closed;
    shape.spacing_m = 3.0;
    for (const std::size_t n : {1U, 2U, 3U, 5U, 8U, 20U, 32U, 100U, 300U, 1000U}) {
      const auto places = formation::places(shape, n);
      ASSERT_TRUE(places.ok()) << entry.path() << ", " << n << ": " << places.error().message;
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
          ASSERT_GE(((*places)[i] - (*places)[j]).norm(), 3.0 - 1e-9);
        }
      }
    }
    ++files;
  }
  EXPECT_GE(files, 1U);
}

}  // namespace
}  // namespace skein::configuration
