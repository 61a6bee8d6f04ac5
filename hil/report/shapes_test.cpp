// SPDX-License-Identifier: Apache-2.0
#include "skein/report/shapes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "skein/configuration/shape_file.hpp"
#include "skein/formation/shapes.hpp"

namespace skein::report {
namespace {

using formation::ShapeKind;
using ::testing::HasSubstr;

std::string read(const std::filesystem::path& file) {
  std::ifstream in{file, std::ios::binary};
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

TEST(ShapesPicture, ShowsEveryPlaceOfEveryShape) {
  const std::string svg = shapes_svg(
      {{"two < three", {Vec3(0, 0, 0), Vec3(-3, 2, 0)}, 1}, {"one", {Vec3(0, 0, 0)}, 5}}, 3.0, 4);
  EXPECT_EQ(count_of(svg, "class=\"dot\""), 2U);
  EXPECT_EQ(count_of(svg, "class=\"ring\""), 1U);
  EXPECT_THAT(svg, HasSubstr("two &lt; three"));
}

TEST(ShapesPicture, AheadIsUpAndLeftIsLeft) {
  const std::string svg = shapes_svg({{"", {Vec3(10, 0, 0), Vec3(0, 10, 0)}, 2}}, 10.0, 1);
  const auto number_after = [&svg](const std::string& key, std::size_t from) {
    return std::stod(svg.substr(svg.find(key, from) + key.size()));
  };
  const std::size_t ahead = svg.find("class=\"dot\"");
  const std::size_t left = svg.find("class=\"dot\"", ahead + 1);
  EXPECT_LT(number_after("cy=\"", ahead), number_after("cy=\"", left));
  EXPECT_GT(number_after("cx=\"", ahead), number_after("cx=\"", left));
}

/// The picture of docs/formation.md.
std::string documented_shapes() {
  constexpr double kSpacing = 4.0;
  std::vector<ShapePanel> panels;
  const auto add = [&](const std::string& title, formation::ShapeSpec shape, std::size_t n) {
    shape.spacing_m = kSpacing;
    const auto places = formation::places(shape, n);
    EXPECT_TRUE(places.ok());
    if (places) panels.push_back({title, *places, 5});
  };
  const auto named = [](ShapeKind kind) {
    formation::ShapeSpec shape;
    shape.kind = kind;
    return shape;
  };
  add("line abreast, 9", named(ShapeKind::line_abreast), 9);
  add("column, 9", named(ShapeKind::column), 9);
  add("echelon, 9", named(ShapeKind::echelon), 9);
  add("wedge, 15", named(ShapeKind::wedge), 15);
  add("pentagon, 30", named(ShapeKind::pentagon), 30);
  add("pentagon, 8", named(ShapeKind::pentagon), 8);
  const auto heart = configuration::load_shape(std::filesystem::path{SKEIN_SOURCE_DIR} /
                                               "scenarios" / "shapes" / "heart.yaml");
  EXPECT_TRUE(heart.ok());
  if (!heart) return "";
  formation::ShapeSpec free = named(ShapeKind::free);
  free.points = heart->points;
  free.closed = heart->closed;
  add("heart, 5", free, 5);
  add("heart, 32", free, 32);
  return shapes_svg(panels, kSpacing, 4);
}

TEST(ShapesPicture, OfTheDocumentationIsWhatTheShapesAre) {
  const auto file = std::filesystem::path{SKEIN_SOURCE_DIR} / "docs" / "images" / "shapes.svg";
  const std::string picture = documented_shapes();
  // One thread. NOLINTNEXTLINE(concurrency-mt-unsafe)
  if (std::getenv("SKEIN_UPDATE_DOCS") != nullptr) {
    std::ofstream{file, std::ios::binary} << picture;
  }
  EXPECT_EQ(read(file), picture) << "run report_test with SKEIN_UPDATE_DOCS=1 to draw " << file;
}

}  // namespace
}  // namespace skein::report
