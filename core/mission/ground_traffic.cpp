// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_traffic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace skein::mission {
namespace {

/// Of a member's way until then: it may turn towards the aircraft.
constexpr double kMember_mps = 40.0;

double distance_m(const SeenAircraft& seen, const Fleet& fleet, Instant now) {
  const Aircraft there = carried_to(seen.aircraft, now);
  const auto nearest = nearest_member(there, fleet, now);
  return nearest ? nearest->distance_m : there.position.norm();
}

/// Whether a member of the team may have to give way to it.
bool may_come_near(const Aircraft& aircraft, double distance_m, const Fleet& fleet) {
  const double ahead_s = to_seconds(GroundTraffic::kAhead);
  const double speed_mps = std::hypot(aircraft.east_mps, aircraft.north_mps) + kMember_mps;
  if (distance_m > std::max(GroundTraffic::kNear_m, ahead_s * speed_mps)) return false;
  const auto [low_m, high_m] =
      std::minmax(aircraft.height_m, aircraft.height_m + aircraft.climb_mps * ahead_s);
  double lowest_m = 0.0;
  double highest_m = 0.0;
  for (const auto& [id, entry] : fleet.vehicles()) {
    if (!entry.telemetry) continue;
    lowest_m = std::min(lowest_m, entry.telemetry->state.z_m);
    highest_m = std::max(highest_m, entry.telemetry->state.z_m);
  }
  return low_m < highest_m + GroundTraffic::kApart_m && high_m > lowest_m - GroundTraffic::kApart_m;
}

}  // namespace

Aircraft carried_to(Aircraft aircraft, Instant now) {
  const double age_s = std::max(0.0, to_seconds(now - aircraft.time));
  aircraft.position += age_s * Vec2{aircraft.east_mps, aircraft.north_mps};
  aircraft.height_m += age_s * aircraft.climb_mps;
  aircraft.time = std::max(aircraft.time, now);
  return aircraft;
}

std::optional<NearestMember> nearest_member(const Aircraft& aircraft, const Fleet& fleet,
                                            Instant now) {
  const Aircraft there = carried_to(aircraft, now);
  std::optional<NearestMember> nearest;
  for (const auto& [id, entry] : fleet.vehicles()) {
    if (!entry.telemetry || entry.revoked) continue;
    const VehicleState& state = entry.telemetry->state;
    const double age_s = std::clamp(to_seconds(now - state.time), 0.0, 5.0);
    const Vec2 velocity{state.velocity_mps().head<2>()};
    const Vec2 apart = there.position - Vec2{state.x_m, state.y_m} - age_s * velocity;
    if (nearest && apart.norm() >= nearest->distance_m) continue;
    const Vec2 closing = Vec2{there.east_mps, there.north_mps} - velocity;
    const double squared = closing.squaredNorm();
    const double in_s = squared > 0.0 ? std::max(0.0, -apart.dot(closing) / squared) : 0.0;
    nearest = NearestMember{id, apart.norm(), there.height_m - state.z_m,
                            (apart + in_s * closing).norm(), in_s};
  }
  return nearest;
}

void GroundTraffic::on_aircraft(SeenAircraft seen, const Fleet& fleet, Instant now) {
  const std::uint32_t address = seen.aircraft.address;
  const auto found = known_.find(address);
  if (found != known_.end() && seen.aircraft.time < found->second.aircraft.time) return;
  if (known_.empty() && !told_) next_tell_ = std::min(next_tell_, now);
  known_[address] = std::move(seen);
  if (known_.size() > kKnownMax) forget_farthest(fleet, now);
}

void GroundTraffic::forget_farthest(const Fleet& fleet, Instant now) {
  auto farthest = known_.begin();
  double most_m = -1.0;
  for (auto known = known_.begin(); known != known_.end(); ++known) {
    const double away_m = distance_m(known->second, fleet, now);
    if (away_m <= most_m) continue;
    most_m = away_m;
    farthest = known;
  }
  known_.erase(farthest);
}

void GroundTraffic::on_timeout(const Fleet& fleet, Instant now) {
  if (now < next_tell_ || (known_.empty() && !told_)) return;
  next_tell_ = now + kTellPeriod;
  std::erase_if(known_,
                [now](const auto& entry) { return now - entry.second.aircraft.time > kForgotten; });
  std::vector<std::pair<double, std::uint32_t>> near;
  for (const auto& [address, seen] : known_) {
    const double away_m = distance_m(seen, fleet, now);
    // Who rolls on the ground comes near to nobody.
    if (seen.on_ground || !may_come_near(carried_to(seen.aircraft, now), away_m, fleet)) continue;
    near.emplace_back(away_m, address);
  }
  std::ranges::sort(near);
  Traffic traffic;
  for (const auto& [away_m, address] : near) {
    if (traffic.aircraft.size() >= kAircraftMax) break;
    traffic.aircraft.push_back(known_.at(address).aircraft);
  }
  const bool any = !traffic.aircraft.empty();
  if (any || told_) message_ = Message{std::move(traffic)};
  told_ = any;
}

std::optional<Message> GroundTraffic::poll_message() { return std::exchange(message_, {}); }

Instant GroundTraffic::next_timeout() const {
  return known_.empty() && !told_ ? Instant::max() : next_tell_;
}

}  // namespace skein::mission
