// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "skein/base/result.hpp"
#include "skein/can/frame.hpp"

/// The log format of can-utils (`candump -L`), a line a frame:
///   (1795230156.622009) can0 1801552A#00000000000000C0     classic, 29-bit id (11-bit: 3 digits)
///   (1795230156.622009) can0 123#R                         asks for data
///   (1795230156.622009) can0 1801552A##1001122             FD; the digit holds flags: 1 = BRS
/// Error frames have bit 29 set in an id of 8 digits. A direction (T or R) may end a line.
namespace skein::can {

struct LogLine {
  std::string interface;
  Frame frame;  ///< with its timestamp
};

/// The reason why not says what is wrong in the line.
[[nodiscard]] Result<LogLine> parse_candump(std::string_view line);
/// Without an end of line; microseconds, as candump.
[[nodiscard]] std::string to_candump(std::string_view interface, const Frame& frame);

}  // namespace skein::can
