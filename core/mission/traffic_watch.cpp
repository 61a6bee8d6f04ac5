// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/traffic_watch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "skein/mission/guidance.hpp"

namespace skein::mission {
namespace {

/// What is not known of where an aircraft will be grows by so much: it turns, and so do plans.
constexpr double kMargin_mps = 3.0;
/// A conflict ends only beyond these.
constexpr double kClearFactor = 1.2;
constexpr double kClearHeight_m = 5.0;
/// Lower, it stands on the ground.
constexpr double kStands_m = 2.0;
/// Of heights, which are told in steps of 25 feet and looked at twice a second.
constexpr double kHeightMargin_m = 3.0;
constexpr Duration kStep = std::chrono::seconds{1};
/// A climb is begun so much later than it is asked for.
constexpr double kClimbLag_s = 3.0;
constexpr std::size_t kAircraftKnownMax = 64;
constexpr std::size_t kEventsMax = 64;

bool is_told_whole(const Aircraft& a) {
  return std::isfinite(a.position.x()) && std::isfinite(a.position.y()) &&
         std::isfinite(a.height_m) && std::isfinite(a.east_mps) && std::isfinite(a.north_mps) &&
         std::isfinite(a.climb_mps);
}

/// Of two points that move evenly, at most.
double least_distance(const Vec2& begin, const Vec2& end) {
  const Vec2 way = end - begin;
  const double squared = way.squaredNorm();
  const double share = squared > 0.0 ? std::clamp(-begin.dot(way) / squared, 0.0, 1.0) : 0.0;
  return (begin + share * way).norm();
}

bool is_in(const HeightBand& band, double height_m) {
  return height_m > band.low_m && height_m < band.high_m;
}

}  // namespace

void TrafficWatch::on_traffic(const Traffic& traffic) {
  if (params_.look_ahead == Duration{}) return;
  if (traffic.aircraft.empty()) {  // none is near any more
    for (auto& [address, known] : known_) known.aircraft.time = Instant::min();
    return;
  }
  for (const Aircraft& told : traffic.aircraft) {
    if (!is_told_whole(told)) continue;
    const auto found = known_.find(told.address);
    if (found == known_.end() && known_.size() >= kAircraftKnownMax) continue;
    Known& known = known_[told.address];
    if (found == known_.end() || told.time >= known.aircraft.time) known.aircraft = told;
  }
}

std::optional<TrafficWatch::Conflict> TrafficWatch::conflict() const {
  std::optional<Conflict> first;
  for (const auto& [address, known] : known_) {
    if (!known.conflict) continue;
    if (!first) first = Conflict{address, known.told_way};
    first->gives_way = first->gives_way && known.told_way;
  }
  return first;
}

std::optional<EventBody> TrafficWatch::poll_event() {
  if (events_.empty()) return std::nullopt;
  EventBody first = std::move(events_.front());
  events_.pop_front();
  return first;
}

void TrafficWatch::step(const Self& self, Instant now) {
  if (now < next_look_ || !watches()) return;
  next_look_ = now + kLookPeriod;
  for (auto& [address, known] : known_) look(known, self, now);
  std::erase_if(known_, [now](const auto& entry) {
    return !entry.second.conflict && (entry.second.aircraft.time == Instant::min() ||
                                      now - entry.second.aircraft.time > kForgotten);
  });
  choose(self);
  for (auto& [address, known] : known_) tell(known, self, now);
}

std::optional<TrafficWatch::Encounter> TrafficWatch::encounter(const Self& self,
                                                               const Aircraft& aircraft,
                                                               double factor, Instant now) const {
  const double age_s = std::max(0.0, to_seconds(now - aircraft.time));
  const Vec2 velocity{aircraft.east_mps, aircraft.north_mps};
  const Vec2 own_velocity{self.state.velocity_mps().head<2>()};
  const Vec2 own_place{self.state.x_m, self.state.y_m};
  const auto apart_at = [&](Duration ahead) {
    const double t_s = to_seconds(ahead);
    const Vec2 own = self.plan != nullptr ? self.plan->timed.pose_at(now + ahead).position()
                                          : Vec2{own_place + t_s * own_velocity};
    return Vec2{aircraft.position + (age_s + t_s) * velocity - own};
  };
  const double height_now_m = aircraft.height_m + aircraft.climb_mps * age_s;
  const double vertical_m = params_.vertical_m + kHeightMargin_m;
  std::optional<Encounter> found;
  Vec2 begin = apart_at({});
  for (Duration ahead{}; ahead < params_.look_ahead; ahead += kStep) {
    const Vec2 end = apart_at(ahead + kStep);
    const double t_s = to_seconds(ahead);
    const double apart_m = least_distance(begin, end);
    begin = end;
    if (apart_m >= factor * params_.horizontal_m + kMargin_mps * (age_s + t_s)) continue;
    // It may go on climbing, or level off at any moment.
    const double then_m = height_now_m + aircraft.climb_mps * (t_s + to_seconds(kStep));
    const auto [low_m, high_m] = std::minmax(height_now_m, then_m);
    if (!found) {
      found = Encounter{.enters_s = t_s,
                        .heights = {low_m - vertical_m, high_m + vertical_m},
                        .horizontal_m = apart_m,
                        .vertical_m = std::abs(then_m - self.state.z_m),
                        .closest_s = t_s};
      continue;
    }
    found->heights.low_m = std::min(found->heights.low_m, low_m - vertical_m);
    found->heights.high_m = std::max(found->heights.high_m, high_m + vertical_m);
    if (apart_m >= found->horizontal_m) continue;
    found->horizontal_m = apart_m;
    found->vertical_m = std::abs(then_m - self.state.z_m);
    found->closest_s = t_s;
  }
  return found;
}

void TrafficWatch::look(Known& known, const Self& self, Instant now) {
  const bool is_known =
      known.aircraft.time != Instant::min() && now - known.aircraft.time <= kForgotten;
  known.encounter = is_known
                        ? encounter(self, known.aircraft, known.conflict ? kClearFactor : 1.0, now)
                        : std::nullopt;
  // Who has given way is to come back.
  // Who takes off is to go there.
  const bool goes_there = self.may_give_way || self.state.z_m > kStands_m;
  const double back_m = goes_there ? self.layer_m : self.state.z_m;
  const auto [low_m, high_m] = std::minmax(self.state.z_m, back_m);
  const double more_m = known.conflict ? kClearHeight_m : 0.0;
  const bool breaks = known.encounter && low_m < known.encounter->heights.high_m + more_m &&
                      high_m > known.encounter->heights.low_m - more_m;
  if (breaks) {
    known.conflict = true;
    known.clear_since = now;
    return;
  }
  const bool is_clear = !is_known || now - known.clear_since >= kClear;
  if (!known.conflict || !is_clear) return;
  known.conflict = false;
  known.encounter.reset();
  if (std::exchange(known.told, false)) {
    events_.emplace_back(event::TrafficClear{known.aircraft.address});
  }
}

/// The nearest height from there on that side that is too near to none of them.
std::optional<double> TrafficWatch::free_height(double from_m, bool up, double ceiling_m) const {
  double height_m = from_m;
  for (bool moved = true; moved;) {
    moved = false;
    for (const auto& [address, known] : known_) {
      if (!known.conflict || !known.encounter) continue;
      const HeightBand& band = known.encounter->heights;
      const HeightBand wide{band.low_m - kRoom_m / 2.0, band.high_m + kRoom_m / 2.0};
      if (!is_in(wide, height_m)) continue;
      height_m = up ? std::ceil(band.high_m + kRoom_m) : std::floor(band.low_m - kRoom_m);
      moved = true;
    }
  }
  const bool allowed = up ? height_m <= ceiling_m : height_m >= params_.floor_m;
  return allowed ? std::optional{height_m} : std::nullopt;
}

/// Does it leave the heights that are too near, on its way there, before they are?
bool TrafficWatch::in_time(const Self& self, const Encounter& encounter, double to_m) const {
  const HeightBand& band = encounter.heights;
  if (is_in(band, to_m)) return false;
  const double z_m = self.state.z_m;
  const bool passes = (z_m > band.low_m && to_m < band.high_m && z_m > to_m) ||
                      (z_m < band.high_m && to_m > band.low_m && z_m < to_m);
  if (!is_in(band, z_m) && !passes) return true;
  const double edge_m = to_m < z_m ? band.low_m : band.high_m;
  const double way_m = std::max(0.0, to_m < z_m ? z_m - edge_m : edge_m - z_m);
  if (way_m == 0.0) return true;
  return way_m / kHeightRate_mps + kClimbLag_s <= encounter.enters_s;
}

void TrafficWatch::choose(const Self& self) {
  const Known* first = nullptr;
  for (const auto& [address, known] : known_) {
    if (!known.conflict || !known.encounter) continue;
    if (first == nullptr || known.encounter->enters_s < first->encounter->enters_s) first = &known;
  }
  const bool holds = std::ranges::any_of(known_, [](const auto& e) { return e.second.conflict; });
  if (!self.may_give_way || !holds) {
    target_.reset();
    room_ = {};
    return;
  }
  if (first == nullptr) return;  // they are clear of each other, and not for long enough yet
  const double ceiling_m = std::min(params_.ceiling_m, self.ceiling_m);
  const auto all_in_time = [&](double to_m) {
    return std::ranges::all_of(known_, [&](const auto& entry) {
      const Known& known = entry.second;
      return !known.conflict || !known.encounter || in_time(self, *known.encounter, to_m);
    });
  };
  if (!target_ || !all_in_time(*target_)) {
    const auto down = free_height(self.layer_m, false, ceiling_m);
    const auto up = free_height(self.layer_m, true, ceiling_m);
    const double other_m =
        0.5 * (first->encounter->heights.low_m + first->encounter->heights.high_m);
    const bool is_above = other_m >= self.state.z_m;
    if (down && all_in_time(*down)) {
      target_ = down;
    } else if (up && all_in_time(*up)) {
      target_ = up;
    } else if (is_above) {
      target_ = down.value_or(std::min(std::max(params_.floor_m, 0.0), self.layer_m));
    } else {
      target_ = up.value_or(std::max(ceiling_m, self.layer_m));
    }
  }
  room_ = {params_.floor_m, ceiling_m};
  if (!all_in_time(*target_)) {  // what the team needs among itself comes first then
    if (*target_ < self.layer_m) room_.high_m = self.layer_m;
    if (*target_ > self.layer_m) room_.low_m = self.layer_m;
    return;
  }
  for (const auto& [address, known] : known_) {
    if (!known.conflict || !known.encounter) continue;
    const HeightBand& band = known.encounter->heights;
    const bool below = *target_ < 0.5 * (band.low_m + band.high_m);
    if (below) {
      room_.high_m = std::min(room_.high_m, std::max(band.low_m, *target_));
    } else {
      room_.low_m = std::max(room_.low_m, std::min(band.high_m, *target_));
    }
  }
}

void TrafficWatch::tell(Known& known, const Self& self, Instant now) {
  if (!known.conflict || !known.encounter) return;
  const bool gives_way = target_ && in_time(self, *known.encounter, *target_);
  const Duration closest_in = from_seconds(known.encounter->closest_s);
  // It has come back, or was later than expected: what was told is no more so.
  const bool is_past = known.told && now > known.told_closest + kToldEvery &&
                       closest_in > kToldEvery && now >= known.told_at + kToldEvery;
  // That it will not do after all is told at once.
  const bool is_news = !known.told || (known.told_way && !gives_way) || is_past;
  if (!is_news) return;
  const bool too_soon = !known.told && known.told_at != Instant::min() &&
                        now - known.told_at < kToldEvery && gives_way;
  if (too_soon || events_.size() >= kEventsMax) return;
  known.told = true;
  known.told_way = gives_way;
  known.told_at = now;
  known.told_closest = now + closest_in;
  events_.emplace_back(event::TrafficWarning{known.aircraft.address, known.encounter->horizontal_m,
                                             known.encounter->vertical_m, closest_in, gives_way});
}

}  // namespace skein::mission
