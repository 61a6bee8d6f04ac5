// SPDX-License-Identifier: Apache-2.0
#include "skein/agencies/outlet.hpp"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <functional>
#include <string>
#include <thread>

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

TEST(Outlet, SendsDatagrams) {
  auto inlet = Inlet::open("127.0.0.1", 0, "");
  ASSERT_TRUE(inlet.ok()) << inlet.error().message;
  auto outlet = open_udp("127.0.0.1", inlet->port(), "");
  ASSERT_TRUE(outlet.ok()) << outlet.error().message;
  (*outlet)->send("first");
  (*outlet)->send("a longer one");
  std::optional<std::string> got;
  ASSERT_TRUE(until([&] { return (got = inlet->poll(100)).has_value(); }));
  EXPECT_EQ(*got, "first");
  ASSERT_TRUE(until([&] { return (got = inlet->poll(4)).has_value(); }));
  EXPECT_EQ(got->size(), 5U) << "one more than it may have";
  EXPECT_FALSE(inlet->poll(100));
  (*outlet)->poll(steady_clock::now());
  EXPECT_EQ((*outlet)->lost(), 0U);
}

TEST(Outlet, IsDeafWhereNobodyListens) {
  std::uint16_t port = 0;
  {
    auto inlet = Inlet::open("127.0.0.1", 0, "");
    ASSERT_TRUE(inlet.ok());
    port = inlet->port();
  }
  auto outlet = open_udp("127.0.0.1", port, "");
  ASSERT_TRUE(outlet.ok());
  for (int i = 0; i < 10; ++i) (*outlet)->send("nobody");
  (*outlet)->poll(steady_clock::now());
  EXPECT_EQ((*outlet)->lost(), 0U) << "that is not known of datagrams";
  EXPECT_FALSE(open_udp("127.0.0.1", port, "not an address").ok() &&
               open_udp("239.2.3.1", port, "not an address").ok());
}

TEST(Outlet, SpeaksToAMulticastOfLoopback) {
  auto inlet = Inlet::open("127.0.0.1", 0, "239.255.83.7");
  ASSERT_TRUE(inlet.ok()) << inlet.error().message;
  auto outlet = open_udp("239.255.83.7", inlet->port(), "127.0.0.1");
  ASSERT_TRUE(outlet.ok()) << outlet.error().message;
  (*outlet)->send("to all");
  std::optional<std::string> got;
  ASSERT_TRUE(until([&] { return (got = inlet->poll(100)).has_value(); }));
  EXPECT_EQ(*got, "to all");
}

TEST(Outlet, ConnectsAndConnectsAnew) {
  boost::asio::io_context io;
  tcp::acceptor acceptor{io, {boost::asio::ip::make_address_v4("127.0.0.1"), 0}};
  acceptor.non_blocking(true);
  const auto outlet = open_tcp("127.0.0.1", acceptor.local_endpoint().port());
  outlet->send("too early");
  EXPECT_EQ(outlet->lost(), 1U);
  auto now = steady_clock::now();
  const auto accepted = [&](tcp::socket& peer) {
    return until([&] {
      outlet->poll(now);
      boost::system::error_code error;
      acceptor.accept(peer, error);
      return !error;
    });
  };
  tcp::socket peer{io};
  ASSERT_TRUE(accepted(peer));
  ASSERT_TRUE(until([&] {
    outlet->poll(now);
    return outlet->poll_news().has_value();
  })) << "connected";
  const std::string text(200'000, 'x');
  outlet->send(text);
  outlet->send(text);
  peer.non_blocking(true);
  std::size_t got = 0;
  std::string part(65'536, '\0');
  ASSERT_TRUE(until([&] {
    outlet->poll(now);
    boost::system::error_code error;
    got += peer.read_some(boost::asio::buffer(part), error);
    return got == 2 * text.size();
  }));
  peer.close();
  ASSERT_TRUE(until([&] {
    outlet->poll(now);
    return outlet->poll_news().has_value();
  })) << "ended";
  now += kTcpRetry;
  tcp::socket again{io};
  EXPECT_TRUE(accepted(again));
}

}  // namespace
}  // namespace skein::agencies
