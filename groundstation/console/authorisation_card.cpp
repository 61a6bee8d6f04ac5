// SPDX-License-Identifier: Apache-2.0
#include "skein/console/authorisation_card.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "news_delay.hpp"
#include "skein/mission/ground_agent.hpp"
#include "skein/mission/shown_state.hpp"
#include "skein/wording/wording.hpp"

namespace skein::console {
namespace {

using mission::AuthorisationRequest;
using mission::Delivery;
using mission::FleetEntry;
using mission::ShownState;

/// Of what the delivery and the way home need: less than that more is little.
constexpr double kSpareShare = 0.1;
constexpr double kLate_s = 2.0;
/// Nobody is faster than that times the speed that it has bid.
constexpr double kHurry = 1.2;
constexpr double kSameTime_s = 0.05;

ShownState state_of(const mission::Telemetry& told) {
  return mission::shown_state(told.activity, told.detail);
}

const FleetEntry* entry_of(const mission::Fleet& fleet, VehicleId vehicle) {
  const auto known = fleet.vehicles().find(vehicle);
  return known == fleet.vehicles().end() ? nullptr : &known->second;
}

const RoundPicture* round_of(const AuthorisationRequest& request, const Picture& picture) {
  for (const auto& [id, coalition] : picture.coalitions()) {
    if (id != request.round.coalition) continue;
    for (const RoundPicture& round : coalition.rounds) {
      if (round.number == request.round.number) return &round;
    }
  }
  return nullptr;
}

const coalition::Bid* bid_of(const RoundPicture* round, VehicleId vehicle) {
  if (round == nullptr) return nullptr;
  const auto bid = std::ranges::find(round->bids, vehicle, &coalition::Bid::bidder);
  return bid == round->bids.end() ? nullptr : &*bid;
}

std::string silent_text(const FleetEntry& entry, Instant now) {
  return fmt::format("silent for {:.0f} s", to_seconds(now - entry.heard_at));
}

/// What concerns whatever it is to do.
std::vector<Mark> marks_of(const FleetEntry* entry, Instant now) {
  if (entry == nullptr || !entry->telemetry) return {{true, "never heard"}};
  std::vector<Mark> marks;
  if (entry->silent) {
    marks.push_back({true, silent_text(*entry, now) + ": it may not hear the decision"});
  }
  if (entry->revoked) marks.push_back({true, "revoked"});
  if (entry->duplicate) marks.push_back({true, "two vehicles with this id"});
  if (entry->differs) marks.push_back({true, "has " + mission::text_of(*entry->differs)});
  return marks;
}

/// It cannot be there in time: by the straight way, at the speed that it has bid.
std::optional<Mark> late_mark(const Delivery& delivery, const mission::Telemetry& told,
                              double distance_m, double speed_mps) {
  if (state_of(told) == ShownState::too_late_for_its_task) {
    return Mark{true, "late: the time of its task has passed"};
  }
  if (speed_mps <= 0.0) return std::nullopt;
  const double left_s = to_seconds(delivery.assignment.time - told.state.time);
  const double late_s = distance_m / (kHurry * speed_mps) - left_s;
  if (late_s < kLate_s) return std::nullopt;
  return Mark{true, fmt::format("late: by {:.0f} s at least", late_s)};
}

/// What the aircraft keeps for the way home from the site, with an orbit there. It knows that
/// itself, and the ground station only by its bid: that tells what the task may use up, from the
/// time on for which it bids. What it had left then is in its telemetry. Not known is whether it
/// comes home at all; and where it was not heard then, or no bid of it was heard (a successor's
/// plan), it is taken as far as from the site to where it was heard first.
double way_home_m(const AuthorisationRequest& request, const RoundPicture* round,
                  const VehiclePicture& vehicle, const coalition::Bid* bid) {
  if (bid != nullptr && round->announcement) {
    const Instant formed_at = round->announcement->formed_at;
    for (const VehiclePicture::Sample& sample : vehicle.series) {
      if (sample.time < formed_at) continue;
      if (sample.time - formed_at > kNewsMayTake) break;
      const double since_m = bid->speed_mps * to_seconds(sample.time - formed_at);
      return std::max(0.0, sample.range_left_m + since_m - bid->range_left_m);
    }
  }
  return vehicle.first_at ? (request.site_position - *vehicle.first_at).norm() : 0.0;
}

/// By its telemetry, in which its reserve is taken off already; it flies all the time until its
/// delivery, the way that its leader has given it time for.
std::optional<Mark> range_mark(const mission::Telemetry& told, double way_m, double home_m) {
  if (state_of(told) == ShownState::range_reserve) {
    return Mark{true, "its range is used up, but for the way home"};
  }
  if (told.range_left_m < 0.0) return Mark{true, "its range is overdrawn"};
  if (told.range_left_m >= (1.0 + kSpareShare) * (way_m + home_m)) return std::nullopt;
  return Mark{false, fmt::format("low on range: {:.1f} km left; {:.1f} km to its delivery, {:.1f} "
                                 "km home",
                                 told.range_left_m / 1000.0, way_m / 1000.0, home_m / 1000.0)};
}

/// By its own word it flies something else.
std::optional<Mark> other_task_mark(const Delivery& delivery, const mission::Telemetry& told,
                                    Instant asked_at) {
  const bool tells = told.task.site != SiteId{} || told.activity != mission::Activity::executing;
  const bool is_old = told.state.time < asked_at + kNewsMayTake;
  if (!tells || is_old || told.task == delivery.assignment.task) return std::nullopt;
  return Mark{true, "does not have this delivery any more: " + words_of(state_of(told))};
}

std::vector<Mark> marks_of(const Delivery& delivery, const AuthorisationRequest& request,
                           const RoundPicture* round, const Picture& picture,
                           const mission::Fleet& fleet, Instant asked_at, Instant now) {
  const FleetEntry* entry = entry_of(fleet, delivery.assignment.vehicle);
  std::vector<Mark> marks = marks_of(entry, now);
  if (entry == nullptr || !entry->telemetry) return marks;
  const mission::Telemetry& told = *entry->telemetry;
  const double distance_m = (request.site_position - Vec2{told.state.x_m, told.state.y_m}).norm();
  const coalition::Bid* bid = bid_of(round, delivery.assignment.vehicle);
  const double speed_mps = bid != nullptr ? bid->speed_mps : told.state.groundspeed_mps;
  const auto seen = picture.vehicles().find(delivery.assignment.vehicle);
  const double home_m =
      seen == picture.vehicles().end() ? 0.0 : way_home_m(request, round, seen->second, bid);
  const double left_s = std::max(0.0, to_seconds(delivery.assignment.time - told.state.time));
  const double way_m = std::max(distance_m, speed_mps * left_s);
  for (const auto& mark :
       {other_task_mark(delivery, told, asked_at), late_mark(delivery, told, distance_m, speed_mps),
        range_mark(told, way_m, home_m)}) {
    if (mark) marks.push_back(*mark);
  }
  return marks;
}

const AuthorisationPicture* picture_of(const AuthorisationRequest& request,
                                       const Picture& picture) {
  for (const AuthorisationPicture& known : picture.authorisations()) {
    const auto& other = known.request;
    if (other.site == request.site && other.round == request.round) return &known;
  }
  return nullptr;
}

// --- what is missing ---

bool is_granted(const TaskId& task, VehicleId vehicle, const Picture& picture) {
  return std::ranges::any_of(picture.authorisations(), [&](const AuthorisationPicture& one) {
    if (!one.decision || !one.decision->granted) return false;
    return std::ranges::any_of(one.request.deliveries, [&](const Delivery& delivery) {
      return delivery.assignment.task == task && delivery.assignment.vehicle == vehicle;
    });
  });
}

/// Nobody has flown that delivery, or is to by an earlier decision.
bool is_open(const TaskId& task, const SitePicture& site, const Picture& picture) {
  const auto known = site.tasks.find(task);
  if (known == site.tasks.end() || !known->second.state) return true;
  switch (*known->second.state) {
    case coalition::TaskState::planned:
      return !known->second.vehicle || !is_granted(task, *known->second.vehicle, picture);
    case coalition::TaskState::failed:
      return true;
    case coalition::TaskState::started:
    case coalition::TaskState::done:
    case coalition::TaskState::unknown:
    case coalition::TaskState::count:
      break;
  }
  return false;
}

bool may_deliver(const FleetEntry& entry) {
  return !entry.telemetry || entry.telemetry->capabilities.has(TaskKind::deliver);
}

/// Its owner keeps it until its lease runs out, whatever has become of it.
std::optional<std::string> whose_still(const TaskId& task, const SitePicture& site,
                                       const mission::Fleet& fleet, Instant now) {
  const auto known = site.tasks.find(task);
  if (known == site.tasks.end() || known->second.state != coalition::TaskState::planned ||
      !known->second.vehicle) {
    return std::nullopt;
  }
  const std::string has = wording::text_of(*known->second.vehicle) + " has it still";
  const FleetEntry* owner = entry_of(fleet, *known->second.vehicle);
  const bool silent = owner != nullptr && owner->silent;
  return silent ? has + ", " + silent_text(*owner, now) : has;
}

std::string why_missing(const RoundPicture* round, std::size_t planned) {
  if (round == nullptr || !round->announcement) return "the bids of this round were not heard";
  const auto can = [](const coalition::Bid& bid) {
    return bid.capabilities.has(TaskKind::deliver) && bid.loads > 0;
  };
  const auto bids = static_cast<std::size_t>(std::ranges::count_if(round->bids, can));
  if (bids > planned) return "no plan was found for it with those that have bid";
  return fmt::format("{} that can deliver {} bid", bids == 0 ? "none" : std::to_string(bids),
                     bids == 1 ? "has" : "have");
}

std::string why_no_bid(VehicleId vehicle, const FleetEntry& entry, const RoundPicture* round,
                       const AuthorisationRequest& request, Instant now) {
  if (!entry.telemetry) return "never heard";
  if (entry.silent) return silent_text(entry, now);
  if (entry.telemetry->loads == 0) return "it has no load left";
  if (round != nullptr) {
    const auto declined = round->declined.find(vehicle);
    if (declined != round->declined.end()) return wording::text_of(declined->second);
  }
  const mission::Telemetry& told = *entry.telemetry;
  if (told.task.site != SiteId{} && told.task.site != request.site) {
    return "it has " + to_string(told.task);
  }
  const ShownState state = state_of(told);
  return state == ShownState::searching ? "no bid of it was heard"
                                        : "no bid of it was heard: " + words_of(state);
}

void add_missing(AuthorisationCard& card, const AuthorisationRequest& request,
                 const RoundPicture* round, const Picture& picture, const mission::Fleet& fleet,
                 Instant now) {
  const auto known = picture.sites().find(request.site);
  if (known == picture.sites().end() || !known->second.site) return;
  const auto is_asked = [&](const TaskId& task) {
    return std::ranges::any_of(request.deliveries,
                               [&](const Delivery& d) { return d.assignment.task == task; });
  };
  const auto& wanted = known->second.site->deliveries;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const TaskId task{request.site, TaskKind::deliver, static_cast<std::uint8_t>(i)};
    if (is_asked(task) || !is_open(task, known->second, picture)) continue;
    const auto still = whose_still(task, known->second, fleet, now);
    card.missing.push_back({task, wanted[i].bearing_rad,
                            still ? *still : why_missing(round, request.deliveries.size())});
  }
  if (card.missing.empty()) return;
  for (const auto& [vehicle, entry] : fleet.vehicles()) {
    const bool takes_part =
        bid_of(round, vehicle) != nullptr ||
        std::ranges::any_of(request.deliveries,
                            [v = vehicle](const Delivery& d) { return d.assignment.vehicle == v; });
    if (takes_part || !may_deliver(entry)) continue;
    card.did_not_bid.push_back({vehicle, why_no_bid(vehicle, entry, round, request, now)});
  }
}

// --- what has changed ---

const AuthorisationPicture* request_before(const AuthorisationRequest& request,
                                           const Picture& picture) {
  const AuthorisationPicture* before = nullptr;
  for (const AuthorisationPicture& known : picture.authorisations()) {
    if (known.request.site != request.site) continue;
    if (known.request.round == request.round) break;
    before = &known;
  }
  return before;
}

std::string outcome_of(const AuthorisationPicture& before) {
  const std::string round = fmt::format("round {} ", before.request.round.number);
  if (!before.decision) return round + "was not decided";
  if (before.taken_back) return round + "was taken back by " + before.decision->decided_by;
  return round + (before.decision->granted ? "was authorised by " : "was refused by ") +
         before.decision->decided_by;
}

std::string name_of(const Delivery& delivery) {
  return fmt::format("delivery {}", delivery.assignment.task.index + 1);
}

void add_changes(AuthorisationCard& card, const AuthorisationRequest& request,
                 const AuthorisationRequest& before) {
  const auto same = [](const std::vector<Delivery>& among, const Delivery& as) {
    return std::ranges::find_if(
        among, [&](const Delivery& d) { return d.assignment.task == as.assignment.task; });
  };
  for (const Delivery& delivery : request.deliveries) {
    const auto was = same(before.deliveries, delivery);
    if (was == before.deliveries.end()) {
      card.changes.push_back(name_of(delivery) + " is new");
      continue;
    }
    if (was->assignment.vehicle != delivery.assignment.vehicle) {
      card.changes.push_back(fmt::format("{}: vehicle {} instead of {}", name_of(delivery),
                                         delivery.assignment.vehicle.value,
                                         was->assignment.vehicle.value));
    }
    const double later_s = to_seconds(delivery.assignment.time - was->assignment.time);
    if (std::abs(later_s) < kSameTime_s) continue;
    card.changes.push_back(fmt::format("{}: {:.1f} s {}", name_of(delivery), std::abs(later_s),
                                       later_s > 0.0 ? "later" : "earlier"));
  }
  for (const Delivery& was : before.deliveries) {
    if (same(request.deliveries, was) != request.deliveries.end()) continue;
    card.changes.push_back(fmt::format("{} of vehicle {} is not in it any more", name_of(was),
                                       was.assignment.vehicle.value));
  }
}

}  // namespace

AuthorisationCard card_of(const AuthorisationRequest& request, const Picture& picture,
                          const mission::Fleet& fleet, Instant now) {
  AuthorisationCard card;
  const RoundPicture* round = round_of(request, picture);
  const AuthorisationPicture* known = picture_of(request, picture);
  const Instant asked_at = known == nullptr ? now : known->asked_at;
  for (const Delivery& delivery : request.deliveries) {
    card.deliveries.push_back(marks_of(delivery, request, round, picture, fleet, asked_at, now));
  }
  card.leader = marks_of(entry_of(fleet, request.round.coalition.leader), now);
  card.silent = mission::silent_in(request, fleet);
  add_missing(card, request, round, picture, fleet, now);
  if (const AuthorisationPicture* before = request_before(request, picture)) {
    card.changes.push_back(outcome_of(*before));
    add_changes(card, request, before->request);
  }
  return card;
}

bool may_be_before_gate(const Delivery& delivery, const Picture& picture, Instant now) {
  if (now >= delivery.assignment.time) return false;
  const auto site = picture.sites().find(delivery.assignment.task.site);
  if (site == picture.sites().end()) return true;
  const auto known = site->second.tasks.find(delivery.assignment.task);
  if (known == site->second.tasks.end() || !known->second.state) return true;
  return *known->second.state == coalition::TaskState::planned;
}

}  // namespace skein::console
