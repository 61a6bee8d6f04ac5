// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "ownship.hpp"
#include "skein/coalition/messages.hpp"

namespace skein::mission {

/// Where a vehicle at `here` orbits to be within `reach_m` of a place: the nearest point that is;
/// none where it can stay.
[[nodiscard]] std::optional<Vec2> relay_place(const Vec2& here, const Vec2& place, double reach_m);

/// Who has nothing else to do stays where a leader that lacks vehicles reaches it, and passes on
/// what the leader and others say, until the coalition stands: so those who fly by become enough.
/// It goes by what leaders say, and bids from there as from anywhere.
class RelayOrbit {
 public:
  explicit RelayOrbit(Ownship& ownship) : ownship_{ownship} {}

  /// Of leaders, whatever this vehicle does.
  void on_message(const coalition::Message& message, Instant now);
  /// Nobody is wanted at that site any more.
  void close(SiteId site);
  /// For a vehicle that has nothing else to do. False where nobody lacks it.
  [[nodiscard]] bool fly(Instant now);
  /// When that does something next.
  [[nodiscard]] Instant flies_at() const;

 private:
  /// A site whose leader lacks vehicles.
  struct Call {
    coalition::Announcement said;           ///< the newest
    bool failed = false;                    ///< an attempt has come to nothing
    std::optional<coalition::Round> award;  ///< that may stand
    Instant heard_at{};
  };
  void on_announcement(const coalition::Announcement& message, Instant now);
  void on_cancel(const coalition::Cancel& message);
  /// A coalition that has come to nothing waits for vehicles.
  [[nodiscard]] bool wanted() const;
  [[nodiscard]] bool has_range(Instant now) const;

  Ownship& ownship_;
  std::optional<Call> call_;
};

}  // namespace skein::mission
