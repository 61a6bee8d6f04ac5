// SPDX-License-Identifier: Apache-2.0
#include "skein/version/version.hpp"

#include <gtest/gtest.h>

#include <regex>

namespace skein {
namespace {

TEST(Version, IsTheReleaseAndTheCommit) {
  EXPECT_EQ(version().rfind(SKEIN_VERSION, 0), 0U) << version();
  EXPECT_TRUE(
      std::regex_match(version(), std::regex{R"(\d+\.\d+\.\d+(\+g[0-9a-f]{12}(\.dirty)?)?)"}))
      << version();
}

}  // namespace
}  // namespace skein
