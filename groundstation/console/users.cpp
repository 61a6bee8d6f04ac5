// SPDX-License-Identifier: Apache-2.0
#include "skein/console/users.hpp"

#include <fmt/format.h>
#include <nettle/memops.h>
#include <nettle/pbkdf2.h>
#include <sys/random.h>

#include <charconv>
#include <fstream>
#include <iterator>
#include <system_error>
#include <vector>

namespace skein::console {
namespace {

constexpr std::string_view kScheme = "pbkdf2-sha256";
constexpr unsigned kIterations = 200'000;
constexpr unsigned kIterationsMax = 10'000'000;
constexpr std::size_t kKeySize = 32;
constexpr std::size_t kSaltSize = 16;
constexpr auto kNotForOthers =
    std::filesystem::perms::group_write | std::filesystem::perms::others_all;

using Bytes = std::vector<std::uint8_t>;

const std::uint8_t* bytes_of(std::string_view text) {
  return reinterpret_cast<const std::uint8_t*>(text.data());
}

std::string hex_of(const Bytes& bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

Bytes key_of(std::string_view password, std::string_view salt, unsigned iterations) {
  Bytes key(kKeySize);
  pbkdf2_hmac_sha256(password.size(), bytes_of(password), iterations, salt.size(), bytes_of(salt),
                     key.size(), key.data());
  return key;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const auto end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::optional<unsigned> iterations_of(std::string_view text) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  if (value < 1000 || value > kIterationsMax) return std::nullopt;
  return value;
}

bool is_hash(std::string_view hash) {
  const auto parts = split(hash, '$');
  return parts.size() == 4 && parts[0] == kScheme && iterations_of(parts[1]) && !parts[2].empty() &&
         parts[3].size() == 2 * kKeySize;
}

bool matches(std::string_view hash, std::string_view password) {
  const auto parts = split(hash, '$');
  const std::string again =
      hash_password(password, parts[2], iterations_of(parts[1]).value_or(kIterations));
  return again.size() == hash.size() && memeql_sec(again.data(), hash.data(), hash.size()) != 0;
}

}  // namespace

std::string_view to_string(Role role) { return role == Role::op ? "operator" : "observer"; }

std::string random_hex(std::size_t bytes) {
  Bytes random(bytes);
  std::size_t have = 0;
  while (have < bytes) {
    const ssize_t got = ::getrandom(random.data() + have, bytes - have, 0);
    if (got > 0) have += static_cast<std::size_t>(got);
  }
  return hex_of(random);
}

std::string hash_password(std::string_view password, std::string_view salt, unsigned iterations) {
  return fmt::format("{}${}${}${}", kScheme, iterations, salt,
                     hex_of(key_of(password, salt, iterations)));
}

std::string hash_password(std::string_view password) {
  return hash_password(password, random_hex(kSaltSize), kIterations);
}

Result<Users> Users::load(const std::filesystem::path& file) {
  std::ifstream stream{file};
  if (!stream) {
    return Error{"cannot read the password file " + file.string() +
                 "; 'skein-ground password NAME' makes its lines"};
  }
  std::error_code failed;
  const auto mode = std::filesystem::status(file, failed).permissions();
  if (!failed && (mode & kNotForOthers) != std::filesystem::perms::none) {
    return Error{fmt::format(
        "{0}: others may read or write it, too (mode {1:04o}), and guess passwords from it; "
        "chmod 600 {0}, or 640 with the group of the ground station's service",
        file.string(), static_cast<unsigned>(mode))};
  }
  return parse(std::string{std::istreambuf_iterator<char>{stream}, {}}, file.string());
}

Result<Users> Users::parse(std::string_view text, const std::string& name) {
  Users users;
  std::size_t number = 0;
  for (const std::string_view line : split(text, '\n')) {
    ++number;
    if (line.empty() || line.front() == '#') continue;
    const auto parts = split(line, ':');
    const bool known = parts.size() == 3 && (parts[1] == "operator" || parts[1] == "observer");
    if (!known || parts[0].empty() || !is_hash(parts[2])) {
      return Error{fmt::format(
          "{}:{}: not NAME:operator:HASH or NAME:observer:HASH; 'skein-ground password NAME' "
          "makes such a line",
          name, number)};
    }
    const std::string user{parts[0]};
    if (users.users_.contains(user)) users.repeated_.insert(user);
    users.users_[user] = {parts[1] == "operator" ? Role::op : Role::observer,
                          std::string{parts[2]}};
  }
  if (users.users_.empty()) return Error{name + ": names nobody; nobody could log in"};
  return users;
}

std::optional<Role> Users::check(const std::string& name, std::string_view password) const {
  const auto known = users_.find(name);
  if (known == users_.end()) {
    // So that nobody learns from the time it takes which names there are.
    static_cast<void>(hash_password(password, "00", kIterations));
    return std::nullopt;
  }
  if (!matches(known->second.hash, password)) return std::nullopt;
  return known->second.role;
}

}  // namespace skein::console
