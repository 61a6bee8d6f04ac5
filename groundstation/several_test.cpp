// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/several.hpp"

#include <gtest/gtest.h>

namespace skein::groundstation {
namespace {

TEST(Several, AreToldEachByItselfAndTheAnswerSaysWho) {
  std::vector<int> asked;
  const auto tell = [&asked](VehicleId vehicle) -> Result<void> {
    asked.push_back(vehicle.value);
    if (vehicle.value == 4) return Error{"vehicle 4 is not in the fleet"};
    return {};
  };
  const OrderToSeveral order{{{3}, {4}, {5}, {6}, {7}}, mission::CommandKind::hold};
  const Answer some = tell_each(order, tell);
  EXPECT_FALSE(some.done);
  EXPECT_EQ(some.text, "told to 3,5-7\nnot to 4: vehicle 4 is not in the fleet\n");
  EXPECT_EQ(asked, (std::vector<int>{3, 4, 5, 6, 7}));

  const Answer all = tell_each({{{1}, {2}}, mission::CommandKind::land}, tell);
  EXPECT_TRUE(all.done);
  EXPECT_EQ(all.text, "told to 1,2\n");

  const Answer nobody = tell_each({{{4}}, mission::CommandKind::land}, tell);
  EXPECT_FALSE(nobody.done);
  EXPECT_EQ(nobody.text.rfind("told to nobody\nnot to 4: ", 0), 0U);
}

}  // namespace
}  // namespace skein::groundstation
