// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mission/fleet.hpp"
#include "skein/mission/ground_routes.hpp"
#include "skein/mission/messages.hpp"
#include "skein/mission/onboard_agent.hpp"
#include "skein/planning/area_search.hpp"

namespace skein::mission {

/// What the operator asks of a search. Mission frame.
struct SearchWishes {
  std::vector<Vec2> corners;        ///< of the area; none: what is left of the last one
  std::vector<VehicleId> vehicles;  ///< none: all that can
  std::optional<double> spacing_m;  ///< of lanes; none: kSearchSpacing sensor radii
  std::optional<double> in_s;       ///< from now on; none: as soon as all can be told
};

/// A tenth of what two neighbours see is seen twice.
inline constexpr double kSearchSpacing = 1.8;

/// One vehicle's share of an area.
struct SearchShare {
  enum class State : std::uint8_t { waits, flies, done, left, count };

  std::vector<planning::Lane> lanes;  ///< not flown yet, in their order
  std::size_t given = 0;              ///< of them those of the route that it has; the first
  std::size_t all = 0;                ///< that it was to fly
  State state = State::waits;
  std::string why;         ///< it has left
  bool has_found = false;  ///< that is: a site, which it surveys
  Instant left_at{};
  double length_m = 0.0;  ///< of its whole way, as planned
  double time_s = 0.0;
  TimedPath route;  ///< that it is given, or would be
  struct RouteLane {
    double ends_m = 0.0;  ///< along the route
    double length_m = 0.0;
  };
  std::vector<RouteLane> route_lanes = {};  ///< in their order
};
[[nodiscard]] std::string_view to_string(SearchShare::State state);

/// An area, and who searches it.
struct AreaSearch {
  enum class State : std::uint8_t { previewed, flown, over, called_off, count };

  std::vector<Vec2> corners;
  double sensor_radius_m = 0.0;  ///< the least of all
  double spacing_m = 0.0;
  std::vector<planning::Lane> lanes;  ///< of the whole area
  std::map<VehicleId, SearchShare> shares;
  std::map<VehicleId, std::string> without;  ///< who takes no part, and why
  double planned = 0.0;  ///< share of the area that is covered when all is flown
  double bound_s = 0.0;  ///< planning::area_bound_s()
  Instant begins{};
  Instant ends{};         ///< as planned
  std::size_t parts = 0;  ///< routes that follow each other, since one has few pieces
  State state = State::previewed;
  std::string why;           ///< it is called off
  bool by_operator = false;  ///< and that by him
  Instant called_off_at{};
  std::uint32_t plan = 0;       ///< of the routes that are given
  std::vector<Hazard> hazards;  ///< that it was planned with
};
[[nodiscard]] std::string_view to_string(AreaSearch::State state);

/// How far one vehicle is with its share, by its route.
struct ShareProgress {
  std::size_t lanes_left = 0;
  double left_m = 0.0;  ///< of lanes
  std::optional<Instant>
      ends;  ///< when it has flown all of it, as far as is known; none: it does not
};
[[nodiscard]] ShareProgress progress_of(const AreaSearch& area, const SearchShare& share,
                                        Instant now);
/// When all shares that are flown will be; none where nobody flies.
[[nodiscard]] std::optional<Instant> expected_end(const AreaSearch& area, Instant now);

struct GroundSearchConfig {
  std::vector<VehicleSpec> vehicles;  ///< what each can do
  planning::AvoidanceParams avoidance{.margin_m = kHazardMargin_m};
};

/// Shares a search area out among vehicles, and gives each its way over the air as routes
/// (GroundRoutes): as many after each other as its way has pieces. What was seen is what vehicles
/// were over by their telemetry. Each flies for itself: who leaves its route, refuses it or is not
/// heard leaves its share, and the others fly on. Who detects a site while it flies its route is
/// released from it, to survey the site; what is left is shared out when the operator asks.
/// Not recalled: who starts this program anew draws the area again. Calling rules as of
/// GroundAgent.
class GroundSearch {
 public:
  explicit GroundSearch(GroundSearchConfig config);

  /// What would be given. Fails where nobody can, the outline is none, and there is nothing left.
  [[nodiscard]] Result<AreaSearch> preview(const SearchWishes& wishes,
                                           const std::vector<Hazard>& hazards, const Fleet& fleet,
                                           const GroundRoutes& routes, Instant now) const;
  /// The same, and gives the routes. Fails as that and as GroundRoutes::give().
  Result<AreaSearch> give(const SearchWishes& wishes, const std::vector<Hazard>& hazards,
                          const Fleet& fleet, GroundRoutes& routes, Instant now);

  void on_message(const Message& message, Instant now);
  void on_timeout(const std::vector<Hazard>& hazards, const Fleet& fleet, GroundRoutes& routes,
                  Instant now);

  /// The newest; none before the first.
  [[nodiscard]] const std::optional<AreaSearch>& area() const { return area_; }
  /// Share of the area that was seen.
  [[nodiscard]] double seen() const { return cells_ ? cells_->share() : 0.0; }
  /// Is there something left that nobody flies?
  [[nodiscard]] bool leaves_rest() const { return rest_; }
  /// Who flies a share now, or is to: ascending.
  [[nodiscard]] std::vector<VehicleId> searching() const;
  /// Those of them whose way from now on enters one of these hazards: they leave it.
  [[nodiscard]] std::vector<VehicleId> barred_by(const std::vector<Hazard>& hazards,
                                                 Instant now) const;

 private:
  struct Known {
    Vec2 home{0.0, 0.0};  ///< where it was heard first
    Vec2 at{0.0, 0.0};
    Instant heard_at{};
  };
  [[nodiscard]] std::optional<std::string> why_not(VehicleId id, const Fleet& fleet,
                                                   bool asked) const;
  [[nodiscard]] planning::Searcher searcher(VehicleId id, const Telemetry& telemetry) const;
  [[nodiscard]] Result<planning::AreaProblem> problem_of(AreaSearch& area,
                                                         const SearchWishes& wishes,
                                                         const Fleet& fleet,
                                                         const Fence& fence) const;
  /// The next routes of who has lanes left; the vehicles that have none to fly leave.
  [[nodiscard]] GroundRoutes::Routes next_part(AreaSearch& area, const Fleet& fleet,
                                               const Fence& fence, Instant begins,
                                               Instant now) const;
  void take_answers(const GivenRoutes& given, Instant now);
  void end_part(const GivenRoutes& given, Instant now);
  void stop(std::string why, Instant now);
  void look_for_rest();

  GroundSearchConfig config_;
  std::map<VehicleId, Known> known_;
  std::optional<AreaSearch> area_;
  std::optional<planning::AreaCells> cells_;
  bool rest_ = false;
  std::set<VehicleId> found_;     ///< who has detected a site, and is to be released
  std::set<VehicleId> released_;  ///< who was, of the area
};

}  // namespace skein::mission
