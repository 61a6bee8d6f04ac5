// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "vehicle_agent_impl.hpp"

namespace skein::mission {
namespace {
/// The decision must be there this long before the first gate, so that it reaches every member.
constexpr Duration kDecisionMargin = std::chrono::seconds{2};
constexpr Duration kRequestPeriod = std::chrono::seconds{1};
constexpr Duration kSurveyLead = std::chrono::milliseconds{200};
constexpr Duration kSurveyPeriod = std::chrono::seconds{5};  ///< between attempts to plan one
constexpr std::size_t kSitesWaitingMax = 16;
constexpr int kFarewells = 5;
/// Who goes to lead a lost site goes around it at this times its planning radius at least.
constexpr Duration kReliefPeriod = std::chrono::seconds{1};  ///< between two looks for such sites
constexpr double kReliefRadiusFactor = 1.2;

/// Of things of which there are few.
template <class Container>
std::uint8_t count_of(const Container& some) {
  return static_cast<std::uint8_t>(std::min<std::size_t>(some.size(), 255));
}

/// Of the lots that a plan may need: another for every round, the same in every replay.
std::uint64_t seed_of(const coalition::Round& round) {
  const std::uint64_t coalition =
      (std::uint64_t{round.coalition.leader.value} << 32U) | round.coalition.number;
  return (coalition << 8U) ^ round.number;
}

Duration final_approach_time(const coalition::Bid& bid) {
  return from_seconds(bid.final_approach_m / bid.speed_mps);
}
}  // namespace

using coalition::Initiator;
using coalition::Reason;
using event::TaskFailure;

void VehicleAgent::Impl::on_site_report(const SiteReport& message, Instant now) {
  if (message.finder != config_.vehicle.id || !known_.insert(message.site.id).second) return;
  const double range = (message.site.position - state_.position().horizontal()).norm();
  report(event::SiteDetected{range}, {}, {message.site.id, TaskKind::survey, 0}, now);
  if (found_.size() < kSitesWaitingMax) found_.push_back({message.site});
}

void VehicleAgent::Impl::take_up_site(Instant now) {
  if (failsafe_.in(Failsafe::Action::take_up_nothing)) return;
  if (!surveyed_.empty()) {
    const Site site = surveyed_.front();
    surveyed_.erase(surveyed_.begin());
    lead(site, sites_.over(site.id), now);
    return;
  }
  if (found_.empty() || now < survey_again_) return;
  survey_again_ = now + kSurveyPeriod;
  for (auto& found : found_) {
    const auto outcome = fly_around(found.site, false, now);
    if (const auto* survey = std::get_if<SurveyFlight>(&outcome)) {
      survey_ = *survey;
      survey_again_ = now;
      std::erase_if(found_, [&](const FoundSite& f) { return f.site.id == survey_->site.id; });
      return;
    }
    // It may become possible: from elsewhere, or with other hazards known.
    if (!std::exchange(found.told, true)) {
      report(std::get<event::TaskFailed>(outcome), {}, {found.site.id, TaskKind::survey, 0}, now);
    }
  }
}

/// The flight to a site and around it, for its survey or (`relief`) to lead there, is the flight
/// plan from now on. It goes on circling the site on the same arc.
std::variant<SurveyFlight, event::TaskFailed> VehicleAgent::Impl::fly_around(const Site& site,
                                                                             bool relief,
                                                                             Instant now) {
  const Instant start = now + kSurveyLead;
  VehicleSpec vehicle = config_.vehicle;
  if (relief) {  // at any radius that it can fly
    vehicle.sensor_radius_m =
        std::max(vehicle.sensor_radius_m, kReliefRadiusFactor * vehicle.planning_radius_m());
  }
  const auto plan = planning::plan_survey(config_.planning, vehicle, flight_.pose_at(start), start,
                                          site, hazards_);
  if (!plan) return event::TaskFailed{TaskFailure::no_plan, {}, plan.error().message};
  const Path& path = plan->timed.path;
  // Who is to lead there must also have the range to stay for some time.
  const double stay_m = relief ? path.length_m() : 0.0;
  if (path.length_m() + stay_m + flight_.way_home_m(path.end(), hazards_) > range_to_spend(start)) {
    return event::TaskFailed{TaskFailure::out_of_range};
  }
  if (!flight_.continue_with(start, path, plan->timed.tail_curvature_per_m, now)) {
    return event::TaskFailed{TaskFailure::path_too_long};
  }
  return SurveyFlight{site, *plan, relief};
}

/// The stagger lets one of several free vehicles go first; its announcement calls the others off.
Instant VehicleAgent::Impl::unheard_since(Instant now) const {
  constexpr Duration kStagger = std::chrono::seconds{2};
  constexpr int kRanks = 8;
  return now - config_.protocol.cut_max - config_.vehicle.id.value % kRanks * kStagger;
}

void VehicleAgent::Impl::take_up_lost_site(Instant now) {
  if (failsafe_.in(Failsafe::Action::take_up_nothing) || now < relief_again_) return;
  relief_again_ = now + kReliefPeriod;
  for (const auto* lost : sites_.lost(unheard_since(now))) {
    const auto outcome = fly_around(lost->site, true, now);
    const auto* relief = std::get_if<SurveyFlight>(&outcome);
    if (relief == nullptr) continue;
    report(event::ReliefBegun{lost->heard_at}, {}, {lost->site.id, {}, 0}, now);
    survey_ = *relief;
    return;
  }
}

void VehicleAgent::Impl::fly_to_lost_site(Instant now) {
  const auto* lost = sites_.lost(survey_->site.id, unheard_since(now));
  if (lost == nullptr) {  // its leader was heard, or nothing is left to do
    survey_.reset();
    search(now);
  } else if (now >= survey_->begin_time() + config_.protocol.silence) {  // it has listened there
    survey_.reset();
    lead(lost->site, lost->over, now);
  }
}

void VehicleAgent::Impl::fly_survey(Instant now) {
  if (survey_->relief) {
    fly_to_lost_site(now);
    return;
  }
  const TaskId task{survey_->site.id, TaskKind::survey, 0};
  if (!survey_->begun && now >= survey_->begin_time()) {
    survey_->begun = true;
    report(event::SurveyStarted{survey_->begin_time()}, {}, task, survey_->begin_time());
  }
  if (!survey_->begun || now < survey_->end_time()) return;
  const auto survey = *std::exchange(survey_, std::nullopt);
  if (!on_track(survey.plan.timed)) {
    report(event::TaskFailed{TaskFailure::off_path}, {}, task, now);
    found_.push_back({survey.site});
    return;
  }
  report(event::SurveyDone{survey.begin_time()}, {}, task, survey.end_time());
  if (sites_.led(survey.site.id, now - config_.protocol.cut_max)) return;
  lead(survey.site, {}, now);
}

void VehicleAgent::Impl::lead(const Site& site, const std::vector<TaskId>& done, Instant now) {
  if (tasks_after_survey(site).empty()) {
    report(event::SiteDone{}, {}, {site.id, TaskKind::survey, 0}, now);
    return;
  }
  initiator_.emplace(config_.protocol, next_coalition(), site, done,
                     flight_.pose_at(now + config_.protocol.formation_time()).position(), now);
  report(event::Announced{count_of(initiator_->announcement().tasks), {}}, initiator_->round(),
         {site.id, {}, 0}, now);
}

void VehicleAgent::Impl::end_closed_site(const coalition::LeaseRenewal& last, Instant now) {
  const bool other = initiator_ && initiator_->site().id == last.site &&
                     initiator_->round().coalition != last.round.coalition;
  if (!other) return;
  initiator_->close({Reason::site_done}, now);
  stop_leading(now);
}

coalition::CoalitionId VehicleAgent::Impl::next_coalition() {
  return {config_.vehicle.id, config_.instance, ++coalitions_led_};
}

void VehicleAgent::Impl::take_over(const coalition::Participant::LeadershipWon& won, Instant now) {
  if (initiator_) return;
  const bool authorised =
      std::find(granted_.begin(), granted_.end(), won.plan.round) != granted_.end();
  initiator_.emplace(config_.protocol, next_coalition(), won, authorised,
                     flight_.pose_at(now + config_.protocol.formation_time()).position(), now);
  const VehicleId lost = won.plan.round.coalition.leader;
  report(event::LeaderReplaced{lost, count_of(won.supporters)}, initiator_->round(),
         {won.plan.site.id, {}, 0}, now);
}

void VehicleAgent::Impl::meet_rival(SiteId site, const coalition::Round& rival, bool stands,
                                    Instant now) {
  if (initiator_ && initiator_->site().id == site) initiator_->on_rival(rival, stands, now);
  std::erase_if(surveyed_, [site](const Site& s) { return s.id == site; });
}

void VehicleAgent::Impl::answer(const Initiator::Output& output, Instant now) {
  const SiteId site = initiator_->site().id;
  if (const auto* wanted = std::get_if<Initiator::AllocationWanted>(&output)) {
    request_allocation(*wanted);
  } else if (const auto* formed = std::get_if<Initiator::Formed>(&output)) {
    std::set<VehicleId> vehicles{config_.vehicle.id};
    for (const auto& a : formed->assignments) vehicles.insert(a.vehicle);
    report(event::CoalitionFormed{count_of(vehicles)}, formed->round, {site, {}, 0}, now);
    request_authorisation(*formed, now);
  } else if (const auto* failed = std::get_if<Initiator::NotFormed>(&output)) {
    request_.reset();
    const bool waits = initiator_->state() == Initiator::State::monitoring;
    const std::uint8_t tasks = count_of(initiator_->announcement().tasks);
    report(waits ? EventBody{event::Monitoring{tasks, failed->why}}
                 : EventBody{event::Announced{tasks, failed->why}},
           failed->round, {site, {}, 0}, now);
  } else if (const auto* lost = std::get_if<Initiator::TaskLost>(&output)) {
    report(event::TaskLost{{lost->why, lost->assignment.vehicle}}, lost->round,
           lost->assignment.task, now);
  } else if (const auto* unknown = std::get_if<Initiator::TaskUnknown>(&output)) {
    report(event::TaskUnknown{unknown->assignment.vehicle}, unknown->round,
           unknown->assignment.task, now);
  } else if (const auto* superseded = std::get_if<Initiator::Superseded>(&output)) {
    report(event::ConflictYielded{superseded->by.leader, 0.0, true}, superseded->round,
           {site, {}, 0}, now);
    pump(now);  // its last messages
    stop_leading(now);
  } else if (std::holds_alternative<Initiator::AllDone>(output)) {
    report(event::SiteDone{count_of(tasks_after_survey(initiator_->site()))}, initiator_->round(),
           {site, {}, 0}, now);
    farewells_.push_back({initiator_->farewell(), now, kFarewells});
    if (farewells_.size() > kSitesWaitingMax) farewells_.erase(farewells_.begin());
    pump(now);  // its last messages
    stop_leading(now);
  }
}

void VehicleAgent::Impl::request_allocation(const Initiator::AllocationWanted& wanted) {
  PlanningRequest request;
  request.round = wanted.round;
  request.answer_by = wanted.answer_by;
  request.params = config_.planning;
  auto& problem = request.problem;
  problem.site = initiator_->site();
  problem.open_tasks = wanted.tasks;
  problem.seed = seed_of(wanted.round);
  problem.hazards = hazards_;
  problem.start = wanted.formed_at;
  Duration approach{};
  for (const auto& bid : wanted.bids) approach = std::max(approach, final_approach_time(bid));
  problem.earliest_delivery =
      wanted.formed_at + config_.protocol.authorisation_lead + kDecisionMargin + approach;
  // A task that is open in this round is not owned, so this looks at deliveries of others only.
  problem.deliveries_done = initiator_->last_delivery().value_or(Instant{});
  bids_.clear();
  for (const auto& bid : wanted.bids) {
    bids_.emplace(bid.bidder, bid);
    problem.candidates.push_back({bid.bidder, bid.pose_at_formation, bid.speed_mps,
                                  bid.planning_radius_m, bid.range_left_m, bid.final_approach_m,
                                  bid.assess_radius_m, bid.capabilities, bid.loads});
  }
  planning_requests.push(std::move(request));
}

void VehicleAgent::Impl::on_planning_result(const PlanningResult& result, Instant now) {
  if (!initiator_ || result.round != initiator_->round()) return;
  const TaskId about{initiator_->site().id, {}, 0};
  if (result.allocation) {
    const auto& assignments = result.allocation->assignments;
    const planning::Allocation& made = *result.allocation;
    report(event::AllocationDone{result.took, count_of(bids_), made.method, made.value.total,
                                 made.proven, made.proven ? 0.0 : made.gap()},
           result.round, about, now);
    initiator_->allocated(result.round, assignments, now);
    if (initiator_->state() == Initiator::State::awarding) {
      report(event::Awarded{count_of(assignments)}, result.round, about, now);
    }
  } else {
    const auto& why = result.allocation.error().message;
    report(event::AllocationFailed{count_of(bids_), why}, result.round, about, now);
    initiator_->allocation_failed(result.round, why, now);
  }
  step(now);
}

void VehicleAgent::Impl::request_authorisation(const Initiator::Formed& formed, Instant now) {
  const auto& site = initiator_->site();
  AuthorisationRequest request{formed.round, site.id, site.position, {}, Instant::max()};
  for (const auto& a : formed.assignments) {
    if (a.task.kind != TaskKind::deliver) continue;
    request.deliveries.push_back({a, site.deliveries.at(a.task.index).bearing_rad});
    const auto bid = bids_.find(a.vehicle);
    if (bid == bids_.end()) continue;
    request.decide_by =
        std::min(request.decide_by, a.time - final_approach_time(bid->second) - kDecisionMargin);
  }
  if (request.deliveries.empty()) return;
  report(event::AuthorisationRequested{request.decide_by}, formed.round,
         {site.id, TaskKind::deliver, 0}, now);
  request_ = std::move(request);
  request_again_ = now;
}

void VehicleAgent::Impl::watch_authorisation(Instant now) {
  if (!request_) return;
  if (now >= request_->decide_by) {
    const auto late = *std::exchange(request_, std::nullopt);
    report(event::AuthorisationLate{event::Lateness::no_decision}, late.round,
           {late.site, TaskKind::deliver, 0}, now);
    initiator_->announce_again(Reason::no_decision, now);
    pump(now);
  } else if (now >= request_again_) {
    messages.push(Message{*request_});
    request_again_ = now + kRequestPeriod;
  }
}

/// Two leaders announce at once: the one with the smaller reward, then the higher id, bids for the
/// other and keeps its own site for later (Wang 2022, protocol step 2).
void VehicleAgent::Impl::yield_to(const coalition::Announcement& other, Instant now) {
  if (!initiator_ || other.round.coalition == initiator_->round().coalition) return;
  if (initiator_->state() != Initiator::State::announcing || !initiator_->owned().empty()) return;
  if (now >= other.bids_until + config_.protocol.clock_guard) return;
  const auto& own = initiator_->announcement();
  if (other.site.id == own.site.id) return;  // a rival: Initiator::on_rival
  const bool yields =
      own.reward < other.reward ||
      (own.reward == other.reward && config_.vehicle.id > other.round.coalition.leader);
  if (!yields) return;
  report(event::ConflictYielded{other.round.coalition.leader, own.reward, false}, own.round,
         {own.site.id, {}, 0}, now);
  surveyed_.push_back(own.site);
  initiator_->close({Reason::yields}, now);
  stop_leading(now);
}

/// The end of a coalition is said several times, and again to whoever announces its site.
void VehicleAgent::Impl::say_farewell(Instant now) {
  for (auto& farewell : farewells_) {
    if (farewell.times == 0 || now < farewell.next) continue;
    --farewell.times;
    farewell.next = now + config_.protocol.heartbeat;
    messages.push(Message{coalition::Message{farewell.last}});
  }
}

void VehicleAgent::Impl::stop_leading(Instant now) {
  // Its last words: cancels and releases.
  while (initiator_) {
    const auto message = initiator_->poll_message();
    if (!message) break;
    send(*message, now);
  }
  if (initiator_) protocol_errors_led_ += initiator_->protocol_errors();
  initiator_.reset();
  request_.reset();
}

}  // namespace skein::mission
