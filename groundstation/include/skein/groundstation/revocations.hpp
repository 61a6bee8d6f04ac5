// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "skein/identity/certificate.hpp"

namespace skein::groundstation {

/// Whom the mission's authority has put out of it (`skein-ground mission revoke`), by the register
/// that it keeps beside the ground station's keys. From any thread.
class Revocations {
 public:
  /// Of a mission without keys: nobody.
  Revocations() = default;
  /// `keys`: the ground station's folder. Who is out already is no news.
  explicit Revocations(const std::filesystem::path& keys);

  /// Reads the register again; one that cannot be read changes nothing.
  void look();
  /// Who came since this was asked last, each once.
  [[nodiscard]] std::vector<identity::Certificate> take_new();
  [[nodiscard]] std::set<VehicleId> vehicles() const;
  /// "revoked: vehicle 3, operator ada"; empty where it is nobody.
  [[nodiscard]] std::string text() const;

 private:
  std::filesystem::path register_;
  mutable std::mutex mutex_;  ///< of what follows
  std::vector<identity::Certificate> out_;
  std::set<identity::Serial> told_;
};

}  // namespace skein::groundstation
