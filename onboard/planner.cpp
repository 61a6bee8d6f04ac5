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
    if (now_) {
      budget.expired = [this, end = request->answer_by - kAnswerMargin] { return now_() >= end; };
    }
    auto allocation = planning::allocate(request->params, request->problem, budget);
    results_.push(
        {request->round, std::move(allocation), std::chrono::steady_clock::now() - begun});
    on_result_();
  }
}

void Planner::stop() {
  stopping_ = true;
  wake_.notify();
}

}  // namespace skein::onboard
