// SPDX-License-Identifier: Apache-2.0
#include "skein/console/team_wind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "skein/base/angles.hpp"
#include "skein/codec/json_text.hpp"

namespace skein::console {
namespace {

using codec::Json;

constexpr std::int64_t kGustSeconds = 3;
/// Below it nobody says from where it blows.
constexpr double kCalm_mps = 0.5;
/// Of the seconds of the window: fewer are too short to average over.
constexpr int kSecondsMin = 5;

std::int64_t second_of(Instant now) {
  return std::chrono::floor<std::chrono::seconds>(now.time_since_epoch()).count();
}

/// What a plane's air does to it; none where that cannot be known of this state.
std::optional<Vec2> wind_of(const VehicleState& s) {
  if (s.airspeed_mps < TeamWind::kAirspeedMin_mps || s.on_ground()) return std::nullopt;
  // The airspeed is along the way through the air, which climbs.
  const double level =
      std::sqrt(std::max(0.0, s.airspeed_mps * s.airspeed_mps - s.climb_mps * s.climb_mps));
  return Vec2{s.groundspeed_mps * unit_vector(s.course_rad) - level * unit_vector(s.heading_rad)};
}

double rounded(double value) { return std::round(10.0 * value) / 10.0; }

Json from_json(const WindEstimate& wind) {
  if (wind.mean_mps.norm() < kCalm_mps) return nullptr;
  return std::fmod(std::round(wind.from_deg()), 360.0);
}

Json wind_json(const WindEstimate& wind, Instant now) {
  return {{"from_deg", from_json(wind)},
          {"speed_mps", rounded(wind.mean_mps.norm())},
          {"gust_mps", rounded(wind.gust_mps)},
          {"age_s", rounded(to_seconds(now - wind.newest))}};
}

}  // namespace

std::string words_of(const WindEstimate& wind) {
  const std::string from =
      wind.mean_mps.norm() < kCalm_mps
          ? "calm"
          : fmt::format("from {:03.0f} deg at", std::fmod(std::round(wind.from_deg()), 360.0));
  return fmt::format("{} {:.1f} m/s, gusts {:.1f} m/s", from, wind.mean_mps.norm(), wind.gust_mps);
}

double WindEstimate::from_deg() const {
  const Vec2 from = -mean_mps;
  return compass_deg_from_heading(std::atan2(from.y(), from.x()));
}

void TeamWind::on_telemetry(const mission::Telemetry& told, Instant now) {
  const auto wind = wind_of(told.state);
  if (!wind || !wind->allFinite()) return;
  if (vehicles_.size() >= kVehiclesMax && !vehicles_.contains(told.vehicle)) return;
  Vehicle& vehicle = vehicles_[told.vehicle];
  const std::int64_t second = second_of(now);
  Slot& slot = vehicle.slots.at(static_cast<std::size_t>((second % kSlots + kSlots) % kSlots));
  if (slot.second != second) slot = {.second = second};
  slot.sum_mps += *wind;
  slot.count += 1.0;
  vehicle.newest = now;
}

std::optional<WindEstimate> TeamWind::estimate_of(const Vehicle& vehicle, Instant now) {
  const std::int64_t last = second_of(now);
  std::array<std::optional<Vec2>, kSlots> means;  // the oldest first
  Vec2 sum{0.0, 0.0};
  int seconds = 0;
  for (const Slot& slot : vehicle.slots) {
    if (slot.count == 0.0 || slot.second <= last - kSlots || slot.second > last) continue;
    const Vec2 mean = slot.sum_mps / slot.count;
    means.at(static_cast<std::size_t>(slot.second - (last - kSlots) - 1)) = mean;
    sum += mean;
    ++seconds;
  }
  if (seconds < kSecondsMin) return std::nullopt;
  WindEstimate estimate;
  estimate.mean_mps = sum / seconds;
  estimate.newest = vehicle.newest;
  for (std::size_t i = 0; i + kGustSeconds <= means.size(); ++i) {
    Vec2 gust{0.0, 0.0};
    double count = 0.0;
    for (std::size_t k = i; k < i + kGustSeconds; ++k) {
      if (!means.at(k)) continue;
      gust += *means.at(k);
      count += 1.0;
    }
    if (count > 0.0) estimate.gust_mps = std::max(estimate.gust_mps, (gust / count).norm());
  }
  estimate.gust_mps = std::max(estimate.gust_mps, estimate.mean_mps.norm());
  return estimate;
}

std::optional<TeamWindEstimate> TeamWind::estimate(const std::set<VehicleId>& not_counted,
                                                   Instant now) const {
  TeamWindEstimate team;
  team.wind.newest = Instant::min();
  for (const auto& [id, vehicle] : vehicles_) {
    const auto one = not_counted.contains(id) ? std::nullopt : estimate_of(vehicle, now);
    if (!one) continue;
    team.vehicles.emplace(id, *one);
    team.wind.mean_mps += one->mean_mps;
    team.wind.gust_mps = std::max(team.wind.gust_mps, one->gust_mps);
    team.wind.newest = std::max(team.wind.newest, one->newest);
  }
  if (team.vehicles.empty()) return std::nullopt;
  const auto count = static_cast<double>(team.vehicles.size());
  team.wind.mean_mps /= count;
  double squares = 0.0;
  for (const auto& [id, one] : team.vehicles) {
    squares += (one.mean_mps - team.wind.mean_mps).squaredNorm();
  }
  team.spread_mps = std::sqrt(squares / count);
  return team;
}

std::set<VehicleId> without_airspeed(const mission::Fleet& fleet) {
  std::set<VehicleId> all;
  for (const auto& [id, entry] : fleet.vehicles()) {
    if (entry.preflight && entry.preflight->copter) all.insert(id);
  }
  return all;
}

std::string wind_json(const std::optional<TeamWindEstimate>& estimate, Instant now) {
  if (!estimate) return "null";
  Json json = wind_json(estimate->wind, now);
  json["spread_mps"] = rounded(estimate->spread_mps);
  json["vehicles"] = Json::array();
  for (const auto& [id, one] : estimate->vehicles) {
    Json vehicle = wind_json(one, now);
    vehicle["id"] = id.value;
    json["vehicles"].push_back(std::move(vehicle));
  }
  return codec::json_text(json);
}

std::string wind_text(const std::optional<TeamWindEstimate>& estimate, Instant now) {
  if (!estimate) return "nobody tells of the wind: it takes planes that fly\n";
  std::string text = fmt::format("{}; {} {}, {:.1f} m/s apart, {:.0f} s old\n",
                                 words_of(estimate->wind), estimate->vehicles.size(),
                                 estimate->vehicles.size() == 1 ? "plane tells" : "planes tell",
                                 estimate->spread_mps, to_seconds(now - estimate->wind.newest));
  for (const auto& [id, one] : estimate->vehicles) {
    text += fmt::format("vehicle {:<5} {}\n", id.value, words_of(one));
  }
  return text;
}

}  // namespace skein::console
