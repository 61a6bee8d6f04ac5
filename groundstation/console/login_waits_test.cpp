// SPDX-License-Identifier: Apache-2.0
#include "login_waits.hpp"

#include <gtest/gtest.h>

#include <string>

namespace skein::console {
namespace {

using std::chrono::seconds;

TEST(LoginWaits, GrowForWhoGuessesAndForNobodyElse) {
  LoginWaits waits;
  auto now = LoginWaits::Time{} + std::chrono::hours{1};
  int tried = 0;
  const auto end = now + std::chrono::hours{1};
  while (now < end) {
    if (!waits.wait("10.0.0.66", now)) {
      EXPECT_EQ(waits.wrong("10.0.0.66", now), ++tried);
    } else {
      now += seconds{1};
    }
    EXPECT_FALSE(waits.wait("10.0.0.1", now));
  }
  EXPECT_GT(tried, 50);
  EXPECT_LT(tried, 75) << "one a minute, once it has been at it for two";
}

TEST(LoginWaits, EndWithTheRightOneAndWithTime) {
  LoginWaits waits;
  const auto now = LoginWaits::Time{} + std::chrono::hours{1};
  for (int i = 0; i < 6; ++i) waits.wrong("10.0.0.1", now);
  EXPECT_EQ(waits.wait("10.0.0.1", now), seconds{4});
  EXPECT_EQ(waits.wait("10.0.0.1", now + seconds{3}), seconds{1});
  EXPECT_FALSE(waits.wait("10.0.0.1", now + seconds{4}));
  waits.right("10.0.0.1");
  EXPECT_FALSE(waits.wait("10.0.0.1", now));
  EXPECT_EQ(waits.wrong("10.0.0.1", now), 1);
  EXPECT_EQ(waits.wrong("10.0.0.1", now + LoginWaits::kForgotten), 1);
}

TEST(LoginWaits, ForgetTheOldestAddressWhereThereAreTooMany) {
  LoginWaits waits;
  const auto now = LoginWaits::Time{} + std::chrono::hours{1};
  for (int i = 0; i < 5; ++i) waits.wrong("old", now);
  for (std::size_t i = 0; i < LoginWaits::kAddressesMax; ++i) {
    waits.wrong("10." + std::to_string(i), now + seconds{1});
  }
  EXPECT_FALSE(waits.wait("old", now + seconds{1}));
}

}  // namespace
}  // namespace skein::console
