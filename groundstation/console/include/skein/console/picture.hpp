// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/console/team_links.hpp"
#include "skein/console/team_wind.hpp"
#include "skein/domain/fence.hpp"
#include "skein/mission/ground_traffic.hpp"
#include "skein/mission/messages.hpp"
#include "skein/mission/shown_state.hpp"

namespace skein::mission {
class GroundAgent;
}

namespace skein::console {

struct PictureParams {
  std::vector<VehicleId> expected = {};        ///< the fleet
  std::vector<Hazard> hazards = {};            ///< known before the mission
  Fence fence = {};                            ///< of the configuration
  double place_tolerance_m = 0.3;              ///< to be in place, in a formation
  Duration silence = std::chrono::seconds{5};  ///< as mission::FleetParams has it
  Duration series_period = std::chrono::seconds{1};
  std::size_t series_max = 600;  ///< samples of a vehicle: ten minutes
  std::size_t spans_max = 1000;  ///< of a vehicle's activities
  std::size_t coalitions_max = 200;
  std::size_t rounds_max = 20;  ///< of a coalition
  std::size_t authorisations_max = 200;
  std::size_t vehicles_max = 1000;  ///< strangers included
  std::size_t sites_max = 1000;
  std::size_t hazards_max = 1000;
  std::size_t proposals_max = 200;
  std::size_t warned_max = 100;  ///< aircraft that vehicles are warned of
};

/// What an operator sees of one vehicle besides its entry in mission::Fleet.
struct VehiclePicture {
  std::optional<mission::PlanReport> plan;
  /// Arrival less sending of its telemetry: what its clock is behind ours, and the link.
  std::deque<std::pair<Instant, Duration>> delays;
  struct Sample {
    Instant time{};
    double x_m = 0.0, y_m = 0.0, z_m = 0.0;
    double groundspeed_mps = 0.0;
    double range_left_m = 0.0;
    Duration delay{};
  };
  std::deque<Sample> series;
  struct Span {
    mission::ShownState state{};
    Instant from{};
    std::optional<SiteId> site;
  };
  std::vector<Span> spans;  ///< each until the next one begins
  std::optional<Instant> heard_at;
  std::optional<Vec2> first_at;  ///< where it was heard first
};

/// One round of a coalition: what was said.
struct RoundPicture {
  std::uint32_t number = 0;
  std::optional<coalition::Announcement> announcement;
  std::vector<coalition::Bid> bids;
  std::map<VehicleId, coalition::Why> declined;
  std::optional<coalition::Award> award;
  std::map<VehicleId, coalition::Confirmation> answers;
  std::optional<coalition::Why> cancelled;
};

enum class CoalitionState : std::uint8_t { announced, awarded, formed, failed, closed, count };
[[nodiscard]] std::string_view to_string(CoalitionState state);

struct CoalitionPicture {
  SiteId site;
  CoalitionState state = CoalitionState::announced;
  coalition::Why why;  ///< it failed
  std::vector<VehicleId> members;
  Instant members_at{};  ///< when its leader said so: what comes later may be older
  std::optional<Instant> lease_until;
  std::deque<RoundPicture> rounds;
};

struct TaskPicture {
  std::optional<VehicleId> vehicle;
  std::optional<Instant> time;
  std::optional<coalition::TaskState> state;  ///< none: nobody has it
  coalition::Round round;                     ///< of the award
  bool held = false;                          ///< its vehicle itself has said since that it has it
  Instant told_at{};                          ///< when anything was heard of it last
};

struct SitePicture {
  std::optional<Site> site;  ///< none while only its number is known
  std::optional<VehicleId> leader;
  bool surveyed = false;
  bool done = false;
  bool withdrawn = false;             ///< by the operator
  bool refused = false;               ///< its deliveries, by the operator: nobody leads it again
  bool taken_back = false;            ///< that, after they had been granted
  std::optional<VehicleId> surveyor;  ///< that was told of it
  std::map<TaskId, TaskPicture> tasks;
  std::optional<mission::MissionEvent> news;  ///< the newest event of the site
  [[nodiscard]] bool over() const { return done || withdrawn || refused; }
};

/// What a detector has seen and the operator has not answered.
struct ProposalPicture {
  mission::event::SiteProposed said;
  Instant at{};
};

struct AuthorisationPicture {
  mission::AuthorisationRequest request;
  Instant asked_at{};
  std::optional<mission::Authorisation> decision;
  bool replaced = false;    ///< by a newer plan of that coalition
  bool taken_back = false;  ///< decided against, after it had been granted
  /// What the ground station itself makes of it (on_decisions); none in a recording.
  struct Standing {
    bool undecided = false;
    bool can_be_taken_back = false;
  };
  std::optional<Standing> standing;
};

struct FormationPicture {
  std::optional<formation::Change> change;
  Instant change_ends{};
  struct Member {
    mission::FormationStatus status;
    Instant heard_at{};
  };
  std::map<VehicleId, Member> members;
  /// The newest flight of each plane that flies along a track.
  struct Flight {
    std::uint32_t number = 0;
    Instant joined{};
  };
  std::map<VehicleId, Flight> flights;
};

/// An aircraft that is not of the team, and whom it has come too near to.
struct TrafficPicture {
  mission::SeenAircraft seen;
  std::map<VehicleId, bool> warned{};  ///< whether that vehicle gives way to it
};

/// Everything that the ground station has heard and said, put together for people: what was said
/// over time, beside the fleet as it is now (mission::Fleet). It decides nothing. Pure and
/// copyable: of a recording, copies taken on the way make every moment quick to reach. `now` never
/// decreases. Every container has a limit: of what passes the oldest gives way, of sites, hazards
/// and vehicles what is new is left out.
class Picture {
 public:
  explicit Picture(PictureParams params);

  /// A message of the mission network, or one that the ground station sent (sender 0).
  void on_message(const mission::Message& message, VehicleId sender, Instant now);
  /// An event, once.
  void on_event(const mission::MissionEvent& event);
  /// What the ground station's own network has counted; none of a recording.
  void on_receptions(std::vector<GroundReception> receptions) {
    receptions_ = std::move(receptions);
  }
  [[nodiscard]] const std::vector<GroundReception>& receptions() const { return receptions_; }
  /// Which requests this ground station lets its operator decide, and which decisions take back.
  void on_decisions(const mission::GroundAgent& agent, Instant now);
  [[nodiscard]] const TeamWind& wind() const { return wind_; }
  /// All aircraft that receivers hear now; in a replay those that vehicles were told of are known.
  void on_traffic(const std::map<std::uint32_t, mission::SeenAircraft>& all);
  [[nodiscard]] const PictureParams& params() const { return params_; }
  [[nodiscard]] const std::map<VehicleId, VehiclePicture>& vehicles() const { return vehicles_; }
  [[nodiscard]] const std::map<SiteId, SitePicture>& sites() const { return sites_; }
  /// In the order in which they were first heard of.
  [[nodiscard]] const std::vector<std::pair<coalition::CoalitionId, CoalitionPicture>>& coalitions()
      const {
    return coalitions_;
  }
  [[nodiscard]] const std::deque<AuthorisationPicture>& authorisations() const {
    return authorisations_;
  }
  [[nodiscard]] const std::map<HazardId, Hazard>& hazards() const { return hazards_; }
  /// That the team is to keep.
  [[nodiscard]] const Fence& fence() const { return fence_; }
  /// The number of the operator's order; 0: it is that of the configuration, or there is none.
  [[nodiscard]] std::uint32_t fence_order() const { return fence_order_; }
  [[nodiscard]] const std::map<std::uint32_t, ProposalPicture>& proposals() const {
    return proposals_;
  }
  [[nodiscard]] const FormationPicture& formation() const { return formation_; }
  /// By their addresses.
  [[nodiscard]] const std::map<std::uint32_t, TrafficPicture>& traffic() const { return traffic_; }

  /// The task that the vehicle was awarded next, and that nobody has taken back.
  [[nodiscard]] std::optional<std::pair<TaskId, TaskPicture>> task_of(VehicleId vehicle) const;
  /// The task that it has by its own word; where an older release does not tell it, the one above.
  [[nodiscard]] std::optional<std::pair<TaskId, TaskPicture>> told_task(
      const mission::Telemetry& told) const;
  /// The least delay of its telemetry lately.
  [[nodiscard]] std::optional<Duration> clock_offset(VehicleId vehicle) const;

 private:
  [[nodiscard]] bool is_known(VehicleId sender) const;
  void on(const mission::Telemetry& telemetry, Instant now);
  void on(const mission::AuthorisationRequest& request, Instant now);
  void on(const mission::Authorisation& decision);
  void on(const mission::SiteReport& m);
  void on(const mission::Traffic& m);
  void show_warned();
  void note_traffic(const mission::MissionEvent& event);
  void on(const coalition::Announcement& m);
  void on(const coalition::Bid& m);
  void on(const coalition::Award& m);
  void on(const coalition::Confirmation& m);
  void on(const coalition::Cancel& m);
  void on(const coalition::LeaseRenewal& m);
  void on(const coalition::MemberStatus& m);
  CoalitionPicture& coalition_of(const coalition::CoalitionId& id);
  RoundPicture& round_of(const coalition::Round& round);
  SitePicture* site_of(SiteId id);  ///< null: one too many
  void note_span(VehiclePicture& vehicle, const mission::Telemetry& telemetry, Instant now) const;
  void note_own_word(const mission::Telemetry& telemetry);
  void note_declined(const mission::Telemetry& telemetry);
  void take_back(const coalition::Round& round, std::optional<VehicleId> only_of);
  void take_back_task(const TaskId& task, VehicleId of);
  void know(const Site& site);

  PictureParams params_;
  Instant heard_at_{};  ///< when the newest message was
  std::map<VehicleId, VehiclePicture> vehicles_;
  std::map<SiteId, SitePicture> sites_;
  std::vector<std::pair<coalition::CoalitionId, CoalitionPicture>> coalitions_;
  std::deque<AuthorisationPicture> authorisations_;
  std::map<HazardId, Hazard> hazards_;
  Fence fence_;
  std::uint32_t fence_order_ = 0;
  std::map<std::uint32_t, ProposalPicture> proposals_;
  FormationPicture formation_;
  std::vector<GroundReception> receptions_;
  TeamWind wind_;
  std::map<std::uint32_t, TrafficPicture> traffic_;
  std::map<std::uint32_t, std::map<VehicleId, bool>> warned_;  ///< of each aircraft
  bool hears_traffic_ = false;
};

}  // namespace skein::console
