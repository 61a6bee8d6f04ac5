// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "carrier.hpp"

namespace skein::network {

[[nodiscard]] std::string to_text(const Endpoint& endpoint);

/// Whether a carrier can run with this; else a sentence that says why not.
[[nodiscard]] Result<void> check(const CarrierConfig& config);
/// Whether both of its ports are there for it on this machine; waits a little for who is ending.
[[nodiscard]] Result<void> check_ports(const CarrierConfig& config);

}  // namespace skein::network
