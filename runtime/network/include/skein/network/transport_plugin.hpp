// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/rtps/transport/TransportDescriptorInterface.h>

#include <cstdint>
#include <memory>

/// What a shared library must export to stand between a node and its sockets. Only plugins include
/// this header: it is the one that needs Fast DDS.
namespace skein::network {

/// Puts its own transport around `transport` (plain UDPv4 when called). Null on success, otherwise
/// a sentence that says why not; it must stay valid.
using WrapTransport =
    const char* (*)(std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface>&
                        transport,
                    std::uint16_t self);
inline constexpr const char* kWrapTransportSymbol = "skein_wrap_transport";

}  // namespace skein::network
