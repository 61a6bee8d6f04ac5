// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "skein/hil/radio/link_table.hpp"
#include "skein/hil/radio/positions.hpp"
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
    made->set({true, 0.25, from_seconds(0.1), from_seconds(0.02)});
    made->set_hops(VehicleId{3}, VehicleId{4}, 2);
    made->set_hops(VehicleId{3}, VehicleId{5}, 0);
    const Link link = opened->get(VehicleId{3}, VehicleId{4});
    EXPECT_DOUBLE_EQ(link.loss, 1.0 - 0.75 * 0.75);
    EXPECT_EQ(link.delay, from_seconds(0.2));
    EXPECT_FALSE(opened->get(VehicleId{3}, VehicleId{5}).up);
    EXPECT_EQ(opened->get(VehicleId{4}, VehicleId{3}).delay, from_seconds(0.1))
        << "each direction is a way of its own";
    EXPECT_TRUE(opened->get(VehicleId{4000}, VehicleId{3}).up) << "who is not in the table passes";
  }
  const auto gone = LinkTable::open(name);
  ASSERT_FALSE(gone);
  EXPECT_NE(gone.error().message.find(name), std::string::npos);
}

TEST(LinkTable, KeepsALinkToTheLastBit) {
  auto table = LinkTable::create();
  ASSERT_TRUE(table) << table.error().message;
  table->set({true, 0.1, from_seconds(0.06), from_seconds(0.03),
              Disorder{0.3, 0.2, from_seconds(2.0)}, 20'000.0});
  const Link back = table->get(VehicleId{1}, VehicleId{2});
  EXPECT_EQ(back.loss, 0.1);
  ASSERT_TRUE(back.disorder.has_value());
  EXPECT_EQ(back.disorder->duplicates, 0.3);
  EXPECT_EQ(back.disorder->held_back, 0.2);
  EXPECT_EQ(back.disorder->held_back_max, from_seconds(2.0));
  EXPECT_EQ(back.bytes_per_s, 20'000.0);
  table->set({});
  EXPECT_FALSE(table->get(VehicleId{1}, VehicleId{2}).disorder.has_value());
  EXPECT_FALSE(table->get(VehicleId{1}, VehicleId{2}).bytes_per_s.has_value());
}

constexpr RadioParams kParams{1500.0, 5000.0, std::chrono::milliseconds{60},
                              std::chrono::milliseconds{30}, 0.1};

Node node(std::uint16_t id) {
  switch (id) {
    case 1:
      return {VehicleId{1}, Vec2{0, 0}};
    case 2:
      return {VehicleId{2}, Vec2{1499, 0}};
    case 3:
      return {VehicleId{3}, Vec2{3000, 0}};
    default:
      return {VehicleId{id}, std::nullopt};
  }
}

Link between(const Node& a, const Node& b, const Interference& interference = {}) {
  return over_hops(link_when_up(kParams, interference), is_up(kParams, interference, a, b) ? 1 : 0);
}
Link between(std::uint16_t a, std::uint16_t b, const Interference& interference = {}) {
  return between(node(a), node(b), interference);
}

Interference cut(Cut cut) {
  Interference interference;
  interference.cuts.push_back(std::move(cut));
  return interference;
}

TEST(RadioModel, RangeAndPartitionsDecide) {
  const auto up = [](std::uint16_t a, std::uint16_t b,
                     const std::vector<std::vector<VehicleId>>& groups = {}) {
    return between(a, b, cut({Cut::Kind::both_ways, groups, {}})).up;
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
  EXPECT_DOUBLE_EQ(between(1, 2).loss, 0.1);
}

TEST(RadioModel, TheGroundStationHasARangeToo) {
  EXPECT_FALSE(between(node(0), {VehicleId{4}, Vec2{0, 5001}}).up);
  EXPECT_FALSE(between({VehicleId{4}, Vec2{0, 5001}}, node(0)).up);
}

TEST(Positions, WhoIsNearIsFoundInOrder) {
  Positions positions{4};
  positions.set(0, {0, 0});
  positions.set(1, {1500, 0});
  positions.set(2, {1500.1, 0});
  positions.set(3, {-900, 1200});
  std::vector<std::uint32_t> near;
  positions.find_near(0, 1500.0, near);
  EXPECT_EQ(near, (std::vector<std::uint32_t>{0, 1, 3})) << "the range itself is near";
  positions.set(0, {3000, 0});
  positions.find_near(0, 1500.0, near);
  EXPECT_EQ(near, (std::vector<std::uint32_t>{0, 1, 2}));
  positions.find_near(0, std::numeric_limits<double>::infinity(), near);
  EXPECT_EQ(near.size(), 4U);
}

TEST(RadioModel, OneWayIsHeardInOneDirectionOnly) {
  const auto deaf = cut(cut_off({VehicleId{1}}, Cut::Kind::one_way));
  EXPECT_FALSE(between(1, 2, deaf).up);
  EXPECT_TRUE(between(2, 1, deaf).up);
}

TEST(RadioModel, ABridgeHearsAndIsHeardByBothHalves) {
  Cut halves = cut_off({VehicleId{1}}, Cut::Kind::bridge);
  EXPECT_FALSE(between(1, 2, cut(halves)).up);
  halves.bridge = VehicleId{2};
  EXPECT_TRUE(between(1, 2, cut(halves)).up);
  EXPECT_TRUE(between(2, 1, cut(halves)).up);
  EXPECT_FALSE(between(1, 0, cut(halves)).up);
}

TEST(RadioModel, WhoIsSilentHearsNobodyAndIsNotHeard) {
  const auto both = cut(silence({VehicleId{1}, VehicleId{2}}));
  EXPECT_FALSE(between(1, 2, both).up);
  EXPECT_FALSE(between(0, 2, both).up);
  const auto unheard = cut(silence({VehicleId{1}, VehicleId{2}}, Cut::Kind::one_way));
  EXPECT_FALSE(between(1, 2, unheard).up);
  EXPECT_FALSE(between(2, 0, unheard).up);
  EXPECT_TRUE(between(0, 2, unheard).up);
}

TEST(RadioModel, WhatIsDisturbedIsWorseAndWhatIsHealedIsPerfect) {
  Interference worse;
  worse.disturbance = {0.5, from_seconds(0.1), from_seconds(0.2), Disorder{}};
  const Link link = between(1, 2, worse);
  EXPECT_EQ(link.loss, 0.5);
  EXPECT_EQ(link.delay, kParams.delay + from_seconds(0.1));
  EXPECT_EQ(link.jitter, kParams.jitter + from_seconds(0.2));
  EXPECT_TRUE(link.disorder.has_value());
  worse.disturbance.loss = 0.05;
  EXPECT_EQ(between(1, 2, worse).loss, 0.1) << "a disturbance makes nothing better";
  Interference healed;
  healed.healed = true;
  EXPECT_TRUE(between(1, 3, healed).up);
  EXPECT_EQ(between(1, 3, healed).loss, 0.0);
}

TEST(RadioModel, MessagesAreLostDoubledAndHeldBackInTheGivenShares) {
  Random random{1};
  const Link link{true, 0.25, from_seconds(0.06), from_seconds(0.03),
                  Disorder{0.5, 0.1, from_seconds(2.0)}};
  int lost = 0;
  int doubled = 0;
  int late = 0;
  for (int i = 0; i < 10'000; ++i) {
    const auto arrivals = carry(link, random);
    if (arrivals.empty()) ++lost;
    if (arrivals.size() == 2) ++doubled;
    for (const Duration delay : arrivals) {
      EXPECT_GE(delay, from_seconds(0.03));
      EXPECT_LE(delay, from_seconds(2.09));
      if (delay > from_seconds(0.09)) ++late;
    }
  }
  EXPECT_NEAR(lost, 2500, 150);
  EXPECT_NEAR(doubled, 3750, 150);
  EXPECT_NEAR(late, 750, 100);
  EXPECT_TRUE(carry({false}, random).empty());
}

TEST(RadioModel, WhatIsHeardSharesTheChannel) {
  Random random{1};
  Link link{true, 0.0, from_seconds(0.06), Duration{}};
  link.bytes_per_s = 1000.0;
  Channel channel;
  const Instant start = at_seconds(5.0);
  std::uint16_t from = 0;
  const auto takes = [&](const Link& way, std::size_t bytes, Instant now) {
    return channel.carry(way, VehicleId{++from}, bytes, now, random);
  };
  EXPECT_EQ(takes(link, 100, start)[0], from_seconds(0.16));
  EXPECT_EQ(takes(link, 200, start)[0], from_seconds(0.36)) << "one after the other";
  EXPECT_EQ(takes(over_hops(link, 2), 100, start)[0], from_seconds(0.62)) << "each hop takes it";
  EXPECT_TRUE(takes(link, 600, start).empty()) << "it would wait for more than a second";
  EXPECT_EQ(takes(link, 100, at_seconds(6.0))[0], from_seconds(0.16));
}

TEST(RadioModel, WhoFloodsHasHalfOfTheChannelAtMost) {
  Random random{1};
  Link link{true, 0.0, Duration{}, Duration{}};
  link.bytes_per_s = 10'000.0;
  Channel channel;
  std::size_t noise = 0;
  int heard = 0;
  constexpr int kSeconds = 20;
  for (int i = 0; i < kSeconds * 100; ++i) {
    const Instant now = at_seconds(i / 100.0);
    for (int k = 0; k < 5; ++k) {
      noise += channel.carry(link, VehicleId{1}, 1000, now, random).size() * 1000;
    }
    if (i % 10 != 0) continue;
    const auto arrivals = channel.carry(link, VehicleId{2}, 100, now, random);
    heard += static_cast<int>(arrivals.size());
    for (const Duration wait : arrivals) EXPECT_LT(wait, from_seconds(0.5));
  }
  EXPECT_EQ(heard, kSeconds * 10) << "nothing of the other is lost";
  EXPECT_NEAR(static_cast<double>(noise) / kSeconds, 5'000.0, 500.0);
}

}  // namespace
}  // namespace skein::hil::radio
