// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "outbox.hpp"
#include "ownship.hpp"
#include "site_to_lead.hpp"
#include "skein/base/state_table.hpp"
#include "skein/coalition/initiator.hpp"
#include "skein/coalition/participant.hpp"

namespace skein::mission {

/// The vehicle as the leader of one site at a time: what its Initiator asks for (an allocation, the
/// operator's decision), whom it gives way to, and what is said when a coalition is over. After
/// each call: poll_message() is for everybody, this vehicle's own member included; answer_next()
/// works off what the Initiator asked; when both have nothing more, part().
class Leader {
 public:
  enum class State : std::uint8_t {
    idle,
    leading,            ///< how far its round has come is the Initiator's state
    awaiting_decision,  ///< the operator's, on the deliveries of the round that has formed
    parting,            ///< its coalition is over: its last words are being said
    count
  };
  enum class Event : std::uint8_t {
    taken_up,     ///< a surveyed site, or the plan of a lost leader
    asked,        ///< for the operator's decision
    granted,      ///< by the operator
    round_ended,  ///< it did not form, or its time is over: there is another
    over,         ///< everything is done, or another leads the site
    ended,
    count
  };
  static constexpr auto kTable =
      state_table(from(State::idle, on(Event::taken_up, State::leading)),
                  from(State::leading, on(Event::asked, State::awaiting_decision),
                       on(Event::round_ended, State::leading), on(Event::over, State::parting),
                       on(Event::ended, State::idle)),
                  from(State::awaiting_decision, on(Event::granted, State::leading),
                       on(Event::round_ended, State::leading), on(Event::over, State::parting),
                       on(Event::ended, State::idle)),
                  from(State::parting, on(Event::ended, State::idle)));

  Leader(const Ownship& ownship, Outbox& outbox)
      : ownship_{ownship}, outbox_{outbox}, protocol_{ownship.config().protocol} {}

  /// From now on it leads that site, unless nothing is to be done there. Precondition: idle.
  void lead(const SurveyedSite& what, Instant now);
  /// It goes on with the plan of a leader that is lost, unless it leads already.
  void take_over(const coalition::Participant::LeadershipWon& won, Instant now);

  /// Its own messages and those of others. What it led, where it gives way to the leader of another
  /// site.
  [[nodiscard]] std::optional<PutOffSite> on_message(const coalition::Message& message,
                                                     Instant now);
  void on_authorisation(const Authorisation& message, Instant now);
  /// False where it is not of the round being led.
  bool on_planning_result(const PlanningResult& result, Instant now);
  void on_timeout(Instant now);
  /// Says again what has to be: farewells, and the request that awaits its decision.
  void repeat(Instant now);

  /// Nobody owns a task of its site, and its last rounds found nobody for any: it may do better
  /// elsewhere meanwhile.
  [[nodiscard]] bool in_vain() const;
  /// Gives the site up for now: it is to be led later.
  [[nodiscard]] std::optional<PutOffSite> put_off(coalition::Reason why, Instant now);
  /// For one that cannot go on: gives the site up as soon as nobody flies what it awarded. Then its
  /// silence tells the others to take the site up.
  void hand_on(coalition::Reason why, Instant now);
  /// Gives that site up for good, where it leads it: the operator has withdrawn it.
  void withdraw(SiteId site, Instant now);

  [[nodiscard]] std::optional<coalition::Message> poll_message();
  /// Of these only what is left to say of a site that was given up. A part that is told of the same
  /// input next must have heard it.
  [[nodiscard]] std::optional<coalition::Message> poll_last_words() { return last_words_.pop(); }
  /// Works off one thing that the Initiator asked for; false when there is none.
  bool answer_next(Instant now);
  /// There is something to be said or worked off.
  [[nodiscard]] bool has_output() const {
    return !last_words_.empty() || (initiator_ && initiator_->has_output());
  }
  /// Ends what is over.
  void part();

  [[nodiscard]] State state() const { return machine_.state(); }
  [[nodiscard]] bool leading() const { return !machine_.in(State::idle); }
  /// It leads another coalition than that one.
  [[nodiscard]] bool leads_other(const coalition::CoalitionId& than) const;
  /// Its last round came to nothing: it waits before the next.
  [[nodiscard]] bool monitoring() const;
  /// It has asked the operator, who has not answered.
  [[nodiscard]] bool awaits_decision() const { return machine_.in(State::awaiting_decision); }
  [[nodiscard]] Instant next_timeout() const;
  [[nodiscard]] coalition::Tally tally() const;

 private:
  using Initiator = coalition::Initiator;
  struct Farewell {
    coalition::LeaseRenewal last;
    Instant next{};
    int times = 0;  ///< still to be said
  };
  void fire(Event event);
  void answer(const Initiator::AllocationWanted& wanted, Instant now);
  void answer(const Initiator::Formed& formed, Instant now);
  void answer(const Initiator::NotFormed& failed, Instant now);
  void answer(const Initiator::TaskLost& lost, Instant now);
  void answer(const Initiator::TaskUnknown& unknown, Instant now);
  void answer(const Initiator::Superseded& superseded, Instant now);
  void answer(const Initiator::AllDone& done, Instant now);
  void on_refusal(const Authorisation& message, Instant now);
  void ask_operator(const Initiator::Formed& formed, Instant now);
  [[nodiscard]] Instant decide_by(const TaskAssignment& delivery) const;
  void say_farewell(Instant now);
  void watch_decision(Instant now);
  void meet_rival(SiteId site, const coalition::Round& rival, bool stands, Instant now);
  [[nodiscard]] bool yields_to(const coalition::Announcement& other, Instant now) const;
  void give_up(const coalition::Why& why, Instant now);
  void end();
  [[nodiscard]] coalition::CoalitionId next_coalition();
  [[nodiscard]] Vec2 position_at_formation(Instant now) const;
  [[nodiscard]] TaskId about_site() const { return {initiator_->site().id, {}, 0}; }

  const Ownship& ownship_;
  Outbox& outbox_;
  coalition::ProtocolParams protocol_;  ///< as configured, but for what was too slow
  StateMachine<State, Event> machine_{kTable, State::idle};
  std::optional<Initiator> initiator_;  ///< unless idle
  AuthorisationRequest request_;        ///< that awaits its decision
  Instant request_again_{};
  std::map<VehicleId, coalition::Bid> bids_;  ///< of the round being allocated or flown
  std::vector<coalition::Round> granted_;  ///< rounds that the operator has authorised, newest last
  std::vector<Farewell> farewells_;        ///< of the coalitions that were led here to the end
  BoundedQueue<coalition::Message> last_words_{64};  ///< of one that has been given up
  std::uint32_t coalitions_led_ = 0;
  int rounds_failed_ = 0;   ///< of this site, one after another
  coalition::Tally tally_;  ///< of coalitions that were led here before
};
[[nodiscard]] std::string_view to_string(Leader::State state);
[[nodiscard]] std::string_view to_string(Leader::Event event);

}  // namespace skein::mission
