// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "skein/base/result.hpp"

/// Who may use the console. A password file has a line for each: NAME:ROLE:HASH, with ROLE
/// `operator` or `observer` and HASH as hash_password() makes it; empty lines and those that begin
/// with # do not count.
namespace skein::console {

enum class Role : std::uint8_t { observer, op };
[[nodiscard]] std::string_view to_string(Role role);

/// "pbkdf2-sha256$ITERATIONS$SALT$KEY" (RFC 8018), salt and key in hexadecimal.
[[nodiscard]] std::string hash_password(std::string_view password, std::string_view salt,
                                        unsigned iterations);
/// The same, with 16 random bytes of salt and as many iterations as take some 0.1 s.
[[nodiscard]] std::string hash_password(std::string_view password);

class Users {
 public:
  /// Fails with "file:line: what is wrong"; also where others than its owner and group may read
  /// it, or others than its owner write it: passwords are guessed from it.
  [[nodiscard]] static Result<Users> load(const std::filesystem::path& file);
  [[nodiscard]] static Result<Users> parse(std::string_view text, const std::string& name);

  /// None where the name is unknown or the password wrong; takes as long for both.
  [[nodiscard]] std::optional<Role> check(const std::string& name, std::string_view password) const;
  /// Of whom there are several lines: the last counts.
  [[nodiscard]] const std::set<std::string>& repeated() const { return repeated_; }

 private:
  struct User {
    Role role = Role::observer;
    std::string hash;
  };
  std::map<std::string, User> users_;
  std::set<std::string> repeated_;
};

/// Random bytes of the system, in hexadecimal.
[[nodiscard]] std::string random_hex(std::size_t bytes);

}  // namespace skein::console
