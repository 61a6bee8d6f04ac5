// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/formation/change.hpp"
#include "skein/formation/execution.hpp"

namespace skein::formation {

/// For how long one that is there may not be heard, counted from the slot that its last word is of:
/// where that message took longest, until two more.
[[nodiscard]] constexpr Duration silent_after(Duration message_delay) {
  return message_delay + 2 * kSlot;
}

struct PassageParams {
  Duration clock_error = std::chrono::milliseconds{20};  ///< between any two vehicles
  double tolerance_m = 0.5;  ///< Progress::off_m up to which Change::separation allows for it
  Duration silent_after = formation::silent_after(std::chrono::milliseconds{200});
};

/// Flies one vehicle's part of a change so that separation holds however late others are and
/// however old what is known of them. After Cap, Gregoire and Frazzoli, "Provably safe and
/// deadlock-free execution of multi-robot plans under delaying disturbances", IROS 2016 (RMTRACK):
/// who is ahead in plan time does not enter where somebody behind has yet to pass. Here vehicles
/// brake in finite time and messages are late or lost: all vehicles slow down by at most one rate a
/// slot, so that every message, however old, says how far its sender is by now at least. The
/// reference speeds up only when, should it brake one slot later, it would at every moment keep the
/// change's separation (where one of two stays that start nearer, as much as at the start) from
/// wherever everyone behind it may be at that moment. Whoever is ahead in
/// plan time does so; so one of each two always does, and no breach is possible while references
/// are followed within tolerance. The last of all never waits, for what it needs is the separation
/// that the plan has in plan time, so there is no deadlock once messages come through;
/// ChangeRequest::reserve_m is what the others may be late by without anybody slowing down.
///
/// Who is silent may have lost its program and come down: nobody enters the column below where it
/// may be; who cannot stop before it, or is in it, goes on where its way soon leads out, and stops
/// where not. Who would stop at its edge, where all is kept but what both may be off, stops there,
/// unless its way leads out without coming nearer.
///
/// step() and reference() allocate nothing.
class Passage final : public Execution {
 public:
  Passage() = default;
  /// Precondition: valid(change), self < movers.
  Passage(const Change& change, std::size_t self, const PassageParams& params, Instant now);

  /// Of another mover, in any order, any number of times. What is impossible or of another change
  /// is ignored.
  void on_progress(std::size_t mover, const Progress& progress);
  void on_progress(std::size_t mover, const Progress& progress,
                   const Vec3& /*reference_m*/) override {
    on_progress(mover, progress);
  }
  void set_off(double off_m) override;
  void hold(bool held) override { held_ = held; }
  void step(Instant now) override;

  [[nodiscard]] Progress progress() const override;
  [[nodiscard]] MotionTrack::Moment reference(Instant now) const override;
  [[nodiscard]] MotionTrack track() const override;

  [[nodiscard]] bool finished() const override { return done_ >= end_; }
  [[nodiscard]] bool at_rest() const override {
    return finished() || (rate_ == 0 && next_rate_ == 0);
  }
  [[nodiscard]] std::optional<std::size_t> waits_for() const override { return waits_for_; }

  [[nodiscard]] const ChangeMotion& motion() const { return motion_; }
  [[nodiscard]] std::uint16_t full_rate() const { return full_; }

 private:
  using Grains = std::int64_t;
  static constexpr std::size_t kBlock = 32;

  struct Other {
    std::int64_t slot = 0;  ///< of what is known
    Grains done = 0;
    Grains rate = 0;
    double off_m = 0.0;      ///< beyond what is allowed for
    double apart_m = 0.0;    ///< that is kept; not more than there is at the start
    double least_m = 0.0;    ///< from this vehicle, in the plan
    double speed_mps = 0.0;  ///< heights stretched
  };
  /// From a slot's boundary on: one slot with the rates given, then braking.
  struct Future {
    Grains done;
    Grains rate;
    Grains next;
    [[nodiscard]] Grains at(std::int64_t slots) const;
    [[nodiscard]] std::int64_t stops_after() const { return next + 1; }
  };

  [[nodiscard]] Grains at_least(const Other& other, std::int64_t slot) const;
  [[nodiscard]] bool clear_of_all(const Future& future);
  [[nodiscard]] bool clear_of(std::size_t mover, const Future& future) const;
  enum class Clearance : std::uint8_t { vehicle, column };
  [[nodiscard]] bool keeps_clear(Clearance what, std::size_t mover, Grains own_from, Grains own_to,
                                 Grains from, Grains to, double apart_m) const;
  void look_for_silence();
  void look_for_columns();
  [[nodiscard]] bool is_in_column(std::uint32_t mover, Grains own_from, Grains own_to,
                                  double apart_m) const;
  [[nodiscard]] Grains stop_of(const Future& future) const;
  [[nodiscard]] std::optional<Grains> way_out_of_column(std::uint32_t mover, Grains stop) const;
  [[nodiscard]] bool goes_on_through_column(std::uint32_t mover) const;
  [[nodiscard]] double both_off_m(std::uint32_t mover) const;
  void look_at_block(std::size_t block, std::int32_t current);
  void look_again(std::size_t mover, Grains at_least_now);
  void decide();
  [[nodiscard]] double seconds(Grains grains) const {
    return static_cast<double>(grains) * grain_s_;
  }
  [[nodiscard]] Vec3 place(std::size_t mover, Grains at) const;

  ChangeMotion motion_;
  std::uint32_t number_ = 0;
  std::size_t self_ = 0;
  PassageParams params_;
  double separation_m_ = 0.0;
  double height_factor_ = 1.0;
  double grain_s_ = 0.0;
  std::uint16_t full_ = 1;
  Grains end_ = 0;
  Grains clock_error_ = 0;
  std::int64_t silent_after_ = 0;      ///< slots
  std::int64_t start_ = 0;             ///< slots; plan time begins
  std::vector<Other> others_;          ///< and this vehicle itself, of whom only the speed counts
  std::vector<std::int32_t> look_at_;  ///< slots since start_, before which each cannot matter
  std::vector<std::int32_t> block_look_at_;  ///< the least of each kBlock of them
  std::vector<std::uint32_t> due_;           ///< who can, now
  std::vector<std::uint32_t> silent_;        ///< movers
  std::vector<std::uint32_t> columns_;       ///< of those of them that are avoided
  std::size_t listened_to_ = 0;              ///< the block of others that was last looked at
  double off_m_ = 0.0;                       ///< beyond what is allowed for

  std::int64_t slot_ = 0;  ///< since mission time 0
  Grains done_ = 0;        ///< at its begin
  Grains rate_ = 0;
  Grains next_rate_ = 0;  ///< at its end
  bool held_ = false;
  std::optional<std::size_t> waits_for_;
};

}  // namespace skein::formation
