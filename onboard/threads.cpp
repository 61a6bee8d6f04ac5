// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/threads.hpp"

#include <pthread.h>
#include <sched.h>
#include <spdlog/spdlog.h>

#include <string>
#include <system_error>
#include <utility>

namespace skein::onboard {

std::thread start_thread(ThreadRole role, std::function<void()> body) {
  const ThreadSpec& spec = spec_of(role);
  std::thread thread{std::move(body)};
  pthread_setname_np(thread.native_handle(), std::string{spec.name}.c_str());
  if (spec.policy == SchedulingPolicy::realtime) {
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
