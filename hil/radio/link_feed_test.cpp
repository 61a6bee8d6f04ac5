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
  h.link.disorder = {0.1, 0.2, milliseconds{500}};
  h.hears.set(0);
  h.hears.set(7);
  h.hears.set(254);
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
  EXPECT_EQ(read->hears, hearing().hears);
  EXPECT_EQ(read->link.loss, 0.25);
  EXPECT_EQ(read->link.delay, milliseconds{60});
  EXPECT_EQ(read->link.jitter, milliseconds{30});
  ASSERT_TRUE(read->link.disorder);
  EXPECT_EQ(read->link.disorder->held_back, 0.2);
  EXPECT_EQ(read->link.disorder->held_back_max, milliseconds{500});
}

TEST(LinkFeed, OtherBytesAreNone) {
  const auto good = encode(hearing());
  auto bytes = good;
  bytes.pop_back();
  EXPECT_FALSE(decode(bytes));
  bytes = good;
  bytes[3] = 2;
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
  EXPECT_FALSE(with([](Hearing& h) { h.link.loss = 1.5; }));
  EXPECT_FALSE(with([](Hearing& h) { h.link.loss = std::nan(""); }));
  EXPECT_FALSE(with([](Hearing& h) { h.link.delay = std::chrono::hours{1}; }));
  EXPECT_FALSE(with([](Hearing& h) { h.link.jitter = Duration{-1}; }));
  EXPECT_FALSE(with([](Hearing& h) { h.link.disorder->held_back_max = Duration::max(); }));
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
  // Without a bench nobody is parted.
  EXPECT_TRUE(eventually([&] { return table.get(VehicleId{1}, kSelf).up; }));
  EXPECT_EQ(table.get(VehicleId{7}, kSelf).delay, Duration{});
}

}  // namespace
}  // namespace skein::hil::radio
