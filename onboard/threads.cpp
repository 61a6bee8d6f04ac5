// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/threads.hpp"

#include <pthread.h>
#include <sched.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <string>
#include <system_error>
#include <utility>

namespace skein::onboard {
namespace {

/// A real-time thread that never waits takes its core from everything else, its own end included:
/// the kernel ends the process instead, and the flight controller's failsafe and the service
/// manager take over.
void limit_realtime() {
  const auto limit = static_cast<rlim_t>(std::chrono::microseconds{kRealtimeWithoutWait}.count());
  rlimit now{};
  if (getrlimit(RLIMIT_RTTIME, &now) != 0 || now.rlim_cur <= limit) return;
  now.rlim_cur = limit;
  if (setrlimit(RLIMIT_RTTIME, &now) != 0) spdlog::warn("real-time threads are not limited");
}

}  // namespace

std::thread start_thread(ThreadRole role, std::function<void()> body) {
  const ThreadSpec& spec = spec_of(role);
  std::thread thread{std::move(body)};
  pthread_setname_np(thread.native_handle(), std::string{spec.name}.c_str());
  if (spec.policy == SchedulingPolicy::realtime) {
    limit_realtime();
    sched_param parameters{};
    parameters.sched_priority = spec.priority;
    const int failure = pthread_setschedparam(thread.native_handle(), SCHED_FIFO, &parameters);
    if (failure != 0) {
      spdlog::warn("thread {} runs without real-time priority ({}); give the process CAP_SYS_NICE",
                   spec.name, std::generic_category().message(failure));
    }
  }
  return thread;
}

}  // namespace skein::onboard
