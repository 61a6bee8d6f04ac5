// SPDX-License-Identifier: Apache-2.0
#include "gate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace skein::console {
namespace {

constexpr std::string_view kName = "skein_session";
constexpr const char* kOperator = "operator";
constexpr const char* kObserver = "observer";

/// Takes as long wherever they differ.
bool is_token(std::string_view token, std::string_view own) {
  if (own.empty()) return false;
  unsigned differ = token.size() == own.size() ? 0U : 1U;
  for (std::size_t i = 0; i < std::min(token.size(), own.size()); ++i) {
    differ |= static_cast<unsigned char>(token[i] ^ own[i]);
  }
  return differ == 0;
}

/// The session that a Cookie field names; empty for none.
std::string_view session_in(std::string_view cookies) {
  while (!cookies.empty()) {
    const auto end = cookies.find(';');
    std::string_view one = cookies.substr(0, end);
    cookies.remove_prefix(end == std::string_view::npos ? cookies.size() : end + 1);
    while (!one.empty() && one.front() == ' ') one.remove_prefix(1);
    if (one.substr(0, kName.size()) != kName) continue;
    one.remove_prefix(kName.size());
    if (!one.empty() && one.front() == '=') return one.substr(1);
  }
  return {};
}

}  // namespace

std::optional<Identity> Gate::identify(std::string_view cookies, Time now) const {
  if (!with_passwords_ && token_.empty()) return Identity{kOperator, Role::op};
  const auto session = sessions_.find(session_in(cookies));
  if (session == sessions_.end() || now >= session->second.until) return std::nullopt;
  return session->second.identity;
}

std::optional<Identity> Gate::check(std::string_view token) const {
  if (is_token(token, token_)) return Identity{kOperator, Role::op};
  if (is_token(token, observer_token_)) return Identity{kObserver, Role::observer};
  return std::nullopt;
}

std::string Gate::admit(const Identity& identity, Time now) {
  std::erase_if(sessions_, [now](const auto& entry) { return now >= entry.second.until; });
  if (sessions_.size() >= kSessionsMax) {
    sessions_.erase(std::min_element(
        sessions_.begin(), sessions_.end(),
        [](const auto& a, const auto& b) { return a.second.until < b.second.until; }));
  }
  std::string id = random_hex(16);
  std::string field = cookie(id, std::chrono::seconds{kSessionLasts}.count());
  sessions_[std::move(id)] = {identity, now + kSessionLasts};
  return field;
}

std::string Gate::dismiss(std::string_view cookies) {
  const auto session = sessions_.find(session_in(cookies));
  if (session != sessions_.end()) sessions_.erase(session);
  return cookie("", 0);
}

void Gate::dismiss_all(std::string_view user) {
  std::erase_if(sessions_,
                [user](const auto& session) { return session.second.identity.user == user; });
}

bool Gate::has_session(std::string_view user) const {
  return std::ranges::any_of(
      sessions_, [user](const auto& session) { return session.second.identity.user == user; });
}

std::string Gate::cookie(std::string_view value, long max_age_s) const {
  return fmt::format("{}={}; HttpOnly; SameSite=Strict; Path=/; Max-Age={}{}", kName, value,
                     max_age_s, secure_ ? "; Secure" : "");
}

bool Gate::is_own_origin(std::string_view origin, std::string_view host) const {
  if (origin.empty()) return true;
  const std::string_view scheme = secure_ ? "https://" : "http://";
  return origin.substr(0, scheme.size()) == scheme && origin.substr(scheme.size()) == host;
}

bool Gate::is_own_host(std::string_view host) const {
  if (with_passwords_) return true;
  const auto colon = host.rfind(':');
  const bool has_port =
      colon != std::string_view::npos && host.find(']', colon) == std::string_view::npos;
  const std::string_view name = host.substr(0, has_port ? colon : std::string_view::npos);
  return name == "localhost" || name == "127.0.0.1" || name == "[::1]";
}

}  // namespace skein::console
