// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "skein/base/bounded_queue.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/mission/fleet.hpp"
#include "skein/mission/messages.hpp"

namespace skein::mission {

/// Whoever does that can be told of a site: nobody holds it, and it is not about to land.
[[nodiscard]] constexpr bool can_be_told_of_sites(Activity does) {
  return does != Activity::holding && does != Activity::forming && does != Activity::landing &&
         does != Activity::landed;
}

/// How far a site has come, as far as the ground station has heard.
enum class SiteState : std::uint8_t {
  waits,     ///< of the operator: nobody can survey it now
  told,      ///< its surveyor has not said yet that it takes it up
  taken_up,  ///< to be surveyed
  led,
  over,  ///< done, or refused
  withdrawn,
  count
};

/// One site that is known here, whoever found it.
struct GroundSite {
  Site site;            ///< its number alone, where nothing else was heard of it
  bool placed = false;  ///< its position is known
  bool of_operator = false;
  SiteState state = SiteState::waits;
  std::optional<VehicleId> wanted;     ///< by the operator, as its surveyor
  std::optional<VehicleId> surveyor;   ///< that is told, or has taken it up
  std::optional<InstanceId> instance;  ///< of the surveyor's program
  std::set<VehicleId> tried;           ///< that did not take it up, or cannot fly there
  Instant told_at{};                   ///< to the surveyor for the first time
  Instant said_at{};                   ///< the newest time that it was said
  Instant led_at{};                    ///< when somebody was last heard who leads it
  Instant next{};                      ///< when it is looked after next
  std::set<std::uint8_t> begun;        ///< its deliveries
  std::set<std::uint8_t> delivered;
  bool granted = false;  ///< some delivery, by the operator
};

/// The sites that the operator tells the team of, takes back and changes. A new one is told to one
/// vehicle, which surveys it like one of its own sensor's: the nearest that is heard, can survey,
/// has the range for the way there and is not held; first who has nothing else to do. It is told
/// until it says that it takes the site up. Where it does not, cannot, or falls silent or starts
/// anew before anybody leads the site, another one is told. What is withdrawn is told to all, now
/// and then for the rest of the mission. Calling rules as of GroundAgent.
class GroundSites {
 public:
  static constexpr std::size_t kSitesMax = 200;  ///< of the operator, in a mission

  void recall(const Message& message, VehicleId sender, Instant at);
  void on_message(const Message& message, Instant now);
  void on_timeout(const Fleet& fleet, Instant now);
  /// The operator's grant for that site has been said.
  void on_granted(SiteId site);
  /// The operator's refusal has been said. It is final: from now on the site is told as withdrawn,
  /// to who has not heard it, takes over from its leader or starts anew.
  void on_refused(SiteId site, Instant now);

  /// A new site; its number is given here (new_number()). `surveyor`: by the operator's wish. Fails
  /// where that vehicle cannot survey, and after kSitesMax.
  Result<SiteId> add(Site site, std::optional<VehicleId> surveyor, const Fleet& fleet, Instant now);
  /// Gives the deliveries that have begun: they are flown to their end. Fails where nothing is
  /// known of it, or nothing is left to be withdrawn.
  Result<std::vector<TaskId>> withdraw(SiteId site, const std::string& by, Instant now);
  /// Another site in place of that one, which is withdrawn: its number is new, so that nobody can
  /// mix the two up. Fails once one of its deliveries is authorised: that may be begun, and would
  /// be flown twice.
  Result<SiteId> change(SiteId old, Site site, std::optional<VehicleId> surveyor,
                        const Fleet& fleet, const std::string& by, Instant now);

  /// The nearest site within that distance that is not over and not withdrawn.
  [[nodiscard]] const GroundSite* open_near(const Vec2& place, double radius_m) const;
  [[nodiscard]] const std::map<SiteId, GroundSite>& sites() const { return sites_; }
  [[nodiscard]] bool is_withdrawn(SiteId site) const;
  /// Who would be told of a site there now.
  [[nodiscard]] std::optional<VehicleId> nearest_surveyor(const Vec2& place,
                                                          const Fleet& fleet) const;

  [[nodiscard]] std::optional<Message> poll_message() { return messages_.pop(); }
  [[nodiscard]] std::optional<MissionEvent> poll_event() { return events_.pop(); }
  [[nodiscard]] Instant next_timeout() const { return next_; }
  [[nodiscard]] std::uint64_t dropped() const { return messages_.dropped() + events_.dropped(); }

 private:
  GroundSite* find(SiteId site);
  GroundSite* know(SiteId site);
  void know(const Site& site);
  void lead(SiteId site, Instant now);
  void on_event(const MissionEvent& event, Instant now);
  void on_coalition(const coalition::Message& message, Instant now);
  void care_for(GroundSite& entry, const Fleet& fleet, Instant now);
  [[nodiscard]] std::optional<VehicleId> choose(const GroundSite& entry, const Fleet& fleet) const;
  [[nodiscard]] bool is_busy(VehicleId vehicle, const FleetEntry& known, SiteId with) const;
  void tell(GroundSite& entry, VehicleId surveyor, InstanceId instance, Instant now);
  void say(GroundSite& entry, Instant now);
  void report(EventBody body, SiteId site, Instant now);

  std::map<SiteId, GroundSite> sites_;
  std::set<SiteId> taken_;
  std::size_t of_operator_ = 0;
  Instant next_ = Instant::max();
  BoundedQueue<Message> messages_{256};
  BoundedQueue<MissionEvent> events_{256};
};

[[nodiscard]] std::string_view to_string(SiteState state);

}  // namespace skein::mission
