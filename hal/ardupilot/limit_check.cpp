// SPDX-License-Identifier: Apache-2.0
#include "limit_check.hpp"

#include <algorithm>

namespace skein::ardupilot {
namespace {

constexpr Duration kAskUnanswered = std::chrono::milliseconds{500};
constexpr Duration kAskWrong = std::chrono::seconds{2};
constexpr int kAskedMax = 4;  ///< then the firmware has none of that name
constexpr Duration kTellAgain = std::chrono::seconds{60};

}  // namespace

LimitCheck::LimitCheck(const VehicleSpec& vehicle, Airframe airframe) : vehicle_{vehicle} {
  for (const LimitParameter& parameter : limit_parameters(airframe)) {
    entries_.push_back({&parameter});
  }
}

std::vector<std::string_view> LimitCheck::due(Instant now) {
  std::vector<std::string_view> names;
  for (Entry& entry : entries_) {
    if (entry.value ? !refusal(entry) : entry.asked >= kAskedMax) continue;
    const Duration pause = entry.value ? kAskWrong : kAskUnanswered;
    if (entry.asked_at && now - *entry.asked_at < pause) continue;
    entry.asked_at = now;
    ++entry.asked;
    if (entry.value) {
      names.push_back(entry.name);
    } else {
      names.insert(names.end(), {entry.parameter->name, entry.parameter->older_name});
    }
  }
  return names;
}

void LimitCheck::on_value(std::string_view name, float value) {
  for (Entry& entry : entries_) {
    const LimitParameter& parameter = *entry.parameter;
    if (name != parameter.name && name != parameter.older_name) continue;
    const auto told = static_cast<double>(value);
    if (entry.value != told) entry.told_at.reset();
    entry.name = name == parameter.name ? parameter.name : parameter.older_name;
    entry.value = told;
  }
}

bool LimitCheck::good() const {
  return std::ranges::all_of(entries_, [this](const Entry& entry) {
    return entry.value ? !refusal(entry) : entry.asked >= kAskedMax;
  });
}

std::optional<std::string> LimitCheck::poll_finding(Instant now) {
  for (Entry& entry : entries_) {
    auto why = refusal(entry);
    if (!why || (entry.told_at && now - *entry.told_at < kTellAgain)) continue;
    entry.told_at = now;
    return why;
  }
  return std::nullopt;
}

std::vector<std::string> LimitCheck::findings() const {
  std::vector<std::string> all;
  for (const Entry& entry : entries_) {
    if (auto why = refusal(entry)) all.push_back(*std::move(why));
  }
  return all;
}

std::optional<std::string> LimitCheck::refusal(const Entry& entry) const {
  if (!entry.value) return std::nullopt;
  const auto judged = judge_limit(vehicle_, *entry.parameter, entry.name, *entry.value);
  if (judged.verdict != LimitFinding::Verdict::refused) return std::nullopt;
  return judged.found + "; " + judged.remedy;
}

}  // namespace skein::ardupilot
