// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/preflight_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "skein/base/text.hpp"
#include "skein/mission/setup_book.hpp"

namespace skein::onboard {
namespace {

using mission::Preflight;

/// At most so many bytes.
std::string cut(std::string_view text, std::size_t most) {
  if (text.size() <= most) return as_text(text, most);
  constexpr std::string_view kMore = "...";
  return as_text(text, most - kMore.size()).append(kMore);
}

void count(Preflight& told, const Check& check) {
  auto of = std::ranges::find(told.counts, check.group, &mission::CheckCount::group);
  if (of == told.counts.end()) {
    of = told.counts.insert(told.counts.end(), {check.group, 0, 0, 0});
  }
  ++(check.verdict == Verdict::ok     ? of->passed
     : check.verdict == Verdict::warn ? of->warned
                                      : of->failed);
}

/// But for figures in what they say.
bool same_verdicts(const Preflight& a, const Preflight& b) {
  const auto without_texts = [](Preflight told) {
    for (auto& line : told.lines) line.found = line.remedy = {};
    return told;
  };
  return without_texts(a) == without_texts(b);
}

}  // namespace

Preflight preflight_of(Preflight base, const Checks& checks) {
  Preflight told = std::move(base);
  for (const Check& check : checks) count(told, check);
  std::size_t bytes = 0;
  for (const Verdict verdict : {Verdict::fail, Verdict::warn}) {
    for (const Check& check : checks) {
      if (check.verdict != verdict) continue;
      mission::CheckLine line{check.group, check.verdict, cut(check.what, mission::kCheckNameMax),
                              cut(check.found, kTextMax), cut(check.remedy, kTextMax)};
      bytes += line.what.size() + line.found.size() + line.remedy.size();
      if (told.lines.size() < mission::kCheckLinesMax && bytes <= kPreflightTextMax) {
        told.lines.push_back(std::move(line));
      } else {
        ++told.lines_left_out;
      }
    }
  }
  return told;
}

std::uint32_t digest_of(const ardupilot::AutopilotFacts& facts) {
  std::string all;
  for (const auto& parameter : facts.safety) {
    if (!parameter.value) continue;
    all += parameter.of_own_id && parameter.finding.empty()
               ? parameter.name + " own\n"
               : fmt::format("{} {:g}\n", parameter.name, *parameter.value);
  }
  for (const auto& [name, value] : facts.parameters) all += fmt::format("{} {:g}\n", name, value);
  return all.empty() ? 0 : std::max(1U, mission::setup_hash(all));
}

std::optional<Preflight> PreflightTeller::due(Instant now) {
  if (!newest_) return std::nullopt;
  if (told_) {
    const Duration since = now - told_at_;
    const bool is_news = asked_ || !same_verdicts(*newest_, *told_);
    const bool is_due = (is_news && since >= kSpacing) ||
                        (*newest_ != *told_ && since >= kFigures) || since >= kRepeat;
    if (!is_due) return std::nullopt;
  }
  asked_ = false;
  told_at_ = now;
  told_ = newest_;
  return told_;
}

}  // namespace skein::onboard
