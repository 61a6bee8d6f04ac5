// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <set>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/idl/domain.hpp"

namespace skein {

/// A hazard, and from when on the team knows of it: from before the mission at the epoch.
struct TimedHazard {
  Hazard hazard;
  Instant known_from{};

  [[nodiscard]] bool known_before() const { return known_from <= Instant{}; }
};

/// Those that are known at `now`; at the epoch: those known before the mission.
[[nodiscard]] inline std::vector<Hazard> hazards_known_at(const std::vector<TimedHazard>& all,
                                                          Instant now) {
  std::vector<Hazard> known;
  for (const TimedHazard& one : all) {
    if (one.known_from <= now) known.push_back(one.hazard);
  }
  return known;
}

/// The hazards that a node knows. One does not change, and what was withdrawn does not come back.
class KnownHazards {
 public:
  KnownHazards() = default;
  explicit KnownHazards(std::vector<Hazard> known) : all_{std::move(known)} {}

  /// False, and nothing added, where one of that id is known, or was.
  bool add(const Hazard& hazard) {
    if (withdrawn_.contains(hazard.id) || knows(hazard.id)) return false;
    all_.push_back(hazard);
    return true;
  }
  /// False where that is known already, or nothing was known of it.
  bool withdraw(HazardId id) {
    withdrawn_.insert(id);
    return std::erase_if(all_, [id](const Hazard& h) { return h.id == id; }) > 0;
  }
  [[nodiscard]] bool knows(HazardId id) const {
    return std::ranges::any_of(all_, [id](const Hazard& h) { return h.id == id; });
  }
  [[nodiscard]] const std::vector<Hazard>& all() const { return all_; }

 private:
  std::vector<Hazard> all_;
  std::set<HazardId> withdrawn_;
};

}  // namespace skein
