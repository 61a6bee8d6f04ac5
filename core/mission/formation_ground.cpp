// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/formation_ground.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "names.hpp"
#include "skein/base/contains.hpp"
#include "skein/base/shortened.hpp"
#include "skein/mission/shown_state.hpp"
#include "skein/planning/fence_check.hpp"

namespace skein::mission {
namespace {

using event::FormationNews;
using formation::Change;
using formation::ChangeMotion;
using formation::Transfer;

/// A change of few is heard within kStuck where half of what is said is lost; one of many is as
/// many datagrams.
constexpr Duration kRepeat = std::chrono::milliseconds{200};
constexpr Duration kRepeatForEach = std::chrono::milliseconds{4};
constexpr Duration kPeriod = std::chrono::milliseconds{100};
/// At rest for so long without having arrived: nothing will move any more.
constexpr Duration kStuck = std::chrono::seconds{2};
/// A change that is not sent any more is not taken up after so long: no copy is on its way.
constexpr Duration kMessageLife = std::chrono::seconds{3};
/// After the start of a change whoever moves in it does.
constexpr Duration kSetOff = std::chrono::seconds{1};
/// Who waits on its way for less may be off again before it hears of another change.
constexpr Duration kRests = std::chrono::seconds{1};
/// So often it is looked for who rests below one that is lost.
constexpr Duration kLookBelow = std::chrono::milliseconds{200};
/// Who leaves alone meets nobody at a time agreed on: it goes as soon as it is told.
constexpr Duration kRoomLead = std::chrono::milliseconds{200};
constexpr Duration kTryAgain = std::chrono::seconds{5};
/// Who is beside its place for so long will not come to it; gusts pass.
constexpr Duration kStaysOff = std::chrono::seconds{5};
/// So far from its reference, a vehicle does not fly what it is told; back within half of it, it
/// does.
constexpr double kAstray_m = 5.0;
/// So near to the end of its way a reference is there.
constexpr double kLedTo_m = 0.05;
/// Where a silent vehicle may be is looked at in such steps.
constexpr double kLook_m = 0.5;
/// Lower than this nobody is flown to the side, unless the rally is lower still.
constexpr double kSidewaysAbove_m = 2.0;
/// What a vehicle is off a vertical may be corrected at any height.
constexpr double kBeside_m = 0.5;
/// Drift is what is left of gusts over so long.
constexpr double kDriftTime_s = 5.0;
constexpr Duration kDriftKnownAfter = std::chrono::seconds{10};
constexpr double kTrimMax_m = 1.0;
/// A shape is made so much larger at most where places of it cannot be taken.
constexpr std::size_t kSparePlaces = 8;

Duration repeat_after(const Change& change) {
  return kRepeat + static_cast<std::int64_t>(change.movers.size()) * kRepeatForEach;
}

std::string metres_of(double m) {
  std::array<char, 32> text{};
  static_cast<void>(std::snprintf(text.data(), text.size(), "%.1f m", m));
  return text.data();
}

/// Corners of a mover's way; points of one that goes around, by the motion.
std::vector<Vec3> way_of(const Change& change, const ChangeMotion& motion, std::size_t mover) {
  const auto& points = change.movers[mover].points;
  if (!change.roundabout || change.movers[mover].level == 0) return {points.begin(), points.end()};
  constexpr double kApart_m = 0.5;
  const double longest_m = motion.speed_max_mps(mover) * to_seconds(motion.duration());
  const auto parts = static_cast<Duration::rep>(std::ceil(longest_m / kApart_m)) + 1;
  std::vector<Vec3> way;
  for (Duration::rep i = 0; i <= parts; ++i) {
    way.push_back(motion.position(mover, motion.duration() * i / parts));
  }
  return way;
}

}  // namespace

FormationGround::FormationGround(const FormationGroundConfig& config, Instant now)
    : config_{config}, next_{now} {}

// --- orders --------------------------------------------------------------------------------------

Result<std::vector<Transfer>> FormationGround::transfers(const FormationOrder& order) const {
  std::vector<Transfer> transfers;
  for (const auto& [vehicle, member] : members_) {  // in the order of their numbers
    if (member.lost) continue;
    // A place is corrected for drift by its trim, and asked for without it.
    transfers.push_back({vehicle, member.status.reference_m, member.status.reference_m});
  }
  if (transfers.empty()) return Error{"no vehicle is heard; is the team switched on and in range?"};
  if (order.kind == OrderKind::take_off || order.kind == OrderKind::land) {
    const double height = order.kind == OrderKind::take_off ? config_.rally.centre.z() : 0.0;
    for (Transfer& transfer : transfers) transfer.to.z() = height;
    return transfers;
  }
  const std::size_t wanted =
      order.kind == OrderKind::form
          ? std::min(order.places.value_or(transfers.size()), transfers.size())
          : 0;
  // The lowest numbers take the places.
  const auto assign = [&](const formation::ShapeSpec& shape, std::size_t first,
                          std::size_t count) -> Result<void> {
    if (count == 0) return {};
    const auto places = free_places(shape, count);
    if (!places) return places.error();
    std::vector<Vec3> from;
    for (std::size_t i = first; i < first + count; ++i) from.push_back(transfers[i].from);
    const auto assigned =
        formation::assign_places(config_.assignment, from, *places, Random{config_.seed + number_});
    if (!assigned) return assigned.error();
    for (std::size_t i = 0; i < count; ++i) {
      transfers[first + i].to = (*places)[static_cast<std::size_t>(assigned->place_of[i])];
    }
    return {};
  };
  if (auto done = assign(order.shape, 0, wanted); !done) return done.error();
  if (auto done = assign(config_.rally, wanted, transfers.size() - wanted); !done)
    return done.error();
  if (auto may_be = may_be_flown(transfers); !may_be) return may_be.error();
  return transfers;
}

Result<void> FormationGround::may_be_flown(const std::vector<Transfer>& transfers) const {
  if (auto low_enough = within_heights(transfers); !low_enough) return low_enough;
  return above_ground(transfers);
}

Result<std::vector<Vec3>> FormationGround::free_places(const formation::ShapeSpec& shape,
                                                       std::size_t count) const {
  const auto all = keep_outs();
  const formation::Separation apart = separation();
  const auto taken = [&](const Vec3& place) {
    return is_near_any(place, all, apart.horizontal_m, height_factor(apart));
  };
  auto places = formation::places(shape, count);
  for (std::size_t wanted = count; places && wanted <= count + kSparePlaces;) {
    std::erase_if(*places, taken);
    if (places->size() >= count) {
      places->resize(count);
      return places;
    }
    places = formation::places(shape, ++wanted);
  }
  return formation::places(shape, count);  // the planner says whose way is in the way
}

/// Nobody is sent above the ceiling, or below the ground, who is not there already.
Result<void> FormationGround::within_heights(const std::vector<Transfer>& transfers) const {
  for (const Transfer& transfer : transfers) {
    const std::string name = "the place of " + name_of(transfer.vehicle);
    if (transfer.to.z() > std::max(config_.ceiling_m, transfer.from.z())) {
      return Error{name + " is " + metres_of(transfer.to.z()) + " high, and the ceiling is " +
                   metres_of(config_.ceiling_m) + "; ask for a lower one"};
    }
    if (transfer.to.z() < std::min(0.0, transfer.from.z())) {
      return Error{name + " is " + metres_of(-transfer.to.z()) +
                   " below the ground; ask for a higher one"};
    }
  }
  return {};
}

/// Nobody is led out of the fence, or further out where it is outside already.
Result<void> FormationGround::within_fence(const Change& change) const {
  const Fence& fence = config_.fence;
  if (!fence.exists()) return {};
  const ChangeMotion motion = change.roundabout ? ChangeMotion{change} : ChangeMotion{};
  for (std::size_t m = 0; m < change.movers.size(); ++m) {
    const formation::Mover& mover = change.movers[m];
    const std::vector<Vec3> way = way_of(change, motion, m);
    for (std::size_t i = 0; i + 1 < way.size(); ++i) {
      const Vec3& from = way[i];
      const Vec3& to = way[i + 1];
      if (to.z() > std::max(fence.height_max_m, from.z())) {
        return Error{name_of(mover.vehicle) + " would be " + metres_of(to.z()) +
                     " high, and the fence ends at " + metres_of(fence.height_max_m) +
                     "; ask for a lower place"};
      }
      const double from_m = fence.inside_m(from.head<2>());
      if (from_m < 0.0 && fence.inside_m(to.head<2>()) >= from_m) continue;
      const auto out = planning::first_outside(fence, Vec2{from.head<2>()}, Vec2{to.head<2>()});
      if (!out) continue;
      return Error{"the way of " + name_of(mover.vehicle) + " leads out of the fence at " +
                   planning::place_text(*out) + "; order it elsewhere, or smaller"};
    }
  }
  return {};
}

double FormationGround::sideways_above_m() const {
  return std::min(kSidewaysAbove_m, config_.rally.centre.z());
}

/// Nobody is flown to the side near the ground: what stands there, and who, is not known.
Result<void> FormationGround::above_ground(const std::vector<Transfer>& transfers) const {
  const double least_m = sideways_above_m();
  for (const Transfer& transfer : transfers) {
    const bool sideways = (transfer.to - transfer.from).head<2>().norm() > kBeside_m;
    if (!sideways) continue;
    const std::string why = ", and nobody is flown to the side below " + metres_of(least_m);
    if (transfer.from.z() < least_m) {
      return Error{name_of(transfer.vehicle) + " is " + metres_of(transfer.from.z()) + " high" +
                   why + "; order 'take-off' first"};
    }
    if (transfer.to.z() < least_m) {
      return Error{"the place of " + name_of(transfer.vehicle) + " is " +
                   metres_of(transfer.to.z()) + " high" + why + "; ask for a higher one"};
    }
  }
  return {};
}

Result<FormationPreview> FormationGround::plan(const FormationOrder& order,
                                               std::vector<Transfer> transfers) const {
  const formation::ChangeRequest request = request_for(std::move(transfers));
  if (order.kind != OrderKind::land) {
    if (auto stranger = unknown(); !stranger.empty()) {
      return Error{stranger + " and may be in the way; land, or wait until it is heard"};
    }
  }
  std::vector<VehicleId> lost;
  for (const auto& [vehicle, member] : members_) {
    if (member.lost) lost.push_back(vehicle);
  }
  auto planned = formation::plan_change(request);
  if (planned) {
    if (auto inside = within_fence(planned->change); !inside) return inside.error();
    return FormationPreview{order, std::move(*planned), std::move(lost), std::nullopt};
  }
  auto room = room_made(request);
  if (!room) return planned.error();
  const auto makes_room = std::ranges::find_if(
      room->change.movers,
      [](const formation::Mover& mover) { return mover.points.front() != mover.points.back(); });
  const VehicleId who = makes_room->vehicle;
  return FormationPreview{order, std::move(*room), std::move(lost), who};
}

formation::ChangeRequest FormationGround::request_for(std::vector<Transfer> transfers) const {
  formation::ChangeRequest request;
  request.transfers = std::move(transfers);
  request.keep_outs = keep_outs();
  request.limits = config_.limits;
  request.separation = separation();
  request.reserve_m = config_.reserve_m;
  request.ceiling_m = config_.ceiling_m;
  if (config_.fence.exists()) {
    request.ceiling_m = std::min(request.ceiling_m, config_.fence.height_max_m);
  }
  return request;
}

std::optional<formation::PlannedChange> FormationGround::room_made(
    const formation::ChangeRequest& request) const {
  return formation::make_room(request, [&](const Transfer& way) {
    // Those that stand on the ground are put further apart.
    if (way.from.z() < sideways_above_m()) return false;
    if (leaves_in_vain(members_.at(way.vehicle))) return false;
    const Change alone{.movers = {{way.vehicle, {way.from, way.to}, 0}}};
    return may_be_flown({way}).ok() && within_fence(alone).ok();
  });
}

/// References are so much further apart as both vehicles may be beside them.
formation::Separation FormationGround::separation() const {
  formation::Separation apart = config_.separation;
  apart.horizontal_m += 2.0 * config_.tracking_m;
  apart.vertical_m += 2.0 * config_.tracking_m;
  return apart;
}

std::vector<formation::KeepOut> FormationGround::keep_outs() const {
  std::vector<formation::KeepOut> all;
  for (const auto& [vehicle, member] : members_) {
    if (!member.lost) continue;
    for (const Vec3& place : may_be(vehicle, member)) {
      // Whoever flies it no more comes down sooner or later. Who rests below it may leave that
      // column, but not through the place.
      all.push_back({vehicle, place, place});
      all.push_back({vehicle, place, {place.x(), place.y(), 0.0}});
    }
  }
  return all;
}

std::optional<std::size_t> FormationGround::may_fly(const Change& change, VehicleId vehicle,
                                                    const Member& member) {
  if (change.number < member.status.progress.change) return std::nullopt;
  return mover_of(change, vehicle);
}

/// Silent since, it is known to be with nobody.
bool FormationGround::is_with_pilot(const Member& member) const {
  return member.piloted && now_ - member.heard_at < config_.silence;
}

/// On its way to the goal of the change that it was heard in, or of one that it may have taken up
/// since.
std::vector<Vec3> FormationGround::may_be(VehicleId vehicle, const Member& member) const {
  if (is_with_pilot(member)) return {member.status.position_m};
  const Vec3& seen = member.status.reference_m;
  std::vector<Vec3> places{seen};
  // The others stop before where it was heard to be beside it (FormationAgent).
  if (member.status.progress.off_m > config_.tracking_m) {
    places.push_back(member.status.position_m);
  }
  for (const Change& change : sent_) {
    const auto mover = may_fly(change, vehicle, member);
    if (!mover) continue;
    const ChangeMotion motion{change};
    std::vector<Vec3> way{change.movers[*mover].points.front()};
    const Duration step = from_seconds(kLook_m / std::max(0.1, motion.speed_max_mps(*mover)));
    for (Duration t{}; t < motion.duration(); t += step) {
      const Vec3 at = motion.position(*mover, t);
      if ((at - way.back()).norm() >= kLook_m / 2.0) way.push_back(at);
    }
    way.push_back(change.movers[*mover].points.back());
    auto from = way.begin();
    if (change.number == member.status.progress.change) {
      // Of a way that leads up and down one vertical, the way up.
      const auto off_m = [&seen](const Vec3& place) { return (place - seen).norm(); };
      const double least_m = off_m(*std::ranges::min_element(way, {}, off_m));
      from = std::ranges::find_if(
          way, [&](const Vec3& place) { return off_m(place) <= least_m + kLook_m / 2.0; });
    }
    places.insert(places.end(), from, way.end());
  }
  return places;
}

/// Of whom this ground station cannot say where it may be, because another has commanded it.
std::string FormationGround::unknown() const {
  for (const auto& [vehicle, member] : members_) {  // it may be elsewhere by now
    if (!member.heard && !member.lost) return name_of(vehicle) + " was not heard yet";
  }
  for (const Change& change : sent_) {
    for (const formation::Mover& mover : change.movers) {
      if (!members_.contains(mover.vehicle)) return name_of(mover.vehicle) + " was not heard yet";
    }
  }
  if (!succeeds_) return "";
  for (const VehicleId vehicle : config_.vehicles) {
    const auto found = members_.find(vehicle);
    if (found == members_.end()) {
      return name_of(vehicle) + " was not heard since this ground station started";
    }
    const std::uint32_t number = found->second.status.progress.change;
    const bool ours = number == 0 || std::any_of(sent_.begin(), sent_.end(), [&](const auto& sent) {
                        return sent.number == number && number > recalled_;
                      });
    if (found->second.lost && !found->second.piloted && !ours) {
      return name_of(vehicle) + " is silent, where it flew to is not known,";
    }
  }
  return "";
}

Result<FormationPreview> FormationGround::preview(const FormationOrder& order) const {
  if (const auto why = barred_.why()) return Error{*why};
  if (moving()) return Error{"vehicles are still moving; wait until they are in place"};
  auto wanted = transfers(order);
  if (!wanted) return wanted.error();
  return plan(order, std::move(*wanted));
}

Result<FormationPreview> FormationGround::command(const FormationOrder& order, Instant now) {
  if (now < Instant{}) return Error{"the mission has not begun; vehicles wait for its start"};
  auto preview = this->preview(order);
  if (!preview) return preview;
  forget_drift();
  begin(*preview, now);
  return preview;
}

/// Places are given anew.
void FormationGround::forget_drift() {
  correcting_ = false;
  for (auto& [vehicle, member] : members_) member.trim_m = Vec3::Zero();
}

void FormationGround::begin(FormationPreview preview, Instant now) {
  order_ = preview.order;
  change_ = std::move(preview.planned.change);
  // Above whatever a ground station before this one has sent.
  number_ = std::max(number_ + 1, static_cast<std::uint32_t>(to_seconds(now) + 1.0));
  for (const auto& [vehicle, member] : members_) {
    number_ = std::max(number_, member.status.progress.change + 1);
  }
  change_->number = number_;
  change_->start = now + (preview.makes_room ? kRoomLead : config_.lead);
  for (auto& [vehicle, member] : members_) member.arrived_at.reset();
  forget_flown();
  sent_.push_back(*change_);
  makes_room_ = preview.makes_room.has_value();
  if (makes_room_) {
    members_.at(*preview.makes_room).led_out = {number_, *goal_of(*preview.makes_room)};
  }
  give_again_ = makes_room_;
  is_sent_ = true;
  withdrawn_ = false;
  stuck_since_.reset();
  near_since_.reset();
  off_since_.reset();
  told_off_ = false;
  told_refused_ = false;
  held_since_.reset();
  rest_since_.reset();
  messages_.push(*change_);
  begun_at_ = sent_at_ = now;
  send_next_ = now + repeat_after(*change_);
  event::ChangeBegun begun;
  begun.number = number_;
  begun.order = preview.order.kind;
  begun.shape = preview.order.shape.kind;
  begun.correction = correcting_;
  begun.way = preview.planned.way;
  begun.vehicles = static_cast<std::uint16_t>(change_->movers.size());
  begun.takes = preview.planned.duration;
  begun.separation_m = preview.planned.least_separation_m;
  report(begun, now);
}

/// What nobody flies any more.
void FormationGround::forget_flown() {
  std::erase_if(sent_, [this](const Change& old) {
    return std::none_of(members_.begin(), members_.end(), [&](const auto& entry) {
      return may_fly(old, entry.first, entry.second).has_value();
    });
  });
}

// --- what is heard -------------------------------------------------------------------------------

void FormationGround::recall(const Message& message, VehicleId sender) {
  if (const auto* change = std::get_if<Change>(&message); change != nullptr) {
    if (sender != kGroundStation || !formation::valid(*change) || change->number <= number_) return;
    number_ = recalled_ = change->number;
    forget_flown();
    sent_.push_back(*change);
  } else if (const auto* status = std::get_if<FormationStatus>(&message)) {
    if (!contains(config_.vehicles, status->vehicle)) return;
    Member& member = members_[status->vehicle];
    member.status = *status;
    member.heard_at = next_;  // it has its time to be heard by this one
  }
}

void FormationGround::on_message(const Message& message, Instant now) {
  if (const auto* status = std::get_if<FormationStatus>(&message)) {
    if (contains(config_.vehicles, status->vehicle)) on_status(*status, now);
  } else if (const auto* telemetry = std::get_if<Telemetry>(&message)) {
    on_telemetry(*telemetry, now);
  }
}

void FormationGround::on_telemetry(const Telemetry& telemetry, Instant now) {
  const auto found = members_.find(telemetry.vehicle);
  if (found == members_.end()) return;
  Member& member = found->second;
  member.piloted = is_piloted(telemetry);
  if (member.piloted && !member.lost) {
    lose(telemetry.vehicle, member, FormationNews::astray, now);
  }
}

std::optional<Vec3> FormationGround::goal_of(VehicleId vehicle) const {
  const auto mover = change_ ? mover_of(*change_, vehicle) : std::nullopt;
  if (!mover) return std::nullopt;
  return change_->movers[*mover].points.back();
}

void FormationGround::on_status(const FormationStatus& status, Instant now) {
  const auto [found, is_new] = members_.try_emplace(status.vehicle);
  Member& member = found->second;
  member.status = status;
  member.heard = true;
  member.heard_at = now;
  if (!status.at_rest) member.moved_at = now;
  const bool astray = status.progress.off_m > (member.lost ? 0.5 : 1.0) * kAstray_m;
  if (member.piloted || astray) {
    if (!member.lost) lose(status.vehicle, member, FormationNews::astray, now);
    return;
  }
  if (!is_new && member.lost) {
    warn(FormationNews::back, {status.vehicle}, now);
  }
  // A ground station before this one has commanded it.
  succeeds_ = succeeds_ || status.progress.change > number_;
  member.lost = false;
  const auto goal = goal_of(status.vehicle);
  if (!goal || status.progress.change != number_) return;
  member.place_error_m = (*goal - member.trim_m - status.position_m).norm();
  // A first-order filter of kDriftTime_s over a status in every slot.
  const double share = to_seconds(formation::kSlot) / kDriftTime_s;
  member.drift_m += share * (*goal - member.trim_m - status.position_m - member.drift_m);
  if (!member.arrived_at && member.place_error_m <= config_.place_tolerance_m && status.at_rest) {
    member.arrived_at = status.progress.at;
    member.drift_m = Vec3::Zero();
  }
}

bool FormationGround::moving() const {
  // All still rest when they have just taken a change up.
  if (change_ && !withdrawn_ && now_ < change_->start + kSetOff) return true;
  return std::any_of(members_.begin(), members_.end(), [this](const auto& entry) {
    const Member& member = entry.second;
    const bool begun =
        withdrawn_ || member.status.progress.change == number_ || !goal_of(entry.first);
    return !member.lost && (!member.status.at_rest || !begun);
  });
}

// --- what is due ---------------------------------------------------------------------------------

void FormationGround::on_timeout(Instant now) {
  now_ = std::max(now_, now);
  if (now < next_) return;
  next_ = now + kPeriod;
  find_lost(now);
  if (!change_) return;
  const bool all_know = std::all_of(change_->movers.begin(), change_->movers.end(),
                                    [this](const formation::Mover& mover) {
                                      const auto found = members_.find(mover.vehicle);
                                      return found == members_.end() || found->second.lost ||
                                             found->second.status.progress.change >= number_;
                                    });
  find_stuck(now);
  if (!all_know && is_sent_ && now >= send_next_) {
    send_next_ = now + repeat_after(*change_);
    sent_at_ = now;
    messages_.push(*change_);
  }
  judge_places(now);
  clear_columns(now);
  if (give_again_) give_again(now);
  if (held_since_ && now - *held_since_ >= kDriftKnownAfter) correct_drift(now);
}

void FormationGround::find_lost(Instant now) {
  for (auto& [vehicle, member] : members_) {
    if (member.lost || now - member.heard_at < config_.silence) continue;
    lose(vehicle, member, is_led(vehicle) ? FormationNews::lost_on_its_way : FormationNews::lost,
         now);
  }
}

void FormationGround::lose(VehicleId vehicle, Member& member, FormationNews why, Instant now) {
  member.lost = true;
  if (is_led(vehicle)) {
    give_again_ = true;
    is_sent_ = false;
  }
  warn(why, {vehicle}, now);
}

/// To a place that it was not seen to hold yet.
bool FormationGround::is_led(VehicleId vehicle) const {
  return change_ && !held_since_ && goal_of(vehicle);
}

/// Nobody moves, and somebody has not taken the change up: it started anew on its way, or is
/// somewhere else.
void FormationGround::find_stuck(Instant now) {
  VehicleId who;
  const bool rest = std::all_of(members_.begin(), members_.end(), [&](const auto& entry) {
    const auto& [vehicle, member] = entry;
    if (member.lost) return true;
    if (member.status.progress.change < number_ && goal_of(vehicle)) who = vehicle;
    return member.status.at_rest;
  });
  if (!rest || who == kGroundStation || now < change_->start) {
    stuck_since_.reset();
    withdrawn_ = false;
    return;
  }
  if (!stuck_since_) stuck_since_ = now;
  if (now - *stuck_since_ >= kStuck && is_sent_) {
    give_again_ = true;
    is_sent_ = false;
    warn(FormationNews::not_begun, {who}, now);
  }
  withdrawn_ = now - *stuck_since_ >= kStuck + kMessageLife;
}

/// It has taken up to leave, and does not: held, or stopped before somebody.
bool FormationGround::leaves_in_vain(const Member& member) {
  const auto& out = member.led_out;
  return out && out->change == member.status.progress.change && member.status.at_rest &&
         (member.status.reference_m - out->to).norm() > kLedTo_m;
}

/// A copy of that change may still be on its way to somebody.
bool FormationGround::may_come(const Change& change) const {
  return now_ < (change.number == number_ ? sent_at_ : begun_at_) + kMessageLife;
}

/// It has for a while, and takes up nothing that was sent.
bool FormationGround::rests(VehicleId vehicle, const Member& member) const {
  const FormationStatus& status = member.status;
  if (member.lost || !status.at_rest || now_ - member.moved_at < kRests) return false;
  return std::ranges::none_of(sent_, [&](const Change& change) {
    return change.number > status.progress.change && may_come(change) && mover_of(change, vehicle);
  });
}

/// Whoever is to has taken up what was sent last, or had the time to, and it is known what each of
/// them flies.
bool FormationGround::may_lead_out(Instant now) const {
  if (barred_.why() || !unknown().empty()) return false;
  bool all_taken_up = true;
  for (const auto& [vehicle, member] : members_) {
    const std::uint32_t flies = member.status.progress.change;
    if (member.lost) continue;
    all_taken_up = all_taken_up && (flies >= number_ || !goal_of(vehicle));
    const bool is_known = flies == 0 || std::ranges::any_of(sent_, [flies](const Change& sent) {
                            return sent.number == flies;
                          });
    if (!is_known) return false;
  }
  return now >= change_->start + (all_taken_up ? kSetOff : kMessageLife);
}

/// Who is silent above others may come down before all rest: who rests in its column is led out at
/// once, alone, clear of whatever the others may fly. A pilot sees on whom he comes down.
void FormationGround::clear_columns(Instant now) {
  const bool any_lost =
      std::ranges::any_of(members_, [](const auto& entry) { return entry.second.lost; });
  if (!any_lost || now < look_below_at_ || !may_lead_out(now)) return;
  look_below_at_ = now + kLookBelow;
  auto columns = keep_outs();
  std::erase_if(columns, [this](const formation::KeepOut& column) {
    return is_with_pilot(members_.at(column.vehicle));
  });
  const formation::Separation apart = separation();
  for (const auto& [vehicle, member] : members_) {
    const Vec3& here = member.status.reference_m;
    const bool below = is_near_any(here, columns, apart.horizontal_m, height_factor(apart));
    if (!below || here.z() < sideways_above_m() || !rests(vehicle, member)) continue;
    auto request = request_for({{vehicle, here, here}});
    for (const auto& [other, others] : members_) {
      if (other == vehicle || others.lost) continue;
      for (const Vec3& place : may_be(other, others)) {
        request.keep_outs.push_back({other, place, place});
      }
    }
    auto room = room_made(request);
    if (!room) continue;
    forget_drift();
    begin({*order_, std::move(*room), {}, vehicle}, now);
    return;
  }
}

void FormationGround::give_again(Instant now) {
  if (moving()) {
    rest_since_.reset();
    return;
  }
  if (!rest_since_) rest_since_ = now;
  if (now - *rest_since_ < kStuck) return;
  auto again = preview(*order_);
  if (!again) {
    rest_since_ = now + kTryAgain;
    if (std::exchange(told_refused_, true)) return;  // and where others rest differs a little
    report(event::OrderWaits{0, std::string{to_string(order_->kind)}, again.error().message}, now);
    return;
  }
  forget_drift();
  begin(std::move(*again), now);
}

void FormationGround::judge_places(Instant now) {
  if (makes_room_) return;
  std::optional<Instant> first;
  std::optional<Instant> last;
  std::vector<VehicleId> off;
  for (const auto& mover : change_->movers) {
    const auto found = members_.find(mover.vehicle);
    if (found == members_.end() || found->second.lost) continue;
    const Member& member = found->second;
    if (!member.arrived_at || member.place_error_m > config_.place_tolerance_m) {
      off.push_back(mover.vehicle);
      continue;
    }
    first = std::min(first.value_or(*member.arrived_at), *member.arrived_at);
    last = std::max(last.value_or(*member.arrived_at), *member.arrived_at);
  }
  if (held_since_ || (off.empty() && !first)) return;
  if (!off.empty() && !stay_off(off, now)) {
    near_since_.reset();
    return;
  }
  if (!near_since_) near_since_ = now;
  if (now - *near_since_ < config_.settle) return;
  held_since_ = now;
  if (correcting_) return;
  report(event::FormationHeld{first ? *last - *first : Duration{}}, now);
}

/// They were led to their ends and are beside them: told once. True where that is all there will
/// be, since they stand.
bool FormationGround::stay_off(const std::vector<VehicleId>& who, Instant now) {
  const bool led = std::ranges::all_of(who, [this](VehicleId vehicle) {
    const FormationStatus& status = members_.at(vehicle).status;
    return status.at_rest && status.progress.change == number_ &&
           (status.reference_m - *goal_of(vehicle)).norm() < kLedTo_m;
  });
  if (!led) {
    off_since_.reset();
    return false;
  }
  if (!off_since_) off_since_ = now;
  if (now - *off_since_ < kStaysOff) return false;
  if (!std::exchange(told_off_, true)) warn(FormationNews::off_place, who, now);
  return order_->kind == OrderKind::land;
}

void FormationGround::correct_drift(Instant now) {
  const double allowed_m = config_.place_tolerance_m / 2.0;
  std::vector<VehicleId> drifting;
  std::vector<Transfer> transfers;
  for (auto& [vehicle, member] : members_) {
    if (member.lost) continue;
    const auto goal = goal_of(vehicle);
    if (!goal) return;  // it has come since: the next order places it
    Transfer transfer{vehicle, *goal, *goal};
    if (member.drift_m.norm() > allowed_m) {
      drifting.push_back(vehicle);
      const Vec3 trim = shortened(Vec3{member.trim_m + member.drift_m}, kTrimMax_m);
      transfer.to += trim - member.trim_m;
      // A place at the edge of the fence is not corrected beyond it.
      if (config_.fence.exists() && config_.fence.inside_m(transfer.to.head<2>()) < 0.0) {
        transfer.to = *goal;
      }
    }
    transfers.push_back(transfer);
  }
  if (drifting.empty()) return;
  held_since_ = now;  // again after as long
  auto again = plan(*order_, transfers);
  if (!again || again->makes_room) return;
  for (const Transfer& transfer : transfers) {
    members_[transfer.vehicle].trim_m += transfer.to - transfer.from;
    members_[transfer.vehicle].drift_m = Vec3::Zero();
  }
  correcting_ = true;
  warn(FormationNews::drift_corrected, drifting, now);
  begin(std::move(*again), now);
}

void FormationGround::report(EventBody body, Instant now) {
  events_.push({kGroundStation, now, {}, {}, std::move(body)});
}

void FormationGround::warn(FormationNews news, std::vector<VehicleId> vehicles, Instant now) {
  report(formation_warning(news, std::move(vehicles)), now);
}

}  // namespace skein::mission
