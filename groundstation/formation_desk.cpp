// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/formation_desk.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "formation_desk_texts.hpp"
#include "skein/codec/json_text.hpp"
#include "skein/configuration/shape_file.hpp"

namespace skein::groundstation {
namespace {

/// After an order of the script that could not be given.
constexpr Duration kTryAgain = std::chrono::seconds{1};
/// Who is not heard by then is told of.
constexpr Duration kTeamWait = std::chrono::seconds{10};

std::string text_of(const mission::FormationPreview& preview) {
  const auto& planned = preview.planned;
  std::string text = fmt::format("{} vehicles, {}, {:.1f} s, separation {:.2f} m at least\n",
                                 planned.change.movers.size(), formation::to_string(planned.way),
                                 to_seconds(planned.duration), planned.least_separation_m);
  for (const auto& mover : planned.change.movers) {
    const Vec3& from = mover.points.front();
    const Vec3& to = mover.points.back();
    text += fmt::format("  vehicle {:<3} ({:7.1f} {:7.1f} {:6.1f}) to ({:7.1f} {:7.1f} {:6.1f})\n",
                        mover.vehicle.value, from.x(), from.y(), from.z(), to.x(), to.y(), to.z());
  }
  if (preview.makes_room) {
    text += fmt::format(
        "  some rest too near to each other: first only vehicle {} makes room, then the order is "
        "given\n",
        preview.makes_room->value);
  }
  for (const VehicleId vehicle : preview.lost) {
    text += fmt::format("  vehicle {} is silent; its way is kept clear\n", vehicle.value);
  }
  return text;
}

std::string data_of(const mission::FormationPreview& preview, bool only_preview) {
  const auto& planned = preview.planned;
  auto data = outcome_json(only_preview, formation::to_string(planned.way), planned.duration,
                           planned.least_separation_m, preview.lost);
  for (const auto& mover : planned.change.movers) {
    auto points = codec::Json::array();
    for (const Vec3& p : mover.points) points.push_back({p.x(), p.y(), p.z()});
    data["movers"].push_back({{"id", mover.vehicle.value}, {"points", std::move(points)}});
  }
  if (preview.makes_room) data["makes_room"] = preview.makes_room->value;
  return codec::json_text(data);
}

}  // namespace

mission::FormationGroundConfig formation_ground(const configuration::FormationConfig& config,
                                                const std::vector<VehicleId>& vehicles) {
  mission::FormationGroundConfig ground;
  ground.vehicles = vehicles;
  ground.rally = config.rally;
  ground.limits = config.limits;
  ground.separation = config.separation;
  ground.tracking_m = config.tracking_m;
  ground.reserve_m = config.reserve_m;
  ground.ceiling_m = config.ceiling_m;
  ground.place_tolerance_m = config.place_tolerance_m;
  ground.assignment.method = config.assignment;
  return ground;
}

FormationDesk::FormationDesk(const configuration::FormationConfig& config,
                             const std::vector<VehicleId>& vehicles, mission::GroundNode& node)
    : config_{config}, vehicles_{vehicles}, node_{&node} {}

Result<FormationDesk> FormationDesk::open(const configuration::FormationConfig& config,
                                          const std::vector<VehicleId>& vehicles,
                                          mission::GroundNode& node) {
  FormationDesk desk{config, vehicles, node};
  for (const configuration::NamedTrack& track : config.tracks) {
    if (auto loaded = desk.load_track(track.name, track.file); !loaded) return loaded.error();
  }
  for (const configuration::NamedShape& shape : config.shapes) {
    if (auto loaded = desk.load(shape.name, shape.file); !loaded) return loaded.error();
  }
  for (std::size_t i = 0; i < config.script.size(); ++i) {
    const std::string where = fmt::format("formation.script, line {}: ", i + 1);
    auto input = parse_input(config.script[i]);
    if (!input) return Error{where + input.error().message};
    if (const auto* order = std::get_if<Formation>(&*input)) {
      if (order->preview) return Error{where + "a script gives orders; take 'preview' away"};
      if (auto loaded = desk.load_files(*order, true); !loaded) {
        return Error{where + loaded.error().message};
      }
    } else if (!std::holds_alternative<Wait>(*input)) {
      return Error{where + "'" + config.script[i] +
                   "' is neither an order to the formation nor 'wait SECONDS'"};
    }
    desk.script_.push_back(*std::move(input));
  }
  return desk;
}

Result<void> FormationDesk::load(const std::string& name, const std::string& file) {
  const auto read = configuration::load_shape(file);
  if (!read) return read.error();
  formation::ShapeSpec shape;
  shape.kind = formation::ShapeKind::free;
  shape.points = read->points;
  shape.closed = read->closed;
  shapes_[name] = std::move(shape);
  return {};
}

Result<void> FormationDesk::load_files(const Formation& input, bool whatever_its_name) {
  const auto is_file = [whatever_its_name](const std::string& name) {
    return whatever_its_name || name.find('.') != std::string::npos;
  };
  if (!input.shape.empty() && !shapes_.contains(input.shape) && is_file(input.shape)) {
    if (auto loaded = load(input.shape, input.shape); !loaded) return loaded;
  }
  if (!input.track.empty() && !tracks_.contains(input.track) && is_file(input.track)) {
    return load_track(input.track, input.track);
  }
  return {};
}

Result<formation::ShapeSpec> FormationDesk::named_shape(const Formation& input) const {
  formation::ShapeSpec shape = input.order.shape;
  if (input.shape.empty()) return shape;
  const auto known = shapes_.find(input.shape);
  if (known == shapes_.end()) {
    return Error{fmt::format("'{}' is no shape: {}{}; or name a file of points", input.shape,
                             fmt::join(shape_names(), ", "), names_of(shapes_))};
  }
  shape.points = known->second.points;
  shape.closed = known->second.closed;
  return shape;
}

Result<mission::FormationOrder> FormationDesk::completed(const Formation& input) const {
  mission::FormationOrder order = input.order;
  if (order.kind != mission::OrderKind::form) return order;
  auto shape = named_shape(input);
  if (!shape) return shape.error();
  order.shape = *std::move(shape);
  if (!input.has_spacing) order.shape.spacing_m = config_.rally.spacing_m;
  if (!input.has_heading) order.shape.heading_rad = config_.rally.heading_rad;
  if (!input.has_centre) order.shape.centre = config_.rally.centre;
  return order;
}

Result<FormationDesk::Outcome> FormationDesk::answer(const Formation& input, Instant now) {
  if (auto loaded = load_files(input, false); !loaded) return loaded.error();
  if (config_.planes) return answer_planes(input, now);
  if (input.order.kind == mission::OrderKind::fly_along) {
    return Error{
        "multirotors fly from place to place, by form; along a track fly planes (formation: "
        "{airframe: plane})"};
  }
  const auto order = completed(input);
  if (!order) return order.error();
  const auto result =
      input.preview ? ground().preview(*order) : node_->formation().command(*order, now);
  if (!result) return result.error();
  return Outcome{(input.preview ? "preview: " : "begun: ") + text_of(*result),
                 data_of(*result, input.preview)};
}

std::string FormationDesk::places_table(Instant now) const {
  if (config_.planes) return tracks_table(now);
  if (ground().members().empty()) return "no vehicle of the formation is heard\n";
  std::string text = places_header("change");
  for (const auto& [vehicle, member] : ground().members()) {
    text += place_line(vehicle, member, member.place_error_m,
                       member.status.at_rest ? "" : ", moving", now);
  }
  text += ground().in_place() ? "in formation\n" : "not in formation\n";
  return text;
}

std::size_t FormationDesk::heard() const {
  return config_.planes ? node_->tracks().members().size() : ground().members().size();
}

bool FormationDesk::is_heard(VehicleId vehicle) const {
  return config_.planes ? node_->tracks().members().contains(vehicle)
                        : ground().members().contains(vehicle);
}

bool FormationDesk::in_place() const {
  return config_.planes ? node_->tracks().in_place() : ground().in_place();
}

void FormationDesk::on_timeout(Instant now) {
  if (ends_ && !node_->tracks().on_track(now)) {
    ends_ = false;
    report(mission::event::ScriptDone{static_cast<std::uint32_t>(script_.size())}, now);
  }
  // Where vehicles have moved to, the next order may wait for something else.
  const bool moving = !config_.planes && ground().moving();
  if (std::exchange(moved_, moving) && !moving) told_waits_ = false;
  if (next_line_ < script_.size()) work_off_script(now);
}

void FormationDesk::work_off_script(Instant now) {
  if (now < Instant{} || now < try_again_) return;
  // The first order is for the whole team.
  if (next_line_ == 0 && !given_ && heard() < vehicles_.size()) {
    if (!team_by_) team_by_ = now + kTeamWait;
    if (now < *team_by_ || std::exchange(told_awaited_, true)) return;
    std::vector<VehicleId> awaited;
    for (const VehicleId vehicle : vehicles_) {
      if (!is_heard(vehicle)) awaited.push_back(vehicle);
    }
    report(mission::formation_warning(mission::event::FormationNews::awaited, std::move(awaited)),
           now);
    return;
  }
  if (given_) {
    if (!in_place()) return;
    given_ = false;
    ++next_line_;
  } else if (wait_until_) {
    if (now < *wait_until_) return;
    wait_until_.reset();
    ++next_line_;
  }
  if (next_line_ == script_.size()) {
    ends_ = config_.planes && node_->tracks().on_track(now);
    if (ends_) return;
    report(mission::event::ScriptDone{static_cast<std::uint32_t>(script_.size())}, now);
    return;
  }
  const Input& line = script_[next_line_];
  if (const auto* wait = std::get_if<Wait>(&line)) {
    wait_until_ = now + wait->duration;
    return;
  }
  const auto given = answer(std::get<Formation>(line), now);
  given_ = given.ok();
  if (given_) {
    told_waits_ = false;
    return;
  }
  try_again_ = now + kTryAgain;
  // Once, until vehicles are led elsewhere: gusts alone change the reason all the time.
  if (std::exchange(told_waits_, true)) return;
  report(mission::event::OrderWaits{static_cast<std::uint32_t>(next_line_ + 1),
                                    config_.script[next_line_], given.error().message},
         now);
}

void FormationDesk::report(mission::EventBody body, Instant now) {
  node_->say({kGroundStation, now, {}, {}, std::move(body)});
}

}  // namespace skein::groundstation
