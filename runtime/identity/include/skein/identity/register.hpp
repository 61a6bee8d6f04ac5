// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/identity/certificate.hpp"
#include "skein/identity/folder_lock.hpp"
#include "skein/identity/key_change.hpp"
#include "skein/seal/keys.hpp"

namespace skein::identity {

/// What a mission is, as its authority keeps it (authority.hpp). As a file: a line for each, in
/// this order.
struct Register {
  Certificate authority;
  seal::EpochKey key;
  RevocationList revoked;
  std::vector<Certificate> members;  ///< the ground station's first; serials 1, 2, ...
};
/// Fails where others may read it, too.
[[nodiscard]] Result<Register> read_register(const std::filesystem::path& file);
[[nodiscard]] Result<void> write_register(const std::filesystem::path& file,
                                          const Register& mission, Durable durable);
/// Who was revoked and has no other certificate that holds, by their serials: the last of each.
[[nodiscard]] std::vector<Certificate> who_is_out(const Register& mission);
/// In a mission's folder; none in a vehicle's.
[[nodiscard]] std::filesystem::path register_file(const std::filesystem::path& folder);

}  // namespace skein::identity
