// SPDX-License-Identifier: Apache-2.0
#include "skein/process/shutdown.hpp"

#include <unistd.h>

#include <csignal>
#include <ctime>

namespace skein::process {
namespace {

sigset_t stop_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  return set;
}

const char* name_of(int signal) { return signal == SIGINT ? "SIGINT" : "SIGTERM"; }

}  // namespace

Shutdown::Shutdown() {
  const sigset_t set = stop_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

const char* Shutdown::wait() const {
  const sigset_t set = stop_signals();
  int signal = 0;
  while (sigwait(&set, &signal) != 0) {
  }
  return name_of(signal);
}

const char* Shutdown::wait_for(std::chrono::nanoseconds at_most) const {
  const sigset_t set = stop_signals();
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(at_most);
  timespec timeout{};
  timeout.tv_sec = static_cast<std::time_t>(whole.count());
  timeout.tv_nsec = static_cast<long>((at_most - whole).count());
  const int signal = sigtimedwait(&set, nullptr, &timeout);
  return signal > 0 ? name_of(signal) : nullptr;
}

void Shutdown::request() const { kill(getpid(), SIGTERM); }

}  // namespace skein::process
