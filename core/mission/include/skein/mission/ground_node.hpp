// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "skein/base/bounded_queue.hpp"
#include "skein/mission/fleet.hpp"
#include "skein/mission/formation_ground.hpp"
#include "skein/mission/ground_agent.hpp"
#include "skein/mission/ground_detections.hpp"
#include "skein/mission/ground_fence.hpp"
#include "skein/mission/ground_hazards.hpp"
#include "skein/mission/ground_landing.hpp"
#include "skein/mission/ground_return.hpp"
#include "skein/mission/ground_routes.hpp"
#include "skein/mission/ground_search.hpp"
#include "skein/mission/ground_sites.hpp"
#include "skein/mission/ground_traffic.hpp"
#include "skein/mission/order_book.hpp"
#include "skein/mission/setup_book.hpp"
#include "skein/mission/track_ground.hpp"

namespace skein::mission {

struct GroundNodeConfig {
  GroundAgentConfig agent;
  FormationGroundConfig formation;
  TrackGroundConfig tracks{};     ///< of planes in formation; without planes it does nothing
  std::vector<Hazard> hazards{};  ///< known before the mission
  Fence fence{};                  ///< of the team, for all that is ordered
  GroundDetectionsConfig detections{};
  GroundSearchConfig searches{};
  GroundReturnConfig returns{};
  SetupParams setup{};
  InstanceId instance{};  ///< of this program
};

/// Everything that the ground station decides and says: its agents and the one picture of the fleet
/// that they, the prompt and the page read. A message that is not its sender's to say is refused
/// and counted, whatever it is. Vehicles that run with another setup are told so, and are neither
/// authorised nor led in formation; those that do not know which orders stand are told them.
/// Calling rules as of VehicleNode.
class GroundNode {
 public:
  GroundNode(const GroundNodeConfig& config, Instant now);

  /// As GroundAgent::recall(); what was not its sender's to say is passed over.
  void recall(const Message& message, VehicleId sender, Instant at);

  /// Another ground station has the command: nothing is decided or said from now on. What the other
  /// says is taken in, so that this one knows what it must when it takes over. Orders to this node
  /// are the caller's to refuse meanwhile.
  void watch(Instant now);
  /// This one has it from now on, as that start of the ground station, which is newer than all that
  /// vehicles have heard. What it cannot know vehicles tell each other first, as after a new start.
  void take_command(InstanceId start, Instant now);
  [[nodiscard]] bool is_watching() const { return watching_; }

  /// False where it is refused.
  bool on_message(const Message& message, VehicleId sender, Instant now);
  void on_timeout(Instant now);
  /// A word to everybody, whoever has been told little lately.
  void speak() { setup_.say_at_once(); }

  /// As GroundAgent::command(). Fails also where those that are to return home are copters that fly
  /// in a formation, and where those that are to land are in one or are not ordered home. Who lands
  /// is told when its turn comes (GroundLanding).
  Result<void> command(VehicleId vehicle, CommandKind kind, Instant now);

  /// The ways home of these, or of all (none), if they were ordered home now. Fails where such an
  /// order would.
  [[nodiscard]] Result<ReturnPreview> preview_return(std::vector<VehicleId> vehicles,
                                                     Instant now) const;

  // As of GroundSites, with the fleet as it is heard.
  Result<SiteId> add_site(Site site, std::optional<VehicleId> surveyor, Instant now) {
    return sites_.add(std::move(site), surveyor, fleet(), now);
  }
  Result<std::vector<TaskId>> withdraw_site(SiteId site, const std::string& by, Instant now);
  Result<SiteId> change_site(SiteId old, Site site, std::optional<VehicleId> surveyor,
                             const std::string& by, Instant now);
  [[nodiscard]] const GroundSites& sites() const { return sites_; }
  /// Takes a proposal as a site, whose number it gives, or dismisses it (0).
  Result<SiteId> answer_proposal(std::uint32_t number, bool accepted, const std::string& by,
                                 Instant now);
  /// As GroundDetections::propose_from_outside().
  bool propose_from_outside(const Detection& seen, Instant now) {
    return detections_.propose_from_outside(seen, sites_, now);
  }
  [[nodiscard]] const GroundDetections& detections() const { return detections_; }
  [[nodiscard]] GroundHazards& hazards() { return hazards_; }
  [[nodiscard]] const GroundHazards& hazards() const { return hazards_; }

  // As of GroundRoutes, with the fleet as it is heard and the hazards that are known.
  [[nodiscard]] Result<void> check_routes(const GroundRoutes::Routes& routes, Instant now) const {
    return routes_.check(routes, hazards_.known(), fleet(), now);
  }
  Result<std::uint32_t> give_routes(const GroundRoutes::Routes& routes, Instant now) {
    return routes_.give(routes, hazards_.known(), fleet(), now);
  }
  Result<void> call_off_routes(Instant now) { return routes_.call_off(now); }
  [[nodiscard]] const GroundRoutes& routes() const { return routes_; }

  /// As GroundFence::order(), with the fleet as it is heard. Formations and routes are looked at
  /// with it from now on.
  Result<std::uint32_t> order_fence(const Fence& fence, Instant now);
  [[nodiscard]] const GroundFence& fence() const { return fence_; }

  // As of GroundSearch, in the same way.
  [[nodiscard]] Result<AreaSearch> preview_search(const SearchWishes& wishes, Instant now) const {
    return searches_.preview(wishes, hazards_.known(), fleet(), routes_, now);
  }
  Result<AreaSearch> give_search(const SearchWishes& wishes, Instant now) {
    return searches_.give(wishes, hazards_.known(), fleet(), routes_, now);
  }
  [[nodiscard]] const GroundSearch& searches() const { return searches_; }

  /// As GroundTraffic::on_aircraft().
  void on_aircraft(SeenAircraft seen, Instant now) {
    traffic_.on_aircraft(std::move(seen), fleet(), now);
  }
  [[nodiscard]] const GroundTraffic& traffic() const { return traffic_; }

  /// Tells all of what was decided around the node: where the script of the formation stands.
  void say(MissionEvent event);

  /// To be sent: all that the ground station says.
  [[nodiscard]] std::optional<Message> poll_message();
  /// To recorder, log and page: its own and those of vehicles, once each.
  [[nodiscard]] std::optional<MissionEvent> poll_event();
  [[nodiscard]] Instant next_timeout() const;

  /// Whom the operator decides with.
  [[nodiscard]] GroundAgent& agent() { return agent_; }
  [[nodiscard]] const GroundAgent& agent() const { return agent_; }
  [[nodiscard]] FormationGround& formation() { return formation_; }
  [[nodiscard]] const FormationGround& formation() const { return formation_; }

  [[nodiscard]] TrackGround& tracks() { return tracks_; }
  [[nodiscard]] const TrackGround& tracks() const { return tracks_; }

  [[nodiscard]] const Fleet& fleet() const { return agent_.fleet(); }
  /// As of Fleet: by the mission's authority, whom no message asks.
  void set_revoked(const std::set<VehicleId>& revoked) { agent_.fleet().set_revoked(revoked); }
  [[nodiscard]] std::uint64_t refused() const { return refused_; }
  /// What queues had no room for.
  [[nodiscard]] std::uint64_t dropped() const {
    return messages_.dropped() + events_.dropped() + agent_.dropped() + formation_.dropped() +
           tracks_.dropped() + sites_.dropped() + hazards_.dropped() + routes_.dropped() +
           detections_.dropped() + fence_.dropped() + returns_.dropped() + landings_.dropped();
  }

  /// Why an order of that kind to all leaves that vehicle out.
  [[nodiscard]] std::optional<std::string> why_not_told(VehicleId vehicle, CommandKind kind) const;

 private:
  void take_events();
  void use_fence();
  void take_in(const Message& message, VehicleId sender, Instant at);
  void drop_words();
  [[nodiscard]] std::optional<Message> next_message();
  void note_refusal(const Authorisation& decision, Instant now);
  void on_setup(const Setup& setup, Instant now);
  [[nodiscard]] bool knows_orders() const;
  void order_again(const Setup& setup, const Command& standing, Instant now);
  void take_differences(VehicleId vehicle, Instant now);
  [[nodiscard]] bool stays_in_formation(VehicleId vehicle) const;
  [[nodiscard]] std::optional<std::string> why_not_return(VehicleId vehicle) const;
  Result<void> land(VehicleId vehicle, Instant now);
  [[nodiscard]] std::optional<std::string> why_not_land(VehicleId vehicle) const;
  [[nodiscard]] std::vector<VehicleId> concerned(VehicleId vehicle) const;

  GroundAgent agent_;
  FormationGround formation_;
  TrackGround tracks_;
  SetupBook setup_;
  InstanceId start_;  ///< that it speaks as
  OrderBook orders_;
  Instant knows_orders_at_;  ///< from then on it says of who has none that it has none
  GroundSites sites_;
  GroundHazards hazards_;
  GroundFence fence_;
  GroundRoutes routes_;
  GroundSearch searches_;
  GroundDetections detections_;
  GroundReturn returns_;
  GroundLanding landings_;
  GroundTraffic traffic_;
  std::uint64_t refused_ = 0;
  bool watching_ = false;
  /// The first order of this ground station since it took the command from another; none: it never
  /// did.
  std::optional<std::uint64_t> reign_from_;
  std::map<VehicleId, std::uint64_t> told_;          ///< the newest order to each, and to all
  std::map<VehicleId, std::uint64_t> orders_heard_;  ///< the newest that each has heard
  BoundedQueue<Message> messages_{64};               ///< the node's own
  BoundedQueue<MissionEvent> events_{64};
};

}  // namespace skein::mission
