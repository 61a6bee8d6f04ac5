// SPDX-License-Identifier: Apache-2.0
#include "failsafe.hpp"

#include <algorithm>
#include <utility>

namespace skein::mission {
namespace {
/// At least, between two looks at the range left.
constexpr Duration kRangePeriod = std::chrono::seconds{1};

const Failsafe::Response* response_to(CommandKind order) {
  switch (order) {
    case CommandKind::hold:
      return &Failsafe::kHold;
    case CommandKind::return_home:
      return &Failsafe::kReturnHome;
    case CommandKind::land:
      return &Failsafe::kLand;
    case CommandKind::resume:
      return &Failsafe::kResume;
    case CommandKind::give_back:  // of the flight controller: the node's, not the agent's
    case CommandKind::count:
      break;
  }
  return nullptr;
}
}  // namespace

const Failsafe::Response* Failsafe::update(Instant now, const News& news) {
  const Response* response = nullptr;
  if (news.path_barred) response = &kPathBarred;
  if (news.id_in_use && !facts_.id_in_use) {
    facts_.id_in_use = true;
    response = &kIdInUse;
  }
  if (news.bar) response = on_bar(*news.bar);
  if (news.piloted) response = on_piloted(*news.piloted);
  if (news.spare && watch_range(*news.spare, now)) response = &kRangeSpent;
  if (news.left_fence && !facts_.left_fence) {
    facts_.left_fence = true;
    if (!facts_.ordered) response = &kLeftFence;
  }
  if (news.order) response = response_to(*news.order);
  if (response == &kHold || response == &kReturnHome || response == &kLand) facts_.ordered = true;
  if (response == &kResume) {
    facts_.ordered = false;
    facts_.left_fence = false;
    if (barred() != nullptr) response = barred();
  }
  rule_ = nullptr;
  for (const Rule& rule : kRules) {
    if (facts_.*rule.holds) rule_ = &rule;
  }
  return response;
}

/// The response that what bars it asks for; null where there is none, or its range is for the way
/// home.
const Failsafe::Response* Failsafe::barred() const {
  if (facts_.range_spent) return nullptr;
  if (facts_.piloted) return &kPiloted;
  if (facts_.setup_differs) return &kSetupDiffers;
  return facts_.orders_unknown ? &kOrdersUnknown : nullptr;
}

/// What it is ordered, and the way home, come first.
const Failsafe::Response* Failsafe::on_bar(Bar bar) {
  const bool was_barred = facts_.setup_differs || facts_.orders_unknown;
  facts_.setup_differs = bar == Bar::setup_differs;
  facts_.orders_unknown = bar == Bar::orders_unknown;
  facts_.started_anew = facts_.started_anew || facts_.orders_unknown;
  if (facts_.ordered) return nullptr;
  if (bar != Bar::none) return barred();
  return was_barred && !facts_.piloted ? &kMayWork : nullptr;
}

/// What it is ordered stands meanwhile, and is obeyed afterwards.
const Failsafe::Response* Failsafe::on_piloted(bool piloted) {
  if (std::exchange(facts_.piloted, piloted) == piloted || facts_.ordered) return nullptr;
  if (piloted) return &kPiloted;
  if (facts_.left_fence) return &kLeftFence;
  const Response* still = barred();
  return still != nullptr ? still : &kMayWork;
}

/// True when it is news that the range is spent.
bool Failsafe::watch_range(const Spare& spare, Instant now) {
  if (facts_.range_spent) return false;
  range_again_ = now + std::max(kRangePeriod, from_seconds(spare.lasts_s));
  facts_.range_spent = spare.is_spent;
  return facts_.range_spent;
}

std::string_view to_string(Failsafe::Action action) {
  static constexpr std::array<std::string_view, 5> kNames{"none", "take_up_nothing", "stay",
                                                          "come_home", "obey"};
  static_assert(kNames.size() == static_cast<std::size_t>(Failsafe::Action::count));
  return kNames.at(static_cast<std::size_t>(action));
}

std::string_view to_string(Failsafe::Lead lead) {
  static constexpr std::array<std::string_view, 3> kNames{"kept", "handed_on", "put_off"};
  static_assert(kNames.size() == static_cast<std::size_t>(Failsafe::Lead::count));
  return kNames.at(static_cast<std::size_t>(lead));
}

std::string_view to_string(Failsafe::Manoeuvre manoeuvre) {
  static constexpr std::array<std::string_view, 6> kNames{"none",      "hold", "fly_home",
                                                          "come_home", "land", "search"};
  static_assert(kNames.size() == static_cast<std::size_t>(Failsafe::Manoeuvre::count));
  return kNames.at(static_cast<std::size_t>(manoeuvre));
}

std::string failsafe_document() {
  std::string text = "| fact | action | it neither bids nor leads: |\n|---|---|---|\n";
  for (const Failsafe::Rule& rule : Failsafe::kRules) {
    text += "| `" + std::string{rule.fact} + "` | `" + std::string{to_string(rule.action)} +
            "` | `" + std::string{coalition::to_string(rule.reason)} + "` |\n";
  }
  return text;
}

std::string responses_document() {
  std::string text =
      "| news | withdraws from its coalition | scouting | its lead | flies "
      "|\n|---|---|---|---|---|\n";
  for (const Failsafe::Response& response : Failsafe::kResponses) {
    const bool stays = response.withdraws == coalition::Reason::none;
    text.append("| `").append(response.news).append("` | ");
    text.append(stays ? "stays" : "`")
        .append(stays ? "" : coalition::to_string(response.withdraws));
    text.append(stays ? " | " : "` | ").append(response.ends_scouting ? "ends" : "goes on");
    text.append(" | `").append(to_string(response.lead));
    text.append("` | `").append(to_string(response.manoeuvre)).append("` |\n");
  }
  return text;
}

}  // namespace skein::mission
