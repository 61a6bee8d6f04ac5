// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/agent_loop.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "skein/onboard/threads.hpp"
#include "skein/process/journal.hpp"
#include "skein/wording/wording.hpp"

namespace skein::onboard {

AgentLoop::AgentLoop(const mission::VehicleNodeConfig& config, AgentLink link,
                     ControlPorts& control, Planner& planner, EventRing& events, Instant now)
    : node_{config, now},
      link_{std::move(link)},
      control_{&control},
      planner_{&planner},
      events_{&events},
      stepped_at_{now} {
  note(recording::AgentStart{node_.instance(), config.program, now});
}

void AgentLoop::step(Instant now) {
  stepped_at_ = now;
  // First: what the node tells of itself follows its state.
  if (node_.wants_condition(now)) give_condition();
  if (const auto* state = control_->state.read()) {
    note(recording::StateGiven{*state, now});
    node_.on_state(*state, now);
    hand_out();
  }
  for (int i = 0; i < kMessagesPerStep; ++i) {
    const auto received = link_.receive();
    if (!received) break;
    // What comes now was sent since this step began, perhaps: by an older time its sender's clock
    // would seem to be ahead.
    if (link_.now) stepped_at_ = std::max(stepped_at_, link_.now());
    take_in(*received);
    hand_out();
  }
  while (const auto result = planner_->result()) {
    note(recording::PlanningGiven{result->round, result->expired_after, result->took, stepped_at_});
    node_.on_planning_result(*result, stepped_at_);
    hand_out();
  }
  while (auto notice = link_.notice ? link_.notice() : std::nullopt) {
    spdlog::info("flight controller, {:.3f} s: {}", to_seconds(notice->time),
                 wording::text_of(notice->what));
    note(recording::NoticeGiven{*notice, stepped_at_});
    node_.on_notice(*notice, stepped_at_);
    hand_out();
  }
  note(recording::TimeoutGiven{stepped_at_});
  node_.on_timeout(stepped_at_);
  hand_out();
}

void AgentLoop::take_in(const AgentLink::Received& received) {
  if (link_.record) {
    if (received.sender == node_.vehicle()) note(recording::NamesakeHeard{stepped_at_});
    note(recording::MessageRecord{received.message, received.sender, stepped_at_});
  }
  node_.on_message(received.message, received.sender, stepped_at_);
}

void AgentLoop::hand_out() {
  while (const auto guidance = node_.poll_guidance()) {
    control_->guidance.write(*guidance);
    if (!link_.record) continue;
    std::visit([this](auto made) { note(std::move(made)); },
               recording::made(*guidance, stepped_at_));
  }
  while (const auto message = node_.poll_message()) {
    if (link_.record) note(recording::MessageRecord{*message, node_.vehicle(), stepped_at_});
    link_.send(*message);
  }
  while (auto request = node_.poll_planning_request()) planner_->request(std::move(*request));
  while (auto event = node_.poll_event()) report(std::move(*event));
  while (const auto issued = node_.poll_give_back()) {
    if (link_.give_back) link_.give_back(*issued);
  }
  while (const auto fence = node_.poll_fence()) {
    if (link_.keep_fence) link_.keep_fence(*fence);
  }
}

void AgentLoop::note(recording::AgentRecord record) const {
  if (link_.record) link_.record(std::move(record));
}

void AgentLoop::report(mission::MissionEvent event) {
  process::log_event(event);
  events_->push(std::move(event));
}

void AgentLoop::give_condition() {
  mission::Condition newest{.mode = link_.mode ? link_.mode() : std::string{},
                            .overruns = control_->overruns.load(std::memory_order_relaxed),
                            .dropped = link_.dropped() + events_->dropped() + planner_->dropped()};
  if (newest == condition_) return;
  condition_ = std::move(newest);
  note(recording::ConditionGiven{condition_, stepped_at_});
  node_.on_condition(condition_);
}

Instant AgentLoop::next_step() const {
  const Instant period = stepped_at_ + spec_of(ThreadRole::agent).period;
  return std::max(std::min(period, node_.next_timeout()), stepped_at_ + kStepSpacing);
}

}  // namespace skein::onboard
