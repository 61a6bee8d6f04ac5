// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "skein/base/result.hpp"
#include "skein/identity/certificate.hpp"
#include "skein/identity/signing.hpp"
#include "skein/mission/messages.hpp"

namespace skein::network {

/// What an operator signs of a grant: the digest of its bytes without round and approval, so that
/// site, deliveries (vehicle, time, bearing), times and names are bound, whatever round has them.
/// None where it is no grant of anything, or is out of its limits.
[[nodiscard]] std::optional<identity::Approval> approval_of(
    const mission::Authorisation& authorisation);

/// Signs it: Authorisation::approval becomes the certificate's bytes (identity::to_bytes), then the
/// signature. Fails where there is nothing to sign.
[[nodiscard]] Result<void> approve(mission::Authorisation& authorisation,
                                   const identity::Signer& op,
                                   const identity::Certificate& certificate);

struct CarriedApproval {
  identity::Certificate by;
  identity::Signature signature{};
};
/// What an authorisation carries; none where it cannot be read.
[[nodiscard]] std::optional<CarriedApproval> carried_approval(
    const mission::Authorisation& authorisation);

}  // namespace skein::network
