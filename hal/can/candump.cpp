// SPDX-License-Identifier: Apache-2.0
#include "skein/can/candump.hpp"

#include <array>
#include <charconv>
#include <cstdint>
#include <optional>

namespace skein::can {
namespace {

constexpr std::uint32_t kErrorBit = 1U << 29U;
constexpr std::uint8_t kFlagBrs = 1;
constexpr std::size_t kStandardDigits = 3;
constexpr std::size_t kExtendedDigits = 8;
constexpr std::size_t kSecondsDigits = 10;
constexpr std::uint64_t kSecondsMax = 9'000'000'000;  // the year 2255: nanoseconds in 63 bits
constexpr std::size_t kFractionDigitsMax = 9;

Error error(std::string_view line, std::string_view what) {
  constexpr std::size_t kShown = 80;
  std::string message{what};
  message += ": '";
  message += line.substr(0, kShown);
  message += line.size() > kShown ? "...'" : "'";
  return Error{message + "; a line is '(seconds.microseconds) interface id#data'"};
}

/// The whole text is a number.
template <class Number>
std::optional<Number> number(std::string_view text, int base) {
  Number value{};
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (failed != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The part of `text` before the next blank; `text` goes on after it.
std::string_view take_word(std::string_view& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) {
    text = {};
    return {};
  }
  text.remove_prefix(begin);
  const std::string_view word = text.substr(0, text.find_first_of(" \t\r\n"));
  text.remove_prefix(word.size());
  return word;
}

std::optional<Duration> timestamp_of(std::string_view word) {
  if (word.size() < 2 || word.front() != '(' || word.back() != ')') return std::nullopt;
  word = word.substr(1, word.size() - 2);
  const std::size_t point = word.find('.');
  if (point == std::string_view::npos) return std::nullopt;
  const std::string_view fraction = word.substr(point + 1);
  if (fraction.size() > kFractionDigitsMax) return std::nullopt;
  const auto seconds = number<std::uint64_t>(word.substr(0, point), 10);
  auto nanoseconds = number<std::uint64_t>(fraction, 10);
  if (!seconds || *seconds > kSecondsMax || !nanoseconds) return std::nullopt;
  for (std::size_t i = fraction.size(); i < kFractionDigitsMax; ++i) *nanoseconds *= 10;
  return std::chrono::seconds{*seconds} + Duration{*nanoseconds};
}

bool read_id(std::string_view digits, Frame& frame) {
  const auto id = number<std::uint32_t>(digits, 16);
  if (!id || (digits.size() != kStandardDigits && digits.size() != kExtendedDigits)) return false;
  frame.error = digits.size() == kExtendedDigits && (*id & kErrorBit) != 0;
  frame.extended = digits.size() == kExtendedDigits && !frame.error;
  frame.id = frame.error ? *id & ~kErrorBit : *id;
  return true;
}

bool read_data(std::string_view digits, Frame& frame) {
  if (digits.size() % 2 != 0 || digits.size() / 2 > kFdDataMax) return false;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    const auto byte = number<std::uint8_t>(digits.substr(i, 2), 16);
    if (!byte) return false;
    frame.data[i / 2] = *byte;
  }
  frame.size = static_cast<std::uint8_t>(digits.size() / 2);
  return true;
}

bool read_frame(std::string_view word, Frame& frame) {
  const std::size_t hash = word.find('#');
  if (hash == std::string_view::npos || !read_id(word.substr(0, hash), frame)) return false;
  std::string_view rest = word.substr(hash + 1);
  if (rest.starts_with('#')) {
    const auto flags = number<std::uint8_t>(rest.substr(1, 1), 16);
    if (!flags) return false;
    frame.fd = true;
    frame.brs = (*flags & kFlagBrs) != 0;
    rest.remove_prefix(2);
  } else if (rest.starts_with('R')) {
    // candump adds the length that is asked for, as a digit; it is of no use to a receiver.
    frame.rtr = true;
    return rest.size() == 1 || (rest.size() == 2 && rest[1] >= '0' && rest[1] <= '8');
  }
  return read_data(rest, frame);
}

void append_hex(std::string& text, std::uint32_t value, std::size_t digits) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  for (std::size_t i = digits; i-- > 0;) text += kDigits[(value >> (4 * i)) & 0xFU];
}

void append_decimal(std::string& text, std::int64_t value, std::size_t digits) {
  std::array<char, 24> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  const auto size = static_cast<std::size_t>(end - buffer.data());
  if (size < digits) text.append(digits - size, '0');
  text.append(buffer.data(), size);
}

}  // namespace

Result<LogLine> parse_candump(std::string_view line) {
  std::string_view rest = line;
  LogLine entry;
  const auto timestamp = timestamp_of(take_word(rest));
  if (!timestamp) return error(line, "no time stamp");
  entry.interface = take_word(rest);
  const std::string_view frame = take_word(rest);
  if (!read_frame(frame, entry.frame) || !is_valid(entry.frame)) return error(line, "no frame");
  const std::string_view direction = take_word(rest);
  if (!direction.empty() && direction != "T" && direction != "R") {
    return error(line, "something after the frame");
  }
  if (!take_word(rest).empty()) return error(line, "something after the frame");
  entry.frame.timestamp = *timestamp;
  return entry;
}

std::string to_candump(std::string_view interface, const Frame& frame) {
  const std::int64_t microseconds =
      std::chrono::duration_cast<std::chrono::microseconds>(frame.timestamp).count();
  std::string text = "(";
  append_decimal(text, microseconds / 1'000'000, kSecondsDigits);
  text += '.';
  append_decimal(text, microseconds % 1'000'000, 6);
  text += ") ";
  text += interface;
  text += ' ';
  const bool wide = frame.extended || frame.error;
  append_hex(text, frame.id | (frame.error ? kErrorBit : 0),
             wide ? kExtendedDigits : kStandardDigits);
  text += '#';
  if (frame.fd) {
    text += '#';
    text += frame.brs ? '1' : '0';
  }
  if (frame.rtr) text += 'R';
  for (const std::uint8_t byte : frame.payload()) append_hex(text, byte, 2);
  return text;
}

}  // namespace skein::can
