// SPDX-License-Identifier: Apache-2.0
#include "skein/agencies/line_source.hpp"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <functional>
#include <string>
#include <thread>

#include "skein/agencies/outlet.hpp"

namespace skein::agencies {
namespace {

using boost::asio::ip::tcp;
using std::chrono::steady_clock;

bool until(const std::function<bool()>& holds) {
  const auto end = steady_clock::now() + std::chrono::seconds{20};
  while (!holds()) {
    if (steady_clock::now() > end) return false;
    std::this_thread::yield();
  }
  return true;
}

struct LineSourceTest : ::testing::Test {
  tcp::socket accepted(LineSource& from) {
    acceptor.non_blocking(true);
    tcp::socket socket{io};
    EXPECT_TRUE(until([&] {
      from.poll(now);
      boost::system::error_code error;
      acceptor.accept(socket, error);
      return !error;
    }));
    return socket;
  }
  static void send(tcp::socket& socket, const std::string& text) {
    boost::asio::write(socket, boost::asio::buffer(text));
  }
  std::optional<std::string> line(LineSource& from) const {
    std::optional<std::string> got;
    (void)until([&] {
      from.poll(now);
      got = from.next();
      return got.has_value();
    });
    return got;
  }

  boost::asio::io_context io;
  tcp::acceptor acceptor{io, {boost::asio::ip::make_address("127.0.0.1"), 0}};
  steady_clock::time_point now = steady_clock::now();
  LineSource source{"127.0.0.1", acceptor.local_endpoint().port(), 20};
};

TEST_F(LineSourceTest, GivesLinesHoweverTheyCome) {
  auto socket = accepted(source);
  send(socket, "first\nsec");
  EXPECT_EQ(line(source), "first");
  send(socket, "ond\n\nfourth\n");
  EXPECT_EQ(line(source), "second");
  EXPECT_EQ(line(source), "");
  EXPECT_EQ(line(source), "fourth");
  EXPECT_TRUE(source.connected());
}

TEST_F(LineSourceTest, LongLinesAreDroppedAndTheNextOneIsTaken) {
  auto socket = accepted(source);
  send(socket, std::string(100, 'x') + "\nshort\n" + std::string(30'000, 'y') + "\nlast\n");
  EXPECT_EQ(line(source), "short");
  EXPECT_EQ(line(source), "last");
  EXPECT_GE(source.dropped(), 2U);
}

TEST_F(LineSourceTest, AConnectionThatEndsIsMadeAgain) {
  {
    auto socket = accepted(source);
    send(socket, "whole\nhalf");
  }
  EXPECT_EQ(line(source), "whole");
  EXPECT_TRUE(until([&] {
    source.poll(now);
    return !source.connected();
  }));
  EXPECT_FALSE(source.next()) << "half of a line";
  EXPECT_TRUE(source.poll_news());
  now += kTcpRetry;
  auto again = accepted(source);
  send(again, "more\n");
  EXPECT_EQ(line(source), "more");
}

}  // namespace
}  // namespace skein::agencies
