// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/operator_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "skein/identity/operator_key.hpp"
#include "skein/network/approval.hpp"

namespace skein::groundstation {
namespace {

// No words of the prompt, where a password would be seen.
constexpr std::string_view kUnlock = "\x01unlock ";
constexpr std::string_view kLock = "\x01lock";

}  // namespace

Result<OperatorKeys::Unlocked> OperatorKeys::unlocked(const std::string& name,
                                                      std::string_view password, Time until) const {
  if (!are_needed()) return Error{"this mission has no keys: nobody signs"};
  if (!identity::is_name(name)) return Error{"that is no operator's name"};
  const auto locked = identity::read_operator_key(folder_, name);
  if (!locked) return locked.error();
  if (const auto trust = trust_in(locked->certificate); trust != identity::Trust::good) {
    return Error{fmt::format("the key of operator {}: {}", name,
                             why_not(locked->certificate, trust, unix_s_()))};
  }
  auto signer = identity::unlock(*locked, password);
  if (!signer) return signer.error();
  return Unlocked{name, *signer, locked->certificate, until};
}

identity::Trust OperatorKeys::trust_in(const identity::Certificate& certificate) const {
  const std::lock_guard lock{mutex_};
  return verifier_->learn(certificate, unix_s_());
}

bool OperatorKeys::is_revoked(const std::string& name) const {
  if (!are_needed()) return false;
  const auto locked = identity::read_operator_key(folder_, name);
  return locked && trust_in(locked->certificate) == identity::Trust::revoked;
}

void OperatorKeys::learn(const identity::RevocationList& revoked) {
  if (!are_needed()) return;
  const std::lock_guard lock{mutex_};
  static_cast<void>(verifier_->learn(revoked));
  const auto is_out = [&revoked](const Unlocked& key) {
    return revoked.contains(key.certificate.serial);
  };
  std::erase_if(unlocked_, [&is_out](const auto& entry) { return is_out(entry.second); });
  if (machine_ && is_out(*machine_)) machine_.reset();
}

Result<void> OperatorKeys::unlock(const std::string& name, std::string_view password, Time now) {
  auto key = unlocked(name, password, now + kUnlockedFor);
  if (!key) return key.error();
  const std::lock_guard lock{mutex_};
  unlocked_.insert_or_assign(name, *std::move(key));
  return {};
}

void OperatorKeys::lock(const std::string& name) {
  const std::lock_guard lock{mutex_};
  unlocked_.erase(name);
}

Result<void> OperatorKeys::unlock_machine(const std::string& name, std::string_view password) {
  auto key = unlocked(name, password, Time::max());
  if (!key) return key.error();
  const std::lock_guard lock{mutex_};
  machine_ = *std::move(key);
  return {};
}

void OperatorKeys::lock_machine() {
  const std::lock_guard lock{mutex_};
  machine_.reset();
}

std::optional<std::string> OperatorKeys::machine_operator() const {
  const std::lock_guard lock{mutex_};
  return machine_ ? std::optional{machine_->name} : std::nullopt;
}

Result<void> OperatorKeys::approve(mission::Authorisation& authorisation, Time now) const {
  if (!are_needed()) return {};
  const std::lock_guard lock{mutex_};
  const auto own = unlocked_.find(authorisation.decided_by);
  const bool is_own = own != unlocked_.end() && now < own->second.until;
  if (!is_own && !machine_) {
    return Error{
        "no operator's key is unlocked, and vehicles deliver only what one has signed; "
        "'skein-ground unlock --operator NAME' unlocks it here, a login at the console that "
        "operator's ('skein-ground mission operator NAME' makes one)"};
  }
  const Unlocked& key = is_own ? own->second : *machine_;
  return network::approve(authorisation, key.signer, key.certificate);
}

std::string line_of(const Unlock& unlock) {
  return unlock.name.empty() ? std::string{kLock}
                             : fmt::format("{}{} {}", kUnlock, unlock.name, unlock.password);
}

std::optional<Unlock> unlock_in(std::string_view line) {
  if (line == kLock) return Unlock{};
  if (!line.starts_with(kUnlock)) return std::nullopt;
  line.remove_prefix(kUnlock.size());
  const auto blank = std::min(line.find(' '), line.size());
  return Unlock{std::string{line.substr(0, blank)},
                std::string{line.substr(std::min(blank + 1, line.size()))}};
}

}  // namespace skein::groundstation
