// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>

#include "skein/mission/onboard_agent.hpp"
#include "skein/onboard/spsc_ring.hpp"
#include "skein/process/wake.hpp"

namespace skein::onboard {

/// Runs planning::allocate for the agent, in a thread of its own: run() is that thread. The agent's
/// thread calls request() and result().
class Planner {
 public:
  /// A result, and what it takes to make it again: its budget was spent when it was asked for this
  /// time; 0: never.
  struct Answer : mission::PlanningResult {
    std::uint64_t expired_after = 0;
  };

  /// A plan is given up improving this long before its request wants the answer.
  static constexpr Duration kAnswerMargin = std::chrono::milliseconds{100};

  /// `on_result` is called from the planner's thread when a result has been queued. `now` is the
  /// mission clock; without one a plan is improved for as long as there is something to improve.
  explicit Planner(std::function<void()> on_result, std::function<Instant()> now = {})
      : on_result_{std::move(on_result)}, now_{std::move(now)} {}

  /// False, and counted in dropped(), when four requests are waiting already.
  bool request(mission::PlanningRequest request);
  [[nodiscard]] std::optional<Answer> result() { return results_.pop(); }

  /// Works until stop(). A plan that is being made is finished first.
  void run();
  void stop();
  [[nodiscard]] std::uint64_t dropped() const { return requests_.dropped() + results_.dropped(); }

 private:
  std::function<void()> on_result_;
  std::function<Instant()> now_;
  SpscRing<mission::PlanningRequest, 4> requests_;
  SpscRing<Answer, 8> results_;
  process::Wake wake_;
  std::atomic<bool> stopping_{false};
};

}  // namespace skein::onboard
