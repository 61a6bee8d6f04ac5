// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "outbox.hpp"
#include "ownship.hpp"
#include "site_book.hpp"
#include "site_to_lead.hpp"
#include "skein/base/state_table.hpp"
#include "skein/coalition/initiator.hpp"

namespace skein::mission {

/// The vehicle's search for sites that need a leader: it surveys what it finds, and flies to a site
/// whose leader is lost (relief), to lead there if that is still silent there. It leads nothing
/// itself: it says which site is to be led.
class Scout {
 public:
  enum class State : std::uint8_t {
    idle,
    to_survey,  ///< on its way to a site that was found here
    surveying,
    to_relief,  ///< on its way to a site whose leader is lost
    listening,  ///< there
    count
  };
  enum class Event : std::uint8_t {
    survey_planned,
    relief_planned,
    arrived,
    ended,  ///< the survey is flown, or it has listened for long enough
    called_off,
    count
  };
  static constexpr auto kTable = state_table(
      from(State::idle, on(Event::survey_planned, State::to_survey),
           on(Event::relief_planned, State::to_relief)),
      from(State::to_survey, on(Event::arrived, State::surveying),
           on(Event::called_off, State::idle)),
      from(State::surveying, on(Event::ended, State::idle), on(Event::called_off, State::idle)),
      from(State::to_relief, on(Event::arrived, State::listening),
           on(Event::called_off, State::idle)),
      from(State::listening, on(Event::ended, State::idle), on(Event::called_off, State::idle)));

  Scout(Ownship& ownship, Outbox& outbox) : ownship_{ownship}, outbox_{outbox} {}

  /// Its own sensor has seen a site, or the operator tells this vehicle of one. Told again, it says
  /// again that it has taken it up. Precondition: it is not withdrawn.
  void on_site_report(const SiteReport& message, Instant now);
  /// The operator has withdrawn it: it is forgotten for good. False where that is known.
  /// `turns_away`: at once, if it is on its way there, and not when its plan ends.
  bool withdraw(SiteId site, bool turns_away, Instant now);
  [[nodiscard]] bool is_withdrawn(SiteId site) const { return withdrawn_.contains(site); }
  /// What others say of the sites that they lead, or this vehicle itself.
  void on_message(const coalition::Message& message, Instant now);
  /// Nobody shall lead it any more.
  void close(SiteId site) { sites_.close(site); }
  /// Not before what was awarded then is over, nor while somebody else may have been chosen to lead
  /// it: who holds it may not have heard that it is led no more.
  void put_off(PutOffSite site);
  /// So with one that was led in vain, after all else that waits here.
  void put_last(PutOffSite site) { surveyed_.push_back({std::move(site), true}); }
  /// Does anything wait here that can be surveyed or led?
  [[nodiscard]] bool has_another_site() const;

  /// For a vehicle that has nothing else to do: a site to lead now; or nothing, and where there is
  /// one to survey or to relieve it is on its way there.
  [[nodiscard]] std::optional<SurveyedSite> take_up(Instant now);
  /// When that does something next. Precondition: !flying().
  [[nodiscard]] Instant takes_up_at() const;
  /// Goes on with what it took up. A site to lead now, when that has ended with one.
  [[nodiscard]] std::optional<SurveyedSite> fly(Instant now);
  /// In place of fly() while a bid for another site is out: nothing is led before that is decided.
  void wait() { waited_ = true; }
  /// The vehicle has to do something else: what it was to survey waits again.
  void call_off();

  [[nodiscard]] State state() const { return machine_.state(); }
  [[nodiscard]] bool flying() const { return !machine_.in(State::idle); }
  /// A survey is a task; a relief is none, and gives way to any.
  [[nodiscard]] bool surveys() const {
    return machine_.in(State::to_survey) || machine_.in(State::surveying);
  }
  /// The survey that it is about; none where it goes to relieve.
  [[nodiscard]] std::optional<TaskId> task() const {
    return surveys() ? std::optional{TaskId{site_.id, TaskKind::survey, 0}} : std::nullopt;
  }
  [[nodiscard]] Instant next_timeout() const;
  /// Reports of sites that there was no room for.
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  struct Found {
    Site site;
    bool told = false;  ///< that it cannot be surveyed now
  };
  struct Surveyed {
    PutOffSite put_off;
    bool in_vain = false;  ///< it was led

    [[nodiscard]] SiteId site() const { return put_off.site.id; }
    [[nodiscard]] Instant may_be_led_at() const;
  };
  void fire(Event event);
  [[nodiscard]] SurveyedSite lead(std::vector<Surveyed>::iterator next, Instant now);
  void on_status(const coalition::MemberStatus& status);
  void report_detected(const Site& site, Instant now);
  void take_up_survey(Instant now);
  void take_up_relief(Instant now);
  [[nodiscard]] std::variant<planning::TaskPlan, event::TaskFailed> fly_around(const Site& site,
                                                                               bool relief,
                                                                               Instant now);
  [[nodiscard]] std::optional<SurveyedSite> survey(Instant now);
  [[nodiscard]] std::optional<SurveyedSite> relieve(Instant now);
  [[nodiscard]] Instant unheard_since(Instant now) const;
  [[nodiscard]] Instant arrival() const;
  [[nodiscard]] Instant told_time() const;
  [[nodiscard]] Instant leads_at() const;
  [[nodiscard]] int rank() const;

  Ownship& ownship_;
  Outbox& outbox_;
  StateMachine<State, Event> machine_{kTable, State::idle};
  Site site_;                   ///< unless idle: that it flies to
  planning::TaskPlan plan_;     ///< of that flight
  bool strayed_ = false;        ///< from the arc of its survey (Ownship::on_arc)
  bool unlocated_ = false;      ///< it is over, and where it was then has not been heard yet
  bool waited_ = false;         ///< since relieve() last looked
  Instant in_turn_at_{};        ///< to lead what it relieves, after that
  std::set<SiteId> known_;      ///< found or announced by anybody
  std::set<SiteId> withdrawn_;  ///< by the operator
  std::vector<Found> found_;    ///< found here, waiting to be surveyed
  /// Led here before, waiting to be led again; last those that were led in vain.
  std::vector<Surveyed> surveyed_;
  SiteBook sites_;          ///< as others lead them
  Instant survey_again_{};  ///< when a survey is tried next
  Instant relief_again_{};
  std::uint64_t dropped_ = 0;
};
[[nodiscard]] std::string_view to_string(Scout::State state);
[[nodiscard]] std::string_view to_string(Scout::Event event);

}  // namespace skein::mission
