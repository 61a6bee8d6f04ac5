// SPDX-License-Identifier: Apache-2.0
#include "skein/can/candump.hpp"

#include <gtest/gtest.h>

#include <string>

#include "skein/base/random.hpp"
#include "skein/can/crc16.hpp"
#include "skein/can/mcast_datagram.hpp"
#include "test_frames.hpp"

namespace skein::can {
namespace {

TEST(Candump, ALineIsReadAndWritten) {
  const std::string line = "(1795230156.622009) can0 1801552A#00000000000000C0";
  const auto entry = parse_candump(line);
  ASSERT_TRUE(entry) << entry.error().message;
  EXPECT_EQ(entry->interface, "can0");
  EXPECT_TRUE(entry->frame.extended);
  EXPECT_EQ(entry->frame.id, 0x1801552AU);
  EXPECT_EQ(entry->frame.size, 8);
  EXPECT_EQ(entry->frame.timestamp, Duration{1'795'230'156'622'009'000});
  EXPECT_EQ(to_candump(entry->interface, entry->frame), line);
}

TEST(Candump, EveryKindOfFrame) {
  for (const char* text :
       {"(0000000001.000000) vcan0 123#", "(0000000001.000001) vcan0 123#R",
        "(0000000001.000001) vcan0 7FF#01", "(0000000001.000001) vcan0 00000123#0102",
        "(0000000001.000001) vcan0 20000040#0000000000000000",
        "(0000000001.000001) vcan0 1801552A##0001122", "(0000000001.000001) vcan0 123##1",
        "(0000000001.000001) vcan0 123##100112233445566778899AABB"}) {
    const auto entry = parse_candump(text);
    ASSERT_TRUE(entry) << entry.error().message;
    EXPECT_EQ(to_candump(entry->interface, entry->frame), text);
  }
  EXPECT_TRUE(parse_candump("(1.5) can0 123#R8").value().frame.rtr);
  EXPECT_TRUE(parse_candump("(1.5) can0 20000040#0000000000000000").value().frame.error);
  EXPECT_TRUE(parse_candump("(1.5) can0 123##3").value().frame.brs);
  EXPECT_TRUE(parse_candump("(1.5) can0 123#00 T\r\n"));
}

TEST(Candump, WhatIsNoLineIsRefusedWithAReason) {
  for (const char* text : {"",
                           "can0 123#00",
                           "(1.0) can0",
                           "(1.0) can0 123",
                           "(1.0) can0 12#00",
                           "(1.0) can0 123#0",
                           "(1.0) can0 123#0G",
                           "(1.0) can0 800#00",
                           "(1.0) can0 FFFFFFFF#00",
                           "(1) can0 123#00",
                           "(x.0) can0 123#00",
                           "(1.0) can0 123#001122334455667788",
                           "(1.0) can0 123##",
                           "(1.0) can0 123##0001122334455667788",
                           "(1.0) can0 123#00 more",
                           "(1.0) can0 123#R9",
                           "(1.0000000000) can0 123#00",
                           "(11111111111.0) can0 123#00",
                           "(9999999999.0) can0 123#00",
                           "(-1.0) can0 123#00"}) {
    const auto entry = parse_candump(text);
    ASSERT_FALSE(entry) << text;
    EXPECT_NE(entry.error().message.find("'(seconds.microseconds) interface id#data'"),
              std::string::npos);
  }
}

TEST(Candump, AnyFrameComesBack) {
  Random random{12};
  for (int i = 0; i < 2000; ++i) {
    Frame frame = random_frame(random);
    frame.timestamp = std::chrono::microseconds{random.index(1ULL << 50U)};
    const auto entry = parse_candump(to_candump("can0", frame));
    ASSERT_TRUE(entry) << entry.error().message;
    ASSERT_TRUE(same_content(entry->frame, frame)) << to_candump("can0", frame);
    ASSERT_EQ(entry->frame.timestamp, frame.timestamp);
  }
}

TEST(Crc16, HasItsCheckValue) {
  Crc16 crc;
  crc.process_bytes("123456789", 9);
  EXPECT_EQ(crc.checksum(), 0x29B1);
}

TEST(Frame, FdSizesAreThoseOfTheStandard) {
  EXPECT_EQ(fd_size(0), 0U);
  EXPECT_EQ(fd_size(8), 8U);
  EXPECT_EQ(fd_size(9), 12U);
  EXPECT_EQ(fd_size(33), 48U);
  EXPECT_EQ(fd_size(64), 64U);
}

// --- datagrams of the multicast bus
// ----------------------------------------------------------------

struct Golden {
  const char* datagram;
  const char* frame;
};

/// As captured on the bus of an ArduPlane 4.6.3 in the loop.
constexpr std::array kGolden{
    Golden{"34290ca900000a55019f01000000000000c0", "1F01550A#01000000000000C0"},
    Golden{"3429f14400000ab90b9001540100c201c0", "100BB90A#01540100C201C0"},
    Golden{"3429fae100008aaa0190c0", "1001AA8A#C0"},
    Golden{"34291c2f00002ab90b906b5001140100c280", "100BB92A#6B5001140100C280"},
    Golden{"34299a1c00002ab90b9001fd090000000120", "100BB92A#01FD090000000120"},
    Golden{"3429f5a300002ab90b90bf00000000000000", "100BB92A#BF00000000000000"},
    Golden{"3429021200002ab90b90001208000403ae20", "100BB92A#001208000403AE20"},
    Golden{"3429669600002ab90b90c640", "100BB92A#C640"},
};

TEST(McastDatagram, GoldenOnesAreReadAndWritten) {
  for (const Golden& golden : kGolden) {
    const auto bytes = bytes_of(golden.datagram);
    const auto frame = from_mcast(bytes);
    ASSERT_TRUE(frame) << golden.datagram;
    const auto expected = parse_candump(std::string{"(0.0) can0 "} + golden.frame);
    ASSERT_TRUE(expected);
    EXPECT_TRUE(same_content(*frame, expected->frame)) << golden.frame;
    EXPECT_TRUE(std::ranges::equal(to_mcast(expected->frame), bytes)) << golden.frame;
  }
}

TEST(McastDatagram, AnyBadBitIsRefused) {
  const auto good = bytes_of(kGolden[3].datagram);
  for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
    auto bad = good;
    bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ (1U << bit % 8));
    EXPECT_FALSE(from_mcast(bad)) << bit;
  }
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_FALSE(from_mcast(std::span{good}.first(size))) << size;
  }
}

TEST(McastDatagram, AnyFrameComesBack) {
  Random random{13};
  for (int i = 0; i < 2000; ++i) {
    Frame frame = random_frame(random);
    frame.brs = false;  // not carried
    const auto back = from_mcast(to_mcast(frame));
    ASSERT_TRUE(back);
    ASSERT_TRUE(same_content(*back, frame));
  }
}

}  // namespace
}  // namespace skein::can
