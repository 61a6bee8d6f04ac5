// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "skein/base/attitude.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/motion_track.hpp"
#include "skein/idl/formation.hpp"

namespace skein::formation {

/// It is decided anew at every multiple of it in mission time how a change goes on.
inline constexpr Duration kSlot = MotionTrack::kStep;

/// How vehicles keep clear of each other in a change.
enum class Avoidance : std::uint8_t {
  passage,  ///< proven (passage.hpp)
  field,    ///< as published, to compare with; separation is not guaranteed (field_flight.hpp)
  count
};
[[nodiscard]] constexpr std::string_view to_string(Avoidance avoidance) {
  return avoidance == Avoidance::passage ? "passage" : "field";
}

/// Flies one vehicle's part of a change, from rest to rest. Deterministic.
class Execution {
 public:
  virtual ~Execution() = default;

  /// Of another mover, in any order, any number of times, with where its reference was at that
  /// time. What is impossible or of another change is ignored.
  virtual void on_progress(std::size_t mover, const Progress& progress,
                           const Vec3& reference_m) = 0;
  /// How far the vehicle itself is from its reference.
  virtual void set_off(double off_m) = 0;
  /// Brakes, and stays where it then is until it may go on.
  virtual void hold(bool held) = 0;
  /// Decides the slot of `now`, which never decreases. In slots that were missed nothing was told:
  /// its track was flown on, and brakes.
  virtual void step(Instant now) = 0;

  /// To be told to the others, with Progress::off_m filled in.
  [[nodiscard]] virtual Progress progress() const = 0;
  /// At a moment of the slot that step() has reached, or later, as its track leads.
  [[nodiscard]] virtual MotionTrack::Moment reference(Instant now) const = 0;
  /// From the slot that step() has reached on: as decided, then braking.
  [[nodiscard]] virtual MotionTrack track() const = 0;

  [[nodiscard]] virtual bool finished() const = 0;
  [[nodiscard]] virtual bool at_rest() const = 0;
  /// The mover for whom it slowed down or waited in the last slot.
  [[nodiscard]] virtual std::optional<std::size_t> waits_for() const = 0;
};

}  // namespace skein::formation
