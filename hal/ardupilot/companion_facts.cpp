// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string_view>

#include "companion_impl.hpp"
#include "skein/ardupilot/flight_limits.hpp"

/// What the companion knows for checks before a flight.
namespace skein::ardupilot {
namespace {

constexpr Duration kPatience = std::chrono::seconds{4};  ///< with what ought to come at once
/// Told where they are there; a firmware may lack them.
constexpr std::array<std::string_view, 2> kOthers{"FENCE_ENABLE", "TKOFF_ALT"};
constexpr Duration kOthersPeriod = std::chrono::milliseconds{400};
constexpr int kOthersAsked = 3;

}  // namespace

void Companion::Impl::look_at(const mavlink::Packet& packet, Instant now) {
  if (looked_at_.take(packet, now)) return;
  if (const auto parameter = mavlink::decode<mavlink::ParamValue>(packet)) {
    const std::string name = mavlink::text_of(parameter->param_id);
    const auto is_limit = [&name](const LimitParameter& limit) {
      return name == limit.name || name == limit.older_name;
    };
    if (std::ranges::find(kOthers, name) != kOthers.end() ||
        std::ranges::any_of(traits_.limits, is_limit)) {
      looked_at_.parameters[name] = static_cast<double>(parameter->param_value);
    }
  }
}

void Companion::Impl::ask_others(Instant now) {
  if (!waits() || others_tried(now)) return;
  if (others_asked_ > 0 && now - others_at_ < kOthersPeriod) return;
  ++others_asked_;
  others_at_ = now;
  for (const std::string_view name : kOthers) {
    if (!looked_at_.parameters.contains(std::string{name})) ask_parameter(name);
  }
}

bool Companion::Impl::others_tried(Instant now) const {
  if (others_asked_ >= kOthersAsked && now - others_at_ >= kOthersPeriod) return true;
  return std::ranges::all_of(kOthers, [this](std::string_view name) {
    return looked_at_.parameters.contains(std::string{name});
  });
}

bool Companion::Impl::facts_are_known(Instant now) const {
  if (link_trouble_) return true;
  switch (machine_.state()) {
    case State::searching:
    case State::lost:
    case State::silent:
    case State::checking:
      return false;
    case State::preparing:
      return now - entry_.at >= kPatience ||
             (looked_at_.health && parameters_.all_tried() && others_tried(now));
    default:
      return true;
  }
}

std::optional<AutopilotFacts> Companion::Impl::facts(Instant now) const {
  if (!facts_are_known(now)) return std::nullopt;
  AutopilotFacts facts = looked_at_;
  facts.trouble = link_trouble_;
  if (machine_.in(State::duplicated)) {
    facts.trouble =
        AutopilotNotice{.news = AutopilotNews::duplicate_node, .number = duplicate_node_};
  }
  if (facts.trouble) facts.heartbeat.reset();
  const auto safety = traits_.safety.size();
  facts.safety = parameters_.tested();
  facts.safety.resize(std::min(safety, facts.safety.size()));
  for (const auto& reason : pre_arm_.texts()) facts.pre_arm.push_back(reason.text);
  if (remote_id_.exists()) facts.remote_id = remote_id_.why_not(now).value_or("");
  const bool only_waits = waits() && !airborne();
  facts.in_flight = !only_waits && in_use().value_or(false);
  return facts;
}

}  // namespace skein::ardupilot
