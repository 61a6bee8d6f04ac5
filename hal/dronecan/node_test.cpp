// SPDX-License-Identifier: Apache-2.0
#include "skein/dronecan/node.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "test_frames.hpp"

namespace skein::dronecan {
namespace {

NodeParams companion() {
  NodeParams params;
  params.node_id = 42;
  params.name = "org.test.companion";
  params.software_version.major = 1;
  params.hardware_version.major = 1;
  for (std::size_t i = 0; i < 16; ++i) {
    params.hardware_version.unique_id.at(i) = static_cast<std::uint8_t>(0xA0 + i);
  }
  return params;
}

NodeParams autopilot() {
  NodeParams params;
  params.node_id = 10;
  params.name = "org.test.autopilot";
  params.hardware_version.unique_id[0] = 1;
  return params;
}

std::vector<can::Frame> drain(Node& node) {
  std::vector<can::Frame> frames;
  for (auto front = node.front(); !front.empty(); front = node.front()) {
    frames.insert(frames.end(), front.begin(), front.end());
    node.pop();
  }
  return frames;
}

std::vector<NodeEventKind> events_of(Node& node) {
  std::vector<NodeEventKind> kinds;
  while (const auto event = node.poll_event()) kinds.push_back(event->kind);
  return kinds;
}

/// Both step, and what one sends the other receives, until both are silent.
void exchange(Node& a, Node& b, Instant now) {
  a.step(now);
  b.step(now);
  for (bool busy = true; busy;) {
    const auto from_a = drain(a);
    const auto from_b = drain(b);
    for (const can::Frame& frame : from_a) (void)b.on_frame(frame, 0, now);
    for (const can::Frame& frame : from_b) (void)a.on_frame(frame, 0, now);
    busy = !from_a.empty() || !from_b.empty();
  }
}

TEST(Node, StatusIsSentEverySecond) {
  Node node{companion(), at_ms(0)};
  std::size_t sent = 0;
  for (int ms = 0; ms <= 5000; ms += 10) {
    node.step(at_ms(ms));
    for (const can::Frame& frame : drain(node)) {
      EXPECT_EQ(frame.id, 0x1F01552AU);
      EXPECT_EQ(frame.data[0], ms / 1000);
      EXPECT_EQ(frame.data[7], 0xC0 | sent);
      ++sent;
    }
  }
  EXPECT_EQ(sent, 6U);
  EXPECT_EQ(node.next_timeout(), at_ms(6000));
}

TEST(Node, AnswersInfoAsCaptured) {
  Node node{companion(), at_ms(0)};
  (void)node.on_frame(frame_of(kInfoRequestOfAutopilot), 0, at_ms(100));
  const auto frames = drain(node);
  ASSERT_EQ(frames.size(), kInfoOfCompanion.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(text_of(frames[i]), kInfoOfCompanion[i]) << i;
  }
}

TEST(Node, RequestsToOthersAreNotAnswered) {
  NodeParams params = companion();
  params.node_id = 43;
  Node node{params, at_ms(0)};
  EXPECT_EQ(node.on_frame(frame_of(kInfoRequestOfAutopilot), 0, at_ms(0)), nullptr);
  EXPECT_TRUE(node.front().empty());
}

TEST(Node, TwoNodesLearnOfEachOther) {
  Node a{companion(), at_ms(0)};
  Node b{autopilot(), at_ms(0)};
  exchange(a, b, at_ms(0));
  EXPECT_EQ(events_of(a), (std::vector{NodeEventKind::appeared, NodeEventKind::informed}));
  EXPECT_EQ(events_of(b), (std::vector{NodeEventKind::appeared, NodeEventKind::informed}));
  ASSERT_NE(a.find(10), nullptr);
  const auto& name = a.find(10)->info->name;
  EXPECT_EQ(std::string(name.begin(), name.end()), "org.test.autopilot");
  EXPECT_EQ(a.find(99), nullptr);
}

TEST(Node, FdNodesUnderstandEachOther) {
  NodeParams left = companion();
  NodeParams right = autopilot();
  left.fd = true;
  right.fd = true;
  Node a{left, at_ms(0)};
  Node b{right, at_ms(0)};
  exchange(a, b, at_ms(0));
  ASSERT_NE(a.find(10), nullptr);
  ASSERT_TRUE(a.find(10)->info);
  EXPECT_EQ(a.find(10)->info->name.size(), right.name.size());
}

TEST(Node, SilenceIsSeenAfterThreeSeconds) {
  Node node{companion(), at_ms(0)};
  (void)node.on_frame(frame_of(kStatusOfAutopilot), 0, at_ms(100));
  node.step(at_ms(3099));
  EXPECT_TRUE(node.find(10)->online);
  node.step(at_ms(3100));
  EXPECT_FALSE(node.find(10)->online);
  const auto events = events_of(node);
  ASSERT_FALSE(events.empty());
  EXPECT_EQ(events.back(), NodeEventKind::silent);
}

TEST(Node, UnansweredQuestionsAreRepeatedAFewTimes) {
  Node node{companion(), at_ms(0)};
  std::size_t requests = 0;
  for (std::int64_t s = 0; s < 20; ++s) {
    can::Frame status = frame_of(kStatusOfAutopilot);
    status.data[0] = static_cast<std::uint8_t>(s + 1);
    status.data[7] = static_cast<std::uint8_t>(0xC0 | s);
    (void)node.on_frame(status, 0, at_ms(s * 1000));
    node.step(at_ms(s * 1000));
    for (const can::Frame& frame : drain(node)) requests += header_of(frame)->type == 1 ? 1 : 0;
  }
  EXPECT_EQ(requests, 5U);
}

TEST(Node, ARebootIsTold) {
  Node node{companion(), at_ms(0)};
  can::Frame status = frame_of(kStatusOfAutopilot);
  status.data[0] = 100;
  (void)node.on_frame(status, 0, at_ms(0));
  (void)events_of(node);
  status.data[0] = 0;
  status.data[7] = 0xC1;
  (void)node.on_frame(status, 0, at_ms(1000));
  EXPECT_EQ(events_of(node), (std::vector{NodeEventKind::restarted}));
}

TEST(Node, SomebodyWithOurIdIsFound) {
  Node node{companion(), at_ms(0)};
  Node other{companion(), at_ms(0)};
  other.step(at_ms(0));
  for (const can::Frame& frame : drain(other)) (void)node.on_frame(frame, 0, at_ms(0));
  EXPECT_EQ(events_of(node), (std::vector{NodeEventKind::duplicate_own}));
}

TEST(Node, TwoOthersWithOneIdAreFoundByTheirUniqueIds) {
  Node node{companion(), at_ms(0)};
  Node first{autopilot(), at_ms(0)};
  exchange(node, first, at_ms(0));
  (void)events_of(node);
  NodeParams params = autopilot();
  params.hardware_version.unique_id[0] = 2;
  Node second{params, at_ms(5000)};
  exchange(node, first, at_ms(5000));
  exchange(node, second, at_ms(5500));
  exchange(node, second, at_ms(6500));
  const auto events = events_of(node);
  EXPECT_EQ(std::count(events.begin(), events.end(), NodeEventKind::duplicate), 1);
}

TEST(Node, TwoOthersWithOneIdAreFoundByTheirUptimesAndToldWhileTheyAreThere) {
  Node node{companion(), at_ms(0)};
  std::vector<std::int64_t> told_s;
  for (std::int64_t s = 0; s < 40; ++s) {
    const bool two = s < 20;
    can::Frame status = frame_of(kStatusOfAutopilot);
    status.data[0] = static_cast<std::uint8_t>(two && s % 2 == 0 ? 200 : s);
    status.data[7] = static_cast<std::uint8_t>(0xC0 | (s & 31));
    (void)node.on_frame(status, 0, at_ms(s * 500));
    for (const auto kind : events_of(node)) {
      if (kind == NodeEventKind::duplicate) told_s.push_back(s / 2);
    }
  }
  ASSERT_GE(told_s.size(), 4U);
  EXPECT_LE(told_s.back(), 10);
  EXPECT_EQ(std::adjacent_find(told_s.begin(), told_s.end()), told_s.end()) << "once a second";
}

TEST(Node, HigherPriorityGoesFirstAndTransfersStayWhole) {
  Node node{companion(), at_ms(0)};
  Targetted message;
  for (int i = 0; i < 20; ++i) message.buffer.push_back(1);
  ASSERT_TRUE(node.publish(message, kPriorityLow));
  const can::Frame begun = node.front()[0];  // handed out: it stays the next one
  ASSERT_TRUE(node.publish(message, kPriorityHigh));
  EXPECT_EQ(node.front()[0].id, begun.id);
  node.pop();
  ASSERT_TRUE(node.publish(message, kPriorityMedium));
  EXPECT_EQ(header_of(node.front()[0])->priority, kPriorityHigh);
  node.pop();
  EXPECT_EQ(header_of(node.front()[0])->priority, kPriorityMedium);
}

TEST(Node, TheQueueIsBounded) {
  NodeParams params = companion();
  params.transmit_limit = 3;
  Node node{params, at_ms(0)};
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(node.publish(NodeStatus{}, kPriorityLow));
  EXPECT_FALSE(node.publish(NodeStatus{}, kPriorityLow));
  EXPECT_EQ(node.refused(), 1U);
  EXPECT_EQ(drain(node).size(), 3U);
}

}  // namespace
}  // namespace skein::dronecan
