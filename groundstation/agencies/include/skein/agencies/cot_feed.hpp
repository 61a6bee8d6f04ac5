// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "skein/agencies/cot_event.hpp"
#include "skein/agencies/shown.hpp"
#include "skein/base/time.hpp"

namespace skein::agencies {

/// Makes Cursor on Target events of what is shown, when they are due: of a vehicle with a newer
/// state kVehiclePeriod apart and no later than it came, of all else when it changes, kChangePeriod
/// after its last event, and before its last event is stale. What is not shown any more is ended,
/// said kEndings times since a datagram may be lost. UIDs are those of the team, and of sites,
/// hazards also of the mission: the same after a new start. Pure; `now` never decreases.
class CotFeed {
 public:
  static constexpr Duration kVehiclePeriod = std::chrono::milliseconds{700};
  static constexpr Duration kVehicleStale = std::chrono::seconds{10};
  static constexpr Duration kOtherPeriod = std::chrono::seconds{20};
  static constexpr Duration kOtherStale = std::chrono::seconds{60};
  static constexpr Duration kChangePeriod = std::chrono::seconds{1};  ///< of one object
  static constexpr int kEndings = 3;

  /// `epoch_unix_ns`: mission time 0, which tells this mission from others.
  CotFeed(std::string team, std::int64_t epoch_unix_ns);

  /// The events that are due. `unix_ns` is `now` by the clock that others have.
  [[nodiscard]] std::vector<CotEvent> update(const Shown& shown, Instant now, std::int64_t unix_ns);

  /// Begins the UIDs of all that this team says.
  [[nodiscard]] const std::string& uid_prefix() const { return prefix_; }

 private:
  struct Said {
    CotEvent event;
    Instant at{};
    Instant measured{};  ///< of a vehicle: its newest state, said or not
    int endings = 0;
    bool shown = false;  ///< in this update
  };

  [[nodiscard]] CotEvent event_of(const ShownVehicle& vehicle, Instant now,
                                  std::int64_t unix_ns) const;
  [[nodiscard]] CotEvent event_of(const ShownSite& site, std::int64_t unix_ns) const;
  [[nodiscard]] CotEvent event_of(const ShownHazard& hazard, std::int64_t unix_ns) const;
  [[nodiscard]] CotEvent event_of(const ShownTrack& track, std::int64_t unix_ns) const;
  [[nodiscard]] std::string uid_of(const char* what, std::uint32_t number, bool of_mission) const;
  /// What was said of it before; and whether it is new, or was ended, and is to be said at once.
  std::pair<Said&, bool> shown_again(const std::string& uid);
  void take_vehicle(CotEvent event, Instant measured, Instant now, std::vector<CotEvent>& due);
  void take_other(CotEvent event, Instant now, std::vector<CotEvent>& due);
  void end_others(Instant now, std::int64_t unix_ns, std::vector<CotEvent>& due);
  void say(Said& said, CotEvent event, Instant now, std::vector<CotEvent>& due) const;

  std::string team_;
  std::string prefix_;
  std::int64_t mission_;              ///< its number in UIDs
  std::map<std::string, Said> said_;  ///< by UID
};

}  // namespace skein::agencies
