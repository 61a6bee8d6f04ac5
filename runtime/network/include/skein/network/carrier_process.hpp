// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

namespace skein::network {

/// First of all in main() of a program whose nodes are isolated (NodeConfig): such a node starts
/// the program again as the process that carries its network. Gives the status to end with if this
/// is that process; nothing in all others, which go on.
[[nodiscard]] std::optional<int> run_carrier(int argc, char** argv);

}  // namespace skein::network
