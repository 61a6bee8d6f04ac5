// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include "vehicle_agent_impl.hpp"

namespace skein::mission {
namespace {
/// The decision must be there this long before the first gate, so that it reaches every member.
constexpr Duration kDecisionMargin = std::chrono::seconds{2};
constexpr Duration kRequestPeriod = std::chrono::seconds{1};
constexpr Duration kSurveyLead = std::chrono::milliseconds{200};
constexpr std::size_t kSitesWaitingMax = 16;

/// "exact: J 1.7312, proven" or "colony: J 1.7312, at most 0.0040 below the optimum".
std::string summary_of(const planning::Allocation& allocation) {
  std::array<char, 96> text{};
  const std::string_view method = planning::to_string(allocation.method);
  const int length =
      std::snprintf(text.data(), text.size(), "%.*s: J %.4f, ", static_cast<int>(method.size()),
                    method.data(), allocation.value.total);
  if (allocation.proven) return std::string{text.data()} + "proven";
  std::snprintf(text.data() + length, text.size() - static_cast<std::size_t>(length),
                "at most %.4f below the optimum", allocation.gap());
  return text.data();
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

void VehicleAgent::Impl::on_site_report(const SiteReport& message, Instant now) {
  if (message.finder != config_.vehicle.id || !known_.insert(message.site.id).second) return;
  const double range = (message.site.position - state_.position().horizontal()).norm();
  report(EventKind::site_detected, {}, {message.site.id, TaskKind::survey, 0}, range, {}, now);
  if (found_.size() < kSitesWaitingMax) found_.push_back(message.site);
}

void VehicleAgent::Impl::take_up_site(Instant now) {
  if (duplicate_id_) return;
  if (!surveyed_.empty()) {
    const Site site = surveyed_.front();
    surveyed_.erase(surveyed_.begin());
    lead(site, now);
    return;
  }
  if (found_.empty()) return;
  const Site site = found_.front();
  found_.erase(found_.begin());
  const Instant start = now + kSurveyLead;
  const auto plan = planning::plan_survey(config_.planning, config_.vehicle, flight_.pose_at(start),
                                          start, site, hazards_);
  const TaskId task{site.id, TaskKind::survey, 0};
  // It goes on circling the site on the survey's own arc while it leads.
  if (!plan ||
      !flight_.continue_with(start, plan->timed.path, plan->timed.tail_curvature_per_m, now)) {
    report(EventKind::task_failed, {}, task, 0.0,
           plan ? "the path has too many pieces" : plan.error().message, now);
    return;
  }
  survey_ = SurveyFlight{site, *plan};
}

void VehicleAgent::Impl::fly_survey(Instant now) {
  const TaskId task{survey_->site.id, TaskKind::survey, 0};
  if (!survey_->begun && now >= survey_->begin_time()) {
    survey_->begun = true;
    report(EventKind::survey_started, {}, task, 0.0, {}, survey_->begin_time());
  }
  if (!survey_->begun || now < survey_->end_time()) return;
  const auto survey = *std::exchange(survey_, std::nullopt);
  if (!on_track(survey.plan.timed)) {
    report(EventKind::task_failed, {}, task, 0.0, "off the planned path", now);
    found_.push_back(survey.site);
    return;
  }
  report(EventKind::survey_done, {}, task, to_seconds(survey.begin_time()), {}, survey.end_time());
  lead(survey.site, now);
}

void VehicleAgent::Impl::lead(const Site& site, Instant now) {
  if (site.tasks_after_survey().empty()) {
    report(EventKind::site_done, {}, {site.id, TaskKind::survey, 0}, 0.0, {}, now);
    return;
  }
  const coalition::CoalitionId id{config_.vehicle.id, config_.instance, ++coalitions_led_};
  initiator_.emplace(config_.protocol, id, site,
                     flight_.pose_at(now + config_.protocol.formation_time()).position(), now);
  report(EventKind::announced, initiator_->round(), {site.id, {}, 0},
         static_cast<double>(initiator_->announcement().tasks.size()), {}, now);
}

void VehicleAgent::Impl::answer(const Initiator::Output& output, Instant now) {
  const SiteId site = initiator_->site().id;
  if (const auto* wanted = std::get_if<Initiator::AllocationWanted>(&output)) {
    request_allocation(*wanted);
  } else if (const auto* formed = std::get_if<Initiator::Formed>(&output)) {
    std::set<VehicleId> vehicles{config_.vehicle.id};
    for (const auto& a : formed->assignments) vehicles.insert(a.vehicle);
    report(EventKind::coalition_formed, formed->round, {site, {}, 0},
           static_cast<double>(vehicles.size()), {}, now);
    request_authorisation(*formed, now);
  } else if (const auto* failed = std::get_if<Initiator::NotFormed>(&output)) {
    request_.reset();
    const bool waits = initiator_->state() == Initiator::State::monitoring;
    report(waits ? EventKind::monitoring : EventKind::announced, failed->round, {site, {}, 0},
           static_cast<double>(initiator_->announcement().tasks.size()), failed->why, now);
  } else if (const auto* lost = std::get_if<Initiator::TaskLost>(&output)) {
    report(EventKind::warning, lost->round, lost->assignment.task, 0.0,
           lost->why + ": vehicle " + std::to_string(lost->assignment.vehicle.value), now);
  } else if (const auto* unknown = std::get_if<Initiator::TaskUnknown>(&output)) {
    report(EventKind::warning, unknown->round, unknown->assignment.task, 0.0,
           "may have been flown: vehicle " + std::to_string(unknown->assignment.vehicle.value) +
               " fell silent; the operator must look",
           now);
  } else if (std::holds_alternative<Initiator::AllDone>(output)) {
    report(EventKind::site_done, initiator_->round(), {site, {}, 0}, 0.0, {}, now);
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
    report(EventKind::allocation_done, result.round, about, to_seconds(result.took),
           std::to_string(bids_.size()) + " bids; " + summary_of(*result.allocation), now);
    report(EventKind::awarded, result.round, about, static_cast<double>(assignments.size()), {},
           now);
    initiator_->allocated(result.round, assignments, now);
  } else {
    const auto& why = result.allocation.error().message;
    report(EventKind::allocation_failed, result.round, about, static_cast<double>(bids_.size()),
           why, now);
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
  report(EventKind::authorisation_requested, formed.round, {site.id, TaskKind::deliver, 0},
         to_seconds(request.decide_by), {}, now);
  request_ = std::move(request);
  request_again_ = now;
}

void VehicleAgent::Impl::watch_authorisation(Instant now) {
  if (!request_) return;
  if (now >= request_->decide_by) {
    const auto late = *std::exchange(request_, std::nullopt);
    report(EventKind::authorisation_late, late.round, {late.site, TaskKind::deliver, 0}, 0.0,
           "no decision: the plan is timed anew", now);
    initiator_->announce_again("no decision of the operator in time", now);
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
  if (now >= other.bids_until) return;
  const auto& own = initiator_->announcement();
  const bool yields =
      own.reward < other.reward ||
      (own.reward == other.reward && config_.vehicle.id > other.round.coalition.leader);
  if (!yields) return;
  report(EventKind::conflict_yielded, own.round, {own.site.id, {}, 0}, own.reward,
         "to vehicle " + std::to_string(other.round.coalition.leader.value), now);
  surveyed_.push_back(own.site);
  initiator_->close("yields to a larger reward", now);
  stop_leading(now);
}

void VehicleAgent::Impl::stop_leading(Instant now) {
  // Its last words: cancels and releases.
  while (initiator_) {
    const auto message = initiator_->poll_message();
    if (!message) break;
    send(*message, now);
  }
  initiator_.reset();
  request_.reset();
}

}  // namespace skein::mission
