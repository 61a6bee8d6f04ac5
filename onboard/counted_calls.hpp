// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Counts allocations and mutex locks of a test program by standing in for operator new and
/// pthread_mutex_lock. Sanitizers stand in for them too; there nothing is counted.
namespace counted_calls {

[[nodiscard]] bool available();
[[nodiscard]] int allocations();
[[nodiscard]] int locks();
void reset();

}  // namespace counted_calls
