// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/setup_filter.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "skein/base/random.hpp"

namespace skein::mission {
namespace {

constexpr VehicleId kSelf{3};
constexpr VehicleId kSeven{7};
constexpr InstanceId kFirst{70};

Instant at(double seconds) { return Instant{} + from_seconds(seconds); }

SetupParams params(const std::string& latitude = "48.1") {
  return {.common = {{"origin.latitude_deg", setup_hash(latitude)}}};
}

Setup setup(VehicleId node = kSeven, Instant sent = at(1)) {
  Setup said;
  said.node = node;
  said.instance = kFirst;
  said.time = sent;
  said.clock_guard = params().clock_guard;
  said.knows_orders = true;
  said.items = items_of(params());
  return said;
}

TEST(SetupFilter, WhatAgreesIsPassedBy) {
  SetupFilter filter{params(), kSelf};
  EXPECT_FALSE(filter.heeds(Message{setup()}, at(1.1)));
  EXPECT_FALSE(filter.heeds(Message{setup(kSeven, at(6))}, at(6.1)));
}

TEST(SetupFilter, TheGroundStationAndTheOwnNumberAreAlwaysHeeded) {
  SetupFilter filter{params(), kSelf};
  EXPECT_TRUE(filter.heeds(Message{setup(kGroundStation)}, at(1.1)));
  EXPECT_TRUE(filter.heeds(Message{setup(kSelf)}, at(1.1)));
}

TEST(SetupFilter, WhatIsUnusualIsHeeded) {
  mission::Setup other_origin = setup();
  other_origin.items = items_of(params("48.2"));
  mission::Setup asks = setup();
  asks.knows_orders = false;
  mission::Setup finds_this_one_ahead = setup();
  finds_this_one_ahead.ahead = {kSelf};
  const mission::Setup ahead = setup(kSeven, at(2));
  for (const mission::Setup& said : {other_origin, asks, finds_this_one_ahead, ahead}) {
    SetupFilter filter{params(), kSelf};
    EXPECT_TRUE(filter.heeds(Message{said}, at(1.1)));
    for (int i = 0; i < 100; ++i) {
      EXPECT_TRUE(filter.heeds(Message{setup()}, at(1.2))) << "it may agree again";
    }
    EXPECT_TRUE(filter.heeds(Message{setup()}, at(600))) << "however many are forged meanwhile";
  }
}

TEST(SetupFilter, OneAMinuteIsProvenAtOtherTimesByOthers) {
  std::set<double> first;
  for (std::uint16_t self = 10; self < 20; ++self) {
    SetupFilter filter{params(), VehicleId{self}};
    std::vector<double> proven;
    for (double t = 1.0; t < 300.0; t += 5.0) {
      if (filter.heeds(Message{setup(kSeven, at(t))}, at(t))) proven.push_back(t);
    }
    ASSERT_GE(proven.size(), 4U);
    ASSERT_LE(proven.size(), 5U);
    first.insert(proven.front());
  }
  EXPECT_GT(first.size(), 4U);
}

TEST(SetupFilter, ANewStartIsHeededAndTheFirstIsNot) {
  SetupFilter filter{params(), kSelf};
  EXPECT_FALSE(filter.heeds(Message{setup()}, at(1.1)));
  mission::Setup anew = setup();
  anew.instance = InstanceId{71};
  EXPECT_TRUE(filter.heeds(Message{anew}, at(1.1)));
  EXPECT_TRUE(filter.heeds(Message{setup()}, at(1.1))) << "there are two";
}

TEST(SetupFilter, ABookBehindItComesToTheSame) {
  Random random{1};
  for (int run = 0; run < 200; ++run) {
    SetupFilter filter{params(), kSelf};
    SetupBook all{params(), kSelf, InstanceId{1}, at(0)};
    SetupBook some{params(), kSelf, InstanceId{1}, at(0)};
    Telemetry telemetry;
    telemetry.vehicle = kSeven;
    bool differs = false;
    double ahead = 0;
    double now = 0;
    const auto say = [&] {
      now += 1.0;
      telemetry.state.time = at(now + ahead);
      (void)filter.heeds(Message{telemetry}, at(now));
      all.on_time(kSeven, telemetry.state.time, at(now));
      some.on_time(kSeven, telemetry.state.time, at(now));
      mission::Setup said = setup(kSeven, at(now + ahead));
      if (differs) said.items = items_of(params("48.2"));
      all.on_setup(said, at(now));
      if (filter.heeds(Message{said}, at(now))) some.on_setup(said, at(now));
      ASSERT_EQ(all.difference(kSeven) == nullptr, some.difference(kSeven) == nullptr)
          << "run " << run << ", at " << now;
      if (all.difference(kSeven) == nullptr) return;
      EXPECT_EQ(all.difference(kSeven)->keys, some.difference(kSeven)->keys);
    };
    for (int i = 0; i < 60; ++i) {
      if (random.uniform() < 0.1) differs = !differs;
      if (random.uniform() < 0.1) ahead = random.uniform() < 0.5 ? 0.0 : 2.0;
      say();
    }
  }
}

}  // namespace
}  // namespace skein::mission
