// SPDX-License-Identifier: Apache-2.0
#include "stop_signal.hpp"

#include <atomic>
#include <csignal>

namespace skein::hil {
namespace {

std::atomic<bool> g_asked_to_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void stop(int signal) {
  g_asked_to_stop = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void listen_for_stop() {
  std::signal(SIGINT, stop);
  std::signal(SIGTERM, stop);
}

bool asked_to_stop() { return g_asked_to_stop; }

}  // namespace skein::hil
