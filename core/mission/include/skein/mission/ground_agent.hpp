// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "skein/base/bounded_queue.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/mission/fleet.hpp"
#include "skein/mission/messages.hpp"

namespace skein::mission {

/// A decision that a scripted scenario takes in the operator's place. The first request for a site
/// gets the site's first decision, the second the second, and so on; the last one serves all later.
struct ScriptedDecision {
  SiteId site;
  bool grant = true;
  Duration reaction{};  ///< after the request arrived
  Instant not_before{};
};

struct GroundAgentConfig {
  std::vector<VehicleId> expected;          ///< the fleet
  std::vector<ScriptedDecision> decisions;  ///< empty: a person decides
  Duration silence = std::chrono::seconds{5};
  /// Fills in a grant's `approval`; fails where the operator may not sign, and nothing is decided.
  /// Empty: grants need none.
  std::function<Result<void>(Authorisation&)> approve = {};
};

/// One request for authorisation, and what became of it.
struct PendingAuthorisation {
  AuthorisationRequest request;
  Instant asked_at{};
  std::optional<Authorisation> decision;
};

/// What the operator decides on a request.
struct Verdict {
  bool grant = false;
  bool although_silent = false;  ///< a grant, also where one that it names is not heard
};

/// Whom of those that the request names the ground station does not hear now, by their ids.
[[nodiscard]] std::vector<VehicleId> silent_in(const AuthorisationRequest& request,
                                               const Fleet& fleet);

/// What an operator must know who has taken a grant back.
struct TakenBack {
  std::vector<TaskAssignment> flown_on;  ///< deliveries that have begun, as far as was heard
  std::vector<VehicleId> silent;         ///< who may not hear it, and fly
};

/// All decisions of the ground station, without I/O: keeps the fleet picture, holds requests for
/// authorisation, sends decisions (every 0.5 s until the last delivery's time has passed) and
/// commands (every 1 s for 5 s). Same calling rules as VehicleAgent. An authorisation is only ever
/// made by authorise(), refuse(), take_back() or a scripted decision; a successor's plan with the
/// very deliveries that were granted needs no new one. It remembers what was flown: a delivery that
/// is done, or was granted to another coalition and may have been flown, is not put to the operator
/// again, but told to the leader that asks. And it passes on, now and then, that a leader is there
/// and that a site is done, so that who is out of the leader's range does not take it for lost. A
/// site whose leader has been silent for long is announced by it: too late for bids, but it is
/// known again to all.
class GroundAgent {
 public:
  GroundAgent(const GroundAgentConfig& config, Instant now);

  /// What an earlier process of this ground station heard then, or said itself, in that order; of
  /// who may say it, and before anything else. Nothing but memory comes of it: of what was granted,
  /// flown and told. Telemetry is passed over.
  void recall(const Message& message, VehicleId sender, Instant at);

  /// Another ground station has the command: nothing is decided, repeated or passed on from now on;
  /// or this one has it (again), from the start on.
  void set_watching(bool watching, Instant now);
  /// What the ground station that has the command has just said: its decisions are this one's.
  void overhear(const Message& message, Instant now);
  /// A vehicle has heard of an order with that number: those to come are greater, whoever gave it.
  void note_order(std::uint64_t number, Instant now);
  [[nodiscard]] std::uint64_t newest_order() const { return last_command_; }

  /// Of who may say it (may_say()).
  void on_message(const Message& message, Instant now);
  void on_timeout(Instant now);

  /// The operator's decision on the newest request for that site. Fails when there is none waiting,
  /// and does not grant what a vehicle id used twice is part of.
  /// Nor one with a member or a leader that is silent here at this moment, or was never heard,
  /// unless the operator passes over that; then gives what he has passed over.
  Result<std::string> authorise(SiteId site, const std::string& operator_name, Instant now,
                                bool although_silent = false);
  Result<void> refuse(SiteId site, const std::string& operator_name, Instant now);
  [[nodiscard]] bool has_granted(SiteId site) const;
  /// As these two, for that plan and no other: one that a person has seen.
  Result<std::string> decide_on(const coalition::Round& round, SiteId site, Verdict what,
                                const std::string& operator_name, Instant now);
  /// Takes back all that is granted at that site: as a refusal, and said as long. A delivery that
  /// has begun is flown to its end. Fails where none is granted that may not have begun.
  Result<TakenBack> take_back(SiteId site, const std::string& by, Instant now);
  [[nodiscard]] bool may_be_taken_back(const PendingAuthorisation& pending, Instant now) const;
  /// A command to one vehicle, or to all (kGroundStation). Fails for a vehicle not in the fleet,
  /// and while two instances answer to the id (for all: while any do, but for `hold`).
  Result<void> command(VehicleId vehicle, CommandKind kind, Instant now);

  /// The operator has withdrawn that site: what waits for a decision on it is refused, now and
  /// whenever it is asked for again.
  void end_site(SiteId site, const std::string& by, Instant now);

  [[nodiscard]] std::optional<Message> poll_message();
  [[nodiscard]] std::optional<MissionEvent>
  poll_event();  ///< its own and those of vehicles, once each
  [[nodiscard]] Instant next_timeout() const;
  /// What its queues had no room for.
  [[nodiscard]] std::uint64_t dropped() const {
    return messages_.dropped() + events_.dropped() + fleet_.dropped();
  }

  [[nodiscard]] const Fleet& fleet() const { return fleet_; }
  [[nodiscard]] Fleet& fleet() { return fleet_; }
  [[nodiscard]] const std::vector<PendingAuthorisation>& authorisations() const { return pending_; }
  /// At the same site.
  [[nodiscard]] bool has_granted_since(const Authorisation& refusal) const;

 private:
  using EventKey = std::tuple<Instant, VehicleId, TaskId, EventBody>;
  /// A delivery that the operator has granted, to the newest round that asked for it.
  struct Granted {
    coalition::Round round;
    TaskAssignment assignment;
    double bearing_rad = 0.0;
    Instant granted_at{};
    bool begun = false;
    bool given_up = false;  ///< its owner has said that it does not fly it
  };
  struct LedSite {
    coalition::LeaseRenewal last;  ///< of its leader
    Instant passed_on_at{Instant::min()};
    int times_closed = 0;                                 ///< that its end was passed on
    std::optional<coalition::Announcement> announcement;  ///< the newest; none when refused
    Instant heard_at{};                                   ///< its leader
  };
  struct SentCommand {
    Command command;
    Instant next{};
    Instant repeat_until{};
  };

  void hear(const Message& message, Instant now);
  void recall_own(const Message& message, Instant at);
  void take(PendingAuthorisation& pending, const Authorisation& decision);
  void note_grant(const Authorisation& grant);
  void on_request(const AuthorisationRequest& request, Instant now);
  void on_event(const MissionEvent& event);
  void on_status(const coalition::MemberStatus& status);
  void note_done(const coalition::TaskStatus& status);
  void on_renewal(const coalition::LeaseRenewal& renewal, Instant now);
  void on_announcement(const coalition::Announcement& announcement, Instant now);
  bool tell_what_is_over(const AuthorisationRequest& request, Instant now);
  [[nodiscard]] const Granted* granted_to_another(const AuthorisationRequest& request) const;
  [[nodiscard]] static bool is_of_grant(const MissionEvent& event, const Granted& granted);
  [[nodiscard]] const Authorisation* granted_before(const AuthorisationRequest& request) const;
  void decide_by_script(Instant now);
  void send_again(Instant now);
  [[nodiscard]] const ScriptedDecision* script_for(SiteId site) const;
  [[nodiscard]] std::optional<Instant> script_due(const PendingAuthorisation& pending) const;
  Result<std::string> decide_newest(SiteId site, Verdict what, const std::string& by, Instant now);
  Result<std::string> decide(PendingAuthorisation& pending, Verdict what, const std::string& by,
                             Instant now);
  [[nodiscard]] std::string silent_text(const AuthorisationRequest& request, Instant now) const;
  [[nodiscard]] std::optional<std::string> why_not_grant(const AuthorisationRequest& request,
                                                         Instant now);
  void grant_again(PendingAuthorisation& pending, Instant now);
  void say(PendingAuthorisation& pending, const Authorisation& decision, Instant now,
           const std::string& although);
  [[nodiscard]] LedSite* led_site(SiteId site);
  void report(EventBody body, const coalition::Round& round, const TaskId& task, Instant now);

  GroundAgentConfig config_;
  Fleet fleet_;
  std::vector<PendingAuthorisation> pending_;
  std::map<SiteId, std::size_t> scripted_;  ///< decisions that the script has taken so far
  Instant script_again_{Instant::min()};    ///< after a decision that could not be taken
  std::map<TaskId, Granted> granted_;
  std::map<TaskId, coalition::TaskStatus> done_;
  std::map<SiteId, LedSite> led_;
  std::vector<SentCommand> commands_;
  std::map<SiteId, std::string> withdrawn_;  ///< and by whom
  std::uint64_t last_command_ = 0;
  bool watching_ = false;
  Instant next_repeat_ = Instant::max();  ///< of the authorisations
  std::set<EventKey> seen_events_;
  BoundedQueue<Message> messages_{256};
  BoundedQueue<MissionEvent> events_{4096};
};

}  // namespace skein::mission
