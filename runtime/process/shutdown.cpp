// SPDX-License-Identifier: Apache-2.0
#include "skein/process/shutdown.hpp"

#include <unistd.h>

#include <csignal>

namespace skein::process {
namespace {

sigset_t stop_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  return set;
}

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
  return signal == SIGINT ? "SIGINT" : "SIGTERM";
}

void Shutdown::request() const { kill(getpid(), SIGTERM); }

}  // namespace skein::process
