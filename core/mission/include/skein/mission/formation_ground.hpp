// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/bounded_queue.hpp"
#include "skein/base/random.hpp"
#include "skein/base/result.hpp"
#include "skein/domain/fence.hpp"
#include "skein/formation/change_planner.hpp"
#include "skein/formation/place_assignment.hpp"
#include "skein/formation/shapes.hpp"
#include "skein/mission/barred_vehicles.hpp"
#include "skein/mission/messages.hpp"

namespace skein::mission {

/// Whose status is not heard for so long is lost to its formation.
inline constexpr Duration kFormationSilence = std::chrono::seconds{3};

struct FormationGroundConfig {
  std::vector<VehicleId> vehicles;
  formation::ShapeSpec rally;  ///< where vehicles gather, and wait that have no place
  formation::MotionLimits limits;
  formation::Separation separation{};  ///< of the vehicles themselves
  double tracking_m = 0.5;             ///< how far a vehicle may be from its reference
  double reserve_m = 1.0;              ///< see formation::ChangeRequest
  double ceiling_m = 120.0;
  Fence fence{};
  double place_tolerance_m = 0.3;             ///< to be in place
  Duration settle = std::chrono::seconds{1};  ///< in place for so long, all: the formation holds
  Duration lead = std::chrono::seconds{1};    ///< from an order to the start of its change
  Duration silence = kFormationSilence;
  formation::PlaceParams assignment{};
  std::uint64_t seed = 1;  ///< of the ant colony
};

struct FormationOrder {
  OrderKind kind = OrderKind::rally;
  formation::ShapeSpec shape{};         ///< of `form`
  std::optional<std::size_t> places{};  ///< of `form`; none: one for every vehicle
};

/// What an order would do, before anybody moves.
struct FormationPreview {
  FormationOrder order;
  formation::PlannedChange planned;
  std::vector<VehicleId> lost;  ///< of whom the change keeps clear
  /// Some rest too near to each other to be led anywhere. `planned` leads that one out from between
  /// them only; then the order is given again.
  std::optional<VehicleId> makes_room;
};

/// The ground station's side of formations, without I/O: turns orders into changes that were
/// checked in continuous time, sends them until they are flown, watches places, corrects drift, and
/// gives an order again to those that are left when a vehicle is lost in it, and to all when one of
/// them cannot take its change up. Keeps the others clear of wherever a silent vehicle may be, and
/// of the air below: places there stay empty, and the shape has as many more. Same calling rules as
/// OnboardAgent.
class FormationGround {
 public:
  FormationGround(const FormationGroundConfig& config, Instant now);

  /// Fails with a reason where the order cannot be flown safely (which is to the side near the
  /// ground, among others), where vehicles still move, or none is heard.
  [[nodiscard]] Result<FormationPreview> preview(const FormationOrder& order) const;
  Result<FormationPreview> command(const FormationOrder& order, Instant now);

  /// While there are any no order is taken.
  [[nodiscard]] BarredVehicles& barred() { return barred_; }
  /// Nobody is led out of that one from now on.
  void set_fence(const Fence& fence) { config_.fence = fence; }

  /// What this ground station, or one before it, said or heard then: it knows who flies what, and
  /// whom it does not hear. Before anything else.
  void recall(const Message& message, VehicleId sender);
  /// Of who may say it (may_say()), and of telemetry none that is late (Fleet::is_late()).
  void on_message(const Message& message, Instant now);
  void on_timeout(Instant now);
  [[nodiscard]] std::optional<Message> poll_message() { return messages_.pop(); }
  [[nodiscard]] std::optional<MissionEvent> poll_event() { return events_.pop(); }
  [[nodiscard]] std::uint64_t dropped() const { return messages_.dropped() + events_.dropped(); }
  [[nodiscard]] Instant next_timeout() const { return next_; }

  struct Member {
    FormationStatus status;
    Instant heard_at{};
    Instant moved_at{};                 ///< heard last not to rest
    bool heard = false;                 ///< by this process, not only recalled
    bool lost = false;                  ///< silent, piloted, or far from its reference
    bool piloted = false;               ///< others fly it, by its telemetry
    std::optional<Instant> arrived_at;  ///< in the newest change
    double place_error_m = 0.0;         ///< from its place; of no meaning on the way
    Vec3 drift_m = Vec3::Zero();        ///< place less position, over the last seconds
    Vec3 trim_m = Vec3::Zero();         ///< what was added to its places against drift
    struct LedOut {
      std::uint32_t change = 0;
      Vec3 to{0.0, 0.0, 0.0};
    };
    std::optional<LedOut> led_out;  ///< of others' way, the last time
  };
  [[nodiscard]] const std::map<VehicleId, Member>& members() const { return members_; }
  /// All have held their places since the newest change.
  [[nodiscard]] bool in_place() const { return held_since_.has_value(); }
  [[nodiscard]] bool moving() const;

 private:
  [[nodiscard]] Result<std::vector<formation::Transfer>> transfers(
      const FormationOrder& order) const;
  [[nodiscard]] Result<std::vector<Vec3>> free_places(const formation::ShapeSpec& shape,
                                                      std::size_t count) const;
  [[nodiscard]] std::vector<formation::KeepOut> keep_outs() const;
  [[nodiscard]] formation::Separation separation() const;
  [[nodiscard]] Result<void> within_heights(
      const std::vector<formation::Transfer>& transfers) const;
  [[nodiscard]] Result<void> within_fence(const formation::Change& change) const;
  [[nodiscard]] double sideways_above_m() const;
  [[nodiscard]] Result<void> above_ground(const std::vector<formation::Transfer>& transfers) const;
  [[nodiscard]] Result<FormationPreview> plan(const FormationOrder& order,
                                              std::vector<formation::Transfer> transfers) const;
  [[nodiscard]] formation::ChangeRequest request_for(
      std::vector<formation::Transfer> transfers) const;
  [[nodiscard]] std::optional<formation::PlannedChange> room_made(
      const formation::ChangeRequest& request) const;
  [[nodiscard]] Result<void> may_be_flown(const std::vector<formation::Transfer>& transfers) const;
  [[nodiscard]] static std::optional<std::size_t> may_fly(const formation::Change& change,
                                                          VehicleId vehicle, const Member& member);
  [[nodiscard]] bool is_with_pilot(const Member& member) const;
  [[nodiscard]] std::vector<Vec3> may_be(VehicleId vehicle, const Member& member) const;
  [[nodiscard]] std::string unknown() const;
  void begin(FormationPreview preview, Instant now);
  void forget_flown();
  void on_status(const FormationStatus& status, Instant now);
  void on_telemetry(const Telemetry& telemetry, Instant now);
  void find_lost(Instant now);
  void lose(VehicleId vehicle, Member& member, event::FormationNews why, Instant now);
  [[nodiscard]] bool is_led(VehicleId vehicle) const;
  void find_stuck(Instant now);
  [[nodiscard]] bool rests(VehicleId vehicle, const Member& member) const;
  [[nodiscard]] static bool leaves_in_vain(const Member& member);
  [[nodiscard]] bool may_come(const formation::Change& change) const;
  [[nodiscard]] bool may_lead_out(Instant now) const;
  void clear_columns(Instant now);
  void forget_drift();
  void give_again(Instant now);
  void judge_places(Instant now);
  [[nodiscard]] bool stay_off(const std::vector<VehicleId>& who, Instant now);
  void correct_drift(Instant now);
  [[nodiscard]] std::optional<Vec3> goal_of(VehicleId vehicle) const;
  void report(EventBody body, Instant now);
  void warn(event::FormationNews news, std::vector<VehicleId> vehicles, Instant now);

  FormationGroundConfig config_;
  std::map<VehicleId, Member> members_;
  std::optional<FormationOrder> order_;
  std::optional<formation::Change> change_;
  std::vector<formation::Change> sent_;  ///< that somebody may fly yet
  Instant begun_at_{};                   ///< the newest change
  Instant sent_at_{};                    ///< its last copy
  Instant send_next_{};
  std::uint32_t number_ = 0;
  std::uint32_t recalled_ = 0;  ///< the newest change of an earlier process
  bool correcting_ = false;     ///< the newest change is against drift only
  bool succeeds_ = false;       ///< somebody flies what this one does not know
  bool give_again_ = false;     ///< somebody was lost in the change, or has not begun it
  bool is_sent_ = false;        ///< the newest change, until all know it, or it is given up
  bool makes_room_ = false;     ///< the newest change leads one out of the others' way only
  bool withdrawn_ = false;      ///< nobody begins the newest change any more
  bool told_refused_ = false;   ///< that the order cannot be given again
  bool told_off_ = false;       ///< who is off its place
  std::optional<Instant> stuck_since_;
  std::optional<Instant> near_since_;  ///< all within tolerance
  std::optional<Instant> off_since_;   ///< somebody is beside where it was led to its end
  std::optional<Instant> held_since_;
  std::optional<Instant> rest_since_;
  Instant look_below_at_{};  ///< for who is to be led out, not before
  Instant next_;
  Instant now_{};  ///< when it was called last
  BarredVehicles barred_;
  BoundedQueue<Message> messages_{64};
  BoundedQueue<MissionEvent> events_{256};
};

}  // namespace skein::mission
