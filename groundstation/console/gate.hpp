// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "skein/console/users.hpp"

namespace skein::console {

/// Who speaks on a connection.
struct Identity {
  std::string user;
  Role role = Role::observer;
};

/// Who is let in: by the cookie of a session, which a password or the token opens, or everybody
/// where there is neither. And from where: a page of another origin is not, so that no site in the
/// operator's browser commands a fleet.
class Gate {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr auto kSessionLasts = std::chrono::hours{12};
  static constexpr std::size_t kSessionsMax = 1000;

  /// Without passwords: whoever has the token is the operator, or with the observers' an observer;
  /// `token` empty, too: whoever reaches the port.
  Gate(bool with_passwords, std::string token, bool secure, std::string observer_token = {})
      : with_passwords_{with_passwords},
        token_{std::move(token)},
        observer_token_{std::move(observer_token)},
        secure_{secure} {}

  [[nodiscard]] std::optional<Identity> identify(std::string_view cookies, Time now) const;
  /// Whose token that is. Precondition: it asks for one.
  [[nodiscard]] std::optional<Identity> check(std::string_view token) const;
  /// Makes a session; gives the Set-Cookie field.
  [[nodiscard]] std::string admit(const Identity& identity, Time now);
  /// Ends the cookie's session; gives the Set-Cookie field.
  [[nodiscard]] std::string dismiss(std::string_view cookies);

  /// Ends every session of that user.
  void dismiss_all(std::string_view user);

  [[nodiscard]] bool has_session(std::string_view user) const;

  [[nodiscard]] bool asks_for_password() const { return with_passwords_; }
  [[nodiscard]] bool asks_for_token() const { return !with_passwords_ && !token_.empty(); }
  /// Does the browser say that the request comes from a page of this very server? Other programs
  /// name no origin.
  [[nodiscard]] bool is_own_origin(std::string_view origin, std::string_view host) const;
  /// Without passwords only names of this machine count as Host: a name that somebody has pointed
  /// to 127.0.0.1 would otherwise make a foreign page ours.
  [[nodiscard]] bool is_own_host(std::string_view host) const;

 private:
  struct Session {
    Identity identity;
    Time until;
  };
  [[nodiscard]] std::string cookie(std::string_view value, long max_age_s) const;

  bool with_passwords_;
  std::string token_;
  std::string observer_token_;
  bool secure_;
  std::map<std::string, Session, std::less<>> sessions_;
};

}  // namespace skein::console
