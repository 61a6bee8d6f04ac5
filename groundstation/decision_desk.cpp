// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/decision_desk.hpp"

#include <fmt/format.h>

namespace skein::groundstation {

Answer decision_answer(const Decision& decision, mission::GroundAgent& agent, const std::string& by,
                       Instant now) {
  const mission::Verdict what{decision.grant, decision.although_silent};
  Result<std::string> outcome = std::string{};
  if (decision.plan) {
    outcome = agent.decide_on(*decision.plan, decision.site, what, by, now);
  } else if (decision.grant) {
    outcome = agent.authorise(decision.site, by, now, decision.although_silent);
  } else if (const auto refused = agent.refuse(decision.site, by, now); !refused) {
    outcome = refused.error();
  }
  if (!outcome) return {false, outcome.error().message + "\n"};
  return {true, outcome->empty() ? "done\n" : "done, although " + *outcome + "\n"};
}

Answer decision_answer(const TakeBack& back, mission::GroundAgent& agent, const std::string& by,
                       Instant now) {
  const auto taken = agent.take_back(back.site, by, now);
  if (!taken) return {false, taken.error().message + "\n"};
  std::string text = fmt::format("what was authorised at site {} is taken back\n", back.site.value);
  for (const TaskAssignment& one : taken->flown_on) {
    text += fmt::format("{} has begun: vehicle {} flies it to its end\n", to_string(one.task),
                        one.vehicle.value);
  }
  for (const VehicleId vehicle : taken->silent) {
    text += fmt::format("vehicle {} is silent: it may not hear this, and fly\n", vehicle.value);
  }
  return {true, text};
}

}  // namespace skein::groundstation
