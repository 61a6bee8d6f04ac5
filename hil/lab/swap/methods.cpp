// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "orca.hpp"
#include "skein/base/random.hpp"
#include "skein/base/shortened.hpp"
#include "skein/formation/change_planner.hpp"
#include "skein/formation/field_avoidance.hpp"
#include "skein/formation/passage.hpp"
#include "skein/swap/avoider.hpp"

namespace skein::swap {
namespace {

/// The newest message of each agent.
class Heard {
 public:
  explicit Heard(std::size_t agents) : newest_(agents, nullptr) {}

  void add(const Message& message) {
    const Message*& newest = newest_.at(message.from.value - 1U);
    if (newest == nullptr || newest->sent_s < message.sent_s) newest = &message;
  }
  template <class Use>
  void for_each(const Use& use) const {
    for (const Message* message : newest_) {
      if (message != nullptr) use(*message);
    }
  }

 private:
  std::vector<const Message*> newest_;
};

double longest_way(const Setting& setting) {
  double longest = 0.0;
  for (std::size_t i = 0; i < setting.starts.size(); ++i) {
    longest = std::max(longest, (setting.goals[i] - setting.starts[i]).norm());
  }
  return longest;
}

class FieldAvoider final : public Avoider {
 public:
  FieldAvoider(const Setting& setting, std::size_t index)
      : setting_{setting}, heard_{setting.starts.size()} {
    self_.id = VehicleId{static_cast<std::uint16_t>(index + 1)};
    self_.goal_m = setting.goals[index];
    self_.arrival_share = (self_.goal_m - setting.starts[index]).norm() / longest_way(setting);
  }

  void on_message(const Message& message, double) override { heard_.add(message); }
  Vec3 step(const OwnMotion& own, double now_s) override {
    self_.position_m = own.position_m;
    self_.velocity_mps = own.velocity_mps;
    neighbours_.clear();
    const double reach = params_.range_m * 4.0;  // of what an old message may still concern
    heard_.for_each([&](const Message& m) {
      if ((m.position_m - own.position_m).squaredNorm() > reach * reach) return;
      neighbours_.push_back({m.from, m.position_m, m.velocity_mps, now_s - m.sent_s, m.at_goal});
    });
    return formation::field_velocity(params_, setting_.limits, self_, neighbours_,
                                     setting_.control_period_s);
  }

 private:
  const Setting& setting_;
  formation::FieldParams params_;
  formation::FieldSelf self_;
  Heard heard_;
  std::vector<formation::FieldNeighbour> neighbours_;
};

/// Follows a wanted velocity as a vehicle can: speed, acceleration and jerk within the limits.
class LimitedVelocity {
 public:
  LimitedVelocity(const formation::MotionLimits& limits, double period_s)
      : limits_{limits}, period_s_{period_s} {}

  Vec3 step(const Vec3& wanted) {
    const Vec3 lacking = wanted - velocity_;
    const double size = lacking.norm();
    Vec3 acceleration = Vec3::Zero();
    if (size > 0.0) {
      const double least_time = std::min(
          {limits_.acceleration_mps2, std::sqrt(2.0 * limits_.jerk_mps3 * size), size / period_s_});
      acceleration = lacking * (least_time / size);
    }
    acceleration_ += shortened(Vec3{acceleration - acceleration_}, limits_.jerk_mps3 * period_s_);
    velocity_ = shortened(Vec3{velocity_ + acceleration_ * period_s_}, limits_.speed_mps);
    return velocity_;
  }

 private:
  formation::MotionLimits limits_;
  double period_s_;
  Vec3 velocity_ = Vec3::Zero();
  Vec3 acceleration_ = Vec3::Zero();
};

/// In the plane of its start. In its favour, others are taken to have flown on since their message.
class OrcaAvoider final : public Avoider {
 public:
  OrcaAvoider(const Setting& setting, std::size_t index, std::uint64_t seed, bool limited)
      : setting_{setting},
        goal_{setting.goals[index].head<2>()},
        random_{seed},
        heard_{setting.starts.size()} {
    params_.distance_m = setting.separation.horizontal_m;
    params_.period_s = setting.control_period_s;
    params_.speed_mps = setting.limits.speed_mps;
    if (limited) limiter_.emplace(setting.limits, setting.control_period_s);
  }

  void on_message(const Message& message, double) override { heard_.add(message); }
  Vec3 step(const OwnMotion& own, double now_s) override {
    const OrcaBody self{own.position_m.head<2>(), own.velocity_mps.head<2>()};
    const double within = 2.0 * params_.speed_mps * params_.horizon_s + params_.distance_m;
    nearest_.clear();
    heard_.for_each([&](const Message& m) {
      const Vec3 now = m.position_m + (now_s - m.sent_s) * m.velocity_mps;
      const double distance2 = (now.head<2>() - self.position_m).squaredNorm();
      if (distance2 > within * within) return;
      nearest_.push_back({distance2, {now.head<2>(), m.velocity_mps.head<2>()}});
    });
    if (nearest_.size() > kNeighboursMax) {
      std::nth_element(nearest_.begin(), nearest_.begin() + kNeighboursMax, nearest_.end(),
                       [](const Near& a, const Near& b) { return a.distance2 < b.distance2; });
      nearest_.resize(kNeighboursMax);
    }
    planes_.clear();
    for (const Near& near : nearest_) {
      planes_.push_back(orca_half_plane(params_, self, near.body));
      std::swap(planes_.back(), planes_[random_.index(planes_.size())]);
    }
    const Vec2 velocity = orca_velocity(planes_, params_.speed_mps, preferred(self.position_m));
    const Vec3 wanted{velocity.x(), velocity.y(), 0.0};
    return limiter_ ? limiter_->step(wanted) : wanted;
  }

 private:
  static constexpr std::ptrdiff_t kNeighboursMax = 20;
  static constexpr double kNearGoalGain = 1.5;  // 1/s, slow enough for the limit of jerk
  struct Near {
    double distance2 = 0.0;
    OrcaBody body;
  };

  /// To the goal at full speed, as fast as it can be stopped there.
  [[nodiscard]] Vec2 preferred(const Vec2& position) const {
    const Vec2 way = goal_ - position;
    const double distance = way.norm();
    if (distance <= 0.0) return Vec2::Zero();
    double speed = std::min(params_.speed_mps, distance / params_.period_s);
    if (limiter_) {
      speed = std::min({speed, std::sqrt(setting_.limits.acceleration_mps2 * distance),
                        kNearGoalGain * distance});
    }
    return way * (speed / distance);
  }

  const Setting& setting_;
  OrcaParams params_;
  Vec2 goal_;
  Random random_;
  Heard heard_;
  std::optional<LimitedVelocity> limiter_;
  std::vector<Near> nearest_;
  std::vector<HalfPlane> planes_;
};

/// Flies its part of a change that a ground station planned, on the references of its Passage. It
/// is always decided for the end of the period, with what is known at its begin.
class PassageAvoider final : public Avoider {
 public:
  PassageAvoider(const Setting& setting, const formation::Change& change, std::size_t index)
      : setting_{setting}, passage_{change, index, {}, Instant{}} {}

  void on_message(const Message& message, double) override {
    if (message.progress) passage_.on_progress(message.from.value - 1U, *message.progress);
  }
  Vec3 step(const OwnMotion& own, double now_s) override {
    const Instant then = at_seconds(now_s + setting_.control_period_s);
    passage_.step(then);
    return (passage_.reference(then).position_m - own.position_m) / setting_.control_period_s;
  }
  void tell(Message& message) const override { message.progress = passage_.progress(); }

 private:
  const Setting& setting_;
  formation::Passage passage_;
};

using Avoiders = std::vector<std::unique_ptr<Avoider>>;

Result<Avoiders> passages(const Setting& setting, std::uint64_t) {
  formation::ChangeRequest request;
  request.limits = setting.limits;
  request.separation = setting.separation;
  // What others fly until a message that follows a lost one is there, so that nobody waits for it.
  request.reserve_m =
      setting.limits.speed_mps * (setting.message_delay_s + 2.0 * setting.message_period_s);
  for (std::size_t i = 0; i < setting.starts.size(); ++i) {
    request.transfers.push_back(
        {VehicleId{static_cast<std::uint16_t>(i + 1)}, setting.starts[i], setting.goals[i]});
  }
  auto planned = formation::plan_change(request);
  // Or as much of it as there is room for.
  for (int i = 0; i < 3 && !planned; ++i) {
    request.reserve_m *= 0.5;
    planned = formation::plan_change(request);
  }
  if (!planned) return planned.error();
  planned->change.number = 1;
  planned->change.start = at_seconds(setting.start_s);
  Avoiders out;
  for (std::size_t i = 0; i < setting.starts.size(); ++i) {
    out.push_back(std::make_unique<PassageAvoider>(setting, planned->change, i));
  }
  return out;
}

Result<Avoiders> fields(const Setting& setting, std::uint64_t) {
  Avoiders out;
  for (std::size_t i = 0; i < setting.starts.size(); ++i) {
    out.push_back(std::make_unique<FieldAvoider>(setting, i));
  }
  return out;
}

MakeAvoiders orca(bool limited) {
  return [limited](const Setting& setting, std::uint64_t seed) -> Result<Avoiders> {
    Random seeds{seed};
    Avoiders out;
    for (std::size_t i = 0; i < setting.starts.size(); ++i) {
      out.push_back(std::make_unique<OrcaAvoider>(setting, i, seeds.next(), limited));
    }
    return out;
  };
}

}  // namespace

const std::vector<Method>& methods() {
  static const std::vector<Method> known{
      {"passage", "a planned change, flown so that who is late is waited for", passages},
      {"field", "the potential field with the order of ids of Zheng (2020)", fields},
      {"orca", "van den Berg et al. (2011); its velocities are flown as they are, at once",
       orca(false)},
      {"orca-limited", "the same, its velocities followed within acceleration and jerk",
       orca(true)},
  };
  return known;
}

Result<const Method*> find_method(std::string_view name) {
  std::string names;
  for (const Method& method : methods()) {
    if (method.name == name) return &method;
    names.append(names.empty() ? "" : ", ").append(method.name);
  }
  return Error{"there is no method \"" + std::string{name} + "\"; choose one of: " + names};
}

}  // namespace skein::swap
