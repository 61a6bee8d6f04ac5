// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/identity/certificate.hpp"
#include "skein/identity/folder_lock.hpp"
#include "skein/identity/key_change.hpp"
#include "skein/identity/membership.hpp"
#include "skein/identity/request.hpp"
#include "skein/seal/keys.hpp"

namespace skein::identity {

inline constexpr int kDaysMax = 366;

/// A mission's authority, on the ground station's machine. Its folder is the ground station's
/// KeyFolder, too, and holds beside that
///   authority.key   what certificates are signed with
///   register        the epoch's key, who was enrolled, who was revoked: what the mission is
///   changes         a KeyChange for each member, for the ground station to send
///   operators       a file for each operator's key
/// The register is written first, and whole; what is made of it is made again where a cut came
/// between. While this lives, no other process has the folder.
class Authority {
 public:
  /// In a folder that is not there yet, or empty; it appears whole or not at all.
  [[nodiscard]] static Result<Authority> create(const std::filesystem::path& folder,
                                                const std::string& name, int days,
                                                std::int64_t now_unix_s,
                                                Durable durable = Durable::yes);
  [[nodiscard]] static Result<Authority> open(
      const std::filesystem::path& folder, std::chrono::milliseconds within = FolderLock::kWithin);

  [[nodiscard]] const Certificate& certificate() const { return certificate_; }
  /// All that it signed, by their serials.
  [[nodiscard]] const std::vector<Certificate>& members() const { return members_; }
  [[nodiscard]] const RevocationList& revoked() const { return revoked_; }
  [[nodiscard]] std::uint8_t epoch() const { return key_of_epoch_.epoch; }
  /// Whom the name or id belongs to, if he was not revoked.
  [[nodiscard]] std::optional<Serial> serial_of(VehicleId vehicle) const;
  [[nodiscard]] std::optional<Serial> serial_of(std::string_view op) const;

  /// An answer for each request, or none for any. Who asks again with the same keys is given the
  /// same certificate, with the present key.
  [[nodiscard]] Result<std::vector<Membership>> enrol(std::span<const Request> requests,
                                                      std::int64_t now_unix_s);
  /// Makes the operator's key, which that password unlocks.
  [[nodiscard]] Result<Certificate> enrol_operator(const std::string& name,
                                                   std::string_view password,
                                                   std::int64_t now_unix_s);
  /// A new epoch, with a key that the revoked one is not given.
  [[nodiscard]] Result<void> revoke(Serial serial);

 private:
  Authority(std::filesystem::path folder, FolderLock lock, Durable durable);
  [[nodiscard]] Result<void> begin(const std::string& name, int days, std::int64_t now_unix_s);
  [[nodiscard]] Result<void> save() const;
  [[nodiscard]] Result<void> publish() const;
  [[nodiscard]] bool is_published() const;
  [[nodiscard]] Result<void> room_for_one(std::int64_t now_unix_s) const;
  [[nodiscard]] Result<Certificate> certify(const Request& request, std::int64_t now_unix_s);
  [[nodiscard]] Certificate signed_by_us(Certificate certificate) const;
  [[nodiscard]] Membership membership_of(const Certificate& member) const;
  [[nodiscard]] std::optional<Certificate> valid(Role role, VehicleId node,
                                                 std::string_view name) const;

  std::filesystem::path folder_;
  FolderLock lock_;
  Durable durable_;
  Secret key_;
  Certificate certificate_;
  seal::EpochKey key_of_epoch_;
  RevocationList revoked_;
  std::vector<Certificate> members_;
};

inline constexpr const char* kChangesFile = "changes";
/// What a member is to be told.
struct MemberChange {
  VehicleId node;
  KeyChange change;
};
/// What Authority keeps in `changes`, a line "NODE SKEIN-CHANGE-1:..." for each: for the ground
/// station's program, which sends it and has no business with the authority's key. It is written
/// last: where it has changed, Identity::open() gives the ground station its own new key.
[[nodiscard]] Result<std::vector<MemberChange>> read_changes(const std::filesystem::path& folder);

}  // namespace skein::identity
