// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "skein/base/result.hpp"

namespace skein::hil {

/// `type` is SOCK_DGRAM or SOCK_STREAM; port 0 is free where the address is this machine's.
[[nodiscard]] bool port_free(int type, const std::string& of, std::uint16_t port);

/// The first port of a free block of UDP, or why there is none; `wanted` 0: anywhere.
[[nodiscard]] Result<std::uint16_t> port_block(const std::string& of, std::uint16_t wanted,
                                               std::size_t count);

}  // namespace skein::hil
