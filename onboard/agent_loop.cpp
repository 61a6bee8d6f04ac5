// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/agent_loop.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "skein/onboard/threads.hpp"
#include "skein/process/event_text.hpp"

namespace skein::onboard {

AgentLoop::AgentLoop(std::unique_ptr<mission::OnboardAgent> agent, VehicleId self, AgentLink link,
                     ControlPorts& control, Planner& planner, EventRing& events, Instant now)
    : agent_{std::move(agent)},
      link_{std::move(link)},
      control_{&control},
      planner_{&planner},
      events_{&events},
      self_{self},
      self_report_{self, link_.program, now},
      stepped_at_{now},
      next_telemetry_{now} {
  if (link_.record) note(recording::AgentStart{agent_->telemetry().instance, now});
}

void AgentLoop::step(Instant now) {
  stepped_at_ = now;
  const bool flying = now >= Instant{};
  if (const auto* newer = control_->state.read()) {
    state_ = *newer;
    has_state_ = true;
    if (flying && state_.time >= Instant{}) {
      note(recording::StateGiven{state_, now});
      agent_->on_state(state_, now);
      hand_out();
    }
  }
  for (int i = 0; i < kMessagesPerStep; ++i) {
    const auto received = link_.receive();
    if (!received) break;
    if (const auto* command = std::get_if<mission::Command>(&received->message)) pass_on(*command);
    self_report_.on_heard(received->sender, now);
    if (link_.record) {
      note(recording::MessageRecord{received->message, received->sender, now});
    }
    agent_->on_message(received->message, received->sender, now);
    hand_out();
  }
  while (const auto result = planner_->result()) {
    note(recording::PlanningGiven{result->round, result->expired_after, result->took, now});
    agent_->on_planning_result(*result, now);
    hand_out();
  }
  if (link_.flight_event) {
    while (auto event = link_.flight_event()) {
      if (link_.record) note(recording::FlightNotice{event->text, now});
      send(mission::Message{*event});
      report(std::move(*event));
    }
  }
  if (flying) {
    note(recording::TimeoutGiven{now});
    agent_->on_timeout(now);
    hand_out();
  }
  send_telemetry(now);
  send_self_report(now);
}

void AgentLoop::hand_out() {
  while (const auto guidance = agent_->poll_guidance()) {
    control_->guidance.write(*guidance);
    if (link_.record) {
      std::visit([this](auto made) { note(std::move(made)); },
                 recording::made(*guidance, stepped_at_));
    }
    if (const auto* plan = std::get_if<mission::FlightPlan>(&*guidance)) {
      self_report_.on_plan(*plan);
    }
  }
  while (const auto message = agent_->poll_message()) send(*message);
  while (auto request = agent_->poll_planning_request()) planner_->request(std::move(*request));
  while (auto event = agent_->poll_event()) report(std::move(*event));
}

void AgentLoop::send(const mission::Message& message) {
  if (link_.record) note(recording::MessageRecord{message, self_, stepped_at_});
  link_.send(message);
}

void AgentLoop::note(recording::AgentRecord record) const {
  if (link_.record) link_.record(std::move(record));
}

void AgentLoop::report(mission::MissionEvent event) {
  const bool warning = event.kind == mission::EventKind::warning;
  spdlog::log(warning ? spdlog::level::warn : spdlog::level::info, process::text_of(event));
  events_->push(std::move(event));
}

void AgentLoop::pass_on(const mission::Command& command) {
  const bool ours = command.vehicle == self_ || command.vehicle == kGroundStation;
  if (!ours || command.number <= command_number_) return;
  command_number_ = command.number;
  if (link_.on_command) link_.on_command(command);
}

void AgentLoop::send_telemetry(Instant now) {
  if (now < next_telemetry_ || !has_state_) return;
  next_telemetry_ = Instant{(now.time_since_epoch() / kTelemetryPeriod + 1) * kTelemetryPeriod};
  mission::Telemetry telemetry = agent_->telemetry();
  telemetry.state = state_;
  telemetry.control_overruns = control_->overruns.load(std::memory_order_relaxed);
  telemetry.messages_dropped = static_cast<std::uint32_t>(dropped());
  send(mission::Message{telemetry});
}

void AgentLoop::send_self_report(Instant now) {
  if (const auto plan = self_report_.plan_due(now)) send(mission::Message{*plan});
  if (!self_report_.health_due(now)) return;
  SelfReport::Condition condition;
  condition.instance = agent_->telemetry().instance;
  if (link_.mode) condition.mode = link_.mode();
  if (has_state_) condition.state_at = state_.time;
  condition.overruns = control_->overruns.load(std::memory_order_relaxed);
  condition.dropped = dropped();
  send(mission::Message{self_report_.health(condition, now)});
}

std::uint64_t AgentLoop::dropped() const {
  std::uint64_t dropped = link_.dropped() + events_->dropped() + planner_->dropped();
  for (const auto& [name, count] : agent_->counters()) dropped += count;
  return dropped;
}

Instant AgentLoop::next_step() const {
  const Instant period = stepped_at_ + spec_of(ThreadRole::agent).period;
  const Instant next =
      std::min({period, next_telemetry_, self_report_.next_due(), agent_->next_timeout()});
  return std::max(next, stepped_at_ + kStepSpacing);
}

}  // namespace skein::onboard
