// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "skein/base/bounded_queue.hpp"
#include "skein/formation/field_flight.hpp"
#include "skein/formation/passage.hpp"
#include "skein/mission/onboard_agent.hpp"
#include "skein/mission/range_budget.hpp"

namespace skein::mission {

struct FormationAgentConfig {
  VehicleId vehicle;
  InstanceId instance;
  double range_m = 0.0;  ///< of the vehicle, from its start
  double battery_reserve_percent = 20.0;
  formation::MotionLimits limits;  ///< of the vehicle; a change that asks for more is refused
  formation::Avoidance avoidance = formation::Avoidance::passage;
  formation::PassageParams passage{};
  formation::FieldParams field{};
  double start_tolerance_m = 0.5;  ///< a change must begin where the vehicle is, to this
  Duration status_period = formation::kSlot;
};

/// All decisions of one multirotor in a formation. The ground station's changes say where to fly;
/// when, is decided here in every slot, from what the others say of theirs (formation::Execution).
/// A change is taken up at rest only, and only where the vehicle is. Whatever falls silent, ground
/// or neighbours, by passage separation holds: the vehicle goes on as far as it may, and waits
/// there. So it does before whoever is off what it follows, its pilot's among them. What its own
/// pilot gives back rests where it is, in no change.
class FormationAgent final : public OnboardAgent {
 public:
  FormationAgent(const FormationAgentConfig& config, Instant now);

  void on_state(const VehicleState& state, Instant now) override;
  void on_message(const Message& message, VehicleId sender, Instant now) override;
  void on_timeout(Instant now) override;
  void on_bar(Bar bar, Instant now) override;
  void on_piloted(bool piloted, Instant now) override;

  [[nodiscard]] std::optional<Message> poll_message() override { return messages_.pop(); }
  /// A new one in every slot, once there is a change.
  [[nodiscard]] std::optional<Guidance> poll_guidance() override;
  [[nodiscard]] std::optional<MissionEvent> poll_event() override { return events_.pop(); }
  [[nodiscard]] Instant next_timeout() const override { return next_slot_; }
  [[nodiscard]] Telemetry telemetry() const override;
  [[nodiscard]] Counters counters() const override;

  /// How it flies the newest change; none before the first.
  [[nodiscard]] const formation::Execution* execution() const { return execution_.get(); }

 private:
  void on_change(const formation::Change& change, Instant now);
  [[nodiscard]] std::optional<event::ChangeRefusal> why_not(const formation::Change& change,
                                                            std::size_t self) const;
  void on_status(const FormationStatus& status, Instant now);
  void look_out_for(const FormationStatus& status);
  struct Stray {
    VehicleId vehicle;
    Vec3 place;
  };
  [[nodiscard]] std::optional<Stray> nears() const;
  [[nodiscard]] bool is_there_yet(const Stray& stray) const;
  void on_command(const Command& command, Instant now);
  void step(Instant now);
  void tell_of_wait(Instant now);
  [[nodiscard]] ActivityDetail detail(bool moving) const;
  [[nodiscard]] bool waits() const {
    return held_ || piloted_ || bar_ != Bar::none || !not_begun_.empty() || stray_ahead_;
  }
  /// Where it is led to be; where it is, as long as nobody leads it.
  [[nodiscard]] Vec3 reference(Instant now) const;
  [[nodiscard]] double off_m(Instant now) const;
  void report(EventBody body, Instant now);

  FormationAgentConfig config_;
  RangeBudget range_;
  std::optional<formation::Change> change_;
  std::unique_ptr<formation::Execution> execution_;  ///< of change_; none before the first
  std::optional<Vec3> rests_at_;  ///< where its pilot took it before a change, or gave it back
  std::optional<VehicleState> state_;
  std::optional<MotionTrack> track_;
  std::uint32_t number_ = 0;  ///< of the newest change that it has taken up
  Instant next_slot_;
  Instant next_status_;
  std::set<VehicleId> not_begun_;  ///< movers not heard of in the change
  std::optional<Instant> waits_since_;
  std::uint32_t refused_ = 0;         ///< number of the newest change that it could not take
  std::map<VehicleId, Vec3> strays_;  ///< who is off what it follows, and where it is
  std::optional<Stray> stray_ahead_;  ///< before whom it stops
  CommandFilter commands_;
  bool held_ = false;     ///< by the operator
  bool piloted_ = false;  ///< others fly it
  Bar bar_ = Bar::none;
  bool arrived_ = false;
  std::uint64_t bad_messages_ = 0;
  BoundedQueue<Message> messages_{64};
  BoundedQueue<MissionEvent> events_{256};
};

}  // namespace skein::mission
