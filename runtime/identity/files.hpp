// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "skein/base/result.hpp"
#include "skein/identity/folder_lock.hpp"

/// Files that are there whole or not at all, and of which nobody else reads what is private.
namespace skein::identity {

inline constexpr const char* kAuthorityKeyFile = "authority.key";
inline constexpr const char* kRegisterFile = "register";
inline constexpr const char* kOperatorsFolder = "operators";

enum class Readers : std::uint8_t {
  owner,    ///< fails where others may read it, too
  anybody,  ///< is looked after by whoever put it there, or holds no secret
};
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& file,
                                            std::size_t bytes_max, Readers readers);
/// With mode 0600, in place of what was there. As root, for the owner of the folder.
[[nodiscard]] Result<void> write_file(const std::filesystem::path& file, std::string_view text,
                                      Durable durable);
/// With those above it, and mode 0700, where it is not there yet. As root, for the owner of the one
/// above it.
[[nodiscard]] Result<void> make_folder(const std::filesystem::path& folder);
[[nodiscard]] bool is_there(const std::filesystem::path& file);
/// Not there, or without a file in it.
[[nodiscard]] bool is_free(const std::filesystem::path& folder);

/// FILE: what is wrong with it.
[[nodiscard]] Error of_file(const std::filesystem::path& file, const Error& error);

}  // namespace skein::identity
