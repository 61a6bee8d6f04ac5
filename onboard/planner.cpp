// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/planner.hpp"

#include <chrono>
#include <utility>

namespace skein::onboard {

bool Planner::request(mission::PlanningRequest request) {
  const bool accepted = requests_.push(std::move(request));
  wake_.notify();
  return accepted;
}

void Planner::run() {
  while (!stopping_) {
    const auto request = requests_.pop();
    if (!request) {
      wake_.wait_until(std::chrono::steady_clock::now() + std::chrono::seconds{1});
      continue;
    }
    const auto begun = std::chrono::steady_clock::now();
    planning::PlanningBudget budget;
    std::uint64_t asked = 0;
    std::uint64_t expired_after = 0;
    if (now_) {
      budget.expired = [&, end = request->answer_by - kAnswerMargin] {
        ++asked;
        if (expired_after == 0 && now_() >= end) expired_after = asked;
        return expired_after != 0;
      };
    }
    auto allocation = planning::allocate(request->params, request->problem, budget);
    results_.push(
        {{request->round, std::move(allocation), std::chrono::steady_clock::now() - begun},
         expired_after});
    on_result_();
  }
}

void Planner::stop() {
  stopping_ = true;
  wake_.notify();
}

}  // namespace skein::onboard
