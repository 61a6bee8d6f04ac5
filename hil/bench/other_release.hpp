// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/configuration/vehicle_config.hpp"

namespace skein::hil {

/// Takes out of a program's configuration what another release of it does not know, by its own word
/// (--check-config), and says which keys these were: it flies with its defaults of them. What it
/// says goes to `log`. Fails with its word where it refuses the file for anything else.
[[nodiscard]] Result<std::vector<std::string>> fit_configuration(
    const std::filesystem::path& file, const std::filesystem::path& program,
    const std::filesystem::path& log);

/// Fitted to another release, where its programs are in `other`, which then flies without our
/// radio's plugin: then with the keys that it does not know ("a.b, c"), else empty.
[[nodiscard]] Result<std::string> write_configuration(configuration::VehicleConfig config,
                                                      const std::filesystem::path& file,
                                                      const std::filesystem::path* other);

/// Without those lines (from 1), and all that is deeper than each below it. For itself, for tests.
[[nodiscard]] std::string without_keys(const std::string& yaml, const std::vector<int>& lines);

}  // namespace skein::hil
