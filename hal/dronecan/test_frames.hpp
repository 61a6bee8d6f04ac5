// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/can/candump.hpp"
#include "skein/can/frame.hpp"

namespace skein::dronecan {

/// A frame as candump writes it: "1F01550A#01000000000000C0".
inline can::Frame frame_of(std::string_view text) {
  return can::parse_candump("(0.0) test " + std::string{text}).value().frame;
}

inline std::string text_of(const can::Frame& frame) {
  const std::string line = can::to_candump("test", frame);
  return line.substr(line.rfind(' ') + 1);
}

inline Instant at_ms(std::int64_t milliseconds) {
  return Instant{std::chrono::milliseconds{milliseconds}};
}

// As captured between an ArduPlane 4.6.3 (node 10) and a companion (node 42).
inline constexpr std::string_view kStatusOfAutopilot = "1F01550A#01000000000000C0";
inline constexpr std::string_view kKeepaliveOfAutopilot = "100BB90A#01540100C201C0";
inline constexpr std::string_view kInfoRequestOfAutopilot = "1001AA8A#C0";
inline const std::vector<std::string> kHeartbeatOfCompanion{
    "100BB92A#6B5001140100C280", "100BB92A#01FD090000000120", "100BB92A#BF00000000000000",
    "100BB92A#001208000403AE20", "100BB92A#C640"};
inline const std::vector<std::string> kInfoOfCompanion{
    "10010AAA#E154000000000080", "10010AAA#0000010000000020", "10010AAA#0000000000000000",
    "10010AAA#0000000100A0A120", "10010AAA#A2A3A4A5A6A7A800", "10010AAA#A9AAABACADAEAF20",
    "10010AAA#006F72672E746500", "10010AAA#73742E636F6D7020", "10010AAA#616E696F6E40"};

}  // namespace skein::dronecan
