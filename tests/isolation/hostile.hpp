// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

/// What hostile_transport.cpp does in the process that carries a node's network, on a datagram to
/// one of the node's ports that begins with kOrder: what a broken library, or somebody who broke
/// into it, might do there.
namespace skein::isolation {

inline constexpr std::string_view kOrder = "hostile:";

inline constexpr std::string_view kCrash = "crash";
inline constexpr std::string_view kLeak = "leak";      ///< takes memory as long as there is some
inline constexpr std::string_view kHang = "hang";      ///< the thread that sends never comes back
inline constexpr std::string_view kEscape = "escape";  ///< tries all that it must not

/// How long a file is that the agent leaves to the programs that it starts.
inline constexpr std::size_t kInheritedBytes = 7777;

/// The answer to kEscape: a line "name errno" for each attempt, 0 where it succeeded.

}  // namespace skein::isolation
