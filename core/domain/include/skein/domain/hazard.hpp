// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "skein/idl/domain.hpp"

namespace skein {

/// False, and nothing added, where one of that id is known: a hazard does not change.
inline bool add_if_new(std::vector<Hazard>& known, const Hazard& hazard) {
  const auto same = [&](const Hazard& h) { return h.id == hazard.id; };
  if (std::any_of(known.begin(), known.end(), same)) return false;
  known.push_back(hazard);
  return true;
}

}  // namespace skein
