// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/order_book.hpp"

#include <gtest/gtest.h>

namespace skein::mission {
namespace {

constexpr VehicleId kSix{6};
constexpr VehicleId kSeven{7};

Command command(VehicleId vehicle, std::uint32_t number, CommandKind kind) {
  Command command;
  command.vehicle = vehicle;
  command.number = number;
  command.kind = kind;
  return command;
}

TEST(OrderBook, OfNoOrderItSaysThatNoneStands) {
  const OrderBook book;
  const Command none = book.standing(kSeven, kSix);
  EXPECT_EQ(none.vehicle, kSeven);
  EXPECT_EQ(none.told_by, kSix);
  EXPECT_EQ(none.number, 0U);
  EXPECT_EQ(none.kind, CommandKind::resume);
}

TEST(OrderBook, TheNewestStandsWhoeverItWasFor) {
  OrderBook book;
  book.note(command(kSeven, 5, CommandKind::return_home));
  book.note(command(kGroundStation, 4, CommandKind::hold));  // comes late
  EXPECT_EQ(book.standing(kSeven, kSix).kind, CommandKind::return_home);
  EXPECT_EQ(book.standing(VehicleId{8}, kSix).kind, CommandKind::hold);
  book.note(command(kGroundStation, 6, CommandKind::resume));
  EXPECT_EQ(book.standing(kSeven, kSix).kind, CommandKind::resume);
  EXPECT_EQ(book.standing(kSeven, kSix).number, 6U);
}

TEST(OrderBook, ToGiveAnAircraftBackStandsForNothing) {
  OrderBook book;
  book.note(command(kSeven, 5, CommandKind::hold));
  book.note(command(kSeven, 6, CommandKind::give_back));
  EXPECT_EQ(book.standing(kSeven, kSix).kind, CommandKind::hold);
}

}  // namespace
}  // namespace skein::mission
