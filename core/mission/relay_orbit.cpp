// SPDX-License-Identifier: Apache-2.0
#include "relay_orbit.hpp"

#include <algorithm>

#include "skein/base/overloaded.hpp"

namespace skein::mission {
namespace {

/// As leaders give way to each other (Leader): to the greater reward, then to the lower id.
bool comes_before(const coalition::Announcement& one, const coalition::Announcement& other) {
  if (one.reward != other.reward) return one.reward > other.reward;
  return one.round.coalition.leader < other.round.coalition.leader;
}

/// It is announced again, as soon as its leader has waited.
bool lacks_vehicles(coalition::Reason why) {
  using coalition::Reason;
  return why == Reason::no_allocation || why == Reason::award_refused ||
         why == Reason::not_confirmed;
}

}  // namespace

std::optional<Vec2> relay_place(const Vec2& here, const Vec2& place, double reach_m) {
  const Vec2 out = here - place;
  const double away_m = out.norm();
  if (away_m <= reach_m) return std::nullopt;
  return place + reach_m / away_m * out;
}

void RelayOrbit::on_message(const coalition::Message& message, Instant now) {
  std::visit(Overloaded{[&](const coalition::Announcement& m) { on_announcement(m, now); },
                        [&](const coalition::Cancel& m) { on_cancel(m); },
                        [&](const coalition::Award& m) {
                          if (call_ && call_->said.site.id == m.site.id) call_->award = m.round;
                        },
                        [&](const coalition::LeaseRenewal& m) {
                          if (!call_ || call_->said.site.id != m.site) return;
                          const bool stands_now = call_->award == m.round && stands(m);
                          if (m.closed || stands_now) call_.reset();
                        },
                        [](const auto&) {}},
             message);
}

void RelayOrbit::on_announcement(const coalition::Announcement& message, Instant now) {
  if (message.round.coalition.leader == ownship_.spec().id || !makes_sense(message, now)) return;
  const auto can = [this](const TaskId& task) { return ownship_.can(task); };
  const bool same = call_ && call_->said.site.id == message.site.id;
  if (std::ranges::none_of(message.tasks, can)) {
    if (same) call_.reset();
    return;
  }
  if (call_ && !same && !comes_before(message, call_->said)) return;
  if (!same) call_ = Call{};
  call_->said = message;
  call_->failed = call_->failed || message.round.number > 1;
  call_->heard_at = now;
}

void RelayOrbit::on_cancel(const coalition::Cancel& message) {
  if (!call_ || call_->said.round.coalition != message.round.coalition) return;
  if (!lacks_vehicles(message.why.reason)) return call_.reset();
  call_->failed = true;
  call_->award.reset();
}

void RelayOrbit::close(SiteId site) {
  if (call_ && call_->said.site.id == site) call_.reset();
}

bool RelayOrbit::has_range(Instant now) const {
  const Site& site = call_->said.site;
  const Vec2 here = ownship_.state().position().horizontal();
  return (here - site.position).norm() < ownship_.range_for(site, now);
}

bool RelayOrbit::wanted() const {
  return ownship_.config().protocol.relay_orbit_m > 0.0 && call_ && call_->failed;
}

Instant RelayOrbit::flies_at() const {
  if (!wanted()) return Instant::max();
  const bool stands_by = ownship_.flight().stands_by() == call_->said.site.id;
  return stands_by ? call_->heard_at + ownship_.config().protocol.cut_max : Instant::min();
}

bool RelayOrbit::fly(Instant now) {
  if (!wanted()) return false;
  const auto& protocol = ownship_.config().protocol;
  const Site& site = call_->said.site;
  const bool stands_by = ownship_.flight().stands_by() == site.id;
  // A leader that is not heard for longer may be lost: then its site is relieved (Scout). Who has
  // not the range looks again when it is announced again.
  if (now >= call_->heard_at + protocol.cut_max || (!stands_by && !has_range(now))) {
    call_.reset();
    return false;
  }
  if (stands_by) return true;
  const Vec2 here = ownship_.flight().pose_at(now).position();
  ownship_.stand_by(site.id, relay_place(here, site.position, protocol.relay_orbit_m), now);
  return true;
}

}  // namespace skein::mission
