// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/vehicle_node.hpp"

#include <algorithm>
#include <utility>

#include "self_report.hpp"
#include "skein/mission/may_say.hpp"

namespace skein::mission {
namespace {

struct MakeAgent {
  Instant now;
  std::unique_ptr<OnboardAgent> operator()(const VehicleAgentConfig& config) const {
    return std::make_unique<VehicleAgent>(config, now);
  }
  std::unique_ptr<OnboardAgent> operator()(const FormationAgentConfig& config) const {
    return std::make_unique<FormationAgent>(config, now);
  }
  std::unique_ptr<OnboardAgent> operator()(const TrackAgentConfig& config) const {
    return std::make_unique<TrackAgent>(config, now);
  }
};

Health unchanging(const VehicleNodeConfig& config, const Telemetry& telemetry) {
  Health health;
  health.vehicle = telemetry.vehicle;
  health.instance = telemetry.instance;
  health.program = config.program;
  health.flight_controller = config.flight_controller;
  return health;
}

}  // namespace

class VehicleNode::Impl {
 public:
  Impl(const VehicleNodeConfig& config, Instant now)
      : agent{std::visit(MakeAgent{now}, config.agent)},
        self{agent->telemetry().vehicle},
        telemetry_period{config.telemetry_period},
        self_report{unchanging(config, agent->telemetry()), now},
        next_telemetry{now} {
    take_guidance();
  }

  void take_guidance() {
    auto newest = agent->poll_guidance();
    if (!newest) return;
    if (const auto* plan = std::get_if<FlightPlan>(&*newest)) self_report.on_plan(*plan);
    guidance = *newest;
  }

  void on_command(const Command& command) {
    if (!commands.take(command, self)) return;
    if (command.kind == CommandKind::give_back && command.vehicle == self) {
      give_back = issued_at(command);
    }
  }

  void report_itself(Instant now) {
    if (now >= next_telemetry && state) {
      next_telemetry = next_multiple(now, telemetry_period);
      Telemetry telemetry = agent->telemetry();
      telemetry.state = *state;
      telemetry.control_overruns = static_cast<std::uint32_t>(condition.overruns);
      telemetry.messages_dropped = static_cast<std::uint32_t>(dropped());
      messages.push(Message{telemetry});
    }
    if (const auto plan = self_report.plan_due(now)) messages.push(Message{*plan});
    if (!self_report.health_due(now)) return;
    SelfReport::Facts facts{.condition = condition, .refused = refused};
    facts.condition.dropped = dropped();
    if (state) facts.state_at = state->time;
    messages.push(Message{self_report.health(facts, now)});
  }

  [[nodiscard]] Counters counters() const {
    Counters all = agent->counters();
    all.refused += refused;
    all.messages_dropped += messages.dropped();
    all.events_dropped += events.dropped();
    return all;
  }
  [[nodiscard]] std::uint64_t dropped() const {
    const Counters ours = counters();
    return condition.dropped + ours.messages_dropped + ours.events_dropped;
  }

  std::unique_ptr<OnboardAgent> agent;
  VehicleId self;
  Duration telemetry_period;
  SelfReport self_report;
  std::optional<VehicleState> state;
  Condition condition;
  std::optional<Guidance> guidance;
  std::optional<Instant> give_back;
  CommandFilter commands;
  std::uint64_t refused = 0;
  Instant next_telemetry;
  BoundedQueue<Message> messages{64};  ///< the node's own
  BoundedQueue<MissionEvent> events{64};
};

VehicleNode::VehicleNode(const VehicleNodeConfig& config, Instant now)
    : impl_{std::make_unique<Impl>(config, now)} {}
VehicleNode::~VehicleNode() = default;
VehicleNode::VehicleNode(VehicleNode&&) noexcept = default;
VehicleNode& VehicleNode::operator=(VehicleNode&&) noexcept = default;

void VehicleNode::on_state(const VehicleState& state, Instant now) {
  impl_->state = state;
  if (now >= Instant{} && state.time >= Instant{}) {
    impl_->agent->on_state(state, now);
    impl_->take_guidance();
  }
  impl_->report_itself(now);
}

void VehicleNode::on_message(const Message& message, VehicleId sender, Instant now) {
  if (!may_say(message, sender)) {
    ++impl_->refused;
    return;
  }
  impl_->self_report.on_heard(sender, now);
  if (const auto* command = std::get_if<Command>(&message)) impl_->on_command(*command);
  impl_->agent->on_message(message, sender, now);
  impl_->take_guidance();
}

void VehicleNode::on_planning_result(const PlanningResult& result, Instant now) {
  impl_->agent->on_planning_result(result, now);
  impl_->take_guidance();
}

void VehicleNode::on_notice(const FlightNotice& notice) {
  if (!notice.warning) return;
  MissionEvent event{impl_->self, notice.time, {}, {}, event::FlightWarning{notice.what}};
  impl_->messages.push(event);
  impl_->events.push(std::move(event));
}

void VehicleNode::on_condition(const Condition& condition) { impl_->condition = condition; }
bool VehicleNode::wants_condition(Instant now) const {
  return now >= impl_->next_telemetry || impl_->self_report.health_due(now);
}

void VehicleNode::on_timeout(Instant now) {
  if (now >= Instant{}) {
    impl_->agent->on_timeout(now);
    impl_->take_guidance();
  }
  impl_->report_itself(now);
}

std::optional<Message> VehicleNode::poll_message() {
  if (auto message = impl_->agent->poll_message()) return message;
  return impl_->messages.pop();
}
std::optional<Guidance> VehicleNode::poll_guidance() {
  if (!impl_->guidance) return std::nullopt;  // what is not there is kilobytes to copy, too
  return std::exchange(impl_->guidance, {});
}
std::optional<PlanningRequest> VehicleNode::poll_planning_request() {
  return impl_->agent->poll_planning_request();
}
std::optional<MissionEvent> VehicleNode::poll_event() {
  if (auto event = impl_->agent->poll_event()) return event;
  return impl_->events.pop();
}
std::optional<Instant> VehicleNode::poll_give_back() { return std::exchange(impl_->give_back, {}); }

Instant VehicleNode::next_timeout() const {
  return std::min(
      {impl_->next_telemetry, impl_->self_report.next_due(), impl_->agent->next_timeout()});
}

const OnboardAgent& VehicleNode::agent() const { return *impl_->agent; }
VehicleId VehicleNode::vehicle() const { return impl_->self; }
InstanceId VehicleNode::instance() const { return impl_->agent->telemetry().instance; }
Counters VehicleNode::counters() const { return impl_->counters(); }

}  // namespace skein::mission
