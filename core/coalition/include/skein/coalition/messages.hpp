// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/domain/site.hpp"
#include "skein/domain/task.hpp"
#include "skein/idl/coalition.hpp"

namespace skein::coalition {

/// The coalition stands, and its leader has its electors behind it.
[[nodiscard]] inline bool stands(const LeaseRenewal& renewal) {
  return !renewal.electors.empty() && renewal.lease_until > renewal.sent_at;
}

}  // namespace skein::coalition
