// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/agency_desk.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <ios>
#include <string>
#include <utility>

#include "skein/groundstation/views.hpp"
#include "skein/wording/wording.hpp"

namespace skein::groundstation {
namespace {

constexpr double kArcStep_rad = 0.3;
constexpr int kMarkersPerStep = 20;  // so that a flood cannot keep the loop from its deadlines
constexpr int kLinesPerStep = 500;
constexpr Duration kComplaintPeriod = std::chrono::seconds{10};

std::vector<Wgs84> points_of(const Path& path, double z_m, const MissionOrigin& origin) {
  std::vector<Wgs84> points;
  const auto add = [&](double distance_m) {
    const Pose2 pose = path.pose_at(distance_m);
    points.push_back(origin.to_wgs84(Position<MissionEnu>{pose.x_m, pose.y_m, z_m}));
  };
  add(0.0);
  double begun_m = 0.0;
  for (const Segment& segment : path.segments) {
    const double turn_rad = std::abs(segment.curvature_per_m) * segment.length_m;
    const double pieces = std::max(1.0, std::ceil(turn_rad / kArcStep_rad));
    for (double i = 1.0; i <= pieces && points.size() + 1 < ShownTracks::kPointsMax; ++i) {
      add(begun_m + segment.length_m * i / pieces);
    }
    begun_m += segment.length_m;
  }
  if (points.size() + 1 == ShownTracks::kPointsMax) add(begun_m);  // there were too many: its end
  return points;
}

bool is_copter(const mission::FleetEntry& entry, const console::FormationPicture& formation,
               VehicleId id) {
  if (entry.preflight) return entry.preflight->copter;
  return formation.members.contains(id) && !formation.flights.contains(id);
}

agencies::ShownVehicle shown_vehicle(VehicleId id, const mission::FleetEntry& entry,
                                     const console::Picture& picture, const MissionOrigin& origin) {
  const mission::Telemetry& telemetry = *entry.telemetry;
  agencies::ShownVehicle shown;
  shown.id = id;
  shown.copter = is_copter(entry, picture.formation(), id);
  shown.state = telemetry.state;
  shown.place = origin.to_wgs84(telemetry.state.position());
  shown.activity = telemetry.activity;
  shown.range_left_m = telemetry.range_left_m;
  shown.loads = telemetry.loads;
  shown.silent = entry.silent;
  if (entry.health) shown.problems = entry.health->problems;
  if (entry.duplicate) shown.problems.emplace_back("two vehicles have this number");
  return shown;
}

void set_progress(agencies::ShownTrack& track, const mission::FlightPlan& plan, Instant now) {
  constexpr std::size_t kMost = 65'534;
  const auto& segments = plan.timed.path.segments;
  const double flown_m = plan.timed.distance_at(now);
  track.legs = static_cast<std::uint16_t>(std::min(segments.size(), kMost));
  track.leg = 0;
  double ends_m = 0.0;
  for (std::size_t i = 0; i < track.legs; ++i) {
    ends_m += segments[i].length_m;
    if (flown_m < ends_m) break;
    track.leg = static_cast<std::uint16_t>(std::min<std::size_t>(i + 1, track.legs - 1U));
  }
  track.left_m = std::max(0.0, plan.timed.path.length_m() - flown_m);
}

}  // namespace

const agencies::ShownTrack& ShownTracks::of(VehicleId vehicle, const mission::FlightPlan& plan,
                                            double z_m) {
  Known& known = known_[vehicle];
  const bool same = known.number == plan.number && known.start == plan.timed.start_time;
  if (!same || known.track.points.empty()) {
    known = {
        plan.number, plan.timed.start_time, {vehicle, points_of(plan.timed.path, z_m, origin_)}};
  }
  return known.track;
}

agencies::Shown shown_of(const console::Picture& picture, const mission::Fleet& fleet,
                         const MissionOrigin& origin, const configuration::TeamRemoteId& ids,
                         ShownTracks& tracks, Instant now) {
  agencies::Shown shown;
  for (const auto& [id, entry] : fleet.vehicles()) {
    if (!entry.telemetry || entry.revoked) continue;
    shown.vehicles.push_back(shown_vehicle(id, entry, picture, origin));
    shown.vehicles.back().remote_id = ids.of(id);
    const auto known = picture.vehicles().find(id);
    const bool has_plan = known != picture.vehicles().end() && known->second.plan.has_value();
    if (!has_plan || entry.silent) continue;
    const mission::FlightPlan& plan = known->second.plan->plan;
    if (now >= plan.timed.end_time()) continue;
    shown.tracks.push_back(tracks.of(id, plan, entry.telemetry->state.z_m));
    set_progress(shown.tracks.back(), plan, now);
  }
  const auto on_ground = [&origin](const Vec2& place) {
    return origin.to_wgs84(Position<MissionEnu>{place.x(), place.y(), 0.0});
  };
  for (const auto& [id, site] : picture.sites()) {
    if (!site.site || site.withdrawn) continue;
    shown.sites.push_back({id, on_ground(site.site->position), site_state_text(site), site.done});
  }
  for (const auto& [id, hazard] : picture.hazards()) {
    shown.hazards.push_back({id, on_ground(hazard.centre), hazard.radius_m});
  }
  return shown;
}

AgencyDesk::AgencyDesk(const configuration::GroundConfig& config, const MissionOrigin& origin)
    : origin_{origin},
      tracks_{origin},
      cot_feed_{config.agencies.team, config.time.epoch_unix_ns},
      intake_{origin, cot_feed_.uid_prefix()},
      remote_ids_{config.remote_id},
      adsb_{origin, {config.agencies.adsb.qnh_hpa, config.agencies.adsb.geoid_height_m}},
      adsb_file_{config.agencies.adsb.file} {
  const configuration::AdsbConfig& adsb = config.agencies.adsb;
  if (!adsb.address.empty()) adsb_lines_.emplace(adsb.address, adsb.port, agencies::kSbsLineMax);
  open_outlets(config.agencies);
  open_markers(config.agencies.markers);
}

void AgencyDesk::open_outlets(const configuration::AgenciesConfig& config) {
  using configuration::CotTarget;
  const auto add_udp = [](Outlets& outlets, const auto& target, const std::string& interface) {
    auto outlet = agencies::open_udp(target.address, target.port, interface);
    if (!outlet) {
      spdlog::warn("agencies: nothing is sent to {}", outlet.error().message);
      return;
    }
    outlets.push_back(std::move(outlet).value());
  };
  for (const CotTarget& target : config.cot) {
    if (target.transport == CotTarget::Transport::tcp) {
      cot_xml_.push_back(agencies::open_tcp(target.address, target.port));
    } else {
      const bool protobuf = target.format == CotTarget::Format::protobuf;
      add_udp(protobuf ? cot_protobuf_ : cot_xml_, target, target.interface);
    }
  }
  for (const auto& target : config.mavlink) add_udp(mavlink_, target, "");
}

void AgencyDesk::open_markers(const configuration::MarkersConfig& config) {
  if (config.port == 0) return;
  auto inlet = agencies::Inlet::open(config.address, config.port, config.group);
  if (!inlet) {
    spdlog::warn("agencies: no markers are taken at {}", inlet.error().message);
    return;
  }
  markers_ = std::move(inlet).value();
}

std::optional<mission::Detection> AgencyDesk::next_marker(Instant now) {
  std::optional<mission::Detection> seen;
  for (int i = 0; markers_ && !seen && i < kMarkersPerStep; ++i) {
    const auto datagram = markers_->poll(agencies::kMarkerTextMax);
    if (!datagram) break;
    seen = intake_.take(*datagram, now);
  }
  if (now >= next_complaint_) {
    if (const auto trouble = intake_.poll_trouble()) {
      next_complaint_ = now + kComplaintPeriod;
      spdlog::warn("agencies: a marker is passed over, {} by now: {}", intake_.unreadable(),
                   *trouble);
    }
  }
  return seen;
}

std::optional<mission::SeenAircraft> AgencyDesk::next_aircraft(Instant now) {
  if (aircraft_.empty() && adsb_lines_) read_lines(now);
  if (aircraft_.empty() && !adsb_file_.empty() && now >= next_file_) read_file(now);
  if (aircraft_.empty()) return std::nullopt;
  mission::SeenAircraft seen = std::move(aircraft_.front());
  aircraft_.pop_front();
  return seen;
}

void AgencyDesk::read_lines(Instant now) {
  if (now < next_lines_) return;
  next_lines_ = now + kPeriod;
  adsb_lines_->poll(std::chrono::steady_clock::now());
  if (const auto news = adsb_lines_->poll_news()) spdlog::info("agencies: ADS-B: {}", *news);
  for (int i = 0; i < kLinesPerStep; ++i) {
    const auto line = adsb_lines_->next();
    if (!line) return;
    if (auto seen = adsb_.take_sbs(*line, now)) aircraft_.push_back(*std::move(seen));
  }
}

void AgencyDesk::read_file(Instant now) {
  next_file_ = now + kFilePeriod;
  std::ifstream in{adsb_file_, std::ios::binary};
  std::string text(agencies::kAircraftJsonMax + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, in.gcount())));
  if (text.empty()) {
    if (std::exchange(reads_file_, false)) {
      spdlog::warn("agencies: ADS-B: {} cannot be read; it is tried again", adsb_file_);
    }
    return;
  }
  reads_file_ = true;
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  for (auto& seen : adsb_.take_json(text, std::chrono::duration<double>(since_1970).count(), now)) {
    aircraft_.push_back(std::move(seen));
  }
}

std::string AgencyDesk::receiver_trouble() const {
  if (adsb_lines_ && !adsb_lines_->connected()) {
    return "there is no connection to the receiver (agencies.adsb.address)";
  }
  if (adsb_file_.empty()) return {};
  if (!reads_file_) return adsb_file_ + " cannot be read (agencies.adsb.file)";
  if (adsb_.is_old()) return adsb_file_ + " is not written any more (agencies.adsb.file)";
  return {};
}

void AgencyDesk::on_timeout(const console::Picture& picture, const mission::Fleet& fleet,
                            Instant now) {
  if (now < next_ || (cot_xml_.empty() && cot_protobuf_.empty() && mavlink_.empty())) return;
  next_ = now + kPeriod;
  poll_outlets(cot_xml_);
  poll_outlets(cot_protobuf_);
  poll_outlets(mavlink_);
  const agencies::Shown shown = shown_of(picture, fleet, origin_, remote_ids_, tracks_, now);
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  const auto unix_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(since_1970).count();
  if (!cot_xml_.empty() || !cot_protobuf_.empty()) {
    for (const auto& event : cot_feed_.update(shown, now, unix_ns)) say(event);
  }
  if (mavlink_.empty()) return;
  for (const auto& packet : mavlink_feed_.update(shown, now, unix_ns)) say(packet);
}

void AgencyDesk::on_event(const mission::MissionEvent& event) {
  if (mavlink_.empty() || !mission::is_warning(event.kind())) return;
  for (const auto& packet : mavlink_feed_.alarm(event.vehicle, wording::news_of(event))) {
    say(packet);
  }
}

void AgencyDesk::say(const agencies::CotEvent& event) {
  if (!cot_xml_.empty()) {
    const std::string xml = agencies::to_xml(event);
    for (const auto& outlet : cot_xml_) outlet->send(xml);
  }
  if (!cot_protobuf_.empty()) {
    const std::string message = agencies::to_protobuf(event);
    for (const auto& outlet : cot_protobuf_) outlet->send(message);
  }
}

void AgencyDesk::say(const mavlink::WireBytes& packet) {
  // Bytes are what sockets take: NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast)
  const std::string_view bytes{reinterpret_cast<const char*>(packet.begin()), packet.size()};
  for (const auto& outlet : mavlink_) outlet->send(bytes);
}

void AgencyDesk::poll_outlets(const Outlets& outlets) {
  const auto now = std::chrono::steady_clock::now();
  for (const auto& outlet : outlets) {
    outlet->poll(now);
    if (const auto news = outlet->poll_news()) spdlog::info("agencies: {}", *news);
  }
}

}  // namespace skein::groundstation
