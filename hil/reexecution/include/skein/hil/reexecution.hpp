// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"

namespace skein::hil {

/// How a vehicle's node did when it was given again what its recording says that it was given.
struct Reexecution {
  VehicleId vehicle;
  std::uint64_t inputs = 0;
  std::uint64_t plans = 0;     ///< flight plans and motion tracks that are the same
  std::uint64_t messages = 0;  ///< that are the same
  std::uint64_t allocations = 0;
  Instant until{};  ///< what came before was compared
  /// The recording lost records there; what comes after is not compared.
  std::optional<Instant> gap;
  std::size_t damaged = 0;  ///< parts of the recording that cannot be read
  bool complete = true;     ///< the recording was closed by its process
  /// The first thing that is not as it was, in full; empty: none.
  std::string difference;
  Instant differs_at{};
};

/// Makes the node from the configuration in a vehicle's recording, gives it the recorded inputs at
/// their times and in their order, plans anew wherever it asks for a plan, and compares everything
/// that it says, and each flight plan and motion track that it gives, with the recorded ones, byte
/// for byte. Fails where there is no recording of a node from its start.
[[nodiscard]] Result<Reexecution> reexecute(const std::filesystem::path& node_folder);

}  // namespace skein::hil
