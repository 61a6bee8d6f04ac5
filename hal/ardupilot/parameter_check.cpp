// SPDX-License-Identifier: Apache-2.0
#include "parameter_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "skein/ardupilot/flight_limits.hpp"

namespace skein::ardupilot {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kAskUnanswered = milliseconds{500};
constexpr Duration kAskWrong = seconds{2};
constexpr int kUnansweredAfter = 5;  ///< questions
constexpr int kUnknownAfter = 4;     ///< questions
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

std::vector<ParameterQuestion> safety_questions(Airframe airframe, std::uint8_t system_id) {
  std::vector<ParameterQuestion> questions;
  for (const SafetyParameter& parameter : safety_parameters(airframe)) {
    const std::string wanted = parameter.good.empty()
                                   ? std::to_string(system_id)
                                   : fmt::format("{}", fmt::join(parameter.good, " or "));
    const auto judge = [parameter, system_id, wanted](std::string_view name,
                                                      float value) -> std::optional<std::string> {
      const auto is = [value](int good) { return value == static_cast<float>(good); };
      if (parameter.good.empty() ? is(system_id) : std::ranges::any_of(parameter.good, is)) {
        return std::nullopt;
      }
      return fmt::format("{} is {:g}, so {}; set it to {}", name, value, parameter.why, wanted);
    };
    questions.push_back(
        {parameter.name, parameter.later_name, judge,
         fmt::format("it does not tell {}, which must be {}", parameter.name, wanted),
         parameter.good.empty()});
  }
  return questions;
}

std::vector<ParameterQuestion> fence_questions(const VehicleSpec& vehicle, const Fence& fence) {
  if (!fence.exists()) return {};
  struct Wanted {
    std::string_view name;
    std::function<bool(double)> is_good;
    std::string why;
    std::string good;
  };
  const double least_m = vehicle.height_m;
  const double most_m = fence.height_max_m;
  // Bits of FENCE_TYPE: 0 is the greatest height, 2 polygons.
  constexpr int kTypes = 5;
  const std::array wanted{
      Wanted{"FENCE_ENABLE", [](double v) { return v == 1.0; }, "the autopilot keeps no fence",
             "1"},
      Wanted{"FENCE_ACTION", [](double v) { return v >= 1.0; }, "it only tells what it leaves",
             "1"},
      Wanted{"FENCE_TYPE",
             [](double v) { return v >= 0.0 && (static_cast<int>(v) & kTypes) == kTypes; },
             "it does not keep both polygon and height", "5"},
      Wanted{"FENCE_ALT_MAX", [=](double v) { return v > least_m && v <= most_m; },
             fmt::format("the fence's height is {:g} m, and the vehicle's {:g} m", most_m, least_m),
             fmt::format("{:g}", most_m)}};
  std::vector<ParameterQuestion> questions;
  for (const Wanted& w : wanted) {
    const auto judge = [w](std::string_view name, float value) -> std::optional<std::string> {
      if (w.is_good(static_cast<double>(value))) return std::nullopt;
      return fmt::format("{} is {:g}, so {}; set it to {}", name, value, w.why, w.good);
    };
    questions.push_back(
        {w.name, "", judge, fmt::format("it does not tell {}, which must be {}", w.name, w.good)});
  }
  return questions;
}

std::vector<ParameterQuestion> limit_questions(const VehicleSpec& vehicle, Airframe airframe) {
  std::vector<ParameterQuestion> questions;
  for (const LimitParameter& parameter : limit_parameters(airframe)) {
    const auto judge = [vehicle, parameter](std::string_view name,
                                            float value) -> std::optional<std::string> {
      const auto judged = judge_limit(vehicle, parameter, name, static_cast<double>(value));
      if (judged.verdict != LimitFinding::Verdict::refused) return std::nullopt;
      return judged.found + "; " + judged.remedy;
    };
    questions.push_back({parameter.name, parameter.older_name, judge, {}});
  }
  return questions;
}

ParameterCheck::ParameterCheck(std::vector<ParameterQuestion> questions) {
  for (ParameterQuestion& question : questions) entries_.push_back({std::move(question)});
}

void ParameterCheck::begin() {
  for (Entry& entry : entries_) entry = {std::move(entry.question)};
}

std::vector<std::string_view> ParameterCheck::due(Instant now) {
  std::vector<std::string_view> names;
  for (Entry& entry : entries_) {
    if (is_settled(entry)) continue;
    const Duration pause = entry.value ? kAskWrong : kAskUnanswered;
    if (entry.asked_at && now - *entry.asked_at < pause) continue;
    entry.asked_at = now;
    ++entry.asked;
    names.push_back(entry.name);
    if (!entry.value && !entry.question.other_name.empty()) {
      names.push_back(entry.question.other_name);
    }
  }
  return names;
}

void ParameterCheck::on_value(std::string_view name, float value) {
  for (Entry& entry : entries_) {
    const ParameterQuestion& question = entry.question;
    if (name.empty() || (name != question.name && name != question.other_name)) continue;
    if (entry.value != value) entry.told_at.reset();
    entry.name = name == question.name ? question.name : question.other_name;
    entry.value = value;
    entry.wrong = question.judge(entry.name, value);
    entry.asked = 0;
  }
}

bool ParameterCheck::good() const {
  return std::ranges::all_of(entries_, &ParameterCheck::is_settled);
}

std::optional<std::string> ParameterCheck::poll_finding(Instant now) {
  for (Entry& entry : entries_) {
    const std::string* wrong = finding(entry);
    if (wrong == nullptr || (entry.told_at && now - *entry.told_at < kTellAgain)) continue;
    entry.told_at = now;
    return *wrong;
  }
  return std::nullopt;
}

std::vector<std::string> ParameterCheck::findings() const {
  std::vector<std::string> all;
  for (const Entry& entry : entries_) {
    if (const std::string* wrong = finding(entry)) all.push_back(*wrong);
  }
  return all;
}

std::vector<TestedParameter> ParameterCheck::tested() const {
  std::vector<TestedParameter> all;
  for (const Entry& entry : entries_) {
    TestedParameter& tested = all.emplace_back();
    tested.name = entry.name;
    if (entry.value) tested.value = static_cast<double>(*entry.value);
    tested.finding = entry.value ? entry.wrong.value_or("") : entry.question.untold;
    tested.of_own_id = entry.question.of_own_id;
  }
  return all;
}

bool ParameterCheck::all_told() const {
  return std::ranges::all_of(entries_, [](const Entry& entry) { return entry.value.has_value(); });
}

bool ParameterCheck::all_tried() const {
  return std::ranges::all_of(entries_, [](const Entry& entry) {
    return entry.value || is_settled(entry) || finding(entry) != nullptr;
  });
}

bool ParameterCheck::is_settled(const Entry& entry) {
  if (entry.value) return !entry.wrong;
  return entry.question.untold.empty() && entry.asked >= kUnknownAfter;
}

const std::string* ParameterCheck::finding(const Entry& entry) {
  if (entry.value) return entry.wrong ? &*entry.wrong : nullptr;
  const std::string& untold = entry.question.untold;
  return !untold.empty() && entry.asked >= kUnansweredAfter ? &untold : nullptr;
}

}  // namespace skein::ardupilot
