// SPDX-License-Identifier: Apache-2.0
#include "skein/ros2/console_client.hpp"

#include <gtest/gtest.h>

namespace skein::ros2 {
namespace {

TEST(Console, IsAnAddressByHttp) {
  const auto console = parse_console("http://10.0.0.7:8080/");
  ASSERT_TRUE(console);
  EXPECT_EQ(console->host, "10.0.0.7");
  EXPECT_EQ(console->port, 8080);
  EXPECT_EQ(parse_console("http://127.0.0.1")->port, 7460);
  for (const char* wrong : {"", "127.0.0.1:7460", "https://127.0.0.1", "http://", "http://here:1",
                            "http://127.0.0.1:", "http://127.0.0.1:0", "http://127.0.0.1:70000",
                            "http://127.0.0.1:1x"}) {
    EXPECT_FALSE(parse_console(wrong)) << wrong;
  }
}

TEST(Console, APlaceMayHaveNoPort) {
  EXPECT_EQ(parse_place("127.0.0.1")->port, 0);
  EXPECT_EQ(parse_place("127.0.0.1:6969")->port, 6969);
  EXPECT_FALSE(parse_place("1.2.3"));
}

}  // namespace
}  // namespace skein::ros2
