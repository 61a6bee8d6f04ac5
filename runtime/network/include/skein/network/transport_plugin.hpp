// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/rtps/transport/TransportDescriptorInterface.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "skein/base/ids.hpp"

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

/// Nodes are told apart by the prefix of their GUID, which every RTPS message carries in its
/// header: bytes 0-3 `kGuidMark`, 4-5 the vehicle id (big endian), 6-11 from the instance id.
inline constexpr std::array<std::uint8_t, 4> kGuidMark{0x01, 0x0F, 0x53, 0x4B};
inline constexpr std::size_t kRtpsGuidPrefixOffset = 8;  ///< in an RTPS message
inline constexpr std::size_t kRtpsHeaderSize = 20;

}  // namespace skein::network
