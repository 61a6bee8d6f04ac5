// SPDX-License-Identifier: Apache-2.0
#include "connections.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>
#include <vector>

namespace skein::console {
namespace {

using Places = std::vector<std::shared_ptr<Connections::Place>>;

TEST(Connections, OneAddressThatOnlyConnectsLeavesRoomForOthers) {
  Connections connections;
  std::set<int> dropped;
  Places idle;
  for (int i = 0; i < 200; ++i) {
    idle.push_back(connections.enter("10.0.0.66", [&dropped, i] { dropped.insert(i); }));
    ASSERT_TRUE(idle.back());
  }
  EXPECT_EQ(connections.size(), Connections::kStrangersOfOneAddress);
  EXPECT_EQ(dropped.size(), 200 - Connections::kStrangersOfOneAddress);
  EXPECT_EQ(*dropped.rbegin(), 183) << "the oldest give way";
  EXPECT_TRUE(connections.enter("10.0.0.1", [] { FAIL(); }));
}

TEST(Connections, ManyAddressesThatOnlyConnectKeepNobodyOut) {
  Connections connections;
  bool operator_dropped = false;
  const auto op = connections.enter("10.0.0.1", [&operator_dropped] { operator_dropped = true; });
  op->has_session();
  Places idle;
  for (int i = 0; i < 200; ++i) {
    idle.push_back(connections.enter("10.0.1." + std::to_string(i), [] {}));
  }
  EXPECT_EQ(connections.size(), Connections::kMax);
  EXPECT_FALSE(operator_dropped);
  EXPECT_TRUE(connections.enter("10.0.0.2", [] {}));
}

TEST(Connections, WhoHasASessionGivesWayToNobody) {
  Connections connections;
  Places all;
  for (std::size_t i = 0; i < Connections::kMax; ++i) {
    all.push_back(connections.enter("10.0.0.1", [] { FAIL(); }));
    all.back()->has_session();
  }
  EXPECT_FALSE(connections.enter("10.0.0.2", [] {}));
  all.pop_back();
  EXPECT_TRUE(connections.enter("10.0.0.2", [] {}));
}

}  // namespace
}  // namespace skein::console
