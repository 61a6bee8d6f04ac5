// SPDX-License-Identifier: Apache-2.0
#include "skein/formation/passage.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "skein/base/assert.hpp"

namespace skein::formation {
namespace {

/// Of distances between ways: nearer calls are taken for too near.
constexpr double kExact_m = 1e-3;
/// Slots by which a message may be ahead: its own slot and differing clocks.
constexpr std::int64_t kAheadMax = 4;
/// Out of a column that cannot be avoided, at full rate: after as many slots at most.
constexpr std::int64_t kOutWithin = 80;

std::int64_t slot_of(Instant t) {
  const auto ns = t.time_since_epoch().count();
  const auto slot = kSlot.count();
  return ns >= 0 ? ns / slot : -((-ns + slot - 1) / slot);
}

/// Gone while braking by one rate a slot.
std::int64_t braking(std::int64_t rate, std::int64_t slots) {
  const std::int64_t n = std::clamp<std::int64_t>(slots, 0, rate);
  return n * (2 * rate - n);
}

}  // namespace

std::int64_t Passage::Future::at(std::int64_t slots) const {
  return slots <= 0 ? done : done + rate + next + braking(next, slots - 1);
}

Passage::Passage(const Change& change, std::size_t self, const PassageParams& params, Instant now)
    : motion_{change},
      number_{change.number},
      self_{self},
      params_{params},
      separation_m_{change.separation.horizontal_m},
      height_factor_{height_factor(change.separation)},
      start_{slot_of(change.start + kSlot - Duration{1})},
      others_(change.movers.size()),
      look_at_(change.movers.size(), 0),
      slot_{slot_of(now)} {
  SKEIN_ASSERT(self < change.movers.size());
  const double slot_s = to_seconds(kSlot);
  const double slots_to_stop =
      std::ceil(change.limits.speed_mps / (change.limits.acceleration_mps2 * slot_s));
  full_ = static_cast<std::uint16_t>(std::max(slots_to_stop, 1.0));
  grain_s_ = slot_s / (2.0 * full_);
  end_ = static_cast<Grains>(std::ceil(to_seconds(motion_.duration()) / grain_s_));
  clock_error_ = static_cast<Grains>(std::ceil(to_seconds(params.clock_error) / grain_s_));
  silent_after_ = (params.silent_after + kSlot - Duration{1}) / kSlot;
  const double stretch = std::max(1.0, height_factor_);
  for (std::size_t i = 0; i < others_.size(); ++i) {
    others_[i].slot = start_;
    others_[i].speed_mps = stretch * motion_.speed_max_mps(i);
    if (i == self_) continue;
    others_[i].least_m = motion_.least_distance_m(self_, i, height_factor_);
    // Of who rests beside whom it leaves no more can be kept than there is.
    const bool one_stays = others_[i].speed_mps == 0.0 || motion_.speed_max_mps(self_) == 0.0;
    const double at_start_m = (place(self_, 0) - place(i, 0)).norm();
    others_[i].apart_m =
        one_stays ? std::min(separation_m_, at_start_m - 2.0 * kExact_m) : separation_m_;
  }
  look_at_[self_] = std::numeric_limits<std::int32_t>::max();
  block_look_at_.assign((look_at_.size() + kBlock - 1) / kBlock, 0);
  due_.reserve(others_.size());
  silent_.reserve(others_.size());
  columns_.reserve(others_.size());
}

void Passage::on_progress(std::size_t mover, const Progress& progress) {
  if (mover >= others_.size() || mover == self_ || progress.change != number_) return;
  Other& other = others_[mover];
  const std::int64_t slot = slot_of(progress.at);
  const bool possible = progress.rate <= full_ && progress.done <= end_ && progress.off_m >= 0.0 &&
                        slot <= slot_ + kAheadMax;
  // Nobody goes back: what says so is older than what is known.
  if (!possible || slot < other.slot || progress.done < other.done) return;
  if (slot_ - other.slot > silent_after_) std::erase(silent_, static_cast<std::uint32_t>(mover));
  other.slot = slot;
  other.done = progress.done;
  other.rate = progress.rate;
  other.off_m = std::max(0.0, progress.off_m - params_.tolerance_m);
  if (other.off_m > 0.0) look_at_[mover] = block_look_at_[mover / kBlock] = 0;
}

void Passage::set_off(double off_m) {
  const double beyond = std::max(0.0, off_m - params_.tolerance_m);
  if (beyond > off_m_) {
    std::fill(look_at_.begin(), look_at_.end(), 0);
    std::fill(block_look_at_.begin(), block_look_at_.end(), 0);
    look_at_[self_] = std::numeric_limits<std::int32_t>::max();
  }
  off_m_ = beyond;
}

Passage::Grains Passage::at_least(const Other& other, std::int64_t slot) const {
  const std::int64_t since = slot - other.slot;
  // What is told of a moment to come holds before it but for what full rate goes in between.
  if (since < 0) return std::max<Grains>(0, other.done + since * 2 * full_ - clock_error_);
  const Grains error = other.rate > 0 ? clock_error_ : 0;
  return std::max<Grains>(0, other.done + braking(other.rate, since) - error);
}

Vec3 Passage::place(std::size_t mover, Grains at) const {
  Vec3 p = motion_.position(mover, from_seconds(seconds(std::min(at, end_))));
  p.z() *= height_factor_;
  return p;
}

/// Wherever both are in their stretches: of the other while it is behind, or of the column of
/// whatever is below it, or so near above it.
bool Passage::keeps_clear(Clearance what, std::size_t mover, Grains own_from, Grains own_to,
                          Grains from, Grains to, double apart_m) const {
  if (what == Clearance::vehicle && from >= own_to) return true;
  const Grains own_middle = (own_from + own_to) / 2;
  const Grains middle = (from + to) / 2;
  // Halves of an odd number of grains differ by one: the longer counts.
  const double own_reach = others_[self_].speed_mps * seconds(own_to - own_middle);
  const double reach = others_[mover].speed_mps * seconds(to - middle);
  const Vec3 apart = place(self_, own_middle) - place(mover, middle);
  const double d =
      what == Clearance::vehicle ? apart.norm() : std::max(apart.head<2>().norm(), apart.z());
  if (d >= apart_m + own_reach + reach + kExact_m) return true;
  const bool split_own = own_to - own_from > 1;
  const bool split = to - from > 1;
  if (d < apart_m || (!split_own && !split)) return false;
  if (split_own && (own_reach >= reach || !split)) {
    return keeps_clear(what, mover, own_from, own_middle, from, to, apart_m) &&
           keeps_clear(what, mover, own_middle, own_to, from, to, apart_m);
  }
  return keeps_clear(what, mover, own_from, own_to, from, middle, apart_m) &&
         keeps_clear(what, mover, own_from, own_to, middle, to, apart_m);
}

bool Passage::clear_of(std::size_t mover, const Future& future) const {
  const Other& other = others_[mover];
  const double apart_m = other.apart_m + other.off_m + off_m_;
  const auto own = [&](std::int64_t slots) { return std::min(end_, future.at(slots)); };
  const std::int64_t own_stop = future.stops_after();
  const std::int64_t its_stop = other.slot + other.rate - slot_;
  // Both brake by the same: what one gains on the other is greatest where one of them stops.
  Grains late = 0;
  for (const std::int64_t slots : {std::int64_t{0}, std::int64_t{1}, its_stop, own_stop}) {
    const std::int64_t then = std::clamp<std::int64_t>(slots, 0, own_stop);
    late = std::max(late, own(then) + 1 - at_least(other, slot_ + then));
  }
  if (late == 0) return true;  // it is ahead, and looks out for this vehicle
  if (other.least_m - other.speed_mps * seconds(late) >= apart_m) return true;
  for (std::int64_t slot = 0; slot < own_stop; ++slot) {
    const Grains to = own(slot + 1);
    if (!keeps_clear(Clearance::vehicle, mover, own(slot), to, at_least(other, slot_ + slot), to,
                     apart_m)) {
      return false;
    }
  }
  return true;
}

/// One block in every slot.
void Passage::look_for_silence() {
  listened_to_ = (listened_to_ + 1) % block_look_at_.size();
  const std::size_t end = std::min(others_.size(), (listened_to_ + 1) * kBlock);
  for (std::size_t i = listened_to_ * kBlock; i < end; ++i) {
    if (i == self_ || slot_ - others_[i].slot <= silent_after_) continue;
    const auto mover = static_cast<std::uint32_t>(i);
    if (std::find(silent_.begin(), silent_.end(), mover) == silent_.end()) silent_.push_back(mover);
  }
}

bool Passage::is_in_column(std::uint32_t mover, Grains own_from, Grains own_to,
                           double apart_m) const {
  const Other& other = others_[mover];
  // It flew on until it is called silent, at full rate, and then braked.
  const auto called_after = silent_after_ + static_cast<std::int64_t>(block_look_at_.size());
  const Grains to = other.done + Grains{2} * full_ * called_after + Grains{full_} * full_;
  return !keeps_clear(Clearance::column, mover, own_from, own_to, other.done, std::min(end_, to),
                      apart_m);
}

/// Beyond what is allowed for in the separation.
double Passage::both_off_m(std::uint32_t mover) const { return others_[mover].off_m + off_m_; }

Passage::Grains Passage::stop_of(const Future& future) const {
  return std::min(end_, future.at(future.stops_after()));
}

/// Beyond where it would stop, at full rate, and unless it is the silent one itself that bars the
/// way.
std::optional<Passage::Grains> Passage::way_out_of_column(std::uint32_t mover, Grains stop) const {
  const Other& other = others_[mover];
  const double off_m = both_off_m(mover);
  Grains from = done_;
  for (std::int64_t slots = 1; slots <= kOutWithin && from < end_; ++slots) {
    const Grains at = std::min(end_, from + Grains{2} * full_);
    if (!keeps_clear(Clearance::vehicle, mover, from, at, at_least(other, slot_ + slots - 1), at,
                     other.apart_m + off_m)) {
      return std::nullopt;
    }
    if (at >= stop && !is_in_column(mover, at, at, separation_m_ + off_m)) return at;
    from = at;
  }
  return std::nullopt;
}

/// A stop at its edge, where there is less room than for what both may be off, is better than a way
/// through its core.
bool Passage::goes_on_through_column(std::uint32_t mover) const {
  const Grains stop = stop_of({done_, rate_, next_rate_});
  const double off_m = both_off_m(mover);
  if (!is_in_column(mover, done_, stop, separation_m_ + off_m)) return false;
  const auto out = way_out_of_column(mover, stop);
  if (!out) return false;
  const double core_m = separation_m_ - 2.0 * params_.tolerance_m;
  return is_in_column(mover, done_, stop, core_m) ||
         !is_in_column(mover, done_, *out, core_m + off_m);
}

/// All but those that cannot be avoided any more and are left where the way leads on.
void Passage::look_for_columns() {
  look_for_silence();
  columns_.clear();
  std::ranges::copy_if(silent_, std::back_inserter(columns_),
                       [&](std::uint32_t mover) { return !goes_on_through_column(mover); });
}

/// Far away, it cannot matter for as long as both would need to meet.
void Passage::look_again(std::size_t mover, Grains at_least_now) {
  const Other& other = others_[mover];
  const double own_speed = others_[self_].speed_mps;
  const double stop_s = seconds(Grains{full_} * full_ + Grains{2} * full_);
  const double behind_s = std::max(0.0, seconds(done_ - at_least_now));
  const double free_m = (place(self_, done_) - place(mover, at_least_now)).norm() - separation_m_ -
                        other.off_m - off_m_ - own_speed * stop_s -
                        other.speed_mps * (behind_s + stop_s);
  const double pace = own_speed + other.speed_mps;
  const double free_s = free_m / std::max(pace, 1e-3);
  look_at_[mover] = static_cast<std::int32_t>(
      slot_ - start_ + static_cast<std::int64_t>(std::clamp(free_s / to_seconds(kSlot), 0.0, 1e6)));
}

void Passage::look_at_block(std::size_t block, std::int32_t current) {
  const std::size_t end = std::min(look_at_.size(), (block + 1) * kBlock);
  std::int32_t next = std::numeric_limits<std::int32_t>::max();
  for (std::size_t i = block * kBlock; i < end; ++i) {
    if (look_at_[i] <= current) {
      look_again(i, at_least(others_[i], slot_));
      if (look_at_[i] <= current) due_.push_back(static_cast<std::uint32_t>(i));
    }
    next = std::min(next, look_at_[i]);
  }
  block_look_at_[block] = next;
}

bool Passage::clear_of_all(const Future& future) {
  for (const std::uint32_t mover : due_) {
    if (clear_of(mover, future)) continue;
    waits_for_ = mover;
    return false;
  }
  return true;
}

void Passage::decide() {
  waits_for_.reset();
  next_rate_ = std::max<Grains>(0, rate_ - 1);
  if (held_ || slot_ < start_) return;
  if (finished()) {
    next_rate_ = full_;  // of no more meaning, and nobody waits for it
    return;
  }
  due_.clear();
  const auto current = static_cast<std::int32_t>(slot_ - start_);
  for (std::size_t block = 0; block < block_look_at_.size(); ++block) {
    if (block_look_at_[block] <= current) look_at_block(block, current);
  }
  look_for_columns();
  const auto fits = [this](Grains rate) {
    const Future future{done_, rate_, rate};
    if (!clear_of_all(future)) return false;
    const auto column = std::ranges::find_if(columns_, [&](std::uint32_t mover) {
      return is_in_column(mover, done_, stop_of(future), separation_m_ + both_off_m(mover));
    });
    if (column != columns_.end()) {
      waits_for_ = *column;
      return false;
    }
    next_rate_ = rate;
    return true;
  };
  // The change itself starts from rest, so plan time may begin at once.
  if (done_ == 0) {
    for (Grains rate = full_; rate > 0; rate /= 2) {
      if (fits(rate)) return;
    }
    return;
  }
  if (rate_ < full_ && fits(rate_ + 1)) return;
  if (rate_ > 0) static_cast<void>(fits(rate_));
}

void Passage::step(Instant now) {
  for (const std::int64_t current = slot_of(now); slot_ < current;) {
    done_ = std::min(end_, done_ + rate_ + next_rate_);
    rate_ = next_rate_;
    ++slot_;
    if (slot_ == current) {
      decide();
    } else {  // the slot is over, and what was told last has braked in it
      next_rate_ = std::max<Grains>(0, rate_ - 1);
    }
  }
}

Progress Passage::progress() const {
  return {.change = number_,
          .at = Instant{kSlot * (slot_ + 1)},
          .done = static_cast<std::uint32_t>(std::min(end_, done_ + rate_ + next_rate_)),
          .rate = static_cast<std::uint16_t>(finished() ? 0 : next_rate_)};
}

MotionTrack::Moment Passage::reference(Instant now) const {
  if (now > Instant{kSlot * (slot_ + 1)}) return track().at(now);
  const double t =
      std::clamp(to_seconds(now - Instant{kSlot * slot_}) / to_seconds(kSlot), 0.0, 1.0);
  const auto begin = static_cast<double>(rate_);
  const auto gained = static_cast<double>(next_rate_ - rate_);
  const double done = static_cast<double>(done_) + 2.0 * begin * t + gained * t * t;
  const double plan_s = std::min(done * grain_s_, to_seconds(motion_.duration()));
  const double rate = (begin + gained * t) / full_;
  const double gain = gained / (full_ * to_seconds(kSlot));
  const auto point = motion_.at(self_, from_seconds(plan_s));
  return {point.position_m, rate * point.velocity_mps,
          rate * rate * point.acceleration_mps2 + gain * point.velocity_mps};
}

MotionTrack Passage::track() const {
  MotionTrack track;
  track.number = number_;
  track.start = Instant{kSlot * slot_};
  const Future future{done_, rate_, next_rate_};
  const std::int64_t last =
      std::min<std::int64_t>(future.stops_after(), MotionTrack::kPointsMax - 1);
  for (std::int64_t slot = 0; slot <= last; ++slot) {
    const Grains rate = slot == 0 ? rate_ : next_rate_ - (slot - 1);
    const Grains done = future.at(slot);
    const auto point = motion_.at(self_, from_seconds(seconds(std::min(done, end_))));
    const double pace = done < end_ ? static_cast<double>(rate) / full_ : 0.0;
    auto& out = track.points.at(static_cast<std::size_t>(slot));
    for (int axis = 0; axis < 3; ++axis) {
      out.position_m.at(static_cast<std::size_t>(axis)) = point.position_m[axis];
      out.velocity_mps.at(static_cast<std::size_t>(axis)) = pace * point.velocity_mps[axis];
    }
  }
  track.count = static_cast<std::uint16_t>(last + 1);
  return track;
}

}  // namespace skein::formation
