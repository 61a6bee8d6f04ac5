// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/logins.hpp"

#include <spdlog/spdlog.h>

#include <system_error>
#include <utility>

namespace skein::groundstation {

Logins::Logins(std::filesystem::path file, OperatorKeys& keys)
    : file_{std::move(file)}, keys_{&keys} {}

Result<Logins> Logins::open(const std::filesystem::path& file, OperatorKeys& keys) {
  Logins logins{file, keys};
  if (auto read = logins.read_again(); !read) return read.error();
  return logins;
}

Result<void> Logins::read_again() {
  std::error_code failed;
  const auto written = std::filesystem::last_write_time(file_, failed);
  if (!failed && written == read_) return {};
  auto users = console::Users::load(file_);
  if (!users) return users.error();
  users_ = *std::move(users);
  read_ = failed ? std::nullopt : std::optional{written};
  for (const std::string& name : users_.repeated()) {
    spdlog::warn("{}: several lines are of {}; the last counts, delete the others", file_.string(),
                 name);
  }
  return {};
}

std::optional<console::Role> Logins::check(const std::string& user, std::string_view password,
                                           OperatorKeys::Time now) {
  if (auto read = read_again(); !read) {
    spdlog::warn("console: who may log in stays as it was: {}", read.error().message);
  }
  const auto role = users_.check(user, password);
  if (!role || !keys_->are_needed()) return role;
  if (keys_->is_revoked(user)) {
    spdlog::warn("console: {} was revoked, and is not let in", user);
    return std::nullopt;
  }
  if (*role == console::Role::op) {
    if (const auto unlocked = keys_->unlock(user, password, now); !unlocked) {
      spdlog::warn("console: {} signs nothing: {}", user, unlocked.error().message);
    }
  }
  return role;
}

}  // namespace skein::groundstation
