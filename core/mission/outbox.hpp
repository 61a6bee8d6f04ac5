// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "skein/base/bounded_queue.hpp"
#include "skein/mission/onboard_agent.hpp"

namespace skein::mission {

/// What the parts of a vehicle's agent bring forth, in the order in which they do.
struct Outbox {
  explicit Outbox(VehicleId sender) : self{sender} {}

  /// What happened, for the recording and for everybody.
  void report(EventBody body, const coalition::Round& round, const TaskId& task, Instant time) {
    const MissionEvent event{self, time, round, task, std::move(body)};
    const EventKind kind = event.kind();
    events.push(event);
    // Renewals and refusals to bid are many and of interest to the recording only.
    if (kind != EventKind::lease_granted && kind != EventKind::bid_declined) messages.push(event);
  }

  VehicleId self;
  BoundedQueue<Message> messages{256};
  BoundedQueue<MissionEvent> events{1024};
  BoundedQueue<PlanningRequest> planning_requests{4};
};

}  // namespace skein::mission
