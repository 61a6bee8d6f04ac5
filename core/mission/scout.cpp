// SPDX-License-Identifier: Apache-2.0
#include "scout.hpp"

#include <algorithm>
#include <utility>

#include "skein/base/assert.hpp"
#include "skein/base/contains.hpp"

namespace skein::mission {
namespace {
constexpr Duration kSurveyPeriod = std::chrono::seconds{5};  ///< between attempts to plan one
constexpr Duration kReliefPeriod = std::chrono::seconds{1};  ///< between two looks for lost sites
/// Who goes to lead a lost site goes around it at this times its planning radius at least.
constexpr double kReliefRadiusFactor = 1.2;
/// Between two that may lead a site that both have come to relieve.
constexpr Duration kTurn = std::chrono::milliseconds{500};
constexpr std::size_t kFoundMax = 16;

TaskId survey_of(const Site& site) { return {site.id, TaskKind::survey, 0}; }
}  // namespace

using event::TaskFailure;

/// Precondition: the table has it.
void Scout::fire(Event event) {
  const bool known = machine_.fire(event);
  SKEIN_ASSERT(known);
}

void Scout::on_site_report(const SiteReport& message, Instant now) {
  const SiteId id = message.site.id;
  const bool ours = message.finder == ownship_.spec().id &&
                    ownship_.spec().capabilities.has(TaskKind::survey) && !is_withdrawn(id);
  if (!ours) return;
  if (known_.contains(id)) {
    const bool waits =
        std::ranges::any_of(found_, [id](const Found& f) { return f.site.id == id; });
    if (waits || (flying() && site_.id == id)) report_detected(message.site, now);
    return;
  }
  if (found_.size() >= kFoundMax) {  // so that it is taken up when it is seen again
    ++dropped_;
    return;
  }
  known_.insert(id);
  report_detected(message.site, now);
  found_.push_back({message.site});
}

void Scout::report_detected(const Site& site, Instant now) {
  const double range = (site.position - ownship_.state().position().horizontal()).norm();
  outbox_.report(event::SiteDetected{range}, {}, survey_of(site), now);
}

bool Scout::withdraw(SiteId site, bool turns_away, Instant now) {
  if (!withdrawn_.insert(site).second) return false;
  known_.insert(site);
  sites_.forget(site);
  std::erase_if(found_, [site](const Found& f) { return f.site.id == site; });
  std::erase_if(surveyed_, [site](const Surveyed& s) { return s.site() == site; });
  if (flying() && site_.id == site) {
    fire(Event::called_off);
    if (turns_away) ownship_.search(now);
  }
  return true;
}

void Scout::on_message(const coalition::Message& message, Instant now) {
  // Its own words come back from the ground station, which passes them on.
  const auto is_led = [this](SiteId site, VehicleId leader) {
    if (leader == ownship_.spec().id) return;
    std::erase_if(surveyed_, [site](const Surveyed& s) { return s.site() == site; });
  };
  // Who says that it was heard later than now would never be lost.
  const Instant latest = now + ownship_.config().protocol.clock_guard;
  if (const auto* announcement = std::get_if<coalition::Announcement>(&message)) {
    known_.insert(announcement->site.id);
    sites_.on_leader(announcement->site, std::min(announcement->announced_at, latest));
    is_led(announcement->site.id, announcement->round.coalition.leader);
  } else if (const auto* award = std::get_if<coalition::Award>(&message)) {
    sites_.on_leader(award->site, std::min(award->awarded_at, latest));
    is_led(award->site.id, award->round.coalition.leader);
  } else if (const auto* renewal = std::get_if<coalition::LeaseRenewal>(&message)) {
    sites_.on_renewal(*renewal, now);
    is_led(renewal->site, renewal->round.coalition.leader);
  } else if (const auto* status = std::get_if<coalition::MemberStatus>(&message)) {
    sites_.on_status(*status);
    on_status(*status);
  } else if (const auto* allegiance = std::get_if<coalition::Allegiance>(&message)) {
    for (Surveyed& s : surveyed_) s.put_off.electorate.on_allegiance(*allegiance, now);
  }
}

/// Whose task has ended, by its own word, holds it no more; and who has left the coalition with its
/// last one, before another leader could be chosen, chooses none.
void Scout::on_status(const coalition::MemberStatus& status) {
  using coalition::TaskState;
  for (Surveyed& surveyed : surveyed_) {
    auto& [site, outstanding, electorate] = surveyed.put_off;
    const auto ended = [&status](const coalition::Initiator::Outstanding& held) {
      return held.owner == status.member && held.round == status.round &&
             std::ranges::any_of(status.tasks, [&held](const coalition::TaskStatus& task) {
               return task.task == held.task && task.state != TaskState::planned &&
                      task.state != TaskState::started;
             });
    };
    if (std::erase_if(outstanding, ended) == 0) continue;
    const bool holds_more = std::ranges::any_of(
        outstanding, [&status](const auto& held) { return held.owner == status.member; });
    const bool in_time = std::ranges::all_of(
        status.tasks, [&](const auto& task) { return task.time < electorate.promised_until; });
    if (!holds_more && in_time) electorate.others.erase(status.member);
  }
}

std::optional<SurveyedSite> Scout::take_up(Instant now) {
  SKEIN_ASSERT(!flying());
  const auto next = std::ranges::find_if(
      surveyed_, [now](const Surveyed& s) { return now >= s.may_be_led_at(); });
  const bool any = next != surveyed_.end();
  if (any && !next->in_vain) return lead(next, now);
  take_up_survey(now);
  if (flying()) return std::nullopt;
  if (any) return lead(next, now);
  take_up_relief(now);
  return std::nullopt;
}

SurveyedSite Scout::lead(std::vector<Surveyed>::iterator next, Instant now) {
  const PutOffSite put_off = std::move(next->put_off);
  surveyed_.erase(next);
  SurveyedSite what{put_off.site, sites_.over(put_off.site.id)};
  for (const auto& held : put_off.outstanding) {
    if (!held.maybe_flown || contains(what.over, held.task)) continue;
    outbox_.report(event::TaskUnknown{held.owner}, held.round, held.task, now);
    what.over.push_back(held.task);
  }
  return what;
}

Instant Scout::Surveyed::may_be_led_at() const {
  const auto& electorate = put_off.electorate;
  Instant at = electorate.may_choose() ? electorate.until : Instant::min();
  for (const auto& held : put_off.outstanding) at = std::max(at, held.until);
  return at;
}

void Scout::put_off(PutOffSite site) {
  surveyed_.insert(std::ranges::find_if(surveyed_, &Surveyed::in_vain),
                   Surveyed{std::move(site), false});
}

bool Scout::has_another_site() const {
  const auto can_be_surveyed = [](const Found& found) { return !found.told; };
  return !surveyed_.empty() || std::ranges::any_of(found_, can_be_surveyed);
}

Instant Scout::takes_up_at() const {
  Instant next = found_.empty() ? relief_again_ : std::min(survey_again_, relief_again_);
  for (const Surveyed& surveyed : surveyed_) next = std::min(next, surveyed.may_be_led_at());
  return next;
}

void Scout::take_up_survey(Instant now) {
  if (found_.empty() || now < survey_again_) return;
  survey_again_ = now + kSurveyPeriod;
  for (auto& found : found_) {
    const auto outcome = fly_around(found.site, false, now);
    if (const auto* plan = std::get_if<planning::TaskPlan>(&outcome)) {
      site_ = found.site;
      plan_ = *plan;
      survey_again_ = now;
      std::erase_if(found_, [this](const Found& f) { return f.site.id == site_.id; });
      fire(Event::survey_planned);
      return;
    }
    // It may become possible: from elsewhere, or with other hazards known.
    if (!std::exchange(found.told, true)) {
      outbox_.report(std::get<event::TaskFailed>(outcome), {}, survey_of(found.site), now);
    }
  }
}

void Scout::take_up_relief(Instant now) {
  if (now < relief_again_) return;
  relief_again_ = now + kReliefPeriod;
  for (const auto* lost : sites_.lost(unheard_since(now))) {
    const auto outcome = fly_around(lost->site, true, now);
    const auto* plan = std::get_if<planning::TaskPlan>(&outcome);
    if (plan == nullptr) continue;
    outbox_.report(event::ReliefBegun{lost->heard_at}, {}, {lost->site.id, {}, 0}, now);
    site_ = lost->site;
    plan_ = *plan;
    waited_ = false;
    fire(Event::relief_planned);
    return;
  }
}

/// The flight to a site and around it, for its survey or (`relief`) to lead there, is the flight
/// plan from now on. It goes on circling the site on the same arc where hazards leave room for it.
std::variant<planning::TaskPlan, event::TaskFailed> Scout::fly_around(const Site& site, bool relief,
                                                                      Instant now) {
  const Instant start = now + ownship_.flight().handover();
  Flight& flight = ownship_.flight();
  VehicleSpec vehicle = ownship_.spec();
  vehicle.turn_radius_margin = ownship_.planning_radius_m() / vehicle.turn_radius_m;
  if (relief) {  // at any radius that it can fly
    vehicle.sensor_radius_m =
        std::max(vehicle.sensor_radius_m, kReliefRadiusFactor * vehicle.planning_radius_m());
  }
  auto plan = planning::plan_survey(ownship_.config().planning, vehicle, flight.pose_at(start),
                                    start, site, ownship_.hazards());
  if (!plan) return event::TaskFailed{TaskFailure::no_plan, {}, plan.error().message};
  plan->timed = ownship_.in_wind(plan->timed);
  const Path& path = plan->timed.path;
  // Who is to lead there must also have the range to stay for some time.
  const double stay_m = relief ? path.length_m() : 0.0;
  if (path.length_m() + stay_m + flight.way_home_m(path.end(), ownship_.hazards()) >
      ownship_.range_to_spend(start)) {
    return event::TaskFailed{TaskFailure::out_of_range};
  }
  // A site may lie where there is room for the arc, and not for a whole lap on it.
  Path way = path;
  const auto tail = flight.orbit_after(way, plan->timed.tail_curvature_per_m, ownship_.hazards());
  if (!tail) {
    return event::TaskFailed{TaskFailure::no_plan, {}, "hazards leave no room for an orbit there"};
  }
  if (!ownship_.stays_in_fence(way, *tail)) {
    return event::TaskFailed{TaskFailure::no_plan, {}, "the way leads out of the fence"};
  }
  if (!flight.continue_with(start, way, *tail, now)) {
    return event::TaskFailed{TaskFailure::path_too_long};
  }
  return *plan;
}

std::optional<SurveyedSite> Scout::fly(Instant now) {
  switch (machine_.state()) {
    case State::to_survey:
    case State::surveying:
      return survey(now);
    case State::to_relief:
    case State::listening:
      return relieve(now);
    case State::idle:
    case State::count:
      break;
  }
  return std::nullopt;
}

std::optional<SurveyedSite> Scout::survey(Instant now) {
  if (machine_.in(State::to_survey)) {
    if (now < arrival()) return std::nullopt;
    fire(Event::arrived);
    strayed_ = unlocated_ = false;
    outbox_.report(event::SurveyStarted{arrival()}, {}, survey_of(site_), arrival());
  }
  strayed_ = strayed_ || !ownship_.on_arc(site_.position, ownship_.spec().sensor_radius_m);
  const Instant over = plan_.timed.end_time();
  if (now < over) return std::nullopt;
  unlocated_ = !ownship_.was_located(over);
  if (now < told_time()) return std::nullopt;
  fire(Event::ended);
  if (unlocated_ || strayed_ || !ownship_.on_track(plan_.timed)) {
    outbox_.report(ownship_.off_path(over, {}), {}, survey_of(site_), now);
    found_.push_back({site_});
    return std::nullopt;
  }
  outbox_.report(event::SurveyDone{arrival()}, {}, survey_of(site_), over);
  const Duration cut_max = ownship_.config().protocol.cut_max;
  if (sites_.led(site_.id, now - cut_max)) return std::nullopt;
  return SurveyedSite{site_, {}};
}

/// Several may have waited for the same award: the announcement of the first calls the others off.
std::optional<SurveyedSite> Scout::relieve(Instant now) {
  if (std::exchange(waited_, false)) in_turn_at_ = now + rank() * kTurn;
  const auto* lost = sites_.lost(site_.id, unheard_since(now));
  if (lost == nullptr) {  // its leader was heard, or nothing is left to do
    fire(Event::called_off);
    ownship_.search(now);
    return std::nullopt;
  }
  if (machine_.in(State::to_relief) && now >= arrival()) fire(Event::arrived);
  if (now < leads_at()) return std::nullopt;
  fire(Event::ended);
  return SurveyedSite{lost->site, lost->over};
}

void Scout::call_off() {
  if (!flying()) return;
  if (surveys()) found_.push_back({site_});
  fire(Event::called_off);
}

/// The stagger lets one of several free vehicles go first; its announcement calls the others off.
Instant Scout::unheard_since(Instant now) const {
  constexpr Duration kStagger = std::chrono::seconds{2};
  return now - ownship_.config().protocol.cut_max - rank() * kStagger;
}

int Scout::rank() const {
  constexpr int kRanks = 8;
  return ownship_.spec().id.value % kRanks;
}

Instant Scout::arrival() const { return plan_.timed.time_at(plan_.gate_m); }

Instant Scout::leads_at() const {
  return std::max(arrival() + ownship_.config().protocol.silence, in_turn_at_);
}

/// What became of the survey is told: a moment later where that is not known at once.
Instant Scout::told_time() const {
  const Instant over = plan_.timed.end_time();
  return unlocated_ ? over + kFlightControllerSilence : over;
}

Instant Scout::next_timeout() const {
  if (!flying()) return Instant::max();
  if (machine_.in(State::listening)) return leads_at();
  return machine_.in(State::surveying) ? told_time() : arrival();
}

std::string_view to_string(Scout::State state) {
  static constexpr std::array<std::string_view, 5> kNames{"idle", "to_survey", "surveying",
                                                          "to_relief", "listening"};
  static_assert(kNames.size() == static_cast<std::size_t>(Scout::State::count));
  return kNames.at(static_cast<std::size_t>(state));
}

std::string_view to_string(Scout::Event event) {
  static constexpr std::array<std::string_view, 5> kNames{"survey_planned", "relief_planned",
                                                          "arrived", "ended", "called_off"};
  static_assert(kNames.size() == static_cast<std::size_t>(Scout::Event::count));
  return kNames.at(static_cast<std::size_t>(event));
}

}  // namespace skein::mission
