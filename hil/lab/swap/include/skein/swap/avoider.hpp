// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/attitude.hpp"
#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/formation/limits.hpp"
#include "skein/formation/passage.hpp"

namespace skein::swap {

/// What is the same for all agents of a run. Positions: mission frame.
struct Setting {
  formation::MotionLimits limits{.speed_mps = 3.0};
  formation::Separation separation;
  double control_period_s = 0.02;
  double message_period_s = 0.06;  ///< a little more than formation::kSlot, in which all is decided
  double message_delay_s = 0.2;    ///< of every message
  double message_loss = 0.2;       ///< share of them, independently for each receiver
  double start_s = 1.0;            ///< nobody moves before; messages are exchanged from 0 s on
  std::vector<Vec3> starts;        ///< of agent i, whose id is i + 1
  std::vector<Vec3> goals;
};

/// What an agent tells all others.
struct Message {
  VehicleId from;
  double sent_s = 0.0;
  Vec3 position_m = Vec3::Zero();
  Vec3 velocity_mps = Vec3::Zero();
  bool at_goal = false;
  std::optional<formation::Progress> progress;  ///< what only passage tells
};

/// Where an agent is, exactly.
struct OwnMotion {
  Vec3 position_m = Vec3::Zero();
  Vec3 velocity_mps = Vec3::Zero();  ///< of the period before
};

/// A method of avoidance on board of one agent. It knows of the others what it was told.
class Avoider {
 public:
  Avoider() = default;
  Avoider(const Avoider&) = delete;
  Avoider& operator=(const Avoider&) = delete;
  virtual ~Avoider() = default;

  /// The message lives as long as the avoider.
  virtual void on_message(const Message& message, double now_s) = 0;
  /// The velocity of the next control period; it is flown exactly. Keeping to Setting::limits is
  /// the method's affair.
  [[nodiscard]] virtual Vec3 step(const OwnMotion& own, double now_s) = 0;
  /// Called before every message of this agent, after step(); the other fields are filled in.
  virtual void tell(Message&) const {}
};

/// One for each agent; what they share beyond that is what a ground station told all before. The
/// setting outlives them. `seed` is for the method's own lots. Fails where it cannot fly that
/// setting.
using MakeAvoiders = std::function<Result<std::vector<std::unique_ptr<Avoider>>>(
    const Setting& setting, std::uint64_t seed)>;

struct Method {
  std::string_view name;
  std::string_view text;  ///< one line for people
  MakeAvoiders make;
};
/// Those that skein-hil swap knows.
[[nodiscard]] const std::vector<Method>& methods();
/// Fails with a sentence that names them.
[[nodiscard]] Result<const Method*> find_method(std::string_view name);

}  // namespace skein::swap
