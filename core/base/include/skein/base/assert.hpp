// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace skein {

/// What a failed SKEIN_ASSERT does. The default prints the place and aborts; a vehicle installs one
/// that leaves the flight controller in its failsafe. The handler does not return.
using AssertHandler = void (*)(const char* condition, const char* file, int line);
void set_assert_handler(AssertHandler handler);

[[noreturn]] void assert_failed(const char* condition, const char* file, int line);

}  // namespace skein

/// An invariant of the program: a failure is a bug, never bad input. On in every build.
#define SKEIN_ASSERT(condition)                        \
  (static_cast<bool>(condition) ? static_cast<void>(0) \
                                : ::skein::assert_failed(#condition, __FILE__, __LINE__))
