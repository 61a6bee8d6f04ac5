// SPDX-License-Identifier: Apache-2.0
#include "in_flight.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

namespace skein::hil {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::Pair;

const auto kWhat = std::make_shared<const Content>(mission::Message{mission::Telemetry{}});

Parcel parcel(Duration at, std::size_t to, std::uint16_t from) {
  return {Instant{at}, 0, to, VehicleId{from}, 0, kWhat};
}

std::vector<int> senders(InFlight& air, Duration until) {
  std::vector<int> all;
  while (const auto due = air.pop_due(Instant{until})) all.push_back(due->from.value);
  return all;
}

TEST(InFlight, WhatIsDueComesInTheOrderOfTimeAndThenOfPosting) {
  InFlight air;
  EXPECT_THAT(senders(air, 0ms), ElementsAre());
  air.post(parcel(39ms, 0, 1));
  air.post(parcel(21ms, 1, 2));
  air.post(parcel(21ms, 0, 3));
  air.post(parcel(45ms, 0, 4));
  EXPECT_THAT(senders(air, 20ms), ElementsAre());
  EXPECT_THAT(senders(air, 40ms), ElementsAre(2, 3, 1));
  EXPECT_THAT(senders(air, 60ms), ElementsAre(4));
}

/// What comes, as node and time.
std::vector<std::pair<std::size_t, Duration>> coming(InFlight& air, Duration until) {
  std::vector<std::pair<std::size_t, Duration>> all;
  while (const auto due = air.pop_due(Instant{until})) {
    all.emplace_back(due->to, due->at.time_since_epoch());
  }
  return all;
}

TEST(InFlight, OfWhatWakesTheFirstOfAStepComesToEachNode) {
  InFlight air;
  EXPECT_THAT(coming(air, 0ms), ElementsAre());
  for (const auto at : {38ms, 22ms, 24ms, 41ms}) air.post_wake(Instant{at}, 0, VehicleId{1}, kWhat);
  air.post_wake(Instant{30ms}, 1, VehicleId{1}, kWhat);
  air.post(parcel(25ms, 0, 5));
  EXPECT_THAT(coming(air, 40ms), ElementsAre(Pair(0, 22ms), Pair(0, 25ms), Pair(1, 30ms)));
  air.post_wake(Instant{40ms}, 0, VehicleId{7}, kWhat);
  EXPECT_THAT(coming(air, 40ms), ElementsAre(Pair(0, 40ms))) << "of a step that has begun";
  EXPECT_THAT(coming(air, 60ms), ElementsAre(Pair(0, 41ms)));
  EXPECT_THAT(coming(air, 80ms), ElementsAre());
}

TEST(InFlight, WhoWasMovedIsWokenByTheNext) {
  InFlight air;
  EXPECT_THAT(senders(air, 0ms), ElementsAre());
  for (const auto at : {22ms, 24ms, 28ms, 30ms}) air.post_wake(Instant{at}, 0, VehicleId{1}, kWhat);
  air.post(parcel(25ms, 0, 2));
  std::vector<Duration> times;
  while (const auto due = air.pop_due(Instant{40ms})) {
    times.push_back(due->at.time_since_epoch());
    if (due->at == Instant{22ms} || due->from == VehicleId{2}) air.on_moved(*due);
  }
  EXPECT_THAT(times, ElementsAre(22ms, 24ms, 25ms, 28ms));
}

}  // namespace
}  // namespace skein::hil
