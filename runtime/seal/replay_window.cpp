// SPDX-License-Identifier: Apache-2.0
#include "skein/seal/replay_window.hpp"

#include <algorithm>

namespace skein::seal {

bool ReplayWindow::is_new(std::uint64_t counter) const {
  if (!any_ || counter > newest_) return true;
  return newest_ - counter < kReach && !seen_[counter % kReach];
}

void ReplayWindow::note(std::uint64_t counter) {
  if (!any_ || counter > newest_) {
    // What lies between was not seen; a jump over the whole window forgets all of it.
    const std::uint64_t jump = any_ ? std::min<std::uint64_t>(counter - newest_, kReach) : kReach;
    for (std::uint64_t i = 0; i < jump; ++i) seen_.reset((counter - i) % kReach);
    newest_ = counter;
    any_ = true;
  }
  if (newest_ - counter < kReach) seen_.set(counter % kReach);
}

}  // namespace skein::seal
