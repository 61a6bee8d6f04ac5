// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/line_reader.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <semaphore>
#include <string>
#include <string_view>

#include "skein/groundstation/prompt.hpp"

namespace skein::groundstation {
namespace {

struct Pipe {
  Pipe() { EXPECT_EQ(pipe(ends.data()), 0); }
  ~Pipe() {
    close_input();
    close(ends[0]);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void type(std::string_view text) const {
    EXPECT_EQ(write(ends[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  void close_input() {
    if (ends[1] >= 0) close(ends[1]);
    ends[1] = -1;
  }
  std::array<int, 2> ends{};
};

TEST(LineReader, GivesWholeLines) {
  Pipe pipe;
  std::counting_semaphore<> told{0};
  LineReader reader{pipe.ends[0], [&] { told.release(); }};
  pipe.type("sta");
  EXPECT_FALSE(reader.next());
  pipe.type("tus\nhelp\n");
  told.acquire();
  EXPECT_EQ(reader.next(), "status");
  EXPECT_EQ(reader.next(), "help");
  EXPECT_FALSE(reader.next());
}

TEST(LineReader, OutlivesTheEndOfItsInputAndStops) {
  Pipe pipe;
  std::counting_semaphore<> told{0};
  LineReader reader{pipe.ends[0], [&] { told.release(); }};
  pipe.type("quit\n");
  told.acquire();
  pipe.close_input();
  EXPECT_EQ(reader.next(), "quit");
}

TEST(LineReader, WhatIsTooLongStaysTooLong) {
  Pipe pipe;
  std::counting_semaphore<> told{0};
  LineReader reader{pipe.ends[0], [&] { told.release(); }};
  pipe.type("hold 7 " + std::string(2 * kLineMax, ' ') + "\n");
  told.acquire();
  const auto line = reader.next();
  ASSERT_TRUE(line);
  EXPECT_EQ(line->size(), kLineMax + 1);
  EXPECT_FALSE(parse_input(*line));
}

TEST(LineReader, StopsWhileNobodyTypes) {
  const Pipe pipe;
  const LineReader reader{pipe.ends[0], [] {}};
}

}  // namespace
}  // namespace skein::groundstation
