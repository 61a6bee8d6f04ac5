// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "skein/base/ids.hpp"

namespace skein::mission {

/// Whom of several ground stations a node heeds: the newest start of the ground station that it has
/// heard, and no other. Who takes the command begins to speak as the ground station with a start
/// that is newer than all before, so two are never heeded by one vehicle.
class NewestStation {
 public:
  /// Whether what that start says is to be heeded; a newer one than before is from now on.
  bool heeds(InstanceId start) {
    if (newest_ && start < *newest_) return false;
    newest_ = start;
    return true;
  }
  [[nodiscard]] const std::optional<InstanceId>& newest() const { return newest_; }

 private:
  std::optional<InstanceId> newest_;
};

}  // namespace skein::mission
