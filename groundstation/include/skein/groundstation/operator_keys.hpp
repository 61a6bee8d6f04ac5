// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "skein/base/result.hpp"
#include "skein/identity/certificate.hpp"
#include "skein/identity/signing.hpp"
#include "skein/mission/messages.hpp"

namespace skein::groundstation {

/// The keys with which operators sign what they authorise, as far as a password has unlocked them:
/// by a login at the console, or for this machine's prompt and command line. From any thread.
class OperatorKeys {
 public:
  using Time = std::chrono::steady_clock::time_point;
  /// As long as a session of the console.
  static constexpr auto kUnlockedFor = std::chrono::hours{12};

  using UnixClock = std::function<std::int64_t()>;

  /// Nothing is signed in this mission.
  OperatorKeys() = default;
  /// `folder`: the mission's keys (identity::Authority), `verifier`: what vehicles believe of them.
  OperatorKeys(std::filesystem::path folder, identity::Verifier verifier, UnixClock unix_s)
      : folder_{std::move(folder)}, unix_s_{std::move(unix_s)}, verifier_{std::move(verifier)} {}

  [[nodiscard]] bool are_needed() const { return !folder_.empty(); }
  /// Who is in that list signs nothing more, from now on.
  void learn(const identity::RevocationList& revoked);
  /// Is that operator's key, as it lies there, one that was revoked?
  [[nodiscard]] bool is_revoked(const std::string& name) const;

  /// For what that user of the console decides. Takes some 0.1 s. Fails where there is no such key,
  /// vehicles do not believe it, or the password is another.
  Result<void> unlock(const std::string& name, std::string_view password, Time now);
  void lock(const std::string& name);
  /// The same for all who give orders on this machine, until lock_machine().
  Result<void> unlock_machine(const std::string& name, std::string_view password);
  void lock_machine();
  /// Who that is.
  [[nodiscard]] std::optional<std::string> machine_operator() const;

  /// Fills in its approval: by the key of who has decided (`decided_by`), or else the machine's.
  Result<void> approve(mission::Authorisation& authorisation, Time now) const;

 private:
  struct Unlocked {
    std::string name;
    identity::Signer signer;
    identity::Certificate certificate;
    Time until;
  };
  [[nodiscard]] identity::Trust trust_in(const identity::Certificate& certificate) const;
  Result<Unlocked> unlocked(const std::string& name, std::string_view password, Time until) const;

  const std::filesystem::path folder_;
  const UnixClock unix_s_;
  mutable std::mutex mutex_;  ///< of what follows
  mutable std::optional<identity::Verifier> verifier_;
  std::map<std::string, Unlocked> unlocked_;
  std::optional<Unlocked> machine_;
};

/// What `skein-ground unlock` and `lock` ask of the running ground station, at its control socket.
struct Unlock {
  std::string name;  ///< empty: lock
  std::string password;
};
[[nodiscard]] std::string line_of(const Unlock& unlock);
/// None where the line is something else.
[[nodiscard]] std::optional<Unlock> unlock_in(std::string_view line);

}  // namespace skein::groundstation
