// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/radio/link_feed.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <thread>

namespace skein::hil::radio {
namespace {

using std::chrono::milliseconds;
constexpr VehicleId kSelf{203};

Hearing hearing() {
  Hearing h{kSelf, {true, 0.25, milliseconds{60}, milliseconds{30}}, {}};
  h.hop.disorder = {0.1, 0.2, milliseconds{500}};
  h.hop.bytes_per_s = 20'000.0;
  h.hops[0] = 1;
  h.hops[7] = 1;
  h.hops[254] = 2;
  h.hops[1023] = 8;
  return h;
}

bool eventually(const std::function<bool()>& holds) {
  for (int i = 0; i < 3000; ++i) {
    if (holds()) return true;
    std::this_thread::sleep_for(milliseconds{5});
  }
  return false;
}

TEST(LinkFeed, IsReadAsItIsWritten) {
  const auto bytes = encode(hearing());
  EXPECT_LT(bytes.size(), 1200U) << "one packet";
  const auto read = decode(bytes);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->self, kSelf);
  EXPECT_EQ(read->hops, hearing().hops);
  EXPECT_EQ(read->hop.loss, 0.25);
  EXPECT_EQ(read->hop.delay, milliseconds{60});
  EXPECT_EQ(read->hop.jitter, milliseconds{30});
  EXPECT_EQ(read->hop.bytes_per_s, 20'000.0);
  ASSERT_TRUE(read->hop.disorder);
  EXPECT_EQ(read->hop.disorder->held_back, 0.2);
  EXPECT_EQ(read->hop.disorder->held_back_max, milliseconds{500});
}

TEST(LinkFeed, OtherBytesAreNone) {
  const auto good = encode(hearing());
  auto bytes = good;
  bytes.pop_back();
  EXPECT_FALSE(decode(bytes));
  bytes = good;
  bytes[3] = 1;
  EXPECT_FALSE(decode(bytes)) << "another version";
  EXPECT_FALSE(decode({}));
}

TEST(LinkFeed, WhatNoRadioCanBeIsNone) {
  const auto with = [](const std::function<void(Hearing&)>& spoil) {
    Hearing h = hearing();
    spoil(h);
    return decode(encode(h)).has_value();
  };
  EXPECT_TRUE(with([](Hearing&) {}));
  EXPECT_FALSE(with([](Hearing& h) { h.hop.loss = 1.5; }));
  EXPECT_FALSE(with([](Hearing& h) { h.hop.loss = std::nan(""); }));
  EXPECT_FALSE(with([](Hearing& h) { h.hop.delay = std::chrono::hours{1}; }));
  EXPECT_FALSE(with([](Hearing& h) { h.hop.bytes_per_s = -1.0; }));
  EXPECT_FALSE(with([](Hearing& h) { h.hop.jitter = Duration{-1}; }));
  EXPECT_FALSE(with([](Hearing& h) { h.hop.disorder->held_back_max = Duration::max(); }));
}

TEST(LinkFeed, AReceiverHearsWhomItIsToldAndEverybodyBefore) {
  const auto receiver = FeedReceiver::open(kSelf);
  ASSERT_TRUE(receiver) << receiver.error().message;
  const LinkTable& table = (*receiver)->table();
  EXPECT_TRUE(table.get(VehicleId{1}, kSelf).up);
  EXPECT_FALSE(FeedReceiver::open(kSelf)) << "its port is taken";
  const auto sender = FeedSender::open();
  ASSERT_TRUE(sender);
  Hearing others = hearing();
  others.self = VehicleId{204};  // nobody's: it must not end the test by an error
  sender->send(others, "127.0.0.1");
  EXPECT_TRUE(eventually([&] {
    sender->send(hearing(), "127.0.0.1");
    return !table.get(VehicleId{1}, kSelf).up;
  }));
  EXPECT_TRUE(table.get(VehicleId{7}, kSelf).up);
  EXPECT_TRUE(table.get(VehicleId{254}, kSelf).up);
  EXPECT_EQ(table.get(VehicleId{7}, kSelf).delay, milliseconds{60});
  EXPECT_EQ(table.get(VehicleId{254}, kSelf).delay, milliseconds{120}) << "over two hops";
  // Without a bench nobody is parted.
  EXPECT_TRUE(eventually([&] { return table.get(VehicleId{1}, kSelf).up; }));
  EXPECT_EQ(table.get(VehicleId{7}, kSelf).delay, Duration{});
}

}  // namespace
}  // namespace skein::hil::radio
