// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "skein/base/frames.hpp"
#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/configuration/site_config.hpp"
#include "skein/domain/fence.hpp"
#include "skein/mission/formation_ground.hpp"
#include "skein/mission/ground_search.hpp"
#include "skein/mission/messages.hpp"

/// What an operator can ask: a closed set, whether it is typed, clicked, or of a script.
namespace skein::groundstation {

/// Between which figures are taken, from the prompt and from the page.
struct Limit {
  double low = 0.0;
  double high = 0.0;
  [[nodiscard]] constexpr bool has(double value) const { return value >= low && value <= high; }
};
inline constexpr Limit kCoordinate_m{-1e5, 1e5};
inline constexpr Limit kHazardRadius_m{1.0, 5e4};
inline constexpr Limit kSpacing_m{0.5, 1000.0};
inline constexpr Limit kHeading_deg{-360.0, 360.0};
inline constexpr Limit kPlaces{1.0, 1000.0};
inline constexpr Limit kTrackSpeed_mps{1.0, 200.0};
inline constexpr Limit kLaps{1.0, 32.0};
inline constexpr Limit kWait_s{0.0, 86400.0};
inline constexpr Limit kRoutesIn_s{5.0, 86400.0};
inline constexpr Limit kLaneSpacing_m{1.0, 1e4};

inline constexpr Limit kFenceHeight_m{10.0, 1e4};  ///< as in a configuration

inline constexpr Limit kLatitude_deg{-90.0, 90.0};
inline constexpr Limit kLongitude_deg{-180.0, 180.0};
/// Vehicles that one order names, after ranges are written out.
inline constexpr std::size_t kVehiclesPerOrderMax = 1000;
inline constexpr Limit kTasks{0.0, static_cast<double>(kTasksPerKindMax)};
/// Those of files of sites.
[[nodiscard]] constexpr Limit limit_of(const configuration::SiteLimit& of) {
  return {of.low, of.high};
}

enum class View {
  help,
  status,
  sites,
  pending,
  places,
  coalitions,
  hazards,
  audit,
  proposals,
  routes,
  search,
  preflight,
  fence,
  links,
  wind,
  traffic,  ///< aircraft that are not of the team
  alarms,
  command,  ///< who has it
  console   ///< its address
};
/// What that vehicle's checks find.
struct PreflightOf {
  VehicleId vehicle;
};
/// That vehicle alone, with all that is known of it.
struct StatusOf {
  VehicleId vehicle;
};
/// The ways home that these would be given if they were ordered home now; none: all.
struct ReturnPreview {
  std::vector<VehicleId> vehicles;
};
/// The operator's decision on the deliveries at a site.
struct Decision {
  SiteId site;
  bool grant = false;
  std::optional<coalition::Round> plan = {};  ///< that was seen; none: the newest
  bool although_silent = false;               ///< a grant, also where one that it names is silent
};
/// What was granted there and has not begun is granted no more.
struct TakeBack {
  SiteId site;
};
/// A command to a vehicle, or to all (kGroundStation).
struct Order {
  VehicleId vehicle;
  mission::CommandKind kind = mission::CommandKind::hold;
};
/// The same command to each of several vehicles, as one order.
struct OrderToSeveral {
  std::vector<VehicleId> vehicles;  ///< ascending, none twice, at least one
  mission::CommandKind kind = mission::CommandKind::hold;
};
/// A circle or a polygon to keep out of, told to all. Mission frame.
struct NewHazard {
  Vec2 centre_m{0.0, 0.0};
  double radius_m = 0.0;
  std::vector<Vec2> corners = {};        ///< of a polygon; none: a circle
  std::optional<HazardId> changes = {};  ///< it takes the place of that one
  bool preview = false;                  ///< only show what would be shut out
};
/// An area that vehicles search, shared out among them.
struct SearchArea {
  mission::SearchWishes wishes;
  bool preview = false;  ///< only show how
};
/// That hazard is no more.
struct WithdrawHazard {
  HazardId hazard;
};
/// Where all vehicles are to stay from now on.
struct NewFence {
  Fence fence;
  std::string file = {};  ///< GeoJSON, or a plan of QGroundControl, that has its corners
  bool preview = false;   ///< only show whether it can be ordered
};
/// What is asked of a site; what is not said is as its template has it, or the site that it
/// changes.
struct SiteWishes {
  std::string like;                                 ///< a template's name; empty: none
  std::optional<Vec2> place_m;                      ///< mission frame; or
  std::optional<Wgs84> place;                       ///< without a height
  std::optional<std::vector<double>> bearings_rad;  ///< of the deliveries
  std::optional<double> interval_s;                 ///< from one to the next; 0: all at one time
  std::optional<int> assessments;
  std::optional<double> assessment_wait_s;
  std::optional<double> assessment_dwell_s;
  std::optional<double> survey_dwell_s;
  std::optional<double> reward;
  std::optional<double> reward_decay_per_s;
  std::optional<VehicleId> surveyor;  ///< none: the nearest that can
  bool anyway = false;                ///< also where a site is known to be
};
/// A new site, or one in place of another.
struct NewSite {
  SiteWishes wishes;
  std::optional<SiteId> changes = {};
  bool preview = false;  ///< only show what it would be
};
/// Those of a file.
struct SitesFromFile {
  std::string file;
};
/// Nobody shall go on with it.
struct WithdrawSite {
  SiteId site;
};
/// Routes of a plan's file, over the air.
struct RoutesFromFile {
  std::string file;
  std::optional<double> in_s = {};  ///< so much from now on; none: from mission time 0
  bool preview = false;             ///< only show whether they could be given
};
/// Nobody shall fly them, or go on with them.
struct CallOffRoutes {};
/// What a detector has seen is taken as a site, or is none.
struct ProposalAnswer {
  std::uint32_t number = 0;
  bool accept = false;
};
/// To the formation. A free shape has its name or file, and no points yet.
struct Formation {
  mission::FormationOrder order;
  std::string shape;         ///< of a free shape
  bool preview = false;      ///< only show what it would do
  bool has_centre = false;   ///< otherwise where the formation is
  bool has_spacing = false;  ///< otherwise the rally's
  bool has_heading = false;  ///< otherwise the rally's
  // Of fly_along:
  std::string track{};                ///< its name or file
  std::optional<double> speed_mps{};  ///< none: the slowest plane's cruise speed
  int laps = 1;
};
/// Of a script: the formation stays so long before the next order.
struct Wait {
  Duration duration{};
};
/// Everything is recorded into that folder from now on, in place of where it was before.
struct Record {
  std::string folder;  ///< empty: nothing is recorded any more
};
/// He has seen those alarms.
struct Acknowledge {
  std::vector<std::uint32_t> numbers;  ///< empty: all that wait for it
};
struct Quit {};
/// This ground station, which watches, takes the command from whoever has it.
struct TakeCommand {
  std::string reason;  ///< for the others; may be empty
};
/// The one that has it asks the others to take it.
struct HandOver {};
/// monostate: an empty line.
using Input =
    std::variant<std::monostate, View, Decision, Order, OrderToSeveral, NewHazard, WithdrawHazard,
                 NewSite, SitesFromFile, WithdrawSite, RoutesFromFile, CallOffRoutes,
                 ProposalAnswer, Formation, Wait, Record, Quit, PreflightOf, NewFence, StatusOf,
                 ReturnPreview, SearchArea, Acknowledge, TakeBack, TakeCommand, HandOver>;

/// "line_abreast" as it is typed: "line-abreast".
[[nodiscard]] std::string hyphened(std::string_view name);
/// The shapes that have a name of their own, as they are typed; all others are free ones.
[[nodiscard]] std::vector<std::string> shape_names();
/// By a name of these, or as files write it: line-abreast, line_abreast.
[[nodiscard]] std::optional<formation::ShapeKind> shape_named(std::string_view name);
/// Ascending numbers as the prompt takes them: 1, 2, 3 and 7 are "1-3,7".
[[nodiscard]] std::string typed_ids(const std::vector<VehicleId>& vehicles);
/// The order in the prompt's words, for the log and the audit: "form wedge spacing 5".
[[nodiscard]] std::string line_of(const Input& input);

/// The order that a page has sent (docs/console-socket.md). Any text is safe; fails with what is
/// wrong.
[[nodiscard]] Result<Input> read_order(std::string_view json);
/// The limits as JSON, for the page's forms.
[[nodiscard]] std::string limits_json();

}  // namespace skein::groundstation
