// SPDX-License-Identifier: Apache-2.0
#include "skein/process/service.hpp"

#include <systemd/sd-daemon.h>

#include <algorithm>

#include "skein/base/assert.hpp"

namespace skein::process {

bool ProgressWatch::all_moved(std::span<const std::uint64_t> counters, Time now) {
  SKEIN_ASSERT(counters.size() == parts_.size());
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (counters[i] != parts_[i].counter) parts_[i] = {counters[i], true, now};
  }
  if (!std::ranges::all_of(parts_, &Part::moved)) return false;
  for (Part& part : parts_) part.moved = false;
  return true;
}

Service::Service() {
  std::uint64_t patience_us = 0;
  if (sd_watchdog_enabled(0, &patience_us) > 0) {
    watchdog_period_ = std::chrono::microseconds{patience_us / 4};
  }
}

void Service::ready() const { (void)sd_notify(0, "READY=1"); }
void Service::stopping() const { (void)sd_notify(0, "STOPPING=1"); }
void Service::feed_watchdog() const { (void)sd_notify(0, "WATCHDOG=1"); }

}  // namespace skein::process
