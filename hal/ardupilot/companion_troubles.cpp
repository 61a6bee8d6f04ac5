// SPDX-License-Identifier: Apache-2.0
#include "companion_impl.hpp"

/// What keeps an aircraft on the ground, and that somebody learns of it.
namespace skein::ardupilot {
namespace {

constexpr Duration kLookPeriod = std::chrono::milliseconds{250};
constexpr Duration kPatience = std::chrono::seconds{4};  ///< with what ought to come at once
constexpr Duration kReasonsAgain = std::chrono::seconds{30};
constexpr Duration kPassesOverWithin = std::chrono::seconds{25};  ///< it was told three times

}  // namespace

void Companion::Impl::watch_troubles(Instant now) {
  if (now < troubles_at_) return;
  troubles_at_ = now + kLookPeriod;
  if (navigation_healthy() || !looked_at_.health || !waits()) position_good_at_ = now;
  if (fails_pre_arm() && (!reasons_asked_at_ || now - *reasons_asked_at_ >= kReasonsAgain)) {
    reasons_asked_at_ = now;
    ask(command_of(mavlink::Command::run_prearm_checks), {1, Patience{}.each}, true);
  }
  if (armed_) pre_arm_.clear();
  pre_arm_.expire(now);
  for (AutopilotNotice& trouble : troubles_.update(troubles_now(now), now)) {
    say(true, std::move(trouble), now);
  }
}

bool Companion::Impl::fails_pre_arm() const {
  return waits() && !armed_ && !airborne() && !custody_.by_others() && looked_at_.health &&
         !looked_at_.prearm_good();
}

std::vector<AutopilotNotice> Companion::Impl::troubles_now(Instant now) const {
  if (machine_.in(State::duplicated)) {
    return {{.news = AutopilotNews::duplicate_node, .number = duplicate_node_}};
  }
  std::vector<AutopilotNotice> all;
  if (hears_unsigned()) {
    all.push_back({AutopilotNews::not_signed});
  } else if (link_trouble_) {
    all.push_back(*link_trouble_);
  }
  if (machine_.in(State::refused) && wrong_) all.push_back(*wrong_);
  if (machine_.in(State::preparing) && now - entry_.at >= kPatience) {
    if (auto missing = not_told(); !missing.empty()) {
      all.push_back({.news = AutopilotNews::not_told, .detail = std::move(missing)});
    }
  }
  for (std::string& finding : parameters_.findings()) {
    all.push_back({.news = parameter_news(), .detail = std::move(finding)});
  }
  if (!fence_failed_.empty()) {
    all.push_back({.news = AutopilotNews::fence_not_uploaded, .detail = fence_failed_});
  }
  if (now - position_good_at_ >= kPatience) all.push_back({AutopilotNews::no_position});
  if (auto hover = hover_trouble(now)) all.push_back(*std::move(hover));
  if (auto why = lacks_remote_id(now); why && waits() && !armed_ && now - entry_.at >= kPatience) {
    all.push_back({.news = AutopilotNews::pre_arm, .detail = *std::move(why)});
  }
  for (const auto& reason : pre_arm_.texts()) {
    all.push_back({.news = AutopilotNews::pre_arm, .detail = reason.text});
  }
  return all;
}

/// Of a quadplane that is to be flown on its wings, and is on its rotors.
std::optional<AutopilotNotice> Companion::Impl::hover_trouble(Instant now) const {
  const bool is_wanted = machine_.in(State::standing_by) && armed_ && airborne() &&
                         !custody_.by_others() && params_.take_over == TakeOver::in_flight;
  if ((is_wanted || machine_.in(State::flying)) && hovers_low()) {
    return AutopilotNotice{.news = AutopilotNews::hovers_low, .number = taken_over_at()};
  }
  if (!machine_.in(State::flying) || !leaves_hover_since_) return std::nullopt;
  if (now - *leaves_hover_since_ < kPassesOverWithin) return std::nullopt;
  return AutopilotNotice{
      .news = AutopilotNews::stays_in_hover,
      .number = static_cast<std::uint16_t>(
          std::chrono::duration_cast<std::chrono::seconds>(kPassesOverWithin).count())};
}

std::string Companion::Impl::not_told() const {
  if (!looked_at_.health) return "its health (SYS_STATUS)";
  if (!motion_.sample() && navigation_healthy())
    return "where it is (ATTITUDE, GLOBAL_POSITION_INT, VFR_HUD)";
  return {};
}

}  // namespace skein::ardupilot
