// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_sites.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>
#include <utility>

#include "names.hpp"
#include "operator_numbers.hpp"

namespace skein::mission {
namespace {

constexpr Duration kTellAgain = std::chrono::seconds{2};
constexpr Duration kTakenUpWithin = std::chrono::seconds{10};
/// Nobody has said for so long that the site is led: who led it has forgotten it, and the others
/// too, or they would have relieved it.
constexpr Duration kLeaderLost = std::chrono::seconds{150};
/// Between two looks for somebody who can survey, and for a surveyor that is lost.
constexpr Duration kLook = std::chrono::seconds{1};
constexpr Duration kWithdrawnAgain = std::chrono::seconds{5};
constexpr std::size_t kRememberedMax =
    1024;  ///< what a flood from the network can make us remember

bool is_over(SiteState state) { return state == SiteState::over || state == SiteState::withdrawn; }

bool is_in_care(const GroundSite& entry) { return entry.of_operator && !is_over(entry.state); }
/// Nobody leads it yet.
bool is_to_survey(const GroundSite& entry) {
  return entry.of_operator && entry.state < SiteState::led;
}

bool can_survey(const FleetEntry& known) {
  if (!known.telemetry || known.silent || known.duplicate || known.differs) return false;
  return can_be_told_of_sites(known.telemetry->activity) &&
         known.telemetry->capabilities.has(TaskKind::survey);
}

}  // namespace

// --- what is heard, and was said ---

void GroundSites::recall(const Message& message, VehicleId sender, Instant at) {
  const auto* report = std::get_if<SiteReport>(&message);
  const auto* decision = std::get_if<Authorisation>(&message);
  if (sender != kGroundStation) {
    on_message(message, at);
  } else if (report != nullptr) {
    know(report->site);
    GroundSite* const entry = find(report->site.id);
    if (entry == nullptr) return;
    of_operator_ += entry->of_operator ? 0 : 1;
    entry->of_operator = true;
    if (report->withdrawn) {
      entry->state = SiteState::withdrawn;
    } else if (is_to_survey(*entry) && report->finder != VehicleId{}) {
      entry->surveyor = report->finder;
      entry->state = std::max(entry->state, SiteState::told);
      entry->told_at = at;
    }
    next_ = at;
  } else if (decision != nullptr && decision->granted) {
    on_granted(decision->site);
  }
}

void GroundSites::on_message(const Message& message, Instant now) {
  if (const auto* report = std::get_if<SiteReport>(&message)) {
    know(report->site);
  } else if (const auto* event = std::get_if<MissionEvent>(&message)) {
    on_event(*event, now);
  } else if (const auto* said = std::get_if<coalition::Message>(&message)) {
    on_coalition(*said, now);
  }
}

void GroundSites::on_coalition(const coalition::Message& message, Instant now) {
  if (const auto* announcement = std::get_if<coalition::Announcement>(&message)) {
    know(announcement->site);
    lead(announcement->site.id, now);
  } else if (const auto* award = std::get_if<coalition::Award>(&message)) {
    know(award->site);
    lead(award->site.id, now);
  } else if (const auto* renewal = std::get_if<coalition::LeaseRenewal>(&message)) {
    lead(renewal->site, now);
    GroundSite* const entry = find(renewal->site);
    if (entry != nullptr && renewal->closed && !is_over(entry->state)) {
      entry->state = SiteState::over;
    }
  }
}

void GroundSites::on_event(const MissionEvent& event, Instant now) {
  if (event.vehicle == kGroundStation || event.task.site == SiteId{}) return;
  GroundSite* const entry = know(event.task.site);
  if (entry == nullptr) return;
  const bool delivery = event.task.kind == TaskKind::deliver;
  switch (event.kind()) {
    case EventKind::site_detected:
      if (entry->state > SiteState::taken_up) return;
      entry->state = SiteState::taken_up;
      if (entry->surveyor != event.vehicle) entry->instance.reset();
      entry->surveyor = event.vehicle;
      return;
    case EventKind::announced:
      return lead(event.task.site, now);
    case EventKind::site_done:
      if (!is_over(entry->state)) entry->state = SiteState::over;
      return;
    case EventKind::task_started:
      if (delivery) entry->begun.insert(event.task.index);
      return;
    case EventKind::task_done:
      if (delivery) entry->delivered.insert(event.task.index);
      return;
    case EventKind::task_failed: {
      // It may try again from elsewhere, but perhaps another can fly there now.
      const bool survey = event.task.kind == TaskKind::survey;
      if (survey && entry->surveyor == event.vehicle && is_to_survey(*entry)) {
        entry->tried.insert(event.vehicle);
        entry->surveyor.reset();
        entry->next = now;
        next_ = now;
      }
      return;
    }
    default:
      return;
  }
}

void GroundSites::on_granted(SiteId site) {
  if (GroundSite* const entry = know(site)) entry->granted = true;
}

void GroundSites::on_refused(SiteId site, Instant now) {
  GroundSite* const entry = know(site);
  if (entry == nullptr || entry->state == SiteState::withdrawn) return;
  entry->state = SiteState::withdrawn;
  of_operator_ += entry->of_operator ? 0 : 1;
  entry->of_operator = true;
  entry->next = now + kWithdrawnAgain;  // first its leader hears why
  next_ = std::min(next_, entry->next);
}

GroundSite* GroundSites::find(SiteId site) {
  const auto known = sites_.find(site);
  return known == sites_.end() ? nullptr : &known->second;
}

/// Null where there is no room.
GroundSite* GroundSites::know(SiteId site) {
  if (!sites_.contains(site) && sites_.size() >= kRememberedMax) return nullptr;
  taken_.insert(site);
  GroundSite& entry = sites_[site];
  entry.site.id = site;
  return &entry;
}

void GroundSites::know(const Site& site) {
  GroundSite* const entry = know(site.id);
  if (entry == nullptr || entry->placed) return;
  entry->site = site;
  entry->placed = true;
}

void GroundSites::lead(SiteId site, Instant now) {
  GroundSite* const entry = know(site);
  if (entry == nullptr || is_over(entry->state)) return;
  entry->state = SiteState::led;
  entry->led_at = now;
}

bool GroundSites::is_withdrawn(SiteId site) const {
  const auto known = sites_.find(site);
  return known != sites_.end() && known->second.state == SiteState::withdrawn;
}

const GroundSite* GroundSites::open_near(const Vec2& place, double radius_m) const {
  const GroundSite* nearest = nullptr;
  for (const auto& [id, entry] : sites_) {
    if (!entry.placed || is_over(entry.state)) continue;
    const double distance_m = (entry.site.position - place).norm();
    if (distance_m > radius_m) continue;
    radius_m = distance_m;
    nearest = &entry;
  }
  return nearest;
}

// --- orders ---

Result<SiteId> GroundSites::add(Site site, std::optional<VehicleId> surveyor, const Fleet& fleet,
                                Instant now) {
  if (!site.position.allFinite()) return Error{"a site needs a position"};
  if (of_operator_ >= kSitesMax) return Error{"there are too many sites of the operator already"};
  if (surveyor) {
    const auto known = fleet.vehicles().find(*surveyor);
    if (known == fleet.vehicles().end() || !can_survey(known->second)) {
      return Error{name_of(*surveyor) +
                   " cannot survey it: it must be heard, have the capability and not be held; name "
                   "another, or none and the nearest is told"};
    }
  }
  site.id = new_number(taken_, now);
  GroundSite& entry = sites_[site.id];
  entry.site = std::move(site);
  entry.placed = entry.of_operator = true;
  entry.wanted = surveyor;
  ++of_operator_;
  care_for(entry, fleet, now);
  next_ = std::min(next_, entry.next);
  return entry.site.id;
}

Result<std::vector<TaskId>> GroundSites::withdraw(SiteId site, const std::string& by, Instant now) {
  GroundSite* const entry = find(site);
  if (entry == nullptr) return Error{"there is no " + name_of(site) + "; 'sites' lists them"};
  if (is_over(entry->state)) {
    return Error{name_of(site) + (entry->state == SiteState::over
                                      ? " is over: nothing is left of it"
                                      : " is withdrawn already")};
  }
  entry->state = SiteState::withdrawn;
  of_operator_ += entry->of_operator ? 0 : 1;
  entry->of_operator = true;
  entry->next = now + kWithdrawnAgain;
  next_ = std::min(next_, entry->next);
  say(*entry, now);
  report(event::SiteWithdrawn{by}, site, now);
  std::vector<TaskId> flown_on;
  for (const std::uint8_t index : entry->begun) {
    if (!entry->delivered.contains(index)) flown_on.push_back({site, TaskKind::deliver, index});
  }
  return flown_on;
}

Result<SiteId> GroundSites::change(SiteId old, Site site, std::optional<VehicleId> surveyor,
                                   const Fleet& fleet, const std::string& by, Instant now) {
  const GroundSite* const entry = find(old);
  if (entry == nullptr) return Error{"there is no " + name_of(old) + "; 'sites' lists them"};
  if (is_over(entry->state)) return Error{name_of(old) + " is over or withdrawn; add a new one"};
  if (entry->granted || !entry->begun.empty() || !entry->delivered.empty()) {
    return Error{
        name_of(old) +
        " has authorised deliveries, which may be flown already; withdraw it, and add what "
        "is left as a new site"};
  }
  auto added = add(std::move(site), surveyor, fleet, now);
  if (!added) return added;
  if (const auto gone = withdraw(old, by, now); !gone) return gone.error();
  return added;
}

// --- who surveys ---

/// It does something, or has another site of the operator to survey.
bool GroundSites::is_busy(VehicleId vehicle, const FleetEntry& known, SiteId with) const {
  const Activity activity = known.telemetry->activity;
  const bool free = activity == Activity::searching || activity == Activity::en_route ||
                    activity == Activity::standing_by;
  if (!free) return true;
  return std::ranges::any_of(sites_, [&](const auto& other) {
    return other.first != with && is_to_survey(other.second) && other.second.surveyor == vehicle;
  });
}

/// Who has been tried before comes last: it may have become possible for it.
std::optional<VehicleId> GroundSites::choose(const GroundSite& entry, const Fleet& fleet) const {
  std::optional<std::tuple<bool, bool, bool, double, VehicleId>> best;
  for (const auto& [vehicle, known] : fleet.vehicles()) {
    if (!can_survey(known)) continue;
    const Vec2 at{known.telemetry->state.x_m, known.telemetry->state.y_m};
    const double distance_m = (entry.site.position - at).norm();
    if (known.telemetry->range_left_m < distance_m) continue;
    const std::tuple rank{entry.tried.contains(vehicle), entry.wanted != vehicle,
                          is_busy(vehicle, known, entry.site.id), distance_m, vehicle};
    if (!best || rank < *best) best = rank;
  }
  return best ? std::optional{std::get<VehicleId>(*best)} : std::nullopt;
}

std::optional<VehicleId> GroundSites::nearest_surveyor(const Vec2& place,
                                                       const Fleet& fleet) const {
  GroundSite asked;
  asked.site.position = place;
  return choose(asked, fleet);
}

void GroundSites::tell(GroundSite& entry, VehicleId surveyor, InstanceId instance, Instant now) {
  entry.surveyor = surveyor;
  entry.instance = instance;
  entry.state = SiteState::told;
  entry.told_at = now;
  say(entry, now);
}

void GroundSites::care_for(GroundSite& entry, const Fleet& fleet, Instant now) {
  const auto& vehicles = fleet.vehicles();
  entry.next = now + kLook;
  if (entry.state == SiteState::led) {
    if (now < entry.led_at + kLeaderLost) return;
    entry.tried.clear();
    entry.surveyor.reset();
  }
  if (entry.surveyor) {
    const auto known = vehicles.find(*entry.surveyor);
    const bool heard = known != vehicles.end() && can_survey(known->second);
    const bool in_vain = entry.state == SiteState::told && now >= entry.told_at + kTakenUpWithin;
    const bool told = entry.state == SiteState::told && now >= entry.said_at + kTellAgain;
    if (!heard || in_vain) {
      entry.tried.insert(*entry.surveyor);
      entry.surveyor.reset();
    } else if (entry.instance != known->second.telemetry->instance) {
      // It remembers nothing, or may have started anew while this program was down.
      tell(entry, known->first, known->second.telemetry->instance, now);
    } else if (told) {
      say(entry, now);
    }
  }
  if (entry.surveyor) return;
  entry.state = SiteState::waits;
  const auto chosen = choose(entry, fleet);
  if (!chosen) {
    if (entry.said_at == Instant{}) say(entry, now);  // who looks on sees it, and who succeeds us
    return;
  }
  tell(entry, *chosen, vehicles.at(*chosen).telemetry->instance, now);
  report(event::SiteTold{*chosen}, entry.site.id, now);
}

void GroundSites::on_timeout(const Fleet& fleet, Instant now) {
  if (now < next_) return;
  next_ = Instant::max();
  for (auto& [id, entry] : sites_) {
    const bool withdrawn = entry.state == SiteState::withdrawn;
    if (!withdrawn && !is_in_care(entry)) continue;
    if (now >= entry.next && withdrawn) {
      say(entry, now);
      entry.next = now + kWithdrawnAgain;
    } else if (now >= entry.next) {
      care_for(entry, fleet, now);
    }
    next_ = std::min(next_, entry.next);
  }
}

void GroundSites::say(GroundSite& entry, Instant now) {
  entry.said_at = now;
  const bool withdrawn = entry.state == SiteState::withdrawn;
  const VehicleId finder = withdrawn ? VehicleId{} : entry.surveyor.value_or(VehicleId{});
  messages_.push(Message{SiteReport{finder, entry.site, withdrawn}});
}

void GroundSites::report(EventBody body, SiteId site, Instant now) {
  events_.push({kGroundStation, now, {}, {site, TaskKind::survey, 0}, std::move(body)});
}

std::string_view to_string(SiteState state) {
  static constexpr std::array<std::string_view, 6> kNames{"waits", "told", "taken_up",
                                                          "led",   "over", "withdrawn"};
  static_assert(kNames.size() == static_cast<std::size_t>(SiteState::count));
  return kNames.at(static_cast<std::size_t>(state));
}

}  // namespace skein::mission
