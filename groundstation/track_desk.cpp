// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <utility>

#include "formation_desk_texts.hpp"
#include "skein/codec/json_text.hpp"
#include "skein/configuration/track_file.hpp"
#include "skein/groundstation/formation_desk.hpp"
#include "skein/mission/track_agent.hpp"

/// What the formation's desk does where planes fly it.
namespace skein::groundstation {
namespace {

/// Of a way as it is drawn before it is flown.
constexpr int kDrawn = 120;

std::string text_of(const mission::TrackPreview& preview, Instant now) {
  const formation::PlannedTrack& planned = preview.planned;
  std::string text = fmt::format(
      "{} planes, {}, in their places after {:.0f} s, at the track's end after {:.0f} s, {:.1f} m "
      "apart at least\n",
      planned.flights.size(), formation::to_string(preview.order.shape.kind),
      to_seconds(planned.joined - now), to_seconds(planned.ends - now), planned.least_separation_m);
  for (const auto& flight : planned.flights) {
    text += fmt::format("  vehicle {:<3} {:7.1f} m ahead, {:7.1f} m left, at {:.0f} m\n",
                        flight.plane.spec.id.value, flight.place.ahead_m, flight.place.left_m,
                        flight.plane.spec.height_m);
  }
  for (const VehicleId vehicle : preview.lost) {
    text +=
        fmt::format("  vehicle {} is left out; the others keep to other heights\n", vehicle.value);
  }
  return text;
}

std::string data_of(const mission::TrackPreview& preview, bool only_preview, Instant now) {
  const formation::PlannedTrack& planned = preview.planned;
  auto data = outcome_json(only_preview, formation::to_string(formation::Way::track),
                           planned.joined - now, planned.least_separation_m, preview.lost);
  for (const auto& flight : planned.flights) {
    auto points = codec::Json::array();
    const double length_m = flight.timed.path.length_m();
    for (int i = 0; i <= kDrawn; ++i) {
      const Pose2 at = flight.timed.pose_at_distance(length_m * i / kDrawn);
      points.push_back({at.x_m, at.y_m, flight.plane.spec.height_m});
    }
    data["movers"].push_back({{"id", flight.plane.spec.id.value}, {"points", std::move(points)}});
  }
  return codec::json_text(data);
}

}  // namespace

mission::TrackGroundConfig track_ground(const configuration::FormationConfig& config,
                                        const std::vector<VehicleSpec>& planes,
                                        const std::vector<Hazard>& hazards) {
  mission::TrackGroundConfig ground;
  ground.planes = planes;
  ground.rules.separation = config.separation;
  ground.rules.tracking_m = config.tracking_m;
  ground.rules.wind_mps = config.wind_mps;
  ground.rules.ceiling_m = config.ceiling_m;
  ground.rules.avoidance.margin_m = mission::kHazardMargin_m;
  ground.rules.hazards = hazards;
  ground.place_tolerance_m = config.place_tolerance_m;
  return ground;
}

Result<void> FormationDesk::load_track(const std::string& name, const std::string& file) {
  const auto read = configuration::load_track(file);
  if (!read) return read.error();
  tracks_[name] = read->track;
  return {};
}

Result<mission::TrackOrder> FormationDesk::completed_track(const Formation& input) const {
  using mission::OrderKind;
  const OrderKind kind = input.order.kind;
  if (kind != OrderKind::fly_along && kind != OrderKind::form) {
    return Error{
        "planes cannot rest: order fly-along TRACK in SHAPE, or form SHAPE on the track; hold and "
        "return go to one or all"};
  }
  if (input.has_centre || input.has_heading || input.order.places) {
    return Error{
        "planes take place and heading from their track; leave at, heading and places away"};
  }
  mission::TrackOrder order;
  order.kind = kind == OrderKind::form ? OrderKind::reshape : OrderKind::fly_along;
  auto shape = named_shape(input);
  if (!shape) return shape.error();
  order.shape = *std::move(shape);
  if (!input.has_spacing) {
    order.shape.spacing_m = 1.5 * (config_.separation.horizontal_m + 2.0 * config_.tracking_m);
  }
  order.speed_mps = input.speed_mps;
  order.laps = input.laps;
  if (order.kind == OrderKind::reshape) return order;
  const auto known = tracks_.find(input.track);
  if (known == tracks_.end()) {
    const std::string names = names_of(tracks_);
    return Error{fmt::format("there is no track '{}'; known are: {}; or name a file of waypoints",
                             input.track, names.empty() ? "none" : names.substr(2))};
  }
  order.track = known->second;
  return order;
}

Result<FormationDesk::Outcome> FormationDesk::answer_planes(const Formation& input, Instant now) {
  const auto order = completed_track(input);
  if (!order) return order.error();
  const auto result =
      input.preview ? node_->tracks().preview(*order, now) : node_->tracks().command(*order, now);
  if (!result) return result.error();
  return Outcome{(input.preview ? "preview: " : "begun: ") + text_of(*result, now),
                 data_of(*result, input.preview, now)};
}

std::string FormationDesk::tracks_table(Instant now) const {
  const mission::TrackGround& tracks = node_->tracks();
  if (tracks.members().empty()) return "no vehicle of the formation is heard\n";
  std::string text = places_header("order");
  for (const auto& [vehicle, member] : tracks.members()) {
    text += place_line(vehicle, member, member.status.progress.off_m,
                       member.status.at_rest ? ", in an orbit" : "", now);
  }
  text += tracks.in_place() ? "in formation\n" : "not in formation\n";
  return text;
}

}  // namespace skein::groundstation
