// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/track_ground.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "names.hpp"
#include "skein/mission/shown_state.hpp"
#include "skein/planning/fence_check.hpp"
#include "told_at_once.hpp"

namespace skein::mission {
namespace {

using event::FormationNews;
using formation::PlannedTrack;

constexpr Duration kPeriod = std::chrono::milliseconds{100};
constexpr Duration kRepeat = std::chrono::milliseconds{500};
/// Who has not begun so long after the start does not begin any more.
constexpr Duration kBegunWithin = std::chrono::seconds{2};
constexpr Duration kTryAgain = std::chrono::seconds{5};
/// Orders that somebody may fly yet who was not heard.
constexpr std::size_t kSentMax = 16;

}  // namespace

TrackGround::TrackGround(const TrackGroundConfig& config, Instant now)
    : config_{config}, hazards_{config.rules.hazards}, next_{now} {}

// --- orders --------------------------------------------------------------------------------------

Result<formation::TrackRequest> TrackGround::request_of(const TrackOrder& order,
                                                        Instant now) const {
  formation::TrackRequest request;
  request.track = order.track;
  request.laps = order.laps;
  request.shape = order.shape;
  request.start = now + config_.lead;
  request.rules = config_.rules;
  double slowest_mps = std::numeric_limits<double>::infinity();
  for (const VehicleSpec& spec : config_.planes) {
    formation::TrackPlane plane{spec, {}, 0.0};
    const auto found = members_.find(spec.id);
    if (found == members_.end() || !found->second.follows()) {
      request.silent.push_back(plane);
      continue;
    }
    const Member& member = found->second;
    const auto flies = flies_.find(spec.id);
    if (flies == flies_.end()) {
      return Error{name_of(spec.id) + " has not told yet what it flies; ask again in some seconds"};
    }
    plane.flies = flies->second.timed;
    plane.range_left_m = member.range_left_m;
    const bool flies_it = member.status.progress.change == number_ && !member.status.at_rest;
    if (order.kind == OrderKind::reshape && number_ > 0 && !flies_it) {
      // It has left the formation, and orbits somewhere at its own height.
      request.silent.push_back(plane);
      continue;
    }
    slowest_mps = std::min(slowest_mps, spec.cruise_speed_mps);
    request.planes.push_back(plane);
  }
  request.speed_mps = order.speed_mps.value_or(slowest_mps);
  return request;
}

PlannedTrack TrackGround::present() const {
  PlannedTrack now = sent_.at(number_);
  now.flights.clear();
  for (const auto& [vehicle, member] : members_) {
    const auto sent = sent_.find(member.status.progress.change);
    if (sent == sent_.end()) continue;
    for (const auto& flight : sent->second.flights) {
      if (flight.plane.spec.id == vehicle) now.flights.push_back(flight);
    }
  }
  return now;
}

/// Nobody is led out of the fence, the orbit after the track included.
Result<void> TrackGround::within_fence(const PlannedTrack& planned) const {
  for (const auto& flight : planned.flights) {
    const std::string name = name_of(flight.plane.spec.id);
    if (const auto out = planning::first_outside(config_.fence, flight.timed)) {
      return Error{"the way of " + name + " leads out of the fence at " +
                   planning::place_text(*out) + "; take another track, or a smaller shape"};
    }
  }
  return {};
}

Result<TrackPreview> TrackGround::preview(const TrackOrder& order, Instant now) const {
  if (const auto why = barred_.why()) return Error{*why};
  const auto request = request_of(order, now);
  if (!request) return request.error();
  const bool reshapes = order.kind == OrderKind::reshape;
  if (reshapes && !on_track(now)) {
    return Error{
        "the planes fly along no track that this ground station has given them, or are at its end; "
        "order fly-along TRACK in SHAPE"};
  }
  auto planned =
      reshapes ? formation::plan_reshape(present(), *request) : formation::plan_track(*request);
  if (!planned) return planned.error();
  if (auto inside = within_fence(*planned); !inside) return inside.error();
  TrackPreview preview{order, *std::move(planned), {}};
  for (const auto& plane : request->silent) preview.lost.push_back(plane.spec.id);
  return preview;
}

Result<TrackPreview> TrackGround::command(const TrackOrder& order, Instant now) {
  if (now < Instant{}) return Error{"the mission has not begun; vehicles wait for its start"};
  auto preview = this->preview(order, now);
  if (preview) begin(*preview, now);
  return preview;
}

void TrackGround::begin(TrackPreview preview, Instant now) {
  order_ = preview.order;
  // Above whatever a ground station before this one has sent.
  number_ = std::max(number_ + 1, static_cast<std::uint32_t>(to_seconds(now) + 1.0));
  for (const auto& [vehicle, member] : members_) {
    number_ = std::max(number_, member.status.progress.change + 1);
  }
  for (auto& [vehicle, member] : members_) member.arrived_at.reset();
  near_since_.reset();
  held_since_.reset();
  told_not_begun_ = false;
  const PlannedTrack& planned = sent_[number_] = std::move(preview.planned);
  if (sent_.size() > kSentMax) sent_.erase(sent_.begin());
  event::ChangeBegun begun;
  begun.number = number_;
  begun.order = preview.order.kind;
  begun.shape = preview.order.shape.kind;
  begun.way = formation::Way::track;
  begun.vehicles = static_cast<std::uint16_t>(planned.flights.size());
  begun.takes = planned.joined - now;
  begun.separation_m = planned.least_separation_m;
  report(begun, now);
  send_from_ = 0;
  send(now);
}

void TrackGround::send(Instant now) {
  const PlannedTrack& planned = sent_.at(number_);
  const std::size_t begin = std::exchange(send_from_, 0);
  std::size_t told = 0;
  for (std::size_t i = begin; i < planned.flights.size(); ++i) {
    const formation::TrackFlightPlan& flight = planned.flights[i];
    const auto found = members_.find(flight.plane.spec.id);
    if (found == members_.end() || !has_not_begun(found->first, found->second)) continue;
    if (told++ == kToldAtOnce) {
      send_from_ = i;
      send_next_ = now + kToldEvery;
      return;
    }
    TrackFlight message;
    message.vehicle = flight.plane.spec.id;
    message.number = number_;
    message.joined = planned.joined;
    message.ahead_m = flight.place.ahead_m;
    message.left_m = flight.place.left_m;
    message.plan = {number_, flight.timed};
    messages_.push(Message{message});
  }
  send_next_ = now + kRepeat;
}

// --- what is heard -------------------------------------------------------------------------------

void TrackGround::on_message(const Message& message, Instant now) {
  const auto ours = [this](VehicleId vehicle) {
    return std::any_of(config_.planes.begin(), config_.planes.end(),
                       [vehicle](const VehicleSpec& spec) { return spec.id == vehicle; });
  };
  if (const auto* status = std::get_if<FormationStatus>(&message)) {
    if (ours(status->vehicle)) on_status(*status, now);
  } else if (const auto* report = std::get_if<PlanReport>(&message)) {
    if (ours(report->vehicle)) flies_[report->vehicle] = report->plan;
  } else if (const auto* telemetry = std::get_if<Telemetry>(&message)) {
    const auto member = members_.find(telemetry->vehicle);
    if (member == members_.end()) return;
    member->second.range_left_m = telemetry->range_left_m;
    member->second.piloted = is_piloted(*telemetry);
  } else if (const auto* hazard = std::get_if<HazardReport>(&message)) {
    know(*hazard);
  }
}

void TrackGround::know(const HazardReport& report) {
  report.withdrawn ? hazards_.withdraw(report.hazard.id) : hazards_.add(report.hazard);
  config_.rules.hazards = hazards_.all();
}

void TrackGround::on_status(const FormationStatus& status, Instant now) {
  Member& member = members_[status.vehicle];
  if (member.lost) report(event::FormationWarning{FormationNews::back, {status.vehicle}}, now);
  member.lost = false;
  member.status = status;
  member.heard_at = now;
  if (status.progress.change != number_ || !flight_of(status.vehicle)) return;
  const bool there = status.progress.at >= sent_.at(number_).joined &&
                     status.progress.off_m <= config_.place_tolerance_m;
  if (there && !member.arrived_at) member.arrived_at = status.progress.at;
}

const formation::TrackFlightPlan* TrackGround::flight_of(VehicleId vehicle) const {
  const auto sent = sent_.find(number_);
  if (sent == sent_.end()) return nullptr;
  const auto& flights = sent->second.flights;
  const auto found = std::find_if(flights.begin(), flights.end(), [vehicle](const auto& flight) {
    return flight.plane.spec.id == vehicle;
  });
  return found == flights.end() ? nullptr : &*found;
}

bool TrackGround::has_not_begun(VehicleId vehicle, const Member& member) const {
  return member.follows() && flight_of(vehicle) != nullptr &&
         member.status.progress.change < number_;
}

bool TrackGround::on_track(Instant now) const {
  const auto sent = sent_.find(number_);
  return sent != sent_.end() && now < sent->second.ends;
}

// --- what is due ---------------------------------------------------------------------------------

void TrackGround::on_timeout(Instant now) {
  if (now < next_) return;
  next_ = now + kPeriod;
  find_lost(now);
  if (!order_) return;
  const auto start = sent_.at(number_).flights.front().timed.start_time;
  if (now >= send_next_ && now < start + kBegunWithin) send(now);
  if (now >= start + kBegunWithin) find_not_begun(now);
  judge_places(now);
}

void TrackGround::find_lost(Instant now) {
  for (auto& [vehicle, member] : members_) {
    if (member.lost || now - member.heard_at < config_.silence) continue;
    member.lost = true;
    const bool on_way = on_track(now) && flight_of(vehicle) != nullptr;
    report(event::FormationWarning{on_way ? FormationNews::lost_on_track : FormationNews::lost,
                                   {vehicle}},
           now);
  }
}

/// A plane flies on what it flew before. The others are on their way all the same: what they were
/// given was checked against that. The order is given again to all.
void TrackGround::find_not_begun(Instant now) {
  std::vector<VehicleId> who;
  for (const auto& [vehicle, member] : members_) {
    if (has_not_begun(vehicle, member)) who.push_back(vehicle);
  }
  if (who.empty() || !on_track(now)) return;
  if (!std::exchange(told_not_begun_, true)) {
    report(formation_warning(FormationNews::not_begun, who), now);
  }
  if (now < try_again_) return;
  try_again_ = now + kTryAgain;
  auto again = preview(*order_, now);
  if (again) {
    told_refused_ = false;
    begin(*std::move(again), now);
    return;
  }
  if (std::exchange(told_refused_, true)) return;
  report(event::OrderWaits{0, std::string{to_string(order_->kind)}, again.error().message}, now);
}

void TrackGround::judge_places(Instant now) {
  const PlannedTrack& planned = sent_.at(number_);
  if (held_since_ || now < planned.joined) return;
  std::optional<Instant> first;
  std::optional<Instant> last;
  for (const auto& flight : planned.flights) {
    const auto found = members_.find(flight.plane.spec.id);
    if (found == members_.end() || !found->second.follows()) continue;
    const Member& member = found->second;
    const bool left =
        member.status.progress.change == number_ && member.status.at_rest && now < planned.ends;
    if (left) continue;
    if (!member.arrived_at) {
      near_since_.reset();
      return;
    }
    first = std::min(first.value_or(*member.arrived_at), *member.arrived_at);
    last = std::max(last.value_or(*member.arrived_at), *member.arrived_at);
  }
  if (!first) return;
  if (!near_since_) near_since_ = now;
  if (now - *near_since_ < config_.settle) return;
  held_since_ = now;
  report(event::FormationHeld{*last - *first}, now);
}

void TrackGround::report(EventBody body, Instant now) {
  events_.push({kGroundStation, now, {}, {}, std::move(body)});
}

}  // namespace skein::mission
