// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "skein/coalition/messages.hpp"

namespace skein::mission {

/// What a vehicle has heard of the sites that others lead, so that a site whose leader is lost is
/// not forgotten: whoever is free flies there, and leads it if it is still silent there.
class SiteBook {
 public:
  /// An announcement or an award, and when its leader made it: the ground station repeats old ones.
  void on_leader(const Site& site, Instant said_at);
  void on_renewal(const coalition::LeaseRenewal& message, Instant now);
  void on_status(const coalition::MemberStatus& message);
  /// The site needs nobody any more: it is done, or the operator wants it no more.
  void close(SiteId site);
  /// As if it had been closed and had made room: also where nothing is known of it.
  void forget(SiteId site);

  struct Entry {
    Site site;
    std::vector<TaskId> over;  ///< done, or never to be flown again because they may have been
    Instant heard_at{};        ///< its leader
    bool closed = false;
  };
  /// The sites that are not closed and whose leader has not been heard of since `before`.
  [[nodiscard]] std::vector<const Entry*> lost(Instant before) const;
  /// That site, on the same conditions.
  [[nodiscard]] const Entry* lost(SiteId site, Instant before) const;
  [[nodiscard]] std::vector<TaskId> over(SiteId site) const;
  /// Somebody leads it, and was heard of since `since`, or it is closed.
  [[nodiscard]] bool led(SiteId site, Instant since) const;

 private:
  static void note_over(Entry& entry, const TaskId& task);
  std::map<SiteId, Entry> entries_;
  std::set<SiteId> closed_;  ///< that made room for others
};

}  // namespace skein::mission
