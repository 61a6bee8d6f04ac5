// SPDX-License-Identifier: Apache-2.0
#include "skein/dronecan/tunnel.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "skein/base/random.hpp"
#include "test_frames.hpp"

namespace skein::dronecan {
namespace {

/// A node with a tunnel to another.
struct End {
  End(std::uint8_t own, std::uint8_t remote, bool fd = false)
      : node{node_params(own, fd), at_ms(0)}, port{port_params(remote), at_ms(0)} {}

  static NodeParams node_params(std::uint8_t own, bool fd) {
    NodeParams params;
    params.node_id = own;
    params.fd = fd;
    params.ask_for_info = false;
    return params;
  }
  static TunnelParams port_params(std::uint8_t remote) {
    TunnelParams params;
    params.remote_node = remote;
    return params;
  }

  Node node;
  TunnelPort port;
};

std::vector<can::Frame> step(End& end, Instant now) {
  end.port.step(end.node, now);
  std::vector<can::Frame> frames;
  for (auto front = end.node.front(); !front.empty(); front = end.node.front()) {
    frames.insert(frames.end(), front.begin(), front.end());
    end.node.pop();
  }
  return frames;
}

void hear(End& end, const std::vector<can::Frame>& frames, Instant now) {
  for (const can::Frame& frame : frames) {
    if (const Transfer* transfer = end.node.on_frame(frame, 0, now)) {
      end.port.on_transfer(*transfer, end.node.node_id(), now);
    }
  }
}

std::vector<std::uint8_t> read_all(TunnelPort& port) {
  std::vector<std::uint8_t> bytes;
  std::array<std::uint8_t, 50> buffer{};
  while (const std::size_t size = port.read(buffer)) {
    bytes.insert(bytes.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(size));
  }
  return bytes;
}

TEST(Tunnel, FirstTransferIsTheCapturedHeartbeat) {
  End companion{42, 10};
  const std::array<std::uint8_t, 21> heartbeat{
      0xFD, 0x09, 0, 0, 0, 0x01, 0xBF, 0, 0, 0, 0, 0, 0, 0, 0x12, 0x08, 0, 0x04, 0x03, 0xAE, 0xC6};
  ASSERT_TRUE(companion.port.write(heartbeat));
  const auto frames = step(companion, at_ms(0));
  ASSERT_EQ(frames.size(), kHeartbeatOfCompanion.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(text_of(frames[i]), kHeartbeatOfCompanion[i]);
  }
}

TEST(Tunnel, KeepaliveIsTheCapturedOne) {
  End autopilot{10, 42};
  const auto frames = step(autopilot, at_ms(0));
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(text_of(frames[0]), kKeepaliveOfAutopilot);
}

TEST(Tunnel, BytesFlowBothWaysInOrder) {
  for (const bool fd : {false, true}) {
    Random random{11};
    End a{42, 10, fd};
    End b{10, 42, fd};
    std::vector<std::uint8_t> sent_a;
    std::vector<std::uint8_t> sent_b;
    std::vector<std::uint8_t> got_a;
    std::vector<std::uint8_t> got_b;
    for (int ms = 0; ms < 500; ms += 5) {
      for (auto* side : {&a, &b}) {
        std::vector<std::uint8_t> bytes(random.index(400));
        for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.next());
        ASSERT_TRUE(side->port.write(bytes));
        auto& sent = side == &a ? sent_a : sent_b;
        sent.insert(sent.end(), bytes.begin(), bytes.end());
      }
      hear(b, step(a, at_ms(ms)), at_ms(ms));
      hear(a, step(b, at_ms(ms)), at_ms(ms));
      const auto from_a = read_all(b.port);
      const auto from_b = read_all(a.port);
      got_b.insert(got_b.end(), from_a.begin(), from_a.end());
      got_a.insert(got_a.end(), from_b.begin(), from_b.end());
    }
    EXPECT_EQ(got_b, sent_a);
    EXPECT_EQ(got_a, sent_b);
    EXPECT_EQ(a.node.reassembly().broken(), 0U);
  }
}

TEST(Tunnel, NoTransferHasMoreThan120Bytes) {
  End a{42, 10};
  End b{10, 42};
  ASSERT_TRUE(a.port.write(std::vector<std::uint8_t>(1000, 7)));
  hear(b, step(a, at_ms(0)), at_ms(0));
  EXPECT_EQ(b.port.statistics().transfers_received, 9U);
  EXPECT_EQ(read_all(b.port).size(), 1000U);
}

TEST(Tunnel, KeepaliveOnlyAfterSilence) {
  End end{42, 10};
  EXPECT_EQ(step(end, at_ms(0)).size(), 1U);
  EXPECT_EQ(step(end, at_ms(499)).size(), 0U);
  ASSERT_TRUE(end.port.write(std::array<std::uint8_t, 1>{1}));
  EXPECT_EQ(step(end, at_ms(499)).size(), 1U);
  EXPECT_EQ(end.port.next_timeout(), at_ms(999));
  EXPECT_EQ(step(end, at_ms(998)).size(), 0U);
  EXPECT_EQ(step(end, at_ms(999)).size(), 1U);
}

TEST(Tunnel, OtherPortsAndTargetsAreNotRead) {
  End listener{42, 10};
  End from_another{11, 42};
  End to_another{10, 43};
  TunnelParams params = End::port_params(42);
  params.serial_id = 1;
  End another_port{10, 42};
  another_port.port = TunnelPort{params, at_ms(0)};
  for (End* end : {&from_another, &to_another, &another_port}) {
    ASSERT_TRUE(end->port.write(std::array<std::uint8_t, 3>{1, 2, 3}));
  }
  hear(listener, step(from_another, at_ms(0)), at_ms(0));
  EXPECT_FALSE(listener.port.heard());
  hear(listener, step(to_another, at_ms(0)), at_ms(0));
  EXPECT_EQ(listener.port.statistics().misaddressed, 1U);
  hear(listener, step(another_port, at_ms(2500)), at_ms(2500));
  EXPECT_FALSE(listener.port.heard());
  EXPECT_TRUE(read_all(listener.port).empty());
}

TEST(Tunnel, AFullBufferTakesAllOrNothing) {
  End end{42, 10};
  EXPECT_FALSE(end.port.write(std::vector<std::uint8_t>(4097, 1)));
  EXPECT_TRUE(end.port.write(std::vector<std::uint8_t>(4096, 1)));
  EXPECT_FALSE(end.port.write(std::array<std::uint8_t, 1>{1}));
  EXPECT_EQ(end.port.unsent(), 4096U);
}

TEST(Tunnel, WhatNobodyReadsOverflowsAndIsCounted) {
  End a{42, 10};
  End b{10, 42};
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(a.port.write(std::vector<std::uint8_t>(1000, 1)));
    hear(b, step(a, at_ms(i)), at_ms(i));
  }
  EXPECT_EQ(b.port.statistics().bytes_overflowed, 5000U - 4096U);
  EXPECT_EQ(read_all(b.port).size(), 4096U);
}

}  // namespace
}  // namespace skein::dronecan
