// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/domain/remote_id.hpp"

namespace skein::configuration {

/// What the vehicles of a team say of themselves by Remote ID: what all have in common, and the id
/// of each.
struct TeamRemoteId {
  struct Id {
    VehicleId vehicle;
    std::string uas_id;
  };
  RemoteId common;  ///< without an id
  std::vector<Id> ids;

  /// Without an id where it has none.
  [[nodiscard]] RemoteId of(VehicleId vehicle) const {
    RemoteId one = common;
    for (const Id& id : ids) {
      if (id.vehicle == vehicle) one.uas_id = id.uas_id;
    }
    one.required = one.required && one.exists();
    return one;
  }
};

}  // namespace skein::configuration
