// SPDX-License-Identifier: Apache-2.0
#include "skein/dronecan/transfer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "skein/base/random.hpp"
#include "test_frames.hpp"

namespace skein::dronecan {
namespace {

constexpr std::uint64_t kTargettedSignature = Targetted::kDefinition.signature;

Header targetted_from(std::uint8_t source, std::uint8_t transfer_id = 0) {
  Header header;
  header.type = Targetted::kDefinition.id;
  header.source = source;
  header.transfer_id = transfer_id;
  return header;
}

std::vector<std::uint8_t> random_bytes(Random& random, std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.next());
  return bytes;
}

const Transfer* push_all(Reassembler& reassembler, const TransferFrames& frames,
                         std::uint8_t interface, Instant now) {
  const Transfer* transfer = nullptr;
  for (const can::Frame& frame : frames) transfer = reassembler.on_frame(frame, interface, now);
  return transfer;
}

TEST(Transfer, IdsAreThoseOfTheCapture) {
  EXPECT_EQ(can_id(targetted_from(42)), 0x100BB92AU);
  Header request;
  request.kind = TransferKind::request;
  request.type = 1;
  request.source = 10;
  request.destination = 42;
  EXPECT_EQ(can_id(request), 0x1001AA8AU);
  Header response = request;
  response.kind = TransferKind::response;
  std::swap(response.source, response.destination);
  EXPECT_EQ(can_id(response), 0x10010AAAU);
}

TEST(Transfer, StatusOfTheAutopilotIsRead) {
  Reassembler reassembler;
  const Transfer* transfer = reassembler.on_frame(frame_of(kStatusOfAutopilot), 0, at_ms(0));
  ASSERT_NE(transfer, nullptr);
  ASSERT_TRUE(is<NodeStatus>(*transfer));
  EXPECT_EQ(transfer->header.source, 10);
  EXPECT_EQ(transfer->header.priority, kPriorityLowest);
  const auto status = decode<NodeStatus>(*transfer);
  ASSERT_TRUE(status);
  EXPECT_EQ(status->uptime_sec, 1U);
  EXPECT_EQ(status->health, Health::ok);
  EXPECT_EQ(status->mode, Mode::operational);
  EXPECT_EQ(to_text(*transfer),
            "uavcan.protocol.NodeStatus uptime_sec=1 health=0 mode=0 sub_mode=0 "
            "vendor_specific_status_code=0");
}

TEST(Transfer, KeepaliveOfTheAutopilotIsRead) {
  Reassembler reassembler;
  const Transfer* transfer = reassembler.on_frame(frame_of(kKeepaliveOfAutopilot), 0, at_ms(0));
  ASSERT_NE(transfer, nullptr);
  const auto message = decode<Targetted>(*transfer);
  ASSERT_TRUE(message && is<Targetted>(*transfer));
  EXPECT_EQ(message->protocol, TunnelProtocol::mavlink2);
  EXPECT_EQ(message->target_node, 42);
  EXPECT_EQ(message->serial_id, 0);
  EXPECT_EQ(message->baudrate, 115200U);
  EXPECT_TRUE(message->buffer.empty());
}

TEST(Transfer, HeartbeatOfTheCompanionIsReadAndWritten) {
  Reassembler reassembler;
  const Transfer* transfer = nullptr;
  for (const std::string& text : kHeartbeatOfCompanion) {
    EXPECT_EQ(transfer, nullptr);
    transfer = reassembler.on_frame(frame_of(text), 0, at_ms(0));
  }
  ASSERT_NE(transfer, nullptr);
  const auto message = decode<Targetted>(*transfer);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->target_node, 10);
  EXPECT_EQ(message->buffer.size(), 21U);
  EXPECT_EQ(message->buffer[0], 0xFD);

  const auto frames =
      to_frames(transfer->header, kTargettedSignature, to_payload(*message, false), false);
  ASSERT_EQ(frames.size(), kHeartbeatOfCompanion.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(text_of(frames[i]), kHeartbeatOfCompanion[i]);
  }
}

TEST(Transfer, EmptyBufferStillFillsTheHeader) {
  const Targetted message;
  EXPECT_EQ(to_payload(message, false).size(), 6U);
  EXPECT_EQ(to_payload(message, true).size(), 7U);  // with 7 bits of length
}

/// CAN FD: the length comes first, so that the data begins 7 bits later.
TEST(Transfer, FdCarriesTheLength) {
  Targetted message;
  message.buffer.push_back(0x81);
  message.buffer.push_back(0x01);
  const Payload payload = to_payload(message, true);
  ASSERT_EQ(payload.size(), 9U);
  EXPECT_EQ(payload[6], 0x05);  // 0000010 1
  EXPECT_EQ(payload[7], 0x02);  // 0000001 0
  EXPECT_EQ(payload[8], 0x02);  // 0000001 (0)
}

TEST(Transfer, EveryLengthComesBackOnClassicAndFd) {
  Random random{3};
  for (const bool fd : {false, true}) {
    Reassembler reassembler;
    for (std::size_t size = 0; size <= kTransferMax - 64; ++size) {
      const auto payload = random_bytes(random, size);
      const auto frames = to_frames(targetted_from(1, static_cast<std::uint8_t>(size % 32)),
                                    kTargettedSignature, payload, fd);
      for (const can::Frame& frame : frames) ASSERT_TRUE(can::is_valid(frame)) << size;
      const Transfer* transfer = push_all(reassembler, frames, 0, at_ms(0));
      ASSERT_NE(transfer, nullptr) << size;
      ASSERT_GE(transfer->payload.size(), size);
      ASSERT_TRUE(std::equal(payload.begin(), payload.end(), transfer->payload.begin()));
      if (!fd) {
        ASSERT_EQ(transfer->payload.size(), size);
      }
    }
    EXPECT_EQ(reassembler.statistics().broken(), 0U);
  }
}

TEST(Transfer, TargettedComesBackOnClassicAndFd) {
  Random random{4};
  for (const bool fd : {false, true}) {
    Reassembler reassembler;
    for (std::size_t size = 0; size <= 120; ++size) {
      Targetted message;
      message.protocol = TunnelProtocol::mavlink2;
      message.target_node = 99;
      message.serial_id = -1;
      message.options = 1;
      message.baudrate = 921600;
      for (const std::uint8_t byte : random_bytes(random, size)) message.buffer.push_back(byte);
      const auto frames = to_frames(targetted_from(1, static_cast<std::uint8_t>(size % 32)),
                                    kTargettedSignature, to_payload(message, fd), fd);
      if (!fd && size == 120) {
        EXPECT_EQ(frames.size(), 19U);
      }
      const Transfer* transfer = push_all(reassembler, frames, 0, at_ms(0));
      ASSERT_NE(transfer, nullptr);
      const auto back = decode<Targetted>(*transfer);
      ASSERT_TRUE(back);
      EXPECT_EQ(back->target_node, 99);
      EXPECT_EQ(back->serial_id, -1);
      EXPECT_EQ(back->options, 1);
      EXPECT_EQ(back->baudrate, 921600U);
      ASSERT_TRUE(std::ranges::equal(back->buffer, message.buffer)) << size;
    }
  }
}

TEST(Transfer, TooManyBytesAreNoTargetted) {
  Transfer transfer;
  for (int i = 0; i < 6 + 121; ++i) transfer.payload.push_back(0);
  EXPECT_FALSE(decode<Targetted>(transfer));
  transfer.payload.pop_back();
  EXPECT_TRUE(decode<Targetted>(transfer));
  while (transfer.payload.size() > 5) transfer.payload.pop_back();
  EXPECT_FALSE(decode<Targetted>(transfer)) << "and too few";
}

TEST(Reassembler, AnyFrameMissingDropsTheTransferAndOnlyThat) {
  Random random{5};
  const auto payload = random_bytes(random, 60);
  const std::size_t count =
      to_frames(targetted_from(1), kTargettedSignature, payload, false).size();
  for (std::size_t missing = 0; missing < count; ++missing) {
    Reassembler reassembler;
    std::size_t delivered = 0;
    for (std::uint8_t id = 0; id < 3; ++id) {
      const auto frames = to_frames(targetted_from(1, id), kTargettedSignature, payload, false);
      for (std::size_t i = 0; i < frames.size(); ++i) {
        if (id == 1 && i == missing) continue;
        if (reassembler.on_frame(frames[i], 0, at_ms(0)) != nullptr) ++delivered;
      }
    }
    EXPECT_EQ(delivered, 2U) << missing;
    // Without its first frame a transfer is not known to have been one.
    EXPECT_EQ(reassembler.statistics().broken(), missing == 0 ? 0U : 1U) << missing;
  }
}

TEST(Reassembler, AFrameTwiceOrABadBitDropsTheTransfer) {
  Random random{6};
  const auto payload = random_bytes(random, 60);
  const auto frames = to_frames(targetted_from(1), kTargettedSignature, payload, false);
  {
    Reassembler reassembler;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      (void)reassembler.on_frame(frames[i], 0, at_ms(0));
      if (i == 3) (void)reassembler.on_frame(frames[i], 0, at_ms(0));
    }
    EXPECT_EQ(reassembler.statistics().transfers, 0U);
    EXPECT_EQ(reassembler.statistics().bad_order, 1U);
  }
  Reassembler reassembler;
  TransferFrames bad = frames;
  bad[2].data[4] ^= 0x10;
  EXPECT_EQ(push_all(reassembler, bad, 0, at_ms(0)), nullptr);
  EXPECT_EQ(reassembler.statistics().bad_crc, 1U);
}

TEST(Reassembler, SendersAndTypesMayInterleave) {
  Random random{7};
  Reassembler reassembler;
  std::vector<TransferFrames> all;
  for (std::uint8_t source = 1; source <= 20; ++source) {
    all.push_back(to_frames(targetted_from(source), kTargettedSignature,
                            random_bytes(random, 10 + source * 5U), false));
  }
  std::size_t delivered = 0;
  for (std::size_t i = 0; i < 20; ++i) {
    for (const TransferFrames& frames : all) {
      if (i < frames.size() && reassembler.on_frame(frames[i], 0, at_ms(0)) != nullptr) ++delivered;
    }
  }
  EXPECT_EQ(delivered, all.size());
}

TEST(Reassembler, ATransferThatComesAgainIsDropped) {
  Reassembler reassembler;
  const can::Frame frame = frame_of(kStatusOfAutopilot);
  EXPECT_NE(reassembler.on_frame(frame, 0, at_ms(0)), nullptr);
  EXPECT_EQ(reassembler.on_frame(frame, 0, at_ms(1)), nullptr);
  EXPECT_EQ(reassembler.statistics().duplicates, 1U);
  EXPECT_NE(reassembler.on_frame(frame, 0, at_ms(2002)), nullptr) << "a sender that began afresh";
}

TEST(Reassembler, AnUnfinishedTransferIsForgottenAfterTheTimeout) {
  Random random{8};
  const auto frames =
      to_frames(targetted_from(1), kTargettedSignature, random_bytes(random, 20), false);
  for (const auto& [pause_ms, arrives] : {std::pair{1999, true}, std::pair{2001, false}}) {
    Reassembler reassembler;
    (void)reassembler.on_frame(frames[0], 0, at_ms(0));
    const Transfer* transfer = nullptr;
    for (std::size_t i = 1; i < frames.size(); ++i) {
      transfer = reassembler.on_frame(frames[i], 0, at_ms(pause_ms));
    }
    EXPECT_EQ(transfer != nullptr, arrives) << pause_ms;
  }
}

TEST(Reassembler, TwoInterfacesDeliverEveryTransferOnce) {
  Random random{9};
  Reassembler reassembler;
  std::size_t delivered = 0;
  const auto send = [&](std::uint8_t id, std::uint8_t interface, std::int64_t ms) {
    const auto frames =
        to_frames(targetted_from(1, id % 32), kTargettedSignature, random_bytes(random, 30), false);
    for (const can::Frame& frame : frames) {
      if (reassembler.on_frame(frame, interface, at_ms(ms)) != nullptr) ++delivered;
    }
  };
  for (std::int64_t i = 0; i < 40; ++i) {
    const auto id = static_cast<std::uint8_t>(i);
    send(id, 0, i * 100);
    send(id, 1, i * 100 + 3);
  }
  EXPECT_EQ(delivered, 40U);
  EXPECT_GT(reassembler.statistics().redundant, 0U);
  EXPECT_EQ(reassembler.statistics().broken(), 0U);

  // Interface 0 is unplugged: after a second of its silence the other is taken.
  for (std::int64_t i = 40; i < 60; ++i) send(static_cast<std::uint8_t>(i), 1, i * 100);
  EXPECT_EQ(delivered, 40U + 10U);
  EXPECT_EQ(reassembler.statistics().broken(), 0U);
}

TEST(Reassembler, ASenderThatRestartsIsHeardAgain) {
  Reassembler reassembler;
  const auto payload = std::vector<std::uint8_t>(20, 1);
  for (std::uint8_t id = 0; id < 5; ++id) {
    EXPECT_NE(
        push_all(reassembler, to_frames(targetted_from(1, id), kTargettedSignature, payload, false),
                 0, at_ms(id)),
        nullptr);
  }
  EXPECT_NE(
      push_all(reassembler, to_frames(targetted_from(1, 0), kTargettedSignature, payload, false), 0,
               at_ms(10)),
      nullptr);
}

TEST(Reassembler, AFloodOfSendersIsBounded) {
  Reassembler::Params params;
  params.sessions = 4;
  Reassembler reassembler{params};
  Random random{10};
  for (std::uint8_t source = 1; source <= 100; ++source) {
    const auto frames =
        to_frames(targetted_from(source), kTargettedSignature, random_bytes(random, 20), false);
    (void)reassembler.on_frame(frames[0], 0, at_ms(source));
  }
  EXPECT_EQ(reassembler.statistics().interrupted, 96U);
}

TEST(Reassembler, WhatIsNotDroneCanIsCounted) {
  Reassembler reassembler;
  EXPECT_EQ(reassembler.on_frame(frame_of("123#C0"), 0, at_ms(0)), nullptr);
  EXPECT_EQ(reassembler.on_frame(frame_of("100BB92A#"), 0, at_ms(0)), nullptr);
  EXPECT_EQ(reassembler.on_frame(frame_of("100BB92A#R"), 0, at_ms(0)), nullptr);
  EXPECT_EQ(reassembler.on_frame(frame_of("20000040#0000000000000000"), 0, at_ms(0)), nullptr);
  EXPECT_EQ(reassembler.statistics().foreign, 4U);
  EXPECT_EQ(reassembler.on_frame(frame_of("100BB92A#E0"), 0, at_ms(0)), nullptr);
  EXPECT_EQ(reassembler.on_frame(frame_of("100BB92A#0080"), 0, at_ms(0)), nullptr);
  EXPECT_EQ(reassembler.statistics().malformed, 2U);
}

TEST(Reassembler, ATransferThatIsTooLongIsDropped) {
  Reassembler reassembler;
  can::Frame frame = frame_of("100BB92A#0000000000000080");
  bool toggle = false;
  for (int i = 0; i < 200; ++i) {
    EXPECT_EQ(reassembler.on_frame(frame, 0, at_ms(0)), nullptr);
    toggle = !toggle;
    frame.data[7] = toggle ? 0x20 : 0x00;
  }
  EXPECT_EQ(reassembler.statistics().too_long, 1U);
}

TEST(Reassembler, AnonymousTransfersAreSingleFrames) {
  Reassembler reassembler;
  const Transfer* transfer = reassembler.on_frame(frame_of("1E000100#0102C3"), 0, at_ms(0));
  ASSERT_NE(transfer, nullptr);
  EXPECT_EQ(transfer->header.kind, TransferKind::anonymous);
  EXPECT_EQ(transfer->header.type, 1);
  EXPECT_EQ(transfer->header.transfer_id, 3);
  EXPECT_EQ(reassembler.on_frame(frame_of("1E000100#010283"), 0, at_ms(0)), nullptr);
}

}  // namespace
}  // namespace skein::dronecan
