// SPDX-License-Identifier: Apache-2.0
#include "parameter_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace skein::ardupilot {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kAskUnanswered = milliseconds{500};
constexpr Duration kAskWrong = seconds{2};
constexpr int kUnansweredAfter = 5;  ///< questions
constexpr Duration kTellAgain = seconds{60};

// ArduPlane 4.6, FS_GCS_ENABL: 1 heartbeat, 2 heartbeat and REMRSSI; 3 is for AUTO alone.
constexpr std::array kPlaneFailsafe{1, 2};
constexpr std::array kPlaneAction{1};  // RTL; 0 flies on in GUIDED
// ArduCopter 4.6, FS_GCS_ENABLE: RTL, SmartRTL or RTL, SmartRTL or land, land, AUTO's landing or
// RTL, brake or land; 0 is off, 2 was taken away.
constexpr std::array kCopterFailsafe{1, 3, 4, 5, 6, 7};

constexpr std::string_view kFliesOn = "the autopilot flies on when the companion falls silent";
constexpr std::string_view kHearsOther = "the autopilot waits for another's heartbeat";

constexpr std::array kPlane{
    SafetyParameter{"FS_GCS_ENABL", "", kPlaneFailsafe, kFliesOn},
    SafetyParameter{"FS_LONG_ACTN", "", kPlaneAction, kFliesOn},
    SafetyParameter{"SYSID_MYGCS", "MAV_GCS_SYSID", {}, kHearsOther},
};
constexpr std::array kCopter{
    SafetyParameter{"FS_GCS_ENABLE", "", kCopterFailsafe, kFliesOn},
    SafetyParameter{"SYSID_MYGCS", "MAV_GCS_SYSID", {}, kHearsOther},
};

}  // namespace

std::span<const SafetyParameter> safety_parameters(Airframe airframe) {
  if (airframe == Airframe::copter) return kCopter;
  return kPlane;
}

ParameterCheck::ParameterCheck(Airframe airframe, std::uint8_t system_id) : system_id_{system_id} {
  for (const SafetyParameter& parameter : safety_parameters(airframe)) {
    entries_.push_back({&parameter, parameter.name});
  }
}

void ParameterCheck::begin() {
  for (Entry& entry : entries_) entry = {entry.parameter, entry.parameter->name};
}

std::vector<std::string_view> ParameterCheck::due(Instant now) {
  std::vector<std::string_view> names;
  for (Entry& entry : entries_) {
    if (is_good(entry)) continue;
    const Duration pause = entry.value ? kAskWrong : kAskUnanswered;
    if (entry.asked_at && now - *entry.asked_at < pause) continue;
    entry.asked_at = now;
    ++entry.asked;
    names.push_back(entry.name);
    if (!entry.value && !entry.parameter->later_name.empty()) {
      names.push_back(entry.parameter->later_name);
    }
  }
  return names;
}

void ParameterCheck::on_value(std::string_view name, float value) {
  for (Entry& entry : entries_) {
    const SafetyParameter& parameter = *entry.parameter;
    if (name.empty() || (name != parameter.name && name != parameter.later_name)) continue;
    if (entry.value != value) entry.told_at.reset();
    entry.name = name == parameter.name ? parameter.name : parameter.later_name;
    entry.value = value;
    entry.asked = 0;
  }
}

bool ParameterCheck::good() const {
  return std::ranges::all_of(entries_, [this](const Entry& entry) { return is_good(entry); });
}

std::optional<std::string> ParameterCheck::poll_finding(Instant now) {
  for (Entry& entry : entries_) {
    if (!is_found_wrong(entry)) continue;
    if (entry.told_at && now - *entry.told_at < kTellAgain) continue;
    entry.told_at = now;
    return finding(entry);
  }
  return std::nullopt;
}

std::vector<std::string> ParameterCheck::findings() const {
  std::vector<std::string> all;
  for (const Entry& entry : entries_) {
    if (is_found_wrong(entry)) all.push_back(finding(entry));
  }
  return all;
}

std::vector<TestedParameter> ParameterCheck::tested() const {
  std::vector<TestedParameter> all;
  for (const Entry& entry : entries_) {
    TestedParameter& tested = all.emplace_back();
    tested.name = entry.name;
    if (entry.value) tested.value = static_cast<double>(*entry.value);
    if (!is_good(entry)) tested.finding = finding(entry);
  }
  return all;
}

bool ParameterCheck::all_told() const {
  return std::ranges::all_of(entries_, [](const Entry& entry) { return entry.value.has_value(); });
}

bool ParameterCheck::is_good(const Entry& entry) const {
  if (!entry.value) return false;
  const auto& good = entry.parameter->good;
  if (good.empty()) return *entry.value == static_cast<float>(system_id_);
  return std::ranges::any_of(good,
                             [&](int value) { return *entry.value == static_cast<float>(value); });
}

bool ParameterCheck::is_found_wrong(const Entry& entry) const {
  return entry.value ? !is_good(entry) : entry.asked >= kUnansweredAfter;
}

std::string ParameterCheck::finding(const Entry& entry) const {
  const SafetyParameter& parameter = *entry.parameter;
  const std::string wanted = parameter.good.empty()
                                 ? std::to_string(system_id_)
                                 : fmt::format("{}", fmt::join(parameter.good, " or "));
  if (!entry.value) {
    return fmt::format("it does not tell {}, which must be {}", parameter.name, wanted);
  }
  return fmt::format("{} is {:g}, so {}; set it to {}", entry.name, *entry.value, parameter.why,
                     wanted);
}

}  // namespace skein::ardupilot
