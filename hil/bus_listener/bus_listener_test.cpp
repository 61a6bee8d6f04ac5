// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/bus_listener.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "skein/can/candump.hpp"

namespace skein::hil {
namespace {

/// The start of a flight of an ArduPlane 4.6.3: see tests/data/can/README.md.
constexpr const char* kRecord = SKEIN_CAN_RECORD;

struct Told {
  BusListener listener;
  std::vector<std::string> lines;
};

Told listen_to(const std::string& file) {
  Told told;
  std::ifstream log{file};
  EXPECT_TRUE(log) << file;
  for (std::string line; std::getline(log, line);) {
    const auto entry = can::parse_candump(line);
    EXPECT_TRUE(entry) << entry.error().message;
    if (!entry) break;
    for (std::string& text : told.listener.on_frame(entry->frame)) {
      told.lines.push_back(std::move(text));
    }
  }
  return told;
}

TEST(BusListener, TheRecordOfAnAutopilotDecodesWithoutALoss) {
  const Told told = listen_to(kRecord);
  const auto& reassembly = told.listener.reassembly();
  EXPECT_EQ(told.listener.frames(), 50'000U);
  EXPECT_EQ(reassembly.broken(), 0U);
  EXPECT_EQ(reassembly.duplicates, 0U);
  EXPECT_EQ(reassembly.malformed, 0U);
  EXPECT_EQ(reassembly.unchecked, 0U) << "every type of many frames is in the table";
  EXPECT_EQ(reassembly.foreign, 0U);

  const auto tunnels = told.listener.tunnels();
  ASSERT_EQ(tunnels.size(), 2U);
  const auto& down = tunnels.at({10, 42, 0});
  const auto& up = tunnels.at({42, 10, 0});
  EXPECT_EQ(down.bad_crc, 0U);
  EXPECT_EQ(down.unknown, 0U);
  EXPECT_EQ(down.packets, 7373U);
  EXPECT_EQ(down.lost, 1U) << "this one the autopilot dropped itself";
  EXPECT_EQ(down.skipped_bytes, 15U) << "the autopilot begins with text for radios";
  EXPECT_EQ(up.packets, 344U);
  EXPECT_EQ(up.lost + up.bad_crc + up.unknown + up.skipped_bytes, 0U);
}

TEST(BusListener, LinesSayWhoSaidWhat) {
  BusListener listener;
  const auto hear = [&](const std::string& frame) {
    return listener.on_frame(can::parse_candump("(1.0) can0 " + frame).value().frame);
  };
  EXPECT_EQ(hear("1F01550A#01000000000000C0").at(0),
            " 10 -> all priority 31 id  0  uavcan.protocol.NodeStatus uptime_sec=1 health=0 mode=0 "
            "sub_mode=0 vendor_specific_status_code=0");
  EXPECT_EQ(hear("1001AA8A#C0").at(0),
            " 10 -> 42  priority 16 id  0  uavcan.protocol.GetNodeInfo request");
  EXPECT_EQ(hear("104E2D0A#07C0").at(0), " 10 -> all priority 16 id  0  message 20013 bytes 07");
  EXPECT_EQ(hear("123#0102").at(0), "not DroneCAN: id 123 data 0102");
  EXPECT_EQ(hear("20000040#0000000000000000").at(0),
            "error frame, class 00000040 data 0000000000000000");
  for (const char* frame : {"100BB92A#6B5001140100C280", "100BB92A#01FD090000000120",
                            "100BB92A#BF00000000000000", "100BB92A#001208000403AE20"}) {
    EXPECT_TRUE(hear(frame).empty());
  }
  const auto lines = hear("100BB92A#C640");
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0],
            " 42 -> all priority 16 id  0  uavcan.tunnel.Targetted target_node=10 serial_id=0 "
            "bytes=21");
  EXPECT_EQ(lines[1],
            "    MAVLink 1.191 #0    HEARTBEAT custom_mode=0 type=18 autopilot=8 base_mode=0 "
            "system_status=4 mavlink_version=3");
}

}  // namespace
}  // namespace skein::hil
