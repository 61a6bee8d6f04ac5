// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_return.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "skein/base/angles.hpp"
#include "told_at_once.hpp"

namespace skein::mission {
namespace {

constexpr Duration kPeriod = std::chrono::milliseconds{100};
constexpr Duration kTellAgain = std::chrono::seconds{1};
/// The order is repeated for so long, and each time what a vehicle flies.
constexpr Duration kGatherFor = std::chrono::seconds{6};
/// From the plan to its begin: enough to be heard once of six times.
constexpr Duration kLead = std::chrono::seconds{6};
/// After the begin, to hear who flies it: that is told each time that a vehicle is told its way.
constexpr Duration kToldBack = std::chrono::seconds{3};
constexpr int kRounds = 4;
constexpr std::size_t kPlansMax = 1024;
/// It begins at home.
constexpr std::uint32_t kFirstPlan = 1;
/// Of the preview's least separation: a plane flies some metres meanwhile.
constexpr Duration kSeparationStep = std::chrono::milliseconds{200};
constexpr int kSeparationStepsMax = 20'000;  ///< more than an hour
/// A round of any orbit, after the last has come there.
constexpr Duration kOrbitsFor = std::chrono::seconds{60};
/// Two ways are one that come to the same places at the same times, to this.
constexpr double kSamePlace_m = 5.0;
constexpr double kSameHeading_rad = 0.05;

Duration telling_takes(std::size_t vehicles) {
  return static_cast<std::int64_t>(vehicles / (kToldAtOnce + 1)) * kToldEvery;
}

std::optional<double> least_separation_m(const std::vector<ReturnPreview::Way>& ways, Instant start,
                                         Instant last_arrival) {
  if (ways.size() < 2) return std::nullopt;
  double least_sq = std::numeric_limits<double>::infinity();
  std::vector<Vec3> places(ways.size());
  const Instant end = last_arrival + kOrbitsFor;
  // Whatever vehicles tell of themselves, one look takes no longer than this.
  const Duration step = std::max(kSeparationStep, (end - start) / kSeparationStepsMax);
  for (Instant t = start; t <= end; t += step) {
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const Vec2 place = ways[i].timed.pose_at(t).position();
      places[i] = {place.x(), place.y(), ways[i].height_m};
      for (std::size_t j = 0; j < i; ++j) {
        least_sq = std::min(least_sq, (places[i] - places[j]).squaredNorm());
      }
    }
  }
  return std::sqrt(least_sq);
}

bool same_way(const TimedPath& flies, const TimedPath& given) {
  const Instant end = given.end_time();
  const Instant begin = given.start_time;
  // And then on the same orbit, whatever its times there.
  const Pose2 ends = flies.path.end();
  const Pose2 to_end = given.path.end();
  if (flies.tail_curvature_per_m != given.tail_curvature_per_m ||
      std::abs(wrap_pi(ends.heading_rad - to_end.heading_rad)) > kSameHeading_rad) {
    return false;
  }
  const std::array<Instant, 3> when{begin, begin + (end - begin) / 2, end};
  return std::ranges::all_of(when, [&](Instant t) {
    return (flies.pose_at(t).position() - given.pose_at(t).position()).norm() <= kSamePlace_m;
  });
}

}  // namespace

// --- orders, and what is heard ---

void GroundReturn::on_order(const std::vector<VehicleId>& vehicles, CommandKind kind,
                            const Fleet& fleet, Instant now) {
  if (kind == CommandKind::give_back) return;  // an act, and no order
  for (const VehicleId vehicle : vehicles) {
    homing_.erase(vehicle);
    const auto known = fleet.vehicles().find(vehicle);
    if (kind != CommandKind::return_home || known == fleet.vehicles().end()) continue;
    const FleetEntry& entry = known->second;
    if (!entry.expected || !entry.telemetry || entry.silent) continue;
    if (entry.telemetry->activity == Activity::landed) continue;
    homing_[vehicle].number_before = entry.telemetry->plan_number;
  }
  if (kind != CommandKind::return_home) {
    if (homing_.empty()) step_ = Step::idle;
    return;
  }
  rounds_ = 0;
  gather(now);
}

void GroundReturn::on_message(const Message& message) {
  if (const auto* told = std::get_if<Telemetry>(&message)) {
    if (begun_.size() < kPlansMax) {
      begun_.try_emplace(told->vehicle, Vec2{told->state.x_m, told->state.y_m});
    }
    return;
  }
  const auto* report = std::get_if<PlanReport>(&message);
  if (report == nullptr) return;
  if (report->plan.number == kFirstPlan && begun_.contains(report->vehicle)) {
    begun_[report->vehicle] = report->plan.timed.path.start.position();
  }
  if (flies_.contains(report->vehicle) || flies_.size() < kPlansMax) {
    flies_[report->vehicle] = report->plan;
  }
}

// --- what is due ---

void GroundReturn::on_timeout(const Fleet& fleet, const std::vector<Hazard>& hazards, Instant now) {
  if (step_ == Step::idle) next_ = Instant::max();
  if (now < next_) return;
  next_ = now + kPeriod;
  if (step_ == Step::gathering) {
    if (all_told(fleet) || now >= step_ends_) plan(fleet, hazards, now);
  } else if (now >= step_ends_) {
    review(now);
  } else {
    tell(now);
  }
}

void GroundReturn::gather(Instant now) {
  step_ = homing_.empty() ? Step::idle : Step::gathering;
  step_ends_ = now + kGatherFor + telling_takes(homing_.size());
  next_ = now;
  ++rounds_;
}

/// What it flies is known: no newer plan of it is heard of than the one that it has told.
bool GroundReturn::is_known(VehicleId vehicle, const Telemetry& telemetry) const {
  const auto flies = flies_.find(vehicle);
  return flies != flies_.end() && flies->second.number >= telemetry.plan_number;
}

/// Its own way home is a plan after those that it flew when it was ordered; on the way it works for
/// nobody.
bool GroundReturn::has_told(VehicleId vehicle, Homing& homing, const Fleet& fleet) const {
  const auto known = fleet.vehicles().find(vehicle);
  if (known == fleet.vehicles().end() || !known->second.telemetry) return false;
  const Telemetry& telemetry = *known->second.telemetry;
  if (telemetry.activity != Activity::holding || !is_known(vehicle, telemetry)) return false;
  if (homing.home) return true;
  const FlightPlan& plan = flies_.at(vehicle);
  if (plan.number <= homing.number_before || plan.timed.tail_curvature_per_m == 0.0) return false;
  homing.home = plan.timed.path.end().position();
  return true;
}

bool GroundReturn::all_told(const Fleet& fleet) {
  bool all = true;
  for (auto& [vehicle, homing] : homing_) all = has_told(vehicle, homing, fleet) && all;
  return all;
}

bool GroundReturn::follows(VehicleId vehicle, const Homing& homing) const {
  const auto flies = flies_.find(vehicle);
  return homing.given && flies != flies_.end() && same_way(flies->second.timed, *homing.given);
}

planning::ReturningVehicle GroundReturn::vehicle_of(VehicleId vehicle, const Homing& homing,
                                                    const Telemetry& telemetry,
                                                    Instant start) const {
  const TimedPath& timed = flies_.at(vehicle).timed;
  planning::ReturningVehicle v;
  v.id = vehicle;
  v.height_m = telemetry.state.z_m;
  v.home = *homing.home;
  // Who flies something newer than it has told has taken up what it was given, most likely.
  if (follows(vehicle, homing) || !is_known(vehicle, telemetry)) {
    v.flies = homing.given;
    return v;
  }
  v.start = timed.pose_at(start);
  v.start_time = start;
  v.speed_mps = timed.speed_mps;
  v.wind_mps = timed.wind_mps();
  v.speed_min_mps = timed.speed_mps;  // what is below it is for keeping its times in wind
  v.turn_radius_m = 1.0 / std::abs(timed.tail_curvature_per_m);
  const double until_then_s = std::max(0.0, to_seconds(start - telemetry.state.time));
  v.range_left_m = telemetry.range_left_m - until_then_s * timed.speed_mps;
  return v;
}

void GroundReturn::plan(const Fleet& fleet, const std::vector<Hazard>& hazards, Instant now) {
  const Instant start = now + kLead + telling_takes(homing_.size());
  (void)all_told(fleet);
  std::vector<planning::ReturningVehicle> vehicles;
  for (auto& [vehicle, homing] : homing_) {
    const auto known = fleet.vehicles().find(vehicle);
    const bool told = known != fleet.vehicles().end() && known->second.telemetry;
    if (!told || !homing.home || homing.alone) continue;
    const Telemetry& telemetry = *known->second.telemetry;
    const bool silent = known->second.silent;
    if (!homing.given && (silent || !is_known(vehicle, telemetry))) continue;
    vehicles.push_back(vehicle_of(vehicle, homing, telemetry, start));
    if (silent) vehicles.back().flies = homing.given;  // as far as anybody knows
  }
  const auto planned = planning::plan_return(config_.params, vehicles, hazards);
  for (const auto& flight : planned.flights) {
    Homing& homing = homing_.at(flight.vehicle);
    homing.given = flight.timed;
    homing.tell_at = now;
  }
  for (const auto& failure : planned.failures) {
    leave_alone(failure.vehicle, homing_.at(failure.vehicle), reason_of(failure), now);
  }
  if (!planned.flights.empty()) {
    // Numbers grow also over a restart of this process, or vehicles would take a new plan for old.
    const auto since_epoch = std::chrono::duration_cast<std::chrono::milliseconds>(
                                 std::max(now, Instant{}).time_since_epoch())
                                 .count();
    plan_ = std::max(plan_, static_cast<std::uint32_t>(since_epoch)) + 1;
    event::ReturnPlanned body;
    body.plan = plan_;
    body.vehicles = static_cast<std::uint16_t>(planned.flights.size());
    body.takes = planned.last_arrival - now;
    events_.push({kGroundStation, now, {}, {}, body});
  }
  step_ = Step::telling;
  step_ends_ = start + kToldBack;
  tell(now);
}

Result<planning::ReturningVehicle> GroundReturn::as_if_ordered(VehicleId vehicle,
                                                               const Fleet& fleet,
                                                               Instant start) const {
  const auto known = fleet.vehicles().find(vehicle);
  if (known == fleet.vehicles().end() || !known->second.expected) {
    return Error{"is not in the fleet"};
  }
  const FleetEntry& entry = known->second;
  if (!entry.telemetry || entry.silent) return Error{"is not heard"};
  const Telemetry& telemetry = *entry.telemetry;
  if (telemetry.state.on_ground() || telemetry.activity == Activity::landed) {
    return Error{"is on the ground"};
  }
  const auto flies = flies_.find(vehicle);
  if (flies == flies_.end()) return Error{"has not told what it flies"};
  const auto homing = homing_.find(vehicle);
  if (homing != homing_.end() && homing->second.home) {
    if (!homing->second.given && !is_known(vehicle, telemetry)) {
      return Error{"has not told what it flies"};
    }
    return vehicle_of(vehicle, homing->second, telemetry, start);
  }
  const TimedPath& timed = flies->second.timed;
  const double curvature =
      std::max(timed.path.curvature_max_per_m(), std::abs(timed.tail_curvature_per_m));
  const auto begun = begun_.find(vehicle);
  if (curvature <= 0.0 || begun == begun_.end()) {
    return Error{"tells of no turn that it flies: it comes home on a way of its own"};
  }
  planning::ReturningVehicle v;
  v.id = vehicle;
  v.height_m = telemetry.state.z_m;
  v.home = begun->second;
  v.start = timed.pose_at(start);
  v.start_time = start;
  v.speed_mps = timed.speed_mps;
  v.wind_mps = timed.wind_mps();
  v.speed_min_mps = timed.speed_mps;
  v.turn_radius_m = 1.0 / curvature;
  v.range_left_m = telemetry.range_left_m -
                   std::max(0.0, to_seconds(start - telemetry.state.time)) * timed.speed_mps;
  return v;
}

ReturnPreview GroundReturn::preview(const std::vector<VehicleId>& vehicles, const Fleet& fleet,
                                    const std::vector<Hazard>& hazards, Instant now) const {
  ReturnPreview preview;
  const Instant start = now + kLead + telling_takes(vehicles.size());
  std::map<VehicleId, planning::ReturningVehicle> asked;  // each once, whatever was typed
  for (const VehicleId vehicle : vehicles) {
    auto one = as_if_ordered(vehicle, fleet, start);
    if (one) {
      asked.emplace(vehicle, *std::move(one));
    } else {
      preview.cannot.emplace_back(vehicle, one.error().message);
    }
  }
  std::vector<planning::ReturningVehicle> all;
  for (const auto& [id, one] : asked) all.push_back(one);
  const auto planned = planning::plan_return(config_.params, all, hazards);
  for (const auto& failure : planned.failures) {
    preview.cannot.emplace_back(failure.vehicle, reason_of(failure));
  }
  const auto add = [&](VehicleId vehicle, const TimedPath& timed) {
    const auto homing = homing_.find(vehicle);
    const bool told = homing != homing_.end() && homing->second.home;
    preview.ways.push_back({vehicle, timed, asked.at(vehicle).height_m, !told});
  };
  for (const auto& one : all) {
    if (one.flies) add(one.id, *one.flies);
  }
  for (const auto& flight : planned.flights) add(flight.vehicle, flight.timed);
  std::ranges::sort(preview.ways, {}, &ReturnPreview::Way::vehicle);
  std::ranges::sort(preview.cannot);
  preview.last_arrival = now;
  for (const auto& way : preview.ways) {
    preview.last_arrival = std::max(preview.last_arrival, way.timed.end_time());
  }
  preview.least_separation_m = least_separation_m(preview.ways, start, preview.last_arrival);
  return preview;
}

void GroundReturn::tell(Instant now) {
  std::size_t told = 0;
  for (auto& [vehicle, homing] : homing_) {
    const bool due = homing.given && now >= homing.tell_at;
    if (!due || follows(vehicle, homing)) continue;
    if (told++ == kToldAtOnce) return;
    messages_.push(Message{ReturnFlight{vehicle, plan_, *homing.given}});
    homing.tell_at = now + kTellAgain;
  }
}

void GroundReturn::review(Instant now) {
  bool all = true;
  for (const auto& [vehicle, homing] : homing_) {
    all = all && (homing.alone || follows(vehicle, homing));
  }
  if (!all && rounds_ < kRounds) return gather(now);
  step_ = Step::idle;
  for (auto& [vehicle, homing] : homing_) {
    if (homing.alone || follows(vehicle, homing)) continue;
    leave_alone(vehicle, homing,
                homing.home ? "it has not taken up the way that it was told"
                            : "it has not told what it flies",
                now);
  }
}

void GroundReturn::leave_alone(VehicleId vehicle, Homing& homing, std::string why, Instant now) {
  homing.given.reset();
  homing.alone = true;
  event::ReturnAlone body;
  body.vehicle = vehicle;
  body.detail = std::move(why);
  events_.push({kGroundStation, now, {}, {}, std::move(body)});
}

}  // namespace skein::mission
