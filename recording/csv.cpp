// SPDX-License-Identifier: Apache-2.0
#include "csv.hpp"

#include <array>

#include "skein/recording/recording.hpp"

namespace skein::recording {
namespace {

// Long enough for any double of up to nine decimals.
using Digits = std::array<char, 350>;

template <class... Format>
void append_chars(std::string& line, Format... format) {
  Digits digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), format...);
  if (error == std::errc{}) line.append(digits.data(), end);
}

}  // namespace

void append_exact(std::string& line, double value) { append_chars(line, value); }
void append_fixed(std::string& line, double value, int decimals) {
  append_chars(line, value, std::chars_format::fixed, decimals);
}
void append_integer(std::string& line, std::int64_t value) { append_chars(line, value); }
void append_unsigned(std::string& line, std::uint64_t value) { append_chars(line, value); }

void append_quoted(std::string& line, std::string_view text) {
  line += '"';
  for (const char c : text) {
    if (c == '"') line += '"';
    line += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  line += '"';
}

Result<std::vector<std::string>> split(std::string_view line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += '"';
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  if (quoted) return Error{"a quote that does not close"};
  return fields;
}

std::string folder_name(VehicleId vehicle) {
  if (vehicle == kGroundStation) return "ground";
  const std::string number = std::to_string(vehicle.value);
  return "vehicle-" + std::string(number.size() < 2 ? 1 : 0, '0') + number;
}

}  // namespace skein::recording
