// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "failsafe.hpp"
#include "flight.hpp"
#include "site_book.hpp"
#include "skein/base/bounded_queue.hpp"
#include "skein/coalition/initiator.hpp"
#include "skein/coalition/participant.hpp"
#include "skein/mission/vehicle_agent.hpp"
#include "take_off.hpp"
#include "task_flight.hpp"

namespace skein::mission {

/// The parts of the agent and their wiring. Sources: vehicle_agent_routing.cpp (inputs to parts and
/// back), vehicle_agent_member.cpp (bids, awards, flying tasks), vehicle_agent_timing.cpp (a task's
/// time in wind), vehicle_agent_leader.cpp (sites,
/// surveys, leading).
class VehicleAgent::Impl {
 public:
  Impl(const VehicleAgentConfig& config, Instant now);

  [[nodiscard]] static bool is_there(const TimedPath& route, const VehicleState& state);
  void on_state(const VehicleState& state, Instant now);
  void on_message(const Message& message, VehicleId sender, Instant now);
  void on_planning_result(const PlanningResult& result, Instant now);
  void on_timeout(Instant now);
  [[nodiscard]] std::optional<Guidance> poll_guidance();
  [[nodiscard]] Instant next_timeout() const;
  [[nodiscard]] Telemetry telemetry() const;
  [[nodiscard]] Activity activity() const;
  [[nodiscard]] Counters counters() const;

  BoundedQueue<Message> messages{256};
  BoundedQueue<MissionEvent> events{1024};
  BoundedQueue<PlanningRequest> planning_requests{4};

 private:
  // Routing: everything that came in is worked off before a call returns.
  void step(Instant now);
  void pump(Instant now);
  void send(const coalition::Message& message, Instant now);
  void receive(const coalition::Message& message, Instant now);
  void report(EventBody body, const coalition::Round& round, const TaskId& task, Instant time);

  // Member: answers what the participant asks, and flies what was awarded.
  void answer(const coalition::Participant::Output& output, Instant now);
  void answer_bid_wanted(const coalition::Announcement& announcement, Instant now);
  [[nodiscard]] std::variant<coalition::Bid, coalition::Reason> make_bid(
      const coalition::Announcement& announcement, Instant now) const;
  void answer_award(const coalition::Participant::AwardReceived& award, Instant now);
  [[nodiscard]] std::variant<TaskFlight, coalition::Why> set_out(TaskFlight task, double speed_mps,
                                                                 Instant start, Instant now);
  void keep_time(Instant now);
  [[nodiscard]] std::optional<double> speed_for(const TaskFlight& task, double along_m,
                                                Instant start) const;
  void fly_task(Instant now);
  void commit_delivery(Instant now);
  void begin_task(Instant now);
  void end_task(Instant now);
  void drop_task(Instant now);
  void on_authorisation(const Authorisation& message, Instant now);
  void on_command(const Command& message, Instant now);
  void on_hazard(const Hazard& hazard, Instant now);
  void idle(Instant now);
  void search(Instant now);
  void note(bool Failsafe::Facts::*fact, bool holds);
  [[nodiscard]] bool comes_home() const;
  void watch_range(Instant now);
  void hand_on_lead(Instant now);

  // Leader: surveys what was found and sees its tasks done.
  void on_site_report(const SiteReport& message, Instant now);
  void take_up_site(Instant now);
  void fly_survey(Instant now);
  void take_up_lost_site(Instant now);
  [[nodiscard]] std::variant<SurveyFlight, event::TaskFailed> fly_around(const Site& site,
                                                                         bool relief, Instant now);
  void fly_to_lost_site(Instant now);
  [[nodiscard]] Instant unheard_since(Instant now) const;
  void lead(const Site& site, const std::vector<TaskId>& done, Instant now);
  void take_over(const coalition::Participant::LeadershipWon& won, Instant now);
  void meet_rival(SiteId site, const coalition::Round& rival, bool stands, Instant now);
  void end_closed_site(const coalition::LeaseRenewal& last, Instant now);
  [[nodiscard]] coalition::CoalitionId next_coalition();
  void answer(const coalition::Initiator::Output& output, Instant now);
  void request_allocation(const coalition::Initiator::AllocationWanted& wanted);
  void request_authorisation(const coalition::Initiator::Formed& formed, Instant now);
  void watch_authorisation(Instant now);
  void yield_to(const coalition::Announcement& other, Instant now);
  void say_farewell(Instant now);
  void stop_leading(Instant now);

  [[nodiscard]] bool deliveries_over(const TaskFlight& assessment) const;
  [[nodiscard]] bool on_track(const TimedPath& timed) const;
  [[nodiscard]] planning::Candidate candidate(const Pose2& pose, Instant at) const;
  [[nodiscard]] double range_left(Instant at) const;
  [[nodiscard]] double range_for(const Site& site, Instant at) const;
  [[nodiscard]] double range_to_spend(Instant at) const;
  [[nodiscard]] double spare_range(Instant now) const;

  VehicleAgentConfig config_;
  std::uint32_t last_command_ = 0;
  std::uint32_t coalitions_led_ = 0;
  std::uint8_t loads_ = 0;
  Failsafe::Facts facts_;
  Failsafe failsafe_;  ///< of facts_: see note()
  VehicleState state_;
  TakeOff take_off_;
  Flight flight_;
  std::vector<Hazard> hazards_;
  Instant range_again_{};  ///< when its range is looked at next

  coalition::Participant participant_;
  std::optional<TaskFlight> task_;
  Instant time_again_{};  ///< when the task's time is looked at next

  Instant survey_again_{};
  std::optional<SurveyFlight> survey_;
  std::vector<Site> surveyed_;  ///< surveyed here, waiting to be led
  struct FoundSite {
    Site site;
    bool told = false;  ///< that it cannot be surveyed now
  };
  std::vector<FoundSite> found_;  ///< found here, waiting to be surveyed
  std::set<SiteId> known_;        ///< found or announced by anybody
  SiteBook sites_;                ///< as others lead them
  std::optional<coalition::Initiator> initiator_;
  struct Farewell {
    coalition::LeaseRenewal last;
    Instant next{};
    int times = 0;  ///< still to be said
  };
  std::vector<Farewell> farewells_;  ///< of the coalitions that were led here to the end
  Instant relief_again_{};
  std::uint64_t protocol_errors_led_ = 0;  ///< of coalitions that were led here before
  std::vector<coalition::Round> granted_;  ///< rounds that the operator has authorised, newest last
  std::map<VehicleId, coalition::Bid> bids_;  ///< of the round being allocated or flown

  /// The request that awaits the operator's decision.
  std::optional<AuthorisationRequest> request_;
  Instant request_again_{};
};

}  // namespace skein::mission
