// SPDX-License-Identifier: Apache-2.0
#include "skein/ros2/cdr.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "skein/ros2/messages.hpp"

namespace skein::ros2 {
namespace {

using testing::ElementsAre;

// Worked out by hand by the rules of CDR (OMG formal/2004-03-12, 15.3), as rmw implementations
// write it.
TEST(Cdr, IsPlainAndAligned) {
  skein_msgs::SiteTask task;
  task.kind = "assess";
  task.index = 2;
  task.vehicle = 0x0103;
  task.state = "open";
  EXPECT_THAT(to_cdr(task),
              ElementsAre(0, 1, 0, 0,                                   // header
                          7, 0, 0, 0, 'a', 's', 's', 'e', 's', 's', 0,  // its length has the NUL
                          2,                                            // at 11
                          0x03, 0x01,                                   // at 12
                          0, 0, 5, 0, 0, 0, 'o', 'p', 'e', 'n', 0));    // a length at 16
}

TEST(Cdr, NumbersOfEightBytesAreAlignedFromTheEndOfTheHeader) {
  std_msgs::String text;
  text.data = "";
  EXPECT_THAT(to_cdr(text), ElementsAre(0, 1, 0, 0, 1, 0, 0, 0, 0));
  skein_msgs::Hazard hazard;
  EXPECT_EQ(to_cdr(hazard).size(), 4U + 8 + 2 * 8 + 3 * 8 + 8);
}

TEST(Cdr, ReadsWhatItWrites) {
  skein_msgs::Sites sites;
  sites.header = {{7, 8}, "frame"};
  sites.sites.resize(2);
  sites.sites[1].id = 12;
  sites.sites[1].has_place = true;
  sites.sites[1].position = {1.5, -2.5, 0.0};
  sites.sites[1].tasks.push_back({"deliver", 3, 4, "done"});
  sites.sites[1].news = "found";
  const auto bytes = to_cdr(sites);
  const auto read = from_cdr<skein_msgs::Sites>(bytes);
  ASSERT_TRUE(read);
  EXPECT_EQ(to_cdr(*read), bytes);
  EXPECT_EQ(read->sites[1].tasks[0].vehicle, 4);
}

TEST(Cdr, EveryCutIsNoticed) {
  skein_msgs::SiteProposal proposal;
  proposal.name = "ridge";
  const auto bytes = to_cdr(proposal);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(from_cdr<skein_msgs::SiteProposal>(std::span{bytes}.first(size))) << size;
  }
  EXPECT_TRUE(from_cdr<skein_msgs::SiteProposal>(bytes));
}

TEST(Cdr, LengthsBeyondTheEndTakeNoMemory) {
  std::vector<std::uint8_t> bytes{0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0};
  bytes.insert(bytes.end(), {0xff, 0xff, 0xff, 0xff});
  EXPECT_FALSE(from_cdr<skein_msgs::Sites>(bytes));
}

TEST(Cdr, OtherEncodingsAreRefused) {
  auto bytes = to_cdr(skein_msgs::SiteProposal{});
  bytes[1] = 0x00;  // big endian
  EXPECT_FALSE(from_cdr<skein_msgs::SiteProposal>(bytes));
  bytes[1] = 0x03;  // a parameter list
  EXPECT_FALSE(from_cdr<skein_msgs::SiteProposal>(bytes));
}

TEST(Messages, HaveTheNamesAndHashesThatRos2Has) {
  EXPECT_EQ(std_msgs::String::kType.name, "std_msgs/msg/String");
  EXPECT_EQ(std_msgs::String::kType.dds_name, "std_msgs::msg::dds_::String_");
  EXPECT_EQ(std_msgs::String::kType.hash,
            "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18");
  EXPECT_EQ(skein_msgs::VehicleStatus::kType.dds_name, "skein_msgs::msg::dds_::VehicleStatus_");
}

}  // namespace
}  // namespace skein::ros2
