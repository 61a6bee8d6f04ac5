// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/vehicle_agent.hpp"

#include "vehicle_agent_impl.hpp"

namespace skein::mission {

VehicleAgent::VehicleAgent(const VehicleAgentConfig& config, Instant now)
    : impl_{std::make_unique<Impl>(config, now)} {}
VehicleAgent::~VehicleAgent() = default;

void VehicleAgent::on_state(const VehicleState& state, Instant now) { impl_->on_state(state, now); }
void VehicleAgent::on_message(const Message& message, VehicleId sender, Instant now) {
  impl_->on_message(message, sender, now);
}
void VehicleAgent::on_planning_result(const PlanningResult& result, Instant now) {
  impl_->on_planning_result(result, now);
}
void VehicleAgent::on_timeout(Instant now) { impl_->on_timeout(now); }

std::optional<Message> VehicleAgent::poll_message() { return impl_->messages.pop(); }
std::optional<Guidance> VehicleAgent::poll_guidance() { return impl_->poll_guidance(); }
std::optional<MissionEvent> VehicleAgent::poll_event() { return impl_->events.pop(); }
std::optional<PlanningRequest> VehicleAgent::poll_planning_request() {
  return impl_->planning_requests.pop();
}
Instant VehicleAgent::next_timeout() const { return impl_->next_timeout(); }
Telemetry VehicleAgent::telemetry() const { return impl_->telemetry(); }
Activity VehicleAgent::activity() const { return impl_->activity(); }
Counters VehicleAgent::counters() const { return impl_->counters(); }

}  // namespace skein::mission
