// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pre_arm_remedies.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/autopilot_notice.hpp"

namespace skein::ardupilot {

/// What is wrong for longer than a moment: told when it comes up, and again each minute while it
/// lasts. One that comes and goes is told once a minute, too.
class Troubles {
 public:
  static constexpr Duration kTellAgain = std::chrono::seconds{60};
  static constexpr Duration kGoneAfter = std::chrono::seconds{5};

  /// All that is wrong at `now`; gives what is to be told.
  [[nodiscard]] std::vector<AutopilotNotice> update(std::vector<AutopilotNotice> holding,
                                                    Instant now) {
    holding_ = std::move(holding);
    std::vector<AutopilotNotice> due;
    for (const AutopilotNotice& trouble : holding_) {
      if (is_told_otherwise(trouble.news)) continue;
      auto told = find(trouble);
      if (told != told_.end() && now - told->at < kTellAgain) {
        told->held = now;
        continue;
      }
      on_told(trouble, now);
      due.push_back(trouble);
    }
    std::erase_if(told_, [now](const Told& told) { return now - told.held > kGoneAfter; });
    return due;
  }
  /// It has been told otherwise.
  void on_told(const AutopilotNotice& trouble, Instant now) {
    const auto told = find(trouble);
    if (told == told_.end()) {
      told_.push_back({trouble, now, now});
    } else {
      *told = {trouble, now, now};
    }
  }
  [[nodiscard]] const std::vector<AutopilotNotice>& holding() const { return holding_; }

 private:
  struct Told {
    AutopilotNotice what;
    Instant at;
    Instant held;
  };
  [[nodiscard]] static bool is_told_otherwise(AutopilotNews news) {
    return news == AutopilotNews::pre_arm || news == AutopilotNews::parameter_wrong ||
           news == AutopilotNews::parameter_changed;
  }
  [[nodiscard]] std::vector<Told>::iterator find(const AutopilotNotice& trouble) {
    return std::ranges::find(told_, trouble, &Told::what);
  }
  std::vector<AutopilotNotice> holding_;
  std::vector<Told> told_;
};

/// Why an autopilot would not arm, as it says itself ("PreArm: ..."), until it says no more.
class PreArmTexts {
 public:
  /// It says all of them again each 30 s.
  static constexpr Duration kGoneAfter = std::chrono::seconds{70};
  static constexpr std::size_t kMax = 8;
  static constexpr std::size_t kBytesMax = 150;

  [[nodiscard]] static bool is_one(std::string_view text) { return text.starts_with(kPrefix); }
  /// Precondition: is_one(text).
  [[nodiscard]] static std::string reason_of(std::string_view text) {
    return with_remedy(text.substr(kPrefix.size()), kBytesMax);
  }
  [[nodiscard]] static bool is_of_mode(std::string_view reason) {
    return std::ranges::any_of(kOfMode, [reason](std::string_view words) {
      return reason.find(words) != std::string_view::npos;
    });
  }
  /// True where it is news.
  bool add(std::string_view text, Instant now) {
    expire(now);
    const auto known = std::ranges::find_if(
        texts_, [text](const Text& other) { return is_same_reason(other.text, text); });
    if (known != texts_.end()) {
      *known = {std::string{text}, now};
      return false;
    }
    if (texts_.size() == kMax) texts_.erase(texts_.begin());
    texts_.push_back({std::string{text}, now});
    return true;
  }
  void clear() { texts_.clear(); }
  void expire(Instant now) {
    std::erase_if(texts_, [now](const Text& text) { return now - text.heard > kGoneAfter; });
  }
  struct Text {
    std::string text;
    Instant heard;
  };
  [[nodiscard]] const std::vector<Text>& texts() const { return texts_; }

 private:
  static constexpr std::string_view kPrefix = "PreArm: ";
  /// An autopilot tells why in words alone.
  /// The second is said of who has landed by its mission.
  static constexpr std::array<std::string_view, 2> kOfMode{"mode not armable",
                                                           "In landing sequence"};
  std::vector<Text> texts_;
};

}  // namespace skein::ardupilot
