// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/revocations.hpp"

#include <utility>

#include "skein/identity/register.hpp"

namespace skein::groundstation {

Revocations::Revocations(const std::filesystem::path& keys)
    : register_{identity::register_file(keys)} {
  look();
  for (const identity::Certificate& one : out_) told_.insert(one.serial);
}

void Revocations::look() {
  if (register_.empty()) return;
  const auto mission = identity::read_register(register_);
  if (!mission) return;
  auto out = identity::who_is_out(*mission);
  const std::lock_guard lock{mutex_};
  out_ = std::move(out);
}

std::vector<identity::Certificate> Revocations::take_new() {
  const std::lock_guard lock{mutex_};
  std::vector<identity::Certificate> fresh;
  for (const identity::Certificate& one : out_) {
    if (told_.insert(one.serial).second) fresh.push_back(one);
  }
  return fresh;
}

std::set<VehicleId> Revocations::vehicles() const {
  const std::lock_guard lock{mutex_};
  std::set<VehicleId> all;
  for (const identity::Certificate& one : out_) {
    if (one.role == identity::Role::vehicle) all.insert(one.node);
  }
  return all;
}

std::string Revocations::text() const {
  const std::lock_guard lock{mutex_};
  std::string all;
  for (const identity::Certificate& one : out_) {
    all += (all.empty() ? "revoked: " : ", ") + holder_of(one);
  }
  return all.empty() ? all : all + "\n";
}

}  // namespace skein::groundstation
