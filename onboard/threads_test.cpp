// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/threads.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <atomic>
#include <csignal>
#include <future>
#include <thread>

namespace skein::onboard {
namespace {

bool may_be_realtime() {
  std::promise<void> looked_at;
  std::thread thread =
      start_thread(ThreadRole::control, [end = looked_at.get_future().share()] { end.wait(); });
  int policy = SCHED_OTHER;
  sched_param parameters{};
  pthread_getschedparam(thread.native_handle(), &policy, &parameters);
  looked_at.set_value();
  thread.join();
  return policy == SCHED_FIFO;
}

TEST(ThreadsDeathTest, ARealtimeThreadThatNeverWaitsEndsItsProcess) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  if (!may_be_realtime()) GTEST_SKIP() << "real-time threads are not permitted here";
  const auto spin = [] {
    std::atomic<std::uint64_t> turns{0};
    start_thread(ThreadRole::control, [&turns] {
      while (true) ++turns;
    }).join();
  };
  EXPECT_EXIT(spin(), testing::KilledBySignal(SIGXCPU), "");
}

}  // namespace
}  // namespace skein::onboard
