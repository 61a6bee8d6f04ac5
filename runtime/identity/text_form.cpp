// SPDX-License-Identifier: Apache-2.0
#include "text_form.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include "bytes.hpp"
#include "crypto.hpp"

namespace skein::identity {
namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZ234567";
constexpr unsigned kBits = 5;  ///< of a digit
constexpr std::size_t kChecksumBytes = 4;
constexpr std::string_view kSpace = " \t\r\n";

std::size_t digits_of(std::size_t bytes) { return (bytes * 8 + kBits - 1) / kBits; }

Bytes checksum(std::string_view prefix, Span bytes) {
  auto sum = sha256(ByteWriter{}.add(prefix).add(bytes).take());
  return {sum.begin(), sum.begin() + kChecksumBytes};
}

/// None where a character is no digit, or the last one says more than there is.
std::optional<Bytes> from_base32(std::string_view text) {
  Bytes bytes;
  bytes.reserve(text.size() * kBits / 8);
  unsigned held = 0;  // bits of `value` that are not in `bytes` yet
  unsigned value = 0;
  for (const char digit : text) {
    const auto at = kDigits.find(digit);
    if (at == std::string_view::npos) return std::nullopt;
    value = (value << kBits | static_cast<unsigned>(at)) & 0xFFFU;
    held += kBits;
    if (held < 8) continue;
    held -= 8;
    bytes.push_back(static_cast<std::uint8_t>(value >> held));
  }
  const bool all_said = held < kBits && (value & ((1U << held) - 1U)) == 0;
  return all_said ? std::optional{std::move(bytes)} : std::nullopt;
}

Error no(const TextForm& form, const char* why) {
  return Error{std::string{"this is no "}.append(form.what).append(": ").append(why)};
}

}  // namespace

std::string base32(Span bytes) {
  std::string text;
  text.reserve(digits_of(bytes.size()));
  unsigned held = 0;
  unsigned value = 0;
  for (const std::uint8_t byte : bytes) {
    value = (value << 8U | byte) & 0xFFFU;
    held += 8;
    while (held >= kBits) {
      held -= kBits;
      text += kDigits[value >> held & 31U];
    }
  }
  if (held > 0) text += kDigits[value << (kBits - held) & 31U];
  return text;
}

std::string_view without_space_around(std::string_view text) {
  const auto first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) + 1 - first);
}

std::optional<std::uint16_t> whole_number(std::string_view digits) {
  std::uint16_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return number;
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const auto end = text.find('\n');
    const auto line = without_space_around(text.substr(0, end));
    if (!line.empty()) lines.push_back(line);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

std::string to_text(const TextForm& form, Span bytes) {
  const Bytes sum = checksum(form.prefix, bytes);
  Bytes all = ByteWriter{}.add(bytes).add(Span{sum}).take();
  std::string text{form.prefix};
  text.append(base32(all));
  wipe(all);  // some are secret
  return text;
}

Result<Bytes> bytes_from_text(const TextForm& form, std::string_view text) {
  text = without_space_around(text);
  if (!text.starts_with(form.prefix)) {
    return Error{std::string{"this is no "}
                     .append(form.what)
                     .append(", which begins with ")
                     .append(form.prefix)};
  }
  text.remove_prefix(form.prefix.size());
  if (text.size() > digits_of(form.bytes_max + kChecksumBytes)) return no(form, "it is too long");
  auto bytes = from_base32(text);
  if (!bytes || bytes->size() < kChecksumBytes) {
    return no(form, "a character was lost or changed on the way; copy it again, all on one line");
  }
  const Bytes sum{bytes->end() - kChecksumBytes, bytes->end()};
  bytes->resize(bytes->size() - kChecksumBytes);
  if (checksum(form.prefix, *bytes) != sum) {
    return no(form, "its checksum says that it was changed on the way; copy it again");
  }
  return *std::move(bytes);
}

}  // namespace skein::identity
