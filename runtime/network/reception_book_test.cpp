// SPDX-License-Identifier: Apache-2.0
#include "reception_book.hpp"

#include <gtest/gtest.h>

namespace skein::network {
namespace {

constexpr VehicleId kThree{3};
constexpr ReceptionBook::Stream kStream{kThree, InstanceId{7}, 0};

Reception of_three(const ReceptionBook& book, double now_s) {
  for (const Reception& one : book.all(at_seconds(now_s))) {
    if (one.sender == kThree) return one;
  }
  return {};
}

TEST(ReceptionBook, CountsWhatCameAndWhatDidNot) {
  ReceptionBook book;
  // Nobody knows how many were before the first.
  for (std::uint64_t n = 100; n < 200; ++n) {
    if (n % 4 != 1)
      book.came(kStream, n, 50, at_seconds(20.0 + 0.05 * static_cast<double>(n - 100)));
  }
  const Reception heard = of_three(book, 25.0);
  EXPECT_EQ(heard.datagrams, 75);
  EXPECT_EQ(heard.bytes, 3750U);
  EXPECT_EQ(heard.lost_percent, 25);
}

TEST(ReceptionBook, WhatComesLateOrTwiceIsNotLostAndCountsOnce) {
  ReceptionBook book;
  for (const std::uint64_t n : {1U, 2U, 5U, 4U, 3U, 3U, 5U, 6U}) {
    book.came(kStream, n, 10, at_seconds(1.0));
  }
  EXPECT_EQ(of_three(book, 1.5).datagrams, 6);
  EXPECT_EQ(of_three(book, 1.5).lost_percent, 0);
}

TEST(ReceptionBook, WhoIsReachedThroughOthersAloneIsLostToTheLastDatagram) {
  ReceptionBook book;
  for (std::uint64_t n = 1; n <= 20; ++n) book.was_sent(kStream, n, at_seconds(3.0));
  EXPECT_EQ(of_three(book, 3.0).datagrams, 0);
  EXPECT_EQ(of_three(book, 3.0).lost_percent, 100);
  // Then it is heard itself, after others have passed the same on.
  for (std::uint64_t n = 11; n <= 20; ++n) book.came(kStream, n, 10, at_seconds(4.0));
  EXPECT_EQ(of_three(book, 4.0).datagrams, 10);
  EXPECT_EQ(of_three(book, 4.0).lost_percent, 50);
}

TEST(ReceptionBook, TheWindowSlides) {
  ReceptionBook book;
  book.came(kStream, 1, 10, at_seconds(0.5));
  book.came(kStream, 11, 10, at_seconds(0.9));  // nine are lost
  for (std::uint64_t n = 12; n < 22; ++n) book.came(kStream, n, 10, at_seconds(6.5));
  EXPECT_EQ(of_three(book, 9.9).lost_percent, 43);
  EXPECT_EQ(of_three(book, 10.5).lost_percent, 0);
  EXPECT_EQ(of_three(book, 10.5).datagrams, 10);
  EXPECT_TRUE(book.all(at_seconds(16.5)).empty());
}

TEST(ReceptionBook, ANewStartLosesNothing) {
  ReceptionBook book;
  book.came(kStream, 500, 10, at_seconds(1.0));
  book.came({kThree, InstanceId{8}, 0}, 0, 10, at_seconds(2.0));
  book.came({kThree, InstanceId{8}, 0}, 1, 10, at_seconds(2.0));
  book.came({kThree, InstanceId{8}, 4}, 90, 10, at_seconds(2.0));
  EXPECT_EQ(of_three(book, 2.0).lost_percent, 0);
  book.came(kStream, 500 + ReceptionBook::kLeapMax + 1, 10, at_seconds(2.0));
  EXPECT_EQ(of_three(book, 2.0).lost_percent, 0);
  EXPECT_EQ(of_three(book, 2.0).datagrams, 5);
}

TEST(ReceptionBook, WhoForgesSendersTakesNoMoreThanTheirRoom) {
  ReceptionBook book;
  for (unsigned id = 1; id < 60'000; ++id) {
    book.came({VehicleId{static_cast<std::uint16_t>(id)}, InstanceId{id}, 0}, 1, 10,
              at_seconds(1.0));
  }
  EXPECT_EQ(book.all(at_seconds(1.0)).size(), ReceptionBook::kSendersMax);
  book.came({VehicleId{60'001}, InstanceId{1}, 0}, 1, 10, at_seconds(12.0));
  EXPECT_EQ(book.all(at_seconds(12.0)).size(), 1U);
}

}  // namespace
}  // namespace skein::network
