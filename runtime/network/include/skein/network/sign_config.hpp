// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/identity/certificate.hpp"
#include "skein/identity/signing.hpp"

namespace skein::network {

/// With which a node signs its decisions (mission::is_signed()), and by which it judges those of
/// others. Its instance must grow with each start (identity::instance_of()).
struct SignConfig {
  identity::Signer signer;
  identity::Certificate own;    ///< told to all who discover this node
  identity::Verifier verifier;  ///< knows the authority and who was revoked
};

}  // namespace skein::network
