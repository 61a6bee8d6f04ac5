// SPDX-License-Identifier: Apache-2.0
#include "skein/schemas/schemas.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "ros2msg.hpp"

namespace skein::schemas {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr const char* kSample = R"(// a comment; struct No {};
#include "other.idl"
module a { module b {
const unsigned long kMax = 3;
/* enum Not { ONE }; */
enum Kind { FIRST, SECOND };
struct Point { double x_m; };
struct Track {
  octet flags;
  Kind kind;
  Kind other;
  sequence<a::b::Point, kMax> points;
  sequence<string<20>, 8> names;
  float fixed[2];
  long long at_ns;
  string free;
};
struct Second { boolean yes; };
union Body switch (Kind) { case FIRST: Track track; case SECOND: Second second_one; };
struct Message { unsigned short version; Body body; };
};};
)";

constexpr const char* kTrack =
    "uint8 flags\n"
    "uint32 FIRST=0\n"
    "uint32 SECOND=1\n"
    "uint32 kind\n"
    "uint32 other\n"
    "Point[<=3] points\n"
    "string<=20[<=8] names\n"
    "float32[2] fixed\n"
    "int64 at_ns\n"
    "string free\n";

std::vector<MadeSchema> schemas_of(const std::string& text) {
  Definitions definitions;
  const auto parsed = parse(text, "sample.idl", definitions);
  EXPECT_TRUE(parsed.ok()) << parsed.error().message;
  auto schemas = ros2msg_schemas(definitions);
  EXPECT_TRUE(schemas.ok()) << schemas.error().message;
  return schemas.ok() ? *schemas : std::vector<MadeSchema>{};
}

std::string refusal(const std::string& text) {
  Definitions definitions;
  if (const auto parsed = parse(text, "sample.idl", definitions); !parsed) {
    return parsed.error().message;
  }
  const auto schemas = ros2msg_schemas(definitions);
  return schemas.ok() ? "" : schemas.error().message;
}

TEST(Schemas, AStructIsItsFieldsAndWhatTheyAreMadeOf) {
  const auto schemas = schemas_of(kSample);
  ASSERT_THAT(schemas, SizeIs(5));
  EXPECT_EQ(schemas[0].name, "skein/msg/Point");
  EXPECT_EQ(schemas[1].type, "a::b::Track");
  EXPECT_EQ(schemas[1].text, kTrack + std::string(80, '=') + "\nMSG: skein/Point\nfloat64 x_m\n");
}

TEST(Schemas, AUnionIsASchemaForEachBranch) {
  const auto schemas = schemas_of(kSample);
  ASSERT_THAT(schemas, SizeIs(5));
  EXPECT_EQ(schemas[3].kind, 0U);
  EXPECT_EQ(schemas[3].branch, "track");
  EXPECT_EQ(schemas[4].kind, 1U);
  EXPECT_EQ(schemas[4].branch, "second_one");
  EXPECT_EQ(schemas[4].name, "skein/msg/MessageSecondOne");
  EXPECT_EQ(schemas[4].text,
            "uint16 version\nuint32 FIRST=0\nuint32 SECOND=1\nuint32 kind\nSecond body\n" +
                std::string(80, '=') + "\nMSG: skein/Second\nbool yes\n");
}

TEST(Schemas, WhatHasNoSchemaIsToldWithItsPlace) {
  EXPECT_THAT(refusal("struct A {\n  map<long, long> m;\n};"), HasSubstr("sample.idl:2: 'map'"));
  EXPECT_THAT(refusal("typedef long Number;"), HasSubstr("'typedef' is not of the IDL"));
  EXPECT_THAT(refusal("struct A { Later l; };"), HasSubstr("'Later' is not defined"));
  EXPECT_THAT(refusal("struct A { long x; };\nmodule m { struct A { long y; }; };"),
              HasSubstr("sample.idl:2: a second 'A'"));
  EXPECT_THAT(refusal("struct A { sequence<long, kMany> x; };"), HasSubstr("'kMany' is neither"));
  EXPECT_THAT(refusal("struct A { long x }"), HasSubstr("expected ';' before '}'"));
  EXPECT_THAT(refusal("struct A {"), HasSubstr("expected"));
  EXPECT_THAT(refusal("enum K { X }; struct S { long x; }; union U switch (K) { case X: S s; };"
                      "struct M { U u; long after; };"),
              HasSubstr("a union can only be the last member"));
}

TEST(Schemas, OfAllThatGoesOverTheAir) {
  std::set<std::string_view> names;
  for (const Schema& schema : all()) EXPECT_TRUE(names.insert(schema.name).second) << schema.name;
  const Schema* telemetry = find("skein::wire::Telemetry");
  ASSERT_NE(telemetry, nullptr);
  EXPECT_THAT(std::string{telemetry->text}, HasSubstr("uint32 SEARCHING=0\n"));
  const Schema* award = find("skein::wire::CoalitionMessage", 2);
  ASSERT_NE(award, nullptr);
  EXPECT_EQ(award->branch, "award");
  EXPECT_THAT(std::string{award->text}, HasSubstr("\nMSG: skein/TaskAssignment\nTaskId task\n"));
  EXPECT_EQ(find("skein::wire::CoalitionMessage"), nullptr);
  EXPECT_EQ(find("skein::wire::CoalitionMessage", 99), nullptr);
}

}  // namespace
}  // namespace skein::schemas
