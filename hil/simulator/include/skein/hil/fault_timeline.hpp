// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "skein/hil/fault.hpp"

namespace skein::hil {

/// Says when each fault of a list begins, and what is wrong with the radio meanwhile.
class FaultTimeline {
 public:
  explicit FaultTimeline(const std::vector<Fault>& faults);

  /// Vehicles that have a role now.
  using Having = std::function<std::vector<VehicleId>(Role)>;
  /// A fault begins; what it does to the radio is done here. False: it cannot be done at this
  /// moment, and comes again at the next.
  using Begin = std::function<bool(const Fault&, const std::vector<VehicleId>& who)>;
  /// Call with a `now` that never decreases.
  void play(Instant now, const Having& having, const Begin& begin);

  /// A ground station has begun a change of the formation.
  void on_change_begun(Instant now) { changes_.push_back(now); }

  /// At the last play(). `changed` is true where it is not what it was at the play() before.
  [[nodiscard]] const radio::Interference& interference() const { return interference_; }
  [[nodiscard]] bool radio_changed() const { return radio_changed_; }
  /// The last moment for which anything is planned that waits for nobody.
  [[nodiscard]] Instant quiet_from() const { return quiet_from_; }

 private:
  struct Coming {
    Fault fault;
    std::optional<Instant> at;
    std::vector<VehicleId> who;
    bool over = false;
  };
  struct Active {
    Fault fault;
    Instant until{};
  };
  void plan(Coming& coming, Instant now, const Having& having) const;
  void update_radio(Instant now);

  std::vector<Coming> coming_;
  std::vector<Active> active_;  ///< of the radio
  std::vector<Instant> changes_;
  radio::Interference interference_;
  bool radio_changed_ = false;
  Instant quiet_from_{};
};

}  // namespace skein::hil
