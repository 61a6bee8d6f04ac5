// SPDX-License-Identifier: Apache-2.0
#include "skein/console/picture.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

#include "news_delay.hpp"
#include "skein/base/overloaded.hpp"
#include "skein/mission/ground_agent.hpp"
#include "skein/mission/told_by.hpp"

namespace skein::console {
namespace {

constexpr Duration kDelayWindow = std::chrono::seconds{10};

/// Newer knowledge of a task never makes it less done.
int rank(const std::optional<coalition::TaskState>& state) {
  using enum coalition::TaskState;
  if (!state) return 0;
  switch (*state) {
    case planned:
      return 1;
    case started:
      return 2;
    case failed:
      return 3;
    case unknown:
      return 4;
    case done:
    case count:
      break;
  }
  return 5;
}

/// At that moment it was heard that nobody has it any more.
void reopen(TaskPicture& task, Instant now) {
  task = {};
  task.told_at = now;
}

void advance(TaskPicture& task, coalition::TaskState state, Instant now) {
  if (rank(state) < rank(task.state)) return;
  if (task.state != state) task.told_at = now;
  task.state = state;
}

/// What that vehicle says of a task of that round is of the task as it stands, and no late copy of
/// what became of it in other hands or in a plan before.
bool is_of(const TaskPicture& task, VehicleId vehicle, const coalition::Round& round) {
  const bool older = task.round.coalition == round.coalition && round.number < task.round.number;
  return (!task.vehicle || task.vehicle == vehicle) && !older;
}

/// What it has not begun can be taken back.
bool can_be_taken_back(const TaskPicture& task) {
  return task.vehicle && task.state == coalition::TaskState::planned;
}

/// An older release does not tell which task it has.
bool tells_task(const mission::Telemetry& telemetry) {
  return telemetry.task.site != SiteId{} || telemetry.activity != mission::Activity::executing;
}

}  // namespace

std::string_view to_string(CoalitionState state) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(CoalitionState::count)>
      kNames{"announced", "awarded", "formed", "failed", "closed"};
  return kNames.at(static_cast<std::size_t>(state));
}

Picture::Picture(PictureParams params) : params_{std::move(params)}, fence_{params_.fence} {
  for (const VehicleId id : params_.expected) vehicles_[id];
  for (const Hazard& hazard : params_.hazards) hazards_[hazard.id] = hazard;
}

bool Picture::is_known(VehicleId sender) const {
  return sender == kGroundStation || vehicles_.contains(sender) ||
         vehicles_.size() < params_.vehicles_max;
}

void Picture::on_message(const mission::Message& message, VehicleId sender, Instant now) {
  // What vehicles pass on the ground station has said itself.
  if (!is_known(sender) || mission::told_by(message) != kGroundStation) return;
  heard_at_ = now;
  std::visit(Overloaded{[&](const mission::Telemetry& m) {
                          if (m.vehicle == sender) on(m, now);
                        },
                        [&](const mission::PlanReport& m) {
                          if (m.vehicle == sender) vehicles_[m.vehicle].plan = m;
                        },
                        [&](const mission::AuthorisationRequest& m) { on(m, now); },
                        [&](const mission::Authorisation& m) { on(m); },
                        [&](const mission::SiteReport& m) { on(m); },
                        [&](const mission::HazardReport& m) {
                          if (m.withdrawn) {
                            hazards_.erase(m.hazard.id);
                          } else if (hazards_.size() < params_.hazards_max) {
                            hazards_[m.hazard.id] = m.hazard;
                          }
                        },
                        [&](const formation::Change& m) {
                          if (sender != kGroundStation || !formation::valid(m)) return;
                          if (formation_.change && formation_.change->number == m.number) return;
                          formation_.change = m;
                          formation_.change_ends = m.start + formation::ChangeMotion{m}.duration();
                        },
                        [&](const mission::FormationStatus& m) {
                          if (m.vehicle == sender) formation_.members[m.vehicle] = {m, now};
                        },
                        [&](const coalition::Message& m) {
                          std::visit(Overloaded{[&](const coalition::LeadershipClaim&) {},
                                                [&](const coalition::Allegiance&) {},
                                                [&](const auto& said) { on(said); }},
                                     m);
                        },
                        [](const mission::MissionEvent&) {},
                        [](const mission::Command&) {},
                        [](const mission::Health&) {},
                        [](const mission::Setup&) {},
                        [](const mission::Detection&) {},
                        [](const mission::Route&) {},
                        [](const mission::RouteStatus&) {},
                        [](const mission::Preflight&) {},
                        [](const mission::ReturnFlight&) {},
                        [&](const mission::FenceOrder& m) {
                          if (m.number <= fence_order_) return;
                          fence_order_ = m.number;
                          fence_ = {m.corners, m.height_max_m};
                        },
                        [&](const mission::Traffic& m) {
                          if (sender == kGroundStation && !hears_traffic_) on(m);
                        },
                        [&](const mission::TrackFlight& m) {
                          if (sender != kGroundStation || !vehicles_.contains(m.vehicle)) return;
                          formation_.flights[m.vehicle] = {m.number, m.joined};
                        }},
             message);
}

void Picture::on(const mission::Telemetry& telemetry, Instant now) {
  VehiclePicture& vehicle = vehicles_[telemetry.vehicle];
  const Duration delay = now - telemetry.state.time;
  if (!vehicle.first_at) vehicle.first_at = Vec2{telemetry.state.x_m, telemetry.state.y_m};
  vehicle.delays.emplace_back(now, delay);
  while (now - vehicle.delays.front().first > kDelayWindow) vehicle.delays.pop_front();
  if (vehicle.series.empty() || now - vehicle.series.back().time >= params_.series_period) {
    const VehicleState& s = telemetry.state;
    vehicle.series.push_back(
        {now, s.x_m, s.y_m, s.z_m, s.groundspeed_mps, telemetry.range_left_m, delay});
    if (vehicle.series.size() > params_.series_max) vehicle.series.pop_front();
  }
  wind_.on_telemetry(telemetry, now);
  note_own_word(telemetry);
  note_declined(telemetry);
  note_span(vehicle, telemetry, now);
}

void Picture::note_span(VehiclePicture& vehicle, const mission::Telemetry& telemetry,
                        Instant now) const {
  const auto state = mission::shown_state(telemetry.activity, telemetry.detail);
  const auto task = told_task(telemetry);
  const auto site = task ? std::optional{task->first.site} : std::nullopt;
  const auto begin = [&](mission::ShownState next, Instant from, std::optional<SiteId> where) {
    if (vehicle.spans.size() >= params_.spans_max) vehicle.spans.erase(vehicle.spans.begin());
    vehicle.spans.push_back({next, from, where});
  };
  // What it did while it was not heard is not known.
  const bool was_silent = vehicle.heard_at && now >= *vehicle.heard_at + params_.silence;
  if (was_silent) begin(mission::ShownState::silent, *vehicle.heard_at, std::nullopt);
  vehicle.heard_at = now;
  if (vehicle.spans.empty() || vehicle.spans.back().state != state) {
    begin(state, now, site);
  } else if (!vehicle.spans.back().site) {
    vehicle.spans.back().site = site;
  }
}

/// In the end the vehicles' own words count, whatever else was heard: an award or its end may not
/// have been.
void Picture::note_own_word(const mission::Telemetry& telemetry) {
  if (!tells_task(telemetry)) return;
  const auto is_old = [&](const TaskPicture& known) {
    return heard_at_ - known.told_at > kNewsMayTake;
  };
  const bool names_one = telemetry.task.site != SiteId{} && telemetry.task.kind != TaskKind::survey;
  SitePicture* const of = names_one ? site_of(telemetry.task.site) : nullptr;
  if (of != nullptr && !of->over()) {
    TaskPicture& told = of->tasks[telemetry.task];
    const bool nobody = !told.vehicle && !told.state;
    const bool another = told.vehicle != telemetry.vehicle &&
                         told.state != coalition::TaskState::done && is_old(told);
    const bool again = told.state == coalition::TaskState::failed && is_old(told);
    if (nobody || another || again) {
      reopen(told, heard_at_);
      told.vehicle = telemetry.vehicle;
      told.state = coalition::TaskState::planned;
    }
  }
  for (auto& [id, site] : sites_) {
    for (auto& [task, known] : site.tasks) {
      if (known.vehicle != telemetry.vehicle) continue;
      if (task == telemetry.task) {
        known.held = true;
        if (known.state != coalition::TaskState::failed) known.told_at = heard_at_;
      } else if ((known.held || is_old(known)) && can_be_taken_back(known)) {
        reopen(known, heard_at_);
      } else if (known.state == coalition::TaskState::started && is_old(known)) {
        advance(known, coalition::TaskState::unknown, heard_at_);
      }
    }
  }
}

void Picture::note_declined(const mission::Telemetry& telemetry) {
  const mission::DeclinedCall& declined = telemetry.declined;
  if (declined.why == coalition::Reason::none) return;
  for (auto& [id, coalition] : coalitions_) {
    if (id != declined.round.coalition) continue;
    for (RoundPicture& round : coalition.rounds) {
      const bool has_bid = std::ranges::any_of(
          round.bids, [&](const auto& bid) { return bid.bidder == telemetry.vehicle; });
      if (round.number != declined.round.number || has_bid) continue;
      round.declined[telemetry.vehicle] = {declined.why, {}, {}};
      return;
    }
  }
}

/// What was awarded in that round, and not begun.
void Picture::take_back(const coalition::Round& round, std::optional<VehicleId> only_of) {
  const auto coalition = std::ranges::find_if(
      coalitions_, [&](const auto& entry) { return entry.first == round.coalition; });
  if (coalition == coalitions_.end()) return;
  const auto site = sites_.find(coalition->second.site);
  if (site == sites_.end()) return;
  for (auto& [task, known] : site->second.tasks) {
    const bool concerned = known.round == round && (!only_of || known.vehicle == *only_of);
    if (concerned && can_be_taken_back(known)) reopen(known, heard_at_);
  }
}

void Picture::take_back_task(const TaskId& task, VehicleId of) {
  const auto site = sites_.find(task.site);
  if (site == sites_.end()) return;
  const auto known = site->second.tasks.find(task);
  if (known == site->second.tasks.end() || known->second.vehicle != of) return;
  if (can_be_taken_back(known->second)) reopen(known->second, heard_at_);
}

void Picture::on(const mission::AuthorisationRequest& request, Instant now) {
  for (auto& known : authorisations_) {
    if (known.request.round != request.round || known.request.site != request.site) continue;
    known.request = request;
    return;
  }
  for (auto& known : authorisations_) {
    const bool same = known.request.site == request.site &&
                      known.request.round.coalition == request.round.coalition;
    if (!same) continue;
    // A late copy of a plan that has been replaced.
    if (known.request.round.number > request.round.number) return;
    known.replaced = true;
  }
  authorisations_.push_back({.request = request, .asked_at = now, .decision = {}, .standing = {}});
  if (authorisations_.size() > params_.authorisations_max) authorisations_.pop_front();
}

void Picture::on(const mission::Authorisation& decision) {
  bool taken_back = false;
  for (auto& known : authorisations_) {
    if (known.request.site != decision.site) continue;
    const bool of_it = known.request.round == decision.round;
    const auto& before = known.decision;
    if (of_it && before && before->decided_at > decision.decided_at) return;  // a late copy
    known.taken_back =
        known.taken_back || (of_it && before && before->granted && !decision.granted);
    taken_back = taken_back || known.taken_back;
    if (of_it) known.decision = decision;
  }
  if (decision.granted) return;
  const auto site = sites_.find(decision.site);
  if (site == sites_.end()) return;
  site->second.refused = true;
  site->second.taken_back = site->second.taken_back || taken_back;
  for (auto& [task, known] : site->second.tasks) {
    if (can_be_taken_back(known)) reopen(known, heard_at_);
  }
}

void Picture::on_decisions(const mission::GroundAgent& agent, Instant now) {
  for (AuthorisationPicture& known : authorisations_) {
    known.standing.emplace();
    for (const mission::PendingAuthorisation& pending : agent.authorisations()) {
      if (pending.request.round != known.request.round ||
          pending.request.site != known.request.site) {
        continue;
      }
      known.standing = {!pending.decision, agent.may_be_taken_back(pending, now)};
    }
  }
}

CoalitionPicture& Picture::coalition_of(const coalition::CoalitionId& id) {
  const auto known = std::find_if(coalitions_.rbegin(), coalitions_.rend(),
                                  [&](const auto& entry) { return entry.first == id; });
  if (known != coalitions_.rend()) return known->second;
  if (coalitions_.size() >= params_.coalitions_max) coalitions_.erase(coalitions_.begin());
  auto& [key, coalition] = coalitions_.emplace_back();
  key = id;
  return coalition;
}

RoundPicture& Picture::round_of(const coalition::Round& round) {
  auto& rounds = coalition_of(round.coalition).rounds;
  const auto at = std::lower_bound(
      rounds.begin(), rounds.end(), round.number,
      [](const RoundPicture& known, std::uint32_t number) { return known.number < number; });
  if (at != rounds.end() && at->number == round.number) return *at;
  // A late word on a round that has given way is put to the oldest that is kept.
  if (at == rounds.begin() && rounds.size() >= params_.rounds_max) return rounds.front();
  RoundPicture fresh;
  fresh.number = round.number;
  const auto index = static_cast<std::size_t>(at - rounds.begin());
  rounds.insert(at, std::move(fresh));
  if (rounds.size() <= params_.rounds_max) return rounds[index];
  rounds.pop_front();
  return rounds[index - 1];
}

SitePicture* Picture::site_of(SiteId id) {
  const bool full = sites_.size() >= params_.sites_max && !sites_.contains(id);
  return full ? nullptr : &sites_[id];
}

void Picture::on(const mission::SiteReport& m) {
  know(m.site);
  SitePicture* const site = site_of(m.site.id);
  if (site == nullptr) return;
  site->withdrawn = site->withdrawn || m.withdrawn;
  if (!m.withdrawn && m.finder != VehicleId{}) site->surveyor = m.finder;
}

void Picture::know(const Site& site) {
  if (SitePicture* known = site_of(site.id)) known->site = site;
}

void Picture::on(const coalition::Announcement& m) {
  know(m.site);
  if (SitePicture* site = site_of(m.site.id)) {
    site->leader = m.round.coalition.leader;
    site->surveyed = true;  // who announces has been there
  }
  CoalitionPicture& coalition = coalition_of(m.round.coalition);
  coalition.site = m.site.id;
  RoundPicture& round = round_of(m.round);
  if (round.announcement) return;  // the ground station repeats old ones
  round.announcement = m;
  coalition.state = CoalitionState::announced;
}

void Picture::on(const coalition::Bid& m) {
  auto& bids = round_of(m.round).bids;
  const auto known = std::find_if(bids.begin(), bids.end(),
                                  [&](const auto& bid) { return bid.bidder == m.bidder; });
  if (known != bids.end()) {
    *known = m;
  } else if (bids.size() < coalition::kMembersMax) {
    bids.push_back(m);
  }
}

void Picture::on(const coalition::Award& m) {
  know(m.site);
  SitePicture* site = site_of(m.site.id);
  if (site != nullptr) site->leader = m.round.coalition.leader;
  CoalitionPicture& coalition = coalition_of(m.round.coalition);
  coalition.site = m.site.id;
  coalition.lease_until = m.lease_until;
  RoundPicture& round = round_of(m.round);
  const bool first = !round.award;
  if (first) {
    coalition.state = CoalitionState::awarded;
    coalition.why = {};
  }
  round.award = m;
  const bool newest = m.awarded_at >= coalition.members_at;
  if (newest) {
    coalition.members.clear();
    coalition.members_at = m.awarded_at;
  }
  for (const TaskAssignment& assignment : m.assignments) {
    if (newest) coalition.members.push_back(assignment.vehicle);
    if (site == nullptr) continue;
    TaskPicture& task = site->tasks[assignment.task];
    if (task.state == coalition::TaskState::done) continue;
    if (first || task.vehicle != assignment.vehicle) {
      task.state.reset();
      task.told_at = heard_at_;
    }
    task.held = task.held && task.vehicle == assignment.vehicle && task.round == m.round;
    task.round = m.round;
    task.vehicle = assignment.vehicle;
    task.time = assignment.time;
    advance(task, coalition::TaskState::planned, heard_at_);
  }
  std::sort(coalition.members.begin(), coalition.members.end());
  coalition.members.erase(std::unique(coalition.members.begin(), coalition.members.end()),
                          coalition.members.end());
}

void Picture::on(const coalition::Confirmation& m) {
  round_of(m.round).answers[m.member] = m;
  if (!m.accepted) take_back(m.round, m.member);
}

void Picture::on(const coalition::Cancel& m) {
  CoalitionPicture& coalition = coalition_of(m.round.coalition);
  round_of(m.round).cancelled = m.why;
  take_back(m.round, std::nullopt);
  if (coalition.state == CoalitionState::closed) return;
  coalition.state = CoalitionState::failed;
  coalition.why = m.why;
}

void Picture::on(const coalition::LeaseRenewal& m) {
  CoalitionPicture& coalition = coalition_of(m.round.coalition);
  coalition.site = m.site;
  coalition.lease_until = m.lease_until;
  SitePicture* site = site_of(m.site);
  if (site != nullptr) {
    for (const TaskId& task : m.done)
      advance(site->tasks[task], coalition::TaskState::done, heard_at_);
    for (const TaskId& task : m.unknown)
      advance(site->tasks[task], coalition::TaskState::unknown, heard_at_);
  }
  if (m.closed) {
    coalition.state = CoalitionState::closed;
    return;
  }
  if (site != nullptr) site->leader = m.round.coalition.leader;
  if (stands(m) && !m.members.empty() && m.sent_at >= coalition.members_at) {
    coalition.members_at = m.sent_at;
    coalition.state = CoalitionState::formed;
    coalition.why = {};
    coalition.members = m.members;
  }
}

void Picture::on(const coalition::MemberStatus& m) {
  for (const auto& entry : m.tasks) {
    SitePicture* site = site_of(entry.task.site);
    if (site == nullptr) continue;
    // Said before it heard that the site is over.
    if (site->refused && entry.state == coalition::TaskState::planned) continue;
    TaskPicture& task = site->tasks[entry.task];
    const bool is_final =
        entry.state == coalition::TaskState::done || entry.state == coalition::TaskState::unknown;
    if (!is_final && !is_of(task, m.member, m.round)) continue;
    if (!task.vehicle) task.vehicle = m.member;
    task.held = task.held || task.vehicle == m.member;
    advance(task, entry.state, heard_at_);
  }
}

void Picture::on_traffic(const std::map<std::uint32_t, mission::SeenAircraft>& all) {
  hears_traffic_ = true;
  traffic_.clear();
  for (const auto& [address, seen] : all) traffic_[address] = {seen, {}};
  show_warned();
}

void Picture::on(const mission::Traffic& m) {
  traffic_.clear();
  for (const mission::Aircraft& aircraft : m.aircraft) {
    traffic_[aircraft.address].seen.aircraft = aircraft;
  }
  show_warned();
}

void Picture::show_warned() {
  for (auto& [address, shown] : traffic_) {
    const auto found = warned_.find(address);
    if (found != warned_.end()) shown.warned = found->second;
  }
}

void Picture::note_traffic(const mission::MissionEvent& event) {
  if (const auto* warning = std::get_if<mission::event::TrafficWarning>(&event.body)) {
    const bool known = warned_.contains(warning->address);
    if (!known && warned_.size() >= params_.warned_max) return;
    warned_[warning->address][event.vehicle] = warning->gives_way;
  } else if (const auto* clear = std::get_if<mission::event::TrafficClear>(&event.body)) {
    const auto found = warned_.find(clear->address);
    if (found == warned_.end()) return;
    found->second.erase(event.vehicle);
    if (found->second.empty()) warned_.erase(found);
  }
}

void Picture::on_event(const mission::MissionEvent& event) {
  using enum mission::EventKind;
  note_traffic(event);
  if (const auto* proposed = std::get_if<mission::event::SiteProposed>(&event.body)) {
    if (proposals_.size() < params_.proposals_max) {
      proposals_[proposed->number] = {*proposed, event.time};
    }
  } else if (const auto* answer = std::get_if<mission::event::ProposalAnswered>(&event.body)) {
    proposals_.erase(answer->number);
  }
  if (event.task.site == SiteId{}) return;
  SitePicture* known = site_of(event.task.site);
  if (known == nullptr) return;
  SitePicture& site = *known;
  site.news = event;
  switch (event.kind()) {
    case survey_done:
      site.surveyed = true;
      advance(site.tasks[{event.task.site, TaskKind::survey, 0}], coalition::TaskState::done,
              heard_at_);
      break;
    case task_started:
    case task_failed: {
      TaskPicture& task = site.tasks[event.task];
      const bool failed = event.kind() == task_failed;
      if (!is_of(task, event.vehicle, event.round)) break;
      advance(task, failed ? coalition::TaskState::failed : coalition::TaskState::started,
              heard_at_);
      break;
    }
    case task_done:
      advance(site.tasks[event.task], coalition::TaskState::done, heard_at_);
      break;
    case site_done:
      site.done = true;
      break;
    case task_lost:
      take_back_task(event.task, std::get<mission::event::TaskLost>(event.body).why.vehicle);
      break;
    case lease_ended:
      if (!std::get<mission::event::LeaseEnded>(event.body).held) {
        take_back_task(event.task, event.vehicle);
      }
      break;
    case bid_declined:
      round_of(event.round).declined[event.vehicle] =
          std::get<mission::event::BidDeclined>(event.body).why;
      break;
    case coalition_formed: {
      CoalitionPicture& coalition = coalition_of(event.round.coalition);
      coalition.site = event.task.site;
      coalition.state = CoalitionState::formed;
      coalition.why = {};
      break;
    }
    case allocation_failed: {
      CoalitionPicture& coalition = coalition_of(event.round.coalition);
      coalition.site = event.task.site;
      if (coalition.state == CoalitionState::closed) break;
      coalition.state = CoalitionState::failed;
      coalition.why = {coalition::Reason::no_allocation,
                       {},
                       std::get<mission::event::AllocationFailed>(event.body).detail};
      break;
    }
    default:
      break;
  }
}

std::optional<std::pair<TaskId, TaskPicture>> Picture::task_of(VehicleId vehicle) const {
  std::optional<std::pair<TaskId, TaskPicture>> next;
  for (const auto& [id, site] : sites_) {
    for (const auto& [task, picture] : site.tasks) {
      const bool open = picture.state == coalition::TaskState::planned ||
                        picture.state == coalition::TaskState::started;
      if (picture.vehicle != vehicle || !open) continue;
      if (!next ||
          picture.time.value_or(Instant::max()) < next->second.time.value_or(Instant::max())) {
        next = {task, picture};
      }
    }
  }
  return next;
}

std::optional<std::pair<TaskId, TaskPicture>> Picture::told_task(
    const mission::Telemetry& told) const {
  if (!tells_task(told)) return task_of(told.vehicle);
  if (told.task.site == SiteId{}) return std::nullopt;
  TaskPicture picture;
  if (const auto site = sites_.find(told.task.site); site != sites_.end()) {
    const auto known = site->second.tasks.find(told.task);
    const bool is_its = known != site->second.tasks.end() && known->second.vehicle == told.vehicle;
    if (is_its) picture = known->second;
  }
  if (!picture.state) picture.state = coalition::TaskState::planned;
  return std::pair{told.task, picture};
}

std::optional<Duration> Picture::clock_offset(VehicleId vehicle) const {
  const auto known = vehicles_.find(vehicle);
  if (known == vehicles_.end() || known->second.delays.empty()) return std::nullopt;
  const auto& delays = known->second.delays;
  return std::min_element(delays.begin(), delays.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->second;
}

}  // namespace skein::console
