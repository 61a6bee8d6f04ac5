// SPDX-License-Identifier: Apache-2.0
#include "skein/schemas/schemas.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

namespace skein::schemas {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const Schema* named(std::string_view name) {
  const auto found = std::ranges::find(all(), name, &Schema::name);
  return found == all().end() ? nullptr : &*found;
}

TEST(Schemas, EachNameIsOfOne) {
  std::set<std::string_view> names;
  for (const Schema& schema : all()) EXPECT_TRUE(names.insert(schema.name).second) << schema.name;
}

TEST(Schemas, AStructIsItsFieldsAndWhatTheyAreMadeOf) {
  const Schema* command = named("skein/msg/Command");
  ASSERT_NE(command, nullptr);
  EXPECT_EQ(command->kind, -1);
  EXPECT_EQ(command->version, 9);
  EXPECT_EQ(
      command->text,
      "uint16 VERSION=9\n"
      "uint16 version\n"
      "uint16 vehicle\n"
      "uint32 number\n"
      "uint32 HOLD=0\nuint32 RESUME=1\nuint32 RETURN_HOME=2\nuint32 GIVE_BACK=3\nuint32 LAND=4\n"
      "uint32 kind\n"
      "uint16 told_by\nuint32 number_high\n");
  const Schema* health = named("skein/msg/Health");
  ASSERT_NE(health, nullptr);
  EXPECT_THAT(std::string{health->text},
              HasSubstr("string<=200[<=8] problems\nHeard[<=64] heard\n"));
  EXPECT_THAT(std::string{health->text},
              HasSubstr("\nMSG: skein/Heard\nuint32 size_bytes\nuint16 vehicle\nint64 age_ns\n"));
}

TEST(Schemas, AUnionIsASchemaForEachBranch) {
  const Schema* award = named("skein/msg/CoalitionMessageAward");
  ASSERT_NE(award, nullptr);
  EXPECT_EQ(award->type, "CoalitionMessage");
  EXPECT_EQ(award->kind, 2);
  EXPECT_EQ(award->branch, "award");
  EXPECT_THAT(std::string{award->text},
              StartsWith("uint16 VERSION=9\nuint16 version\nuint32 ANNOUNCEMENT=0\n"));
  EXPECT_THAT(std::string{award->text}, HasSubstr("\nuint32 kind\nAward body\n"));
  EXPECT_THAT(std::string{award->text}, HasSubstr("\nMSG: skein/TaskAssignment\nTaskId task\n"));
  EXPECT_EQ(named("skein/msg/CoalitionMessage"), nullptr);
}

}  // namespace
}  // namespace skein::schemas
