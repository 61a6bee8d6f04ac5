// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/identity/certificate.hpp"
#include "skein/identity/signing.hpp"

/// What makes audit.jsonl evidence: each line has the SHA-256 of the line before it ("prev"), and
/// at the end of each run the ground station signs. What a signature follows cannot be changed,
/// left out or added to without its key. What none follows can be written anew by who can write the
/// file; and who cuts it off behind an earlier signature leaves a shorter log that is good.
namespace skein::groundstation {

/// In place of the line before the first, in hexadecimal as all of them.
inline const std::string kNoLineBefore(64, '0');
/// Of a line without its end.
[[nodiscard]] std::string hash_of_line(std::string_view line);

/// With which the ground station signs its audit.
struct AuditKey {
  identity::Signer signer;
  identity::Certificate own;
  InstanceId instance;
};

/// The line that ends a run: all before it is what that process wrote, or found. Ed25519 over a
/// statement of topic "audit of the ground station", whose sequence is `seq` and whose body is the
/// hash `prev` (32 bytes) and the time in seconds since 1970 (8, big endian).
[[nodiscard]] std::string seal_line(const AuditKey& key, std::uint64_t seq, const std::string& prev,
                                    Instant now, std::int64_t unix_s);

struct AuditFindings {
  std::size_t entries = 0;
  std::size_t signatures = 0;
  std::size_t good_signatures = 0;  ///< of them, checked and good
  std::size_t after_signature =
      0;  ///< entries that no signature follows, good where they are checked
  std::vector<std::string> remarks;  ///< that break nothing
  std::vector<std::string> faults;   ///< what somebody has changed, by line
  [[nodiscard]] bool good() const { return faults.empty(); }
};
/// Looks at all lines of a file. `authority`: of the mission, already checked; none: signatures are
/// counted, not checked.
[[nodiscard]] AuditFindings verify_audit(std::string_view text,
                                         const identity::Certificate* authority);

}  // namespace skein::groundstation
