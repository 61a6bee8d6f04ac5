// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "skein/hil/radio/link_table.hpp"
#include "skein/hil/radio/radio_model.hpp"

namespace skein::hil::radio {
namespace {

TEST(LinkTable, IsSharedByNameAndGoneWithItsMaker) {
  std::string name;
  {
    auto made = LinkTable::create();
    ASSERT_TRUE(made) << made.error().message;
    name = made->name();
    const auto opened = LinkTable::open(name);
    ASSERT_TRUE(opened);
    EXPECT_TRUE(opened->get(VehicleId{3}, VehicleId{4}).up) << "perfect at first";
    made->set(VehicleId{3}, VehicleId{4}, {false, 0.25, from_seconds(0.1), from_seconds(0.02)});
    const Link link = opened->get(VehicleId{3}, VehicleId{4});
    EXPECT_FALSE(link.up);
    EXPECT_DOUBLE_EQ(link.loss, 0.25);
    EXPECT_EQ(link.delay, from_seconds(0.1));
    EXPECT_TRUE(opened->get(VehicleId{4}, VehicleId{3}).up)
        << "each direction is a link of its own";
    EXPECT_TRUE(opened->get(VehicleId{4000}, VehicleId{3}).up) << "who is not in the table passes";
  }
  const auto gone = LinkTable::open(name);
  ASSERT_FALSE(gone);
  EXPECT_NE(gone.error().message.find(name), std::string::npos);
}

TEST(RadioModel, RangeAndPartitionsDecide) {
  const RadioParams params{1500.0, 5000.0, from_seconds(0.06), from_seconds(0.03), 0.1};
  const std::map<VehicleId, Vec2> at{
      {VehicleId{1}, {0, 0}}, {VehicleId{2}, {1499, 0}}, {VehicleId{3}, {3000, 0}}};
  const auto up = [&](std::uint16_t a, std::uint16_t b,
                      const std::vector<std::vector<VehicleId>>& groups = {}) {
    return link_between(params, VehicleId{a}, VehicleId{b}, at, groups).up;
  };
  EXPECT_TRUE(up(1, 2));
  EXPECT_FALSE(up(1, 3));
  EXPECT_FALSE(up(2, 3));
  EXPECT_TRUE(up(0, 3)) << "the ground station hears further";
  EXPECT_FALSE(up(1, 9)) << "whose place is unknown is out of range";
  EXPECT_TRUE(up(0, 9));
  EXPECT_FALSE(up(1, 2, {{VehicleId{1}}, {VehicleId{2}}}));
  EXPECT_TRUE(up(1, 2, {{VehicleId{1}, VehicleId{2}}}));
  EXPECT_FALSE(up(1, 2, {{VehicleId{1}}})) << "one inside, one outside";
  EXPECT_DOUBLE_EQ(link_between(params, VehicleId{1}, VehicleId{2}, at, {}).loss, 0.1);
}

}  // namespace
}  // namespace skein::hil::radio
