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
  EXPECT_TRUE(some.in_part);
  EXPECT_EQ(some.text, "told to 3,5-7\nnot to 4: vehicle 4 is not in the fleet\n");
  EXPECT_EQ(asked, (std::vector<int>{3, 4, 5, 6, 7}));

  const Answer all = tell_each({{{1}, {2}}, mission::CommandKind::land}, tell);
  EXPECT_TRUE(all.done);
  EXPECT_EQ(all.text, "told to 1,2\n");

  const Answer nobody = tell_each({{{4}}, mission::CommandKind::land}, tell);
  EXPECT_FALSE(nobody.done);
  EXPECT_FALSE(nobody.in_part);
  EXPECT_EQ(nobody.text.rfind("told to nobody\nnot to 4: ", 0), 0U);
}

TEST(Several, AnOrderToAllSaysWhoIsNotToldAndWhoMayNotHearIt) {
  mission::Fleet fleet{{.expected = {{1}, {2}, {3}, {4}}}};
  mission::Telemetry telemetry;
  for (const VehicleId one : {VehicleId{1}, VehicleId{2}}) {
    telemetry.vehicle = one;
    fleet.on_message(mission::Message{telemetry}, at_seconds(1.0));
  }
  const auto why_not = [](VehicleId one) {
    return one.value == 2 ? std::optional<std::string>{"it flies in a formation"} : std::nullopt;
  };
  const Answer told = told_all({}, fleet, why_not);
  EXPECT_TRUE(told.done);
  EXPECT_EQ(told.text,
            "told to all others\nnot to 2: it flies in a formation\n"
            "not heard now, and may not hear it: 3,4\n");
  EXPECT_FALSE(told_all(Error{"nobody is at home"}, fleet, why_not).done);
}

}  // namespace
}  // namespace skein::groundstation
