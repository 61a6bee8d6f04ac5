// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <thread>

#include "skein/base/time.hpp"

namespace skein::onboard {

enum class ThreadRole : std::uint8_t { control, can, agent, planner, recorder, preflight, count };
enum class SchedulingPolicy : std::uint8_t { realtime, normal };

/// One thread of skein-onboard. Periods are mission time; a period of zero means that the
/// thread waits for work.
struct ThreadSpec {
  ThreadRole role;
  std::string_view name;
  SchedulingPolicy policy;
  int priority;  ///< SCHED_FIFO priority; 0 for normal threads
  Duration period;
};

/// All threads of the process but main, what watches keys and DDS's own, which are normal. `can`
/// runs where the flight controller is on a bus, whenever a frame comes and at its period.
inline constexpr std::array<ThreadSpec, static_cast<std::size_t>(ThreadRole::count)> kThreads{{
    {ThreadRole::control, "control", SchedulingPolicy::realtime, 50, std::chrono::milliseconds{20}},
    {ThreadRole::can, "can", SchedulingPolicy::realtime, 60, std::chrono::milliseconds{5}},
    {ThreadRole::agent, "agent", SchedulingPolicy::normal, 0, std::chrono::milliseconds{50}},
    {ThreadRole::planner, "planner", SchedulingPolicy::normal, 0, Duration::zero()},
    {ThreadRole::recorder, "recorder", SchedulingPolicy::normal, 0, std::chrono::milliseconds{200}},
    {ThreadRole::preflight, "preflight", SchedulingPolicy::normal, 0,
     std::chrono::milliseconds{500}},
}};

[[nodiscard]] constexpr const ThreadSpec& spec_of(ThreadRole role) {
  return kThreads[static_cast<std::size_t>(role)];
}

/// A process whose real-time thread computes so long without a wait is ended (SIGXCPU).
inline constexpr std::chrono::milliseconds kRealtimeWithoutWait{500};

/// Starts the thread under its name and policy. Where SCHED_FIFO is not permitted it runs as a
/// normal thread, with one warning in the log.
[[nodiscard]] std::thread start_thread(ThreadRole role, std::function<void()> body);

}  // namespace skein::onboard
