// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/host_watch.hpp"

#include <gtest/gtest.h>

namespace skein::mission {
namespace {

using Problems = std::vector<std::string>;

TEST(HostWatch, NamesAClockThatNobodySetsAndADiskThatRunsFull) {
  EXPECT_EQ(host_problems({}), Problems{});
  HostFacts facts;
  facts.disk_free_bytes = kDiskFreeMinBytes;
  facts.clock = HostFacts::Clock{true, kClockErrorMax};
  EXPECT_EQ(host_problems(facts), Problems{});
  facts.disk_free_bytes = kDiskFreeMinBytes - 1;
  EXPECT_EQ(host_problems(facts), Problems{"499 MB are left on the disk of its recording"});
  facts.disk_free_bytes.reset();
  facts.clock->error_max += std::chrono::microseconds{1};
  EXPECT_EQ(host_problems(facts), Problems{"its clock is not synchronised"});
  facts.clock = HostFacts::Clock{false, {}};
  EXPECT_EQ(host_problems(facts), Problems{"its clock is not synchronised"});
  facts = {};
  facts.network_restarts = 1;
  EXPECT_EQ(host_problems(facts), Problems{"its network was started again, so far 1 time"});
}

}  // namespace
}  // namespace skein::mission
