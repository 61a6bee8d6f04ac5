// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

/// What a process that parses bytes from the air gives up, for good.
namespace skein::network {

// Sanitizers reserve terabytes, and open files for what they report: of these, neither memory nor
// system calls are limited.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// Data, stacks and heap of a carrier's process. A team of 48 takes 20 MB, and what eight threads
/// may use as stack counts in full.
inline constexpr std::size_t kCarrierMemoryMax = std::size_t{256} << 20U;

/// All but this descriptor and the standard ones; capabilities, also those of programs that it
/// might start; memory beyond the limit; cores; real-time priority; to be traced or read by others
/// of its user. It ends with its parent's thread, and before others where memory is scarce. Of one
/// thread, first of all. Gives what did not succeed as a sentence; empty if all did.
[[nodiscard]] std::string give_up_rights(int keep);

/// System calls, of all threads: what is left is to work with the descriptors and the memory that
/// it has, and, while it opens, to make UDP sockets and threads. No file, no program, no other
/// process, no memory that is executed. A call that is not allowed fails.
enum class Calls { opening, open };
/// Gives why it cannot be, or nothing.
[[nodiscard]] std::string keep_only(Calls calls);

}  // namespace skein::network
