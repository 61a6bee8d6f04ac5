// SPDX-License-Identifier: Apache-2.0
#include "parameter_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
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

/// A value that has to be good, told or not.
ParameterQuestion question(std::string_view name, std::string_view other_name, std::string wanted,
                           std::string why, std::function<bool(double)> is_good) {
  std::string untold = fmt::format("it does not tell {}, which must be {}", name, wanted);
  auto judge = [wanted = std::move(wanted), why = std::move(why), is_good = std::move(is_good)](
                   std::string_view told, float value,
                   const Told& /*others*/) -> std::optional<std::string> {
    if (is_good(static_cast<double>(value))) return std::nullopt;
    return fmt::format("{} is {:g}, so {}; set it to {}", told, value, why, wanted);
  };
  return {name, other_name, std::move(judge), std::move(untold)};
}

void add_fence_questions(std::vector<ParameterQuestion>& questions, const VehicleSpec& vehicle,
                         const Fence& fence) {
  if (!fence.exists()) return;
  std::ranges::move(ordered_fence_questions(), std::back_inserter(questions));
  const double least_m = vehicle.height_m;
  const double most_m = fence.height_max_m;
  questions.push_back(question(
      "FENCE_ALT_MAX", "", fmt::format("{:g}", most_m),
      fmt::format("the fence's height is {:g} m, and the vehicle's {:g} m", most_m, least_m),
      [=](double v) { return v > least_m && v <= most_m; }));
}

}  // namespace

std::vector<ParameterQuestion> ordered_fence_questions() {
  std::vector<ParameterQuestion> questions;
  // Bits of FENCE_TYPE: 0 is the greatest height, 2 polygons.
  constexpr int kTypes = 5;
  questions.push_back(question("FENCE_ENABLE", "", "1", "the autopilot keeps no fence",
                               [](double v) { return v == 1.0; }));
  questions.push_back(question("FENCE_ACTION", "", "1", "it only tells what it leaves",
                               [](double v) { return v >= 1.0; }));
  questions.push_back(
      question("FENCE_TYPE", "", "5", "it does not keep both polygon and height",
               [](double v) { return v >= 0.0 && (static_cast<int>(v) & kTypes) == kTypes; }));
  return questions;
}

std::vector<ParameterQuestion> safety_questions(const VehicleSpec& vehicle, std::uint8_t system_id,
                                                const Fence& fence) {
  std::vector<ParameterQuestion> questions;
  for (const SafetyParameter& parameter : traits_of(vehicle.airframe).safety) {
    std::string wanted = fmt::format("{}", fmt::join(parameter.good, " or "));
    std::function<bool(double)> is_good = [good = parameter.good](double v) {
      return std::ranges::any_of(good, [v](int one) { return v == static_cast<double>(one); });
    };
    const bool of_own_id = parameter.good.empty();
    if (of_own_id) {
      wanted = std::to_string(system_id);
      is_good = [system_id](double v) { return v == static_cast<double>(system_id); };
    }
    questions.push_back(question(parameter.name, parameter.later_name, std::move(wanted),
                                 std::string{parameter.why}, std::move(is_good)));
    questions.back().of_own_id = of_own_id;
  }
  add_fence_questions(questions, vehicle, fence);
  return questions;
}

std::vector<ParameterQuestion> remote_id_questions(const RemoteId& id) {
  if (!id.required) return {};
  std::vector<ParameterQuestion> questions;
  questions.push_back(question("DID_ENABLE", "", "1", "the autopilot tells no transmitter anything",
                               [](double v) { return v == 1.0; }));
  questions.push_back(question("DID_OPTIONS", "", "1", "it arms without a Remote ID", [](double v) {
    return v >= 0.0 && (static_cast<int>(v) & 1) == 1;
  }));
  return questions;
}

std::vector<ParameterQuestion> limit_questions(const VehicleSpec& vehicle) {
  std::vector<ParameterQuestion> questions;
  for (const LimitParameter& parameter : traits_of(vehicle.airframe).limits) {
    const auto judge = [vehicle, parameter](std::string_view name, float value,
                                            const Told& told) -> std::optional<std::string> {
      const auto judged = judge_limit(vehicle, parameter, name, static_cast<double>(value),
                                      told(kStallPrevention.name));
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

void ParameterCheck::add(std::vector<ParameterQuestion> questions) {
  for (ParameterQuestion& question : questions) {
    const bool asks = std::ranges::any_of(
        entries_, [&](const Entry& entry) { return entry.question.name == question.name; });
    if (!asks) entries_.push_back({std::move(question)});
  }
}

void ParameterCheck::begin() {
  for (Entry& entry : entries_) entry = {std::move(entry.question)};
}

std::vector<std::string_view> ParameterCheck::due(Instant now) {
  // What is wrong may be so by another, which is good: both are asked for until none is.
  const bool none_wrong =
      std::ranges::none_of(entries_, [](const Entry& entry) { return entry.wrong.has_value(); });
  std::vector<std::string_view> names;
  for (Entry& entry : entries_) {
    if (is_settled(entry) && (none_wrong || !entry.value)) continue;
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
    entry.asked = 0;
  }
  // One may be wrong by what another is.
  for (Entry& entry : entries_) {
    if (!entry.value) continue;
    entry.wrong = entry.question.judge(entry.name, *entry.value,
                                       [this](std::string_view other) { return told(other); });
  }
}

std::optional<double> ParameterCheck::told(std::string_view name) const {
  const auto found = std::ranges::find_if(
      entries_, [name](const Entry& entry) { return entry.question.name == name; });
  if (found == entries_.end() || !found->value) return std::nullopt;
  return static_cast<double>(*found->value);
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
