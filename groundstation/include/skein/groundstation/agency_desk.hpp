// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "skein/agencies/adsb_intake.hpp"
#include "skein/agencies/cot_feed.hpp"
#include "skein/agencies/line_source.hpp"
#include "skein/agencies/marker_intake.hpp"
#include "skein/agencies/mavlink_feed.hpp"
#include "skein/agencies/outlet.hpp"
#include "skein/agencies/shown.hpp"
#include "skein/base/frames.hpp"
#include "skein/configuration/ground_config.hpp"
#include "skein/console/picture.hpp"
#include "skein/mission/fleet.hpp"

namespace skein::groundstation {

/// The planned ways of vehicles as points, made once a plan.
class ShownTracks {
 public:
  static constexpr std::size_t kPointsMax = 100;

  explicit ShownTracks(const MissionOrigin& origin) : origin_{origin} {}
  /// Of that plan, at that height. The reference holds until the next call.
  const agencies::ShownTrack& of(VehicleId vehicle, const mission::FlightPlan& plan, double z_m);

 private:
  struct Known {
    std::uint32_t number = 0;
    Instant start{};
    agencies::ShownTrack track;
  };
  MissionOrigin origin_;
  std::map<VehicleId, Known> known_;
};

/// What others are shown: vehicles that were heard and belong to the mission, their plans until
/// these end, sites that are not withdrawn, and hazards.
[[nodiscard]] agencies::Shown shown_of(const console::Picture& picture, const mission::Fleet& fleet,
                                       const MissionOrigin& origin,
                                       const configuration::TeamRemoteId& ids, ShownTracks& tracks,
                                       Instant now);

/// Where systems of other agencies meet the ground station (docs/agencies.md): they are shown the
/// team, and what they mark is proposed. Nothing else of what they send is heeded. Does nothing
/// where none are configured; an address that cannot be had is left out, with a warning.
class AgencyDesk {
 public:
  static constexpr Duration kPeriod = std::chrono::milliseconds{50};
  static constexpr Duration kFilePeriod = std::chrono::seconds{1};  ///< of aircraft.json

  AgencyDesk(const configuration::GroundConfig& config, const MissionOrigin& origin);

  /// The next marker that is to be proposed to the operator.
  [[nodiscard]] std::optional<mission::Detection> next_marker(Instant now);
  /// The next aircraft that a receiver of ADS-B tells of.
  [[nodiscard]] std::optional<mission::SeenAircraft> next_aircraft(Instant now);
  /// Why no receiver of ADS-B tells of aircraft, for people; empty where one does, or none is
  /// configured.
  [[nodiscard]] std::string receiver_trouble() const;
  /// `now` and the system's clock.
  void on_timeout(const console::Picture& picture, const mission::Fleet& fleet, Instant now);
  /// Warnings of vehicles are passed on.
  void on_event(const mission::MissionEvent& event);

 private:
  using Outlets = std::vector<std::unique_ptr<agencies::Outlet>>;

  void open_outlets(const configuration::AgenciesConfig& config);
  void read_lines(Instant now);
  void read_file(Instant now);
  void open_markers(const configuration::MarkersConfig& config);
  void say(const agencies::CotEvent& event);
  void say(const mavlink::WireBytes& packet);
  static void poll_outlets(const Outlets& outlets);

  MissionOrigin origin_;
  ShownTracks tracks_;
  agencies::CotFeed cot_feed_;
  agencies::MavlinkFeed mavlink_feed_;
  agencies::MarkerIntake intake_;
  Outlets cot_xml_;
  Outlets cot_protobuf_;
  Outlets mavlink_;
  std::optional<agencies::Inlet> markers_;
  configuration::TeamRemoteId remote_ids_;
  agencies::AdsbIntake adsb_;
  std::optional<agencies::LineSource> adsb_lines_;
  std::string adsb_file_;
  std::deque<mission::SeenAircraft> aircraft_;
  Instant next_lines_{Instant::min()};
  Instant next_file_{Instant::min()};
  bool reads_file_ = true;  ///< could it be read the last time
  Instant next_{Instant::min()};
  Instant next_complaint_{Instant::min()};
};

}  // namespace skein::groundstation
