// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace skein::configuration {

/// docs/scenarios.md and docs/configuration.md, printed from the tables that the loader reads by.
[[nodiscard]] std::string scenario_reference();
[[nodiscard]] std::string configuration_reference();

}  // namespace skein::configuration
