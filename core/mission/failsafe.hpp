// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "skein/coalition/messages.hpp"

namespace skein::mission {

/// What a vehicle does whatever it was about. Several facts may hold at once: one action follows,
/// that of the last rule whose fact holds.
class Failsafe {
 public:
  enum class Action : std::uint8_t {
    none,
    take_up_nothing,  ///< what it was awarded is flown
    come_home,        ///< or hold, to be recovered; only a run that has begun is flown to its end
    obey,             ///< the operator: hold, or come home, until told to go on
    count
  };
  struct Facts {
    bool id_in_use = false;    ///< by another vehicle too
    bool range_spent = false;  ///< what is left of its range is for the way home
    bool ordered = false;      ///< by the operator to hold or to come home
  };
  struct Rule {
    std::string_view fact;
    bool Facts::*holds;
    Action action;
    coalition::Reason reason;  ///< that it bids no more
  };
  /// Later entries take precedence.
  static constexpr std::array kRules{
      Rule{"id_in_use", &Facts::id_in_use, Action::take_up_nothing, coalition::Reason::id_in_use},
      Rule{"range_spent", &Facts::range_spent, Action::come_home, coalition::Reason::out_of_range},
      Rule{"ordered", &Facts::ordered, Action::obey, coalition::Reason::held_by_operator},
  };

  Action update(const Facts& facts) {
    rule_ = nullptr;
    for (const Rule& rule : kRules) {
      if (facts.*rule.holds) rule_ = &rule;
    }
    return action();
  }
  [[nodiscard]] Action action() const { return rule_ == nullptr ? Action::none : rule_->action; }
  [[nodiscard]] bool in(Action action) const { return this->action() == action; }
  /// Why it neither bids nor leads; none where it may.
  [[nodiscard]] coalition::Reason reason() const {
    return rule_ == nullptr ? coalition::Reason::none : rule_->reason;
  }

 private:
  const Rule* rule_ = nullptr;
};
[[nodiscard]] std::string_view to_string(Failsafe::Action action);
/// The rules as a table of docs/protocol.md.
[[nodiscard]] std::string failsafe_document();

}  // namespace skein::mission
