// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/rtps/transport/TransportDescriptorInterface.h>

#include <memory>

#include "seals.hpp"

namespace skein::network {

/// Puts a transport around `transport` that sends nothing in clear, and hands on only what was
/// opened: before that nothing of a datagram is parsed but the 14 bytes of its header.
[[nodiscard]] std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> sealed(
    std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> transport,
    std::shared_ptr<Seals> seals);

}  // namespace skein::network
