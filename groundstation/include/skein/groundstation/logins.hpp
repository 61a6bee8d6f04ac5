// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "skein/base/result.hpp"
#include "skein/console/users.hpp"
#include "skein/groundstation/operator_keys.hpp"

namespace skein::groundstation {

/// Who may use the console with a password: by the password file as it is at that moment, but
/// nobody whose key the mission's authority has revoked. Of one thread.
class Logins {
 public:
  /// `keys` must outlive it.
  [[nodiscard]] static Result<Logins> open(const std::filesystem::path& file, OperatorKeys& keys);

  /// Unlocks an operator's key, too. None where name and password do not belong together, which
  /// takes as long for a name that is not known.
  [[nodiscard]] std::optional<console::Role> check(const std::string& user,
                                                   std::string_view password,
                                                   OperatorKeys::Time now);

 private:
  Logins(std::filesystem::path file, OperatorKeys& keys);
  /// Where the file has changed since. One that cannot be read changes nothing.
  [[nodiscard]] Result<void> read_again();

  std::filesystem::path file_;
  OperatorKeys* keys_;
  std::optional<std::filesystem::file_time_type> read_;
  console::Users users_;
};

}  // namespace skein::groundstation
