// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "skein/console/picture.hpp"
#include "skein/console/sections.hpp"
#include "skein/hil/team_mission.hpp"
#include "skein/hil/team_simulator.hpp"

/// What the operator is shown, held against what the vehicles themselves are about, at every moment
/// of a whole mission: it may be as old as the newest word that the ground station has heard, and
/// never wrong.
namespace skein::hil {

/// What telemetry, and what reliable messages, may take where they are heard.
struct Lateness {
  Duration telemetry = std::chrono::milliseconds{500};
  Duration word = std::chrono::milliseconds{1500};
  Duration every = std::chrono::milliseconds{40};  ///< between two looks
};

class PictureWatch {
 public:
  explicit PictureWatch(const TeamMission& team, Lateness late = {});
  PictureWatch(const PictureWatch&) = delete;
  PictureWatch& operator=(const PictureWatch&) = delete;
  ~PictureWatch();

  /// Refers to this watch.
  [[nodiscard]] TeamObserver observer();

  /// What was shown and not so: a line each, of each kind the first.
  [[nodiscard]] const std::vector<std::string>& differences() const { return differences_; }

  /// States that were shown, of any vehicle.
  std::set<std::string> seen;
  std::map<std::uint16_t, std::set<std::string>> seen_of;
  /// When a task of a vehicle was shown last.
  std::optional<Instant> task_shown;
  std::optional<Instant> refused_at;
  std::vector<mission::MissionEvent> events;
  int cards = 0;   ///< that waited, at some moment
  int marked = 0;  ///< deliveries in them
  std::set<std::string> reasons;
  std::map<std::uint16_t, std::set<std::string>> did_not_bid;
  /// Things that were held against each other, by kind: none proves nothing.
  std::map<std::string, std::size_t> judged;

 private:
  void remember(const std::vector<OwnWord>& words, Instant now);
  void note(const mission::MissionEvent& event);
  void note_said(const mission::Message& message);
  void note_heard(const mission::Message& message, VehicleId sender, Instant now);
  void look(Instant now, const mission::GroundNode& node);
  void judge_vehicles(Instant now, const mission::GroundNode& node);
  void judge_facts(VehicleId id, const std::string& state, Instant now);
  void judge_sites(Instant now, const mission::GroundNode& node);
  void judge_coalitions(Instant now, const mission::GroundNode& node);
  void judge_cards(Instant now, const mission::GroundNode& node);
  void judge_hazards(Instant now, const mission::GroundNode& node);
  [[nodiscard]] std::string section(console::Section which, const mission::GroundNode& node,
                                    Instant now) const;
  /// Wrong at once, or where it is not so any more only after that long.
  void expect(bool so, const std::string& kind, const std::string& what, Instant now,
              Duration for_long = {});

  /// From one moment on, by its own clock, until the next.
  struct Moment {
    Instant from{};
    std::string state;
    std::string task;
  };
  /// What one vehicle is about, by its own word, whether it is heard or not.
  struct Own {
    std::deque<Moment> lately;
    std::optional<Instant> ended;       ///< its program, in true time
    Duration clock{};                   ///< ahead of the true time
    std::optional<Instant> heard_sent;  ///< the newest telemetry that was heard, by its own clock
    std::optional<InstanceId> heard_instance;
    std::optional<Instant> heard_at;  ///< any telemetry, in true time
    [[nodiscard]] const Moment* now() const { return lately.empty() ? nullptr : &lately.back(); }
  };
  template <class Has>
  [[nodiscard]] bool lately(const Own& own, Has has) const;
  [[nodiscard]] bool is_fresh(const Own& own, Instant now) const;
  [[nodiscard]] bool is_silent(const Own& own, Instant now) const;

  /// What events, which are told in true time, say of a vehicle besides.
  struct Facts {
    std::optional<mission::CommandKind> order = {};  ///< the newest that it obeys
    bool range_spent = false;
    bool authorised = false;  ///< its newest delivery
    Instant changed_at{};
  };
  /// What leaders have said of their coalitions, and what of it was heard.
  struct Said {
    Instant at{};  ///< by its leader's clock
    std::vector<VehicleId> members;
  };
  struct Coalition {
    std::deque<Said> said;
    std::optional<Instant> heard;  ///< the newest of these
    bool closed = false;
    bool cancelled = false;
    bool formed = false;
  };

  Lateness late_;
  Duration ground_clock_;
  MissionOrigin origin_;
  console::Picture picture_;
  std::map<VehicleId, Own> own_;
  std::map<VehicleId, Facts> facts_;
  std::set<VehicleId> used_twice_;  ///< numbers: what is shown is of one or the other
  std::map<coalition::CoalitionId, Coalition> coalitions_;
  std::set<SiteId> surveyed_;
  std::set<SiteId> done_;
  std::map<std::pair<std::string, std::string>, Instant> wrong_since_;
  std::set<std::pair<std::string, std::string>> looked_;  ///< in this look
  std::set<std::string> told_;
  std::vector<std::string> differences_;
};

}  // namespace skein::hil
