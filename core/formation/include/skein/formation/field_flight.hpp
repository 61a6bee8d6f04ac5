// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "skein/formation/change.hpp"
#include "skein/formation/execution.hpp"
#include "skein/formation/field_avoidance.hpp"

namespace skein::formation {

/// Flies a change by the published field (field_avoidance.hpp) from neighbours' messages: straight
/// to the place, whatever way the change has planned, pushed aside by whoever goes first. It can
/// come too near to others, and can stand still before it is there.
class FieldFlight final : public Execution {
 public:
  /// Precondition: valid(change), self < movers.
  FieldFlight(const Change& change, std::size_t self, const FieldParams& params, Instant now);

  void on_progress(std::size_t mover, const Progress& progress, const Vec3& reference_m) override;
  void set_off(double /*off_m*/) override {}  // the field knows nothing of it
  void hold(bool held) override { held_ = held; }
  void step(Instant now) override;

  [[nodiscard]] Progress progress() const override;
  [[nodiscard]] MotionTrack::Moment reference(Instant now) const override;
  [[nodiscard]] MotionTrack track() const override;
  [[nodiscard]] bool finished() const override { return finished_; }
  [[nodiscard]] bool at_rest() const override;
  [[nodiscard]] std::optional<std::size_t> waits_for() const override { return std::nullopt; }

 private:
  struct Other {
    FieldNeighbour last;
    Instant at{};
    Vec3 goal_m = Vec3::Zero();
    bool heard = false;
  };
  [[nodiscard]] Vec3 wanted_velocity();
  void plan_slot(const Vec3& next_velocity_mps);
  [[nodiscard]] std::optional<Vec3> landing_velocity() const;
  [[nodiscard]] Instant slot_begin() const { return Instant{kSlot * slot_}; }

  std::uint32_t number_;
  FieldParams params_;
  MotionLimits limits_;
  Instant start_;
  std::size_t self_index_;
  FieldSelf self_;  ///< at the slot's begin
  Vec3 next_position_m_;
  Vec3 next_velocity_mps_ = Vec3::Zero();
  std::vector<Other> others_;  ///< and this vehicle itself, never heard
  std::vector<FieldNeighbour> neighbours_;
  std::int64_t slot_;  ///< since mission time 0
  bool held_ = false;
  bool finished_ = false;
};

}  // namespace skein::formation
