// SPDX-License-Identifier: Apache-2.0
#include "skein/schemas/cdr_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace skein::schemas {
namespace {

using ::testing::EndsWith;

constexpr const char* kSchema =
    "uint16 version\n"
    "uint32 LOW=0\n"
    "uint32 HIGH=1\n"
    "uint32 kind\n"
    "Point[<=4] points\n"
    "string<=20 text\n"
    "int8[2] pair\n"
    "float64 value\n"
    "===\n"
    "MSG: skein/Point\n"
    "bool set\n"
    "int32 x\n";

const std::vector<std::uint8_t> kBytes{0,    1, 0, 0,                          // header
                                       7,    0, 0, 0, 1,    0,    0,    0,     // version, kind
                                       2,    0, 0, 0,                          // points
                                       1,    0, 0, 0, 5,    0,    0,    0,     //
                                       0,    0, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF,  //
                                       4,    0, 0, 0, 'n',  '"',  'o',  0,     // text
                                       0xFE, 3, 0, 0,  // pair, and up to the next multiple of 8
                                       0,    0, 0, 0, 0,    0,    0xE0, 0x3F};

TEST(CdrText, SaysAllThatIsThere) {
  EXPECT_EQ(text_of(kSchema, kBytes),
            "{version: 7, kind: HIGH, points: [{set: true, x: 5}, {set: false, x: -1}], "
            "text: \"n\\\"o\", pair: [-2, 3], value: 0.5}");
}

TEST(CdrText, EndsWhereTheBytesDo) {
  for (std::size_t size = 0; size < kBytes.size(); ++size) {
    EXPECT_THAT(text_of(kSchema, std::span{kBytes}.first(size)), EndsWith("..."));
  }
}

}  // namespace
}  // namespace skein::schemas
