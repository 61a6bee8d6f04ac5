// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "skein/coalition/messages.hpp"
#include "skein/mission/messages.hpp"
#include "skein/mission/onboard_agent.hpp"

namespace skein::mission {

/// What a vehicle does whatever it was about. Facts that hold decide on its action for as long as
/// they do: several may, and the action is that of the last rule whose fact holds. News asks for a
/// response at once, besides.
class Failsafe {
 public:
  enum class Action : std::uint8_t {
    none,
    take_up_nothing,  ///< what it was awarded is flown
    stay,             ///< and hold there, until it may work with the others
    come_home,        ///< or hold, to be recovered; only a run that has begun is flown to its end
    obey,             ///< the operator: hold, or come home, until told to go on
    count
  };
  struct Facts {
    bool id_in_use = false;       ///< by another vehicle too
    bool setup_differs = false;   ///< from the ground station's
    bool orders_unknown = false;  ///< to a program that has started anew
    bool piloted = false;         ///< others fly the aircraft: its pilot, or its autopilot
    bool left_fence = false;      ///< or would have, since the operator last told it to go on
    bool range_spent = false;     ///< what is left of its range is for the way home
    bool ordered = false;         ///< by the operator to hold, to come home or to land
    bool started_anew = false;    ///< its program, in the mission: it may take any place for home
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
      Rule{"setup_differs", &Facts::setup_differs, Action::stay, coalition::Reason::setup_differs},
      Rule{"orders_unknown", &Facts::orders_unknown, Action::stay,
           coalition::Reason::orders_unknown},
      Rule{"piloted", &Facts::piloted, Action::stay, coalition::Reason::piloted},
      Rule{"left_fence", &Facts::left_fence, Action::come_home, coalition::Reason::outside_fence},
      Rule{"range_spent", &Facts::range_spent, Action::come_home, coalition::Reason::out_of_range},
      Rule{"ordered", &Facts::ordered, Action::obey, coalition::Reason::held_by_operator},
  };

  /// What becomes of the site that it leads.
  enum class Lead : std::uint8_t {
    kept,
    handed_on,  ///< to the others, as soon as nobody flies what it awarded
    put_off,    ///< it is led here later
    count
  };
  enum class Manoeuvre : std::uint8_t {
    none,       ///< as before
    hold,       ///< an orbit here
    fly_home,   ///< and an orbit there
    come_home,  ///< the same, or hold where it is recovered anywhere
    land,       ///< at home; fly_home first where it does not yet
    search,     ///< unless it has a task or a survey; where its range is spent: come_home
    count
  };
  struct Response {
    std::string_view news;
    coalition::Reason withdraws;  ///< from its coalition, for that reason; none: it stays
    bool ends_scouting;           ///< what it was to survey waits
    Lead lead;
    Manoeuvre manoeuvre;
  };
  using Reason = coalition::Reason;
  static constexpr Response kPathBarred{"path_barred", Reason::path_barred, false, Lead::kept,
                                        Manoeuvre::hold};
  static constexpr Response kIdInUse{"id_in_use", Reason::none, false, Lead::kept, Manoeuvre::none};
  static constexpr Response kSetupDiffers{"setup_differs", Reason::setup_differs, true,
                                          Lead::put_off, Manoeuvre::hold};
  static constexpr Response kOrdersUnknown{"orders_unknown", Reason::orders_unknown, true,
                                           Lead::put_off, Manoeuvre::hold};
  static constexpr Response kPiloted{"piloted", Reason::piloted, true, Lead::handed_on,
                                     Manoeuvre::hold};
  static constexpr Response kMayWork{"may_work", Reason::none, false, Lead::kept,
                                     Manoeuvre::search};
  static constexpr Response kRangeSpent{"range_spent", Reason::out_of_range, true, Lead::handed_on,
                                        Manoeuvre::come_home};
  static constexpr Response kLeftFence{"left_fence", Reason::outside_fence, true, Lead::handed_on,
                                       Manoeuvre::fly_home};
  static constexpr Response kHold{"hold", Reason::held_by_operator, true, Lead::put_off,
                                  Manoeuvre::hold};
  static constexpr Response kReturnHome{"return_home", Reason::sent_home, true, Lead::put_off,
                                        Manoeuvre::fly_home};
  static constexpr Response kLand{"land", Reason::sent_home, true, Lead::put_off, Manoeuvre::land};
  static constexpr Response kResume{"resume", Reason::none, false, Lead::kept, Manoeuvre::search};
  static constexpr std::array kResponses{kPathBarred, kIdInUse,    kSetupDiffers, kOrdersUnknown,
                                         kPiloted,    kMayWork,    kRangeSpent,   kLeftFence,
                                         kHold,       kReturnHome, kLand,         kResume};

  /// Of its range, beyond what the way home takes.
  struct Spare {
    bool is_spent = false;
    double lasts_s = 0.0;  ///< surely; less than 0: nobody knows
  };
  /// One of these at a time.
  struct News {
    bool path_barred = false;     ///< by a hazard, and there is no other way to its task
    bool left_fence = false;      ///< it is outside, or what it flies leads there soon
    bool id_in_use = false;       ///< another vehicle was heard under its number
    std::optional<Bar> bar = {};  ///< what keeps it from working with the others
    std::optional<bool> piloted = {};
    std::optional<Spare> spare = {};
    std::optional<CommandKind> order = {};  ///< new, from the operator
  };
  /// The response that the news asks for; null where it is none.
  const Response* update(Instant now, const News& news);
  /// Is it time to look at the range again? Then News::spare is wanted. It costs a path to
  /// compute, so it is asked for as rarely as it can matter.
  [[nodiscard]] bool wants_range(Instant now) const { return now >= wants_range_at(); }
  [[nodiscard]] Instant wants_range_at() const {
    return facts_.range_spent ? Instant::max() : range_again_;
  }
  /// The way home may have become longer, or the range shorter than by flying on.
  void look_again(Instant now) { range_again_ = now; }

  [[nodiscard]] const Facts& facts() const { return facts_; }
  [[nodiscard]] Action action() const { return rule_ == nullptr ? Action::none : rule_->action; }
  [[nodiscard]] bool in(Action action) const { return this->action() == action; }
  /// It takes up nothing of its own, not even its search.
  [[nodiscard]] bool holds_still() const { return in(Action::obey) || in(Action::stay); }
  /// Why it neither bids nor leads; none where it may.
  [[nodiscard]] coalition::Reason reason() const {
    return rule_ == nullptr ? coalition::Reason::none : rule_->reason;
  }

 private:
  [[nodiscard]] const Response* on_bar(Bar bar);
  [[nodiscard]] const Response* on_piloted(bool piloted);
  [[nodiscard]] const Response* barred() const;
  [[nodiscard]] bool watch_range(const Spare& spare, Instant now);

  Facts facts_;
  const Rule* rule_ = nullptr;  ///< that decides
  Instant range_again_{};
};
[[nodiscard]] std::string_view to_string(Failsafe::Action action);
[[nodiscard]] std::string_view to_string(Failsafe::Lead lead);
[[nodiscard]] std::string_view to_string(Failsafe::Manoeuvre manoeuvre);
/// The rules, and the responses, as tables of docs/protocol.md.
[[nodiscard]] std::string failsafe_document();
[[nodiscard]] std::string responses_document();

}  // namespace skein::mission
