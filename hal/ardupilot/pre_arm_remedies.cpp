// SPDX-License-Identifier: Apache-2.0
#include "pre_arm_remedies.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace skein::ardupilot {
namespace {

constexpr std::string_view kElse = "see ArduPilot's pre-arm checks";

/// By a word of the reason, as ArduPilot 4.5 and 4.6 say it; the first that fits counts.
constexpr std::array<std::pair<std::string_view, std::string_view>, 30> kRemedies{{
    {"OpenDroneID", "see the Remote ID transmitter and DID_MAVPORT"},
    {"not armable", "switch to another mode"},
    {"safety switch", "press the safety switch"},
    {"ompass", "away from metal; calibrate the compass"},
    {"GPS", "wait under open sky; is its receiver connected?"},
    {"home", "wait under open sky until it knows where it is"},
    {"osition", "wait under open sky until it knows where it is"},
    {"EKF", "keep it still until the filter has settled"},
    {"AHRS", "keep it still until the filter has settled"},
    {"DCM", "keep it still until the filter has settled"},
    {"Gyro", "keep it still; calibrate it level"},
    {"Accel", "keep it still; calibrate it level"},
    {"AccCal", "calibrate it level"},
    {"attery", "charge or change it; see BATT_ARM_VOLT"},
    {"BATT", "charge or change it; see BATT_ARM_VOLT"},
    {"irspeed", "cover the pitot tube and calibrate it"},
    {"Baro", "keep wind off the barometer; reboot it"},
    {"hrottle", "transmitter on and its throttle down"},
    {"Radio", "switch the transmitter on"},
    {"RC", "switch the transmitter on; calibrate it"},
    {"fence", "see FENCE_ENABLE and the fence's bounds"},
    {"ogging", "is its memory card there, and not full?"},
    {"errain", "wait for terrain, or set TERRAIN_ENABLE 0"},
    {"SERVO", "see SERVOn_FUNCTION, _MIN and _MAX"},
    {"Motor", "see FRAME_CLASS and SERVOn_FUNCTION"},
    {"FRAME", "see FRAME_CLASS and FRAME_TYPE"},
    {"CAN", "are all nodes of its bus there?"},
    {"oard", "measure its supply"},
    {"aram", "reboot it; see its parameters"},
    {"nitiali", "wait until it has started"},
}};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The end of the number of several digits that begins at `at`, or `at`.
std::size_t after_number(std::string_view text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && (is_digit(text[end]) || (end > at && text[end] == '.'))) ++end;
  return end - at > 1 ? end : at;
}

}  // namespace

std::string with_remedy(std::string_view reason, std::size_t bytes_max) {
  const auto* const known = std::ranges::find_if(kRemedies, [reason](const auto& remedy) {
    return reason.find(remedy.first) != std::string_view::npos;
  });
  const std::string remedy =
      " (" + std::string{known == kRemedies.end() ? kElse : known->second} + ")";
  return std::string{reason.substr(0, bytes_max - std::min(bytes_max, remedy.size()))} + remedy;
}

bool is_same_reason(std::string_view a, std::string_view b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    const std::size_t after_a = after_number(a, i);
    const std::size_t after_b = after_number(b, j);
    if (after_a > i && after_b > j) {
      i = after_a;
      j = after_b;
    } else if (a[i++] != b[j++]) {
      return false;
    }
  }
  return i == a.size() && j == b.size();
}

}  // namespace skein::ardupilot
