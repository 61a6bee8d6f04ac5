// SPDX-License-Identifier: Apache-2.0
#include "skein/agencies/cot_event.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <pugixml.hpp>
#include <string>

namespace skein::agencies {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

CotEvent event() {
  CotEvent made;
  made.uid = "alpha-vehicle-3";
  made.type = "a-f-A-M-F-Q";
  made.how = "m-g";
  made.time_unix_ns = 1'700'000'000'123'456'789;
  made.stale_unix_ns = 1'700'000'010'123'456'789;
  made.place = {59.12345678, -17.5, 480.126};
  made.callsign = "alpha-3";
  made.remarks = "a < b & \"c\"";
  return made;
}

pugi::xml_document parsed(const CotEvent& of) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(to_xml(of).c_str()));
  return document;
}

std::string attribute(const pugi::xml_node& node, const char* name) {
  return node.attribute(name).value();
}

TEST(CotEvent, IsXmlWithTimesInMillisecondsAndPlacesInCentimetres) {
  const auto document = parsed(event());
  const auto root = document.child("event");
  EXPECT_EQ(attribute(root, "version"), "2.0");
  EXPECT_EQ(attribute(root, "uid"), "alpha-vehicle-3");
  EXPECT_EQ(attribute(root, "type"), "a-f-A-M-F-Q");
  EXPECT_EQ(attribute(root, "how"), "m-g");
  EXPECT_EQ(attribute(root, "time"), "2023-11-14T22:13:20.123Z");
  EXPECT_EQ(attribute(root, "start"), attribute(root, "time"));
  EXPECT_EQ(attribute(root, "stale"), "2023-11-14T22:13:30.123Z");
  CotEvent full = event();
  full.time_unix_ns = 1'700'000'000'000'000'000;
  const auto of_a_second = parsed(full);
  EXPECT_EQ(attribute(of_a_second.child("event"), "time"), "2023-11-14T22:13:20.000Z");
  const auto point = root.child("point");
  EXPECT_EQ(attribute(point, "lat"), "59.1234568");
  EXPECT_EQ(attribute(point, "lon"), "-17.5000000");
  EXPECT_EQ(attribute(point, "hae"), "480.13");
  EXPECT_EQ(attribute(point, "ce"), "9999999.0");
  EXPECT_EQ(attribute(root.child("detail").child("contact"), "callsign"), "alpha-3");
  EXPECT_STREQ(root.child("detail").child_value("remarks"), "a < b & \"c\"");
  EXPECT_FALSE(root.child("detail").child("track")) << "nothing is said of what is not known";
  EXPECT_FALSE(root.child("detail").child("status"));
}

TEST(CotEvent, HasCourseSpeedAndBattery) {
  CotEvent made = event();
  made.track = {271.5, 20.25};
  made.battery_percent = 80;
  const auto document = parsed(made);
  const auto detail = document.child("event").child("detail");
  EXPECT_EQ(attribute(detail.child("track"), "course"), "271.50");
  EXPECT_EQ(attribute(detail.child("track"), "speed"), "20.25");
  EXPECT_EQ(attribute(detail.child("status"), "battery"), "80");
}

TEST(CotEvent, DrawsCirclesAndLines) {
  CotEvent circle = event();
  circle.radius_m = 150.0;
  circle.colour_argb = 0xFFFF0000;
  const auto round = parsed(circle);
  const auto ellipse = round.child("event").child("detail").child("shape").child("ellipse");
  EXPECT_EQ(attribute(ellipse, "major"), "150.00");
  EXPECT_EQ(attribute(ellipse, "minor"), "150.00");
  EXPECT_EQ(attribute(round.child("event").child("detail").child("strokeColor"), "value"),
            "-65536");
  CotEvent line = event();
  line.line = {{59.0, 17.0, 30.0}, {59.5, 17.25, 40.0}};
  const auto drawn = parsed(line);
  const auto first = drawn.child("event").child("detail").child("link");
  EXPECT_EQ(attribute(first, "point"), "59.0000000,17.0000000,30.00");
  EXPECT_EQ(attribute(first.next_sibling("link"), "point"), "59.5000000,17.2500000,40.00");
}

TEST(CotEvent, IsADatagramOfTaksProtocolToo) {
  CotEvent made = event();
  made.battery_percent = 80;
  const std::string bytes = to_protobuf(made);
  EXPECT_THAT(bytes, StartsWith(std::string{"\xBF\x01\xBF\x12"})) << "header, then cotEvent";
  EXPECT_THAT(bytes, HasSubstr("\x0A\x0B"
                               "a-f-A-M-F-Q"));
  EXPECT_THAT(bytes, HasSubstr("\x2A\x0F"
                               "alpha-vehicle-3"));
  EXPECT_THAT(bytes, HasSubstr("\x2A\x02\x08\x50")) << "the battery, of 80 percent";
  EXPECT_THAT(bytes, HasSubstr("<remarks>a &lt; b &amp; \"c\"</remarks>"));
}

}  // namespace
}  // namespace skein::agencies
