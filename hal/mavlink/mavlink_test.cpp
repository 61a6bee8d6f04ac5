// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/random.hpp"
#include "skein/mavlink/enums.hpp"
#include "skein/mavlink/parser.hpp"

namespace skein::mavlink {
namespace {

using ByteList = std::vector<std::uint8_t>;

std::vector<Packet> parse_all(Parser& parser, std::span<const std::uint8_t> bytes) {
  std::vector<Packet> packets;
  parser.parse(bytes, [&](const Packet& packet) { packets.push_back(packet); });
  return packets;
}

void append(ByteList& to, const WireBytes& bytes) {
  to.insert(to.end(), bytes.begin(), bytes.end());
}

Heartbeat companion() {
  Heartbeat heartbeat;
  heartbeat.type = static_cast<std::uint8_t>(VehicleType::onboard_controller);
  heartbeat.autopilot = static_cast<std::uint8_t>(Autopilot::invalid);
  heartbeat.system_status = static_cast<std::uint8_t>(SystemState::active);
  return heartbeat;
}

/// The companion's first heartbeat as it was captured on its way to an ArduPlane 4.6.3.
constexpr std::array<std::uint8_t, 21> kHeartbeat{
    0xFD, 0x09, 0, 0, 0, 0x01, 0xBF, 0, 0, 0, 0, 0, 0, 0, 0x12, 0x08, 0, 0x04, 0x03, 0xAE, 0xC6};

struct Published {
  std::uint32_t id;
  std::string_view name;
  std::uint8_t crc_extra;
  std::uint8_t length;
};

/// CRC extras and lengths as published with the MAVLink definitions.
constexpr std::array kPublished{Published{0, "HEARTBEAT", 50, 9},
                                Published{1, "SYS_STATUS", 124, 43},
                                Published{2, "SYSTEM_TIME", 137, 12},
                                Published{20, "PARAM_REQUEST_READ", 214, 20},
                                Published{21, "PARAM_REQUEST_LIST", 159, 2},
                                Published{22, "PARAM_VALUE", 220, 25},
                                Published{23, "PARAM_SET", 168, 23},
                                Published{24, "GPS_RAW_INT", 24, 52},
                                Published{27, "RAW_IMU", 144, 29},
                                Published{29, "SCALED_PRESSURE", 115, 16},
                                Published{30, "ATTITUDE", 39, 28},
                                Published{32, "LOCAL_POSITION_NED", 185, 28},
                                Published{33, "GLOBAL_POSITION_INT", 104, 28},
                                Published{36, "SERVO_OUTPUT_RAW", 222, 37},
                                Published{40, "MISSION_REQUEST", 230, 5},
                                Published{41, "MISSION_SET_CURRENT", 28, 4},
                                Published{42, "MISSION_CURRENT", 28, 18},
                                Published{43, "MISSION_REQUEST_LIST", 132, 3},
                                Published{44, "MISSION_COUNT", 221, 9},
                                Published{45, "MISSION_CLEAR_ALL", 232, 3},
                                Published{46, "MISSION_ITEM_REACHED", 11, 2},
                                Published{47, "MISSION_ACK", 153, 8},
                                Published{49, "GPS_GLOBAL_ORIGIN", 39, 20},
                                Published{51, "MISSION_REQUEST_INT", 196, 5},
                                Published{62, "NAV_CONTROLLER_OUTPUT", 183, 26},
                                Published{65, "RC_CHANNELS", 118, 42},
                                Published{73, "MISSION_ITEM_INT", 38, 38},
                                Published{74, "VFR_HUD", 20, 20},
                                Published{75, "COMMAND_INT", 158, 35},
                                Published{76, "COMMAND_LONG", 152, 33},
                                Published{77, "COMMAND_ACK", 143, 10},
                                Published{82, "SET_ATTITUDE_TARGET", 49, 51},
                                Published{83, "ATTITUDE_TARGET", 22, 37},
                                Published{84, "SET_POSITION_TARGET_LOCAL_NED", 143, 53},
                                Published{85, "POSITION_TARGET_LOCAL_NED", 140, 51},
                                Published{86, "SET_POSITION_TARGET_GLOBAL_INT", 5, 53},
                                Published{87, "POSITION_TARGET_GLOBAL_INT", 150, 51},
                                Published{108, "SIM_STATE", 32, 92},
                                Published{111, "TIMESYNC", 34, 18},
                                Published{116, "SCALED_IMU2", 76, 24},
                                Published{125, "POWER_STATUS", 203, 6},
                                Published{129, "SCALED_IMU3", 46, 24},
                                Published{133, "TERRAIN_REQUEST", 6, 18},
                                Published{136, "TERRAIN_REPORT", 1, 22},
                                Published{137, "SCALED_PRESSURE2", 195, 16},
                                Published{147, "BATTERY_STATUS", 154, 54},
                                Published{148, "AUTOPILOT_VERSION", 178, 78},
                                Published{152, "MEMINFO", 208, 8},
                                Published{163, "AHRS", 127, 28},
                                Published{164, "SIMSTATE", 154, 44},
                                Published{168, "WIND", 1, 12},
                                Published{178, "AHRS2", 47, 24},
                                Published{193, "EKF_STATUS_REPORT", 71, 26},
                                Published{241, "VIBRATION", 90, 32},
                                Published{242, "HOME_POSITION", 104, 60},
                                Published{244, "MESSAGE_INTERVAL", 95, 6},
                                Published{245, "EXTENDED_SYS_STATE", 130, 2},
                                Published{253, "STATUSTEXT", 83, 54},
                                Published{295, "AIRSPEED", 234, 12},
                                Published{11020, "AOA_SSA", 205, 16},
                                Published{11030, "ESC_TELEMETRY_1_TO_4", 144, 44},
                                Published{12900, "OPEN_DRONE_ID_BASIC_ID", 114, 44},
                                Published{12901, "OPEN_DRONE_ID_LOCATION", 254, 59},
                                Published{12903, "OPEN_DRONE_ID_SELF_ID", 249, 46},
                                Published{12904, "OPEN_DRONE_ID_SYSTEM", 77, 54},
                                Published{12905, "OPEN_DRONE_ID_OPERATOR_ID", 49, 43},
                                Published{12918, "OPEN_DRONE_ID_ARM_STATUS", 139, 51}};

TEST(Mavlink, EveryDefinitionHasThePublishedCrcExtra) {
  ASSERT_EQ(messages().size(), kPublished.size());
  for (const Published& published : kPublished) {
    const MessageInfo* info = find_message(published.id);
    ASSERT_NE(info, nullptr) << published.name;
    EXPECT_EQ(info->name, published.name);
    EXPECT_EQ(info->crc_extra, published.crc_extra) << published.name;
    EXPECT_EQ(info->length, published.length) << published.name;
  }
}

TEST(Mavlink, ChecksumHasItsCheckValue) {
  X25 crc;
  for (const char c : std::string_view{"123456789"}) crc.add(static_cast<std::uint8_t>(c));
  EXPECT_EQ(crc.value(), 0x6F91);
}

TEST(Mavlink, HeartbeatIsTheGoldenOne) {
  Encoder encoder{1, kComponentOnboardComputer};
  const WireBytes bytes = encoder.encode(companion());
  EXPECT_TRUE(std::ranges::equal(bytes, kHeartbeat));
  EXPECT_EQ(encoder.encode(companion())[4], 1) << "the sequence counts";
}

TEST(Mavlink, GoldenHeartbeatIsRead) {
  Parser parser;
  const auto packets = parse_all(parser, kHeartbeat);
  ASSERT_EQ(packets.size(), 1U);
  EXPECT_EQ(packets[0].version, 2);
  EXPECT_EQ(packets[0].system, 1);
  EXPECT_EQ(packets[0].component, 191);
  const auto heartbeat = decode<Heartbeat>(packets[0]);
  ASSERT_TRUE(heartbeat);
  EXPECT_EQ(heartbeat->type, 18);
  EXPECT_EQ(heartbeat->mavlink_version, 3);
  EXPECT_FALSE(decode<Attitude>(packets[0]));
  EXPECT_EQ(to_text(packets[0]),
            "HEARTBEAT custom_mode=0 type=18 autopilot=8 base_mode=0 system_status=4 "
            "mavlink_version=3");
}

/// Any payload of any message comes back as it was.
TEST(Mavlink, EveryMessageComesBack) {
  Random random{1};
  Encoder encoder{7, 8};
  Parser parser;
  for (const MessageInfo& info : messages()) {
    Payload payload{};
    for (std::size_t i = 0; i < info.length; ++i) {
      payload[i] = static_cast<std::uint8_t>(random.next());
    }
    payload[info.length - 1U] = 0;  // so that something is truncated
    const auto packets = parse_all(parser, encoder.encode(info, payload));
    ASSERT_EQ(packets.size(), 1U) << info.name;
    EXPECT_EQ(packets[0].id, info.id);
    EXPECT_LT(packets[0].length, std::max<unsigned>(info.length, 2)) << info.name;
    EXPECT_EQ(packets[0].payload, payload) << info.name;
  }
  EXPECT_EQ(parser.statistics().lost, 0U);
}

TEST(Mavlink, StructsAndPayloadsAreTheSame) {
  BatteryStatus battery;
  battery.current_consumed = -3;
  battery.voltages = {4100, 4099, 4098, 0, 0, 0, 0, 0, 0, 65535};
  battery.battery_remaining = -1;
  battery.voltages_ext[3] = 7;
  battery.fault_bitmask = 0x80000001;
  const auto back = from_payload<BatteryStatus>(to_payload(battery));
  EXPECT_EQ(back.current_consumed, -3);
  EXPECT_EQ(back.voltages, battery.voltages);
  EXPECT_EQ(back.battery_remaining, -1);
  EXPECT_EQ(back.voltages_ext, battery.voltages_ext);
  EXPECT_EQ(back.fault_bitmask, 0x80000001U);

  CommandInt command;
  command.param1 = -1.5F;
  command.x = -356'000'000;
  const Payload payload = to_payload(command);
  EXPECT_EQ(payload[3], 0xBF);  // -1.5 is BFC00000, little endian
  EXPECT_EQ(payload[2], 0xC0);
  EXPECT_EQ(from_payload<CommandInt>(payload).x, -356'000'000);
}

TEST(Mavlink, ZerosAtTheEndAreTruncatedButForOneByte) {
  Encoder encoder{1, 1};
  EXPECT_EQ(encoder.encode(MissionItemReached{})[1], 1);
  CommandAck ack;
  ack.command = 400;
  EXPECT_EQ(encoder.encode(ack)[1], 2);
}

/// MAVLink 1 has no truncation and no extensions.
TEST(Mavlink, VersionOneIsRead) {
  ByteList bytes{0xFE, 9, 42, 1, 1, 0, 10, 0, 0, 0, 1, 3, 0x51, 4, 3};
  X25 crc;
  crc.add(std::span{bytes}.subspan(1));
  crc.add(50);
  bytes.push_back(static_cast<std::uint8_t>(crc.value()));
  bytes.push_back(static_cast<std::uint8_t>(crc.value() >> 8U));
  Parser parser;
  const auto packets = parse_all(parser, bytes);
  ASSERT_EQ(packets.size(), 1U);
  EXPECT_EQ(packets[0].version, 1);
  EXPECT_EQ(packets[0].sequence, 42);
  EXPECT_EQ(decode<Heartbeat>(packets[0])->custom_mode, 10U);
}

TEST(Mavlink, NoiseBetweenPacketsCostsOnlyItself) {
  Encoder encoder{1, 1};
  ByteList bytes;
  for (const char c : std::string_view{"0 0 0 "}) bytes.push_back(static_cast<std::uint8_t>(c));
  append(bytes, encoder.encode(Attitude{}));
  const ByteList noise{0xFD, 0x20, 0x00, 0xFE, 0xFD, 0xFD, 0x09};
  bytes.insert(bytes.end(), noise.begin(), noise.end());
  append(bytes, encoder.encode(companion()));
  append(bytes, encoder.encode(companion()));
  Parser parser;
  const auto packets = parse_all(parser, bytes);
  // The noise may look like the head of a long packet; then it takes more bytes to know better.
  const auto rest = parse_all(parser, ByteList(300, 0));
  EXPECT_EQ(packets.size() + rest.size(), 3U);
  EXPECT_EQ(parser.statistics().lost, 0U);
}

/// However the stream is cut, and whatever byte is hit, the other packets arrive.
TEST(Mavlink, PacketsSurviveCutsAndOneIsLostToABadByte) {
  Random random{2};
  for (int round = 0; round < 200; ++round) {
    Encoder encoder{1, 1};
    ByteList bytes;
    constexpr std::size_t kPackets = 20;
    for (std::size_t i = 0; i < kPackets; ++i) {
      Attitude attitude;
      attitude.roll = static_cast<float>(random.uniform());
      attitude.time_boot_ms = static_cast<std::uint32_t>(i);
      attitude.yawspeed = 1;
      append(bytes, encoder.encode(attitude));
    }
    const std::size_t hit = random.index(bytes.size());
    bytes[hit] = static_cast<std::uint8_t>(bytes[hit] ^ (1U << random.index(8)));
    bytes.insert(bytes.end(), 600, 0);
    Parser parser;
    std::size_t received = 0;
    for (std::size_t at = 0; at < bytes.size();) {
      const std::size_t size = std::min<std::size_t>(1 + random.index(50), bytes.size() - at);
      parser.parse(std::span{bytes}.subspan(at, size), [&](const Packet&) { ++received; });
      at += size;
    }
    ASSERT_EQ(received, kPackets - 1) << "byte " << hit;
    // A packet of another id may be taken for one not in use; nothing else may be counted as lost.
    ASSERT_LE(parser.statistics().lost, 1U);
  }
}

TEST(Mavlink, MissingSequenceNumbersAreCountedForEachSender) {
  Encoder a{1, 1};
  Encoder b{2, 1};
  ByteList bytes;
  append(bytes, a.encode(Attitude{}));
  append(bytes, b.encode(Attitude{}));
  (void)a.encode(Attitude{});
  (void)a.encode(Attitude{});
  append(bytes, a.encode(Attitude{}));
  append(bytes, b.encode(Attitude{}));
  Parser parser;
  EXPECT_EQ(parse_all(parser, bytes).size(), 4U);
  EXPECT_EQ(parser.statistics().lost, 2U);
}

TEST(Mavlink, SequenceWrapsWithoutLoss) {
  Encoder encoder{1, 1};
  Parser parser;
  for (int i = 0; i < 600; ++i) (void)parse_all(parser, encoder.encode(Attitude{}));
  EXPECT_EQ(parser.statistics().packets, 600U);
  EXPECT_EQ(parser.statistics().lost, 0U);
}

TEST(Mavlink, MessagesNotInUseAreSkippedWholeAndCounted) {
  Encoder encoder{1, 1};
  static constexpr std::array<FieldInfo, 0> kNoFields{};
  const MessageInfo other{12000, "OTHER", 77, 30, 30, kNoFields};
  Payload payload{};
  payload.fill(0xFD);
  ByteList bytes;
  append(bytes, encoder.encode(Attitude{}));
  append(bytes, encoder.encode(other, payload));
  append(bytes, encoder.encode(Attitude{}));
  Parser parser;
  EXPECT_EQ(parse_all(parser, bytes).size(), 2U);
  EXPECT_EQ(parser.statistics().unknown, 1U);
  EXPECT_EQ(parser.statistics().last_unknown, 12000U);
  EXPECT_EQ(parser.statistics().lost, 0U);
  EXPECT_EQ(parser.statistics().skipped_bytes, 0U);
}

TEST(Mavlink, TextFieldsEndAtZeroOrAtTheirEnd) {
  EXPECT_EQ(text_of(field_of<16>("FS_LONG_ACTN")), "FS_LONG_ACTN");
  EXPECT_EQ(text_of(field_of<16>("0123456789abcdefgh")), "0123456789abcdef");
  Statustext status;
  status.text = field_of<50>("a\x1b[2J\"b");
  Packet packet;
  packet.id = 253;
  packet.payload = to_payload(status);
  EXPECT_EQ(to_text(packet), "STATUSTEXT severity=0 text=\"a?[2J?b\" id=0 chunk_seq=0");
}

// --- signatures ----------------------------------------------------------------------------------

ParserParams with_key(std::string_view passphrase) {
  ParserParams params;
  params.key = key_of(passphrase);
  params.accept_unsigned = false;
  return params;
}

TEST(MavlinkSigning, KeyOfAPassphraseIsItsSha256) {
  // FIPS 180-2, appendix B.1: "abc".
  EXPECT_EQ(key_of("abc")[0], 0xBA);
  EXPECT_EQ(key_of("abc")[31], 0xAD);
}

TEST(MavlinkSigning, GenuinePacketsPassOnce) {
  Encoder encoder{1, 1};
  encoder.sign_with(Signer{key_of("secret"), 3, 1000});
  const WireBytes first = encoder.encode(companion());
  EXPECT_EQ(first.size(), kHeartbeat.size() + kSignatureSize);
  EXPECT_EQ(first[2], 1) << "says that it is signed";
  Parser parser{with_key("secret")};
  EXPECT_EQ(parse_all(parser, first).size(), 1U);
  EXPECT_EQ(parse_all(parser, first).size(), 0U) << "a replay";
  EXPECT_EQ(parse_all(parser, encoder.encode(companion())).size(), 1U);
  EXPECT_EQ(parser.statistics().bad_signature, 1U);
}

TEST(MavlinkSigning, OthersAreRefused) {
  Encoder encoder{1, 1};
  Parser parser{with_key("secret")};
  EXPECT_EQ(parse_all(parser, encoder.encode(companion())).size(), 0U) << "unsigned";
  encoder.sign_with(Signer{key_of("another"), 3, 1000});
  EXPECT_EQ(parse_all(parser, encoder.encode(companion())).size(), 0U) << "another key";
  encoder.sign_with(Signer{key_of("secret"), 3, 1000});
  WireBytes forged = encoder.encode(companion());
  forged[forged.size() - 7] ^= 1;  // its time
  EXPECT_EQ(parse_all(parser, forged).size(), 0U) << "another time";
  EXPECT_EQ(parser.statistics().bad_signature, 3U);
}

TEST(MavlinkSigning, OldStreamsAreRefused) {
  ParserParams params = with_key("secret");
  params.now = 100'000'000;
  Parser parser{params};
  Encoder encoder{1, 1};
  encoder.sign_with(Signer{key_of("secret"), 3, params.now - kSigningTimeSlack - 10});
  EXPECT_EQ(parse_all(parser, encoder.encode(companion())).size(), 0U);
  encoder.signer()->advance_to(params.now - kSigningTimeSlack + 10);
  EXPECT_EQ(parse_all(parser, encoder.encode(companion())).size(), 1U);
}

TEST(MavlinkSigning, ReadWithoutAKeyAsIfUnsigned) {
  Encoder encoder{1, 1};
  encoder.sign_with(Signer{key_of("secret"), 3, 1000});
  Parser parser;
  const auto packets = parse_all(parser, encoder.encode(companion()));
  ASSERT_EQ(packets.size(), 1U);
  EXPECT_TRUE(packets[0].is_signed);
}

}  // namespace
}  // namespace skein::mavlink
