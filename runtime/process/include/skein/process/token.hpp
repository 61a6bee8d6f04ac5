// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "skein/base/result.hpp"

namespace skein::process {

/// In a ground station's recording folder: what opens its console.
inline constexpr const char* kConsoleTokenFile = "console.token";
/// The same, for looking only.
inline constexpr const char* kObserverTokenFile = "console.observer.token";

/// A word that nobody guesses: 128 random bits in hexadecimal.
[[nodiscard]] std::string make_token();
/// In a file that only this user can read (0600), and that is not there yet.
[[nodiscard]] Result<void> keep_token(const std::filesystem::path& file, std::string_view token);
/// What the file has, or a new one that it has from now on. Fails where others could read it, too.
[[nodiscard]] Result<std::string> read_or_make_token(const std::filesystem::path& file);

}  // namespace skein::process
