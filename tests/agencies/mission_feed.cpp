// SPDX-License-Identifier: Apache-2.0
//
// A mission of many vehicles in virtual time, and all that other agencies' systems would be sent of
// it, on standard output:
//   agencies_mission_feed VEHICLES SECONDS
// Each record: kind (u8: 0 truth, 1 Cursor on Target as XML, 2 as protobuf, 3 MAVLink), mission
// time (i64, ns), length (u32), bytes; numbers are little-endian. Truth: vehicle (u16), then
// latitude, longitude and height above the ellipsoid (f64).
#include <unistd.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "skein/agencies/cot_feed.hpp"
#include "skein/agencies/mavlink_feed.hpp"
#include "skein/console/picture.hpp"
#include "skein/groundstation/agency_desk.hpp"
#include "skein/hil/team_simulator.hpp"

namespace skein {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::int64_t kEpoch_unix_ns = 1'760'000'000'000'000'000;
constexpr Wgs84 kOrigin{31.522062, 105.044327, 480.0};
constexpr std::size_t kBuffer = 1U << 20U;

enum class Kind : std::uint8_t { truth, xml, protobuf, mavlink };

/// Written in large pieces: there are millions of records.
class Output {
 public:
  ~Output() { flush(); }
  Output() = default;
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  void record(Kind kind, Instant at, std::string_view bytes) {
    put(static_cast<std::uint8_t>(kind));
    put(std::int64_t{at.time_since_epoch().count()});
    put(static_cast<std::uint32_t>(bytes.size()));
    buffer_ += bytes;
    if (buffer_.size() > kBuffer) flush();
  }

 private:
  template <class T>
  void put(T value) {
    std::array<char, sizeof(T)> bytes{};
    std::memcpy(bytes.data(), &value, sizeof(T));
    buffer_.append(bytes.data(), bytes.size());
  }
  void flush() {
    std::string_view rest = buffer_;
    while (!rest.empty()) {
      const ssize_t written = ::write(STDOUT_FILENO, rest.data(), rest.size());
      if (written <= 0) std::exit(1);  // who reads has gone
      rest.remove_prefix(static_cast<std::size_t>(written));
    }
    buffer_.clear();
  }
  std::string buffer_;
};

/// Squares of vehicles that search, each in a layer of its own; sites that are reported to them all
/// along, hazards, and an hour's worth of range.
hil::TeamMission mission_of(int count, int seconds) {
  hil::TeamMission team;
  constexpr double kSide_m = 700.0;
  for (int i = 0; i < count; ++i) {
    hil::SimulatedVehicle v;
    v.spec.id = VehicleId{static_cast<std::uint16_t>(i + 1)};
    v.spec.cruise_speed_mps = 22.0 + 0.5 * (i % 12);
    v.spec.speed_min_mps = 18.0;
    v.spec.speed_max_mps = 32.0;
    v.spec.turn_radius_m = 60.0;
    v.spec.heading_gain_per_s = 1.5;
    v.spec.range_m = 400'000.0;
    v.spec.sensor_radius_m = 150.0;
    v.spec.height_m = 60.0 + 10.0 * i;
    v.spec.assess_radius_m = 120.0;
    v.spec.final_approach_m = 200.0;
    v.spec.loads = 2;
    for (const TaskKind kind : {TaskKind::survey, TaskKind::deliver, TaskKind::assess}) {
      v.spec.capabilities.add(kind);
    }
    const Vec2 corner{kSide_m * (i % 7 - 3), kSide_m * (i / 7 - 3)};
    v.start = {corner.x(), corner.y(), 0.3 * i};
    for (int lap = 0; lap < 40; ++lap) {
      const double in_m = 8.0 * lap;
      v.search.insert(v.search.end(),
                      {corner + Vec2{kSide_m - in_m, 0.0}, corner + Vec2{kSide_m - in_m, kSide_m},
                       corner + Vec2{0.0, kSide_m}, corner});
    }
    team.vehicles.push_back(v);
  }
  const int sites = std::max(1, seconds / 120);
  for (int i = 0; i < sites; ++i) {
    Site site;
    site.id = SiteId{static_cast<std::uint16_t>(i + 1)};
    site.position = {400.0 * (i % 9 - 4), 350.0 * (i % 7 - 3)};
    site.survey.dwell = std::chrono::seconds{5};
    site.assessments.emplace_back().dwell = std::chrono::seconds{4};
    team.sites.push_back(site);
    team.reported[site.id] = at_seconds(20.0 + 115.0 * i);
  }
  Site never;  // that nobody finds: the mission goes on to its end
  never.id = SiteId{60'000};
  never.position = {90'000.0, 0.0};
  team.sites.push_back(never);
  for (std::uint16_t i = 1; i <= 3; ++i) {
    team.hazards.push_back({{HazardId{i}, {900.0 * i - 1750.0, 1150.0}, 60.0}, Instant{}});
  }
  team.radio.range_m = 20'000.0;
  team.radio.ground_range_m = 30'000.0;
  team.wind.gust_mps = 0.5;
  team.duration_max = std::chrono::seconds{seconds};
  // Plans are told where the ground station reads them.
  team.faults = {{{at_seconds(seconds - 1.0)},
                  std::nullopt,
                  hil::Ordered{VehicleId{1}, mission::CommandKind::return_home}}};
  return team;
}

void tell_truth(Output& output, VehicleId vehicle, const Wgs84& place, Instant at) {
  std::array<char, sizeof(vehicle.value) + 3 * sizeof(double)> bytes{};
  const std::array<double, 3> figures{place.latitude_deg, place.longitude_deg, place.height_m};
  std::memcpy(bytes.data(), &vehicle.value, sizeof(vehicle.value));
  std::memcpy(bytes.data() + sizeof(vehicle.value), figures.data(), sizeof(figures));
  output.record(Kind::truth, at, {bytes.data(), bytes.size()});
}

int run(int count, int seconds) {
  const auto origin = MissionOrigin::make(kOrigin).value();
  const hil::TeamMission team = mission_of(count, seconds);
  Output output;
  console::PictureParams params;
  configuration::TeamRemoteId ids;
  ids.common.operator_id = "SWE1234567890abc";
  ids.common.description = "a mission of an hour";
  for (const auto& v : team.vehicles) {
    params.expected.push_back(v.spec.id);
    ids.ids.push_back({v.spec.id, "1ABCD" + std::to_string(v.spec.id.value)});
  }
  console::Picture picture{params};
  groundstation::ShownTracks tracks{origin};
  agencies::CotFeed cot{"alpha", kEpoch_unix_ns};
  agencies::MavlinkFeed mavlink;
  const auto say = [&](const mavlink::WireBytes& packet, Instant now) {
    // Bytes are what records take: NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast)
    output.record(Kind::mavlink, now,
                  {reinterpret_cast<const char*>(packet.begin()), packet.size()});
  };

  hil::TeamObserver observer;
  observer.track = [&](VehicleId id, const VehicleState& state, const mission::FlightPlan&) {
    tell_truth(output, id, origin.to_wgs84(state.position()), state.time);
  };
  observer.ground_message = [&](const mission::Message& m, VehicleId sender, Instant now) {
    picture.on_message(m, sender, now);
  };
  observer.ground_event = [&](const mission::MissionEvent& event) {
    picture.on_event(event);
    if (!mission::is_warning(event.kind())) return;
    for (const auto& packet : mavlink.alarm(event.vehicle, "a warning")) say(packet, event.time);
  };
  Instant next{};
  observer.moment = [&](Instant now, const mission::GroundNode& node,
                        const std::vector<hil::OwnWord>&) {
    if (now < next) return;
    next = now + groundstation::AgencyDesk::kPeriod;
    const agencies::Shown shown =
        groundstation::shown_of(picture, node.fleet(), origin, ids, tracks, now);
    const std::int64_t unix_ns = kEpoch_unix_ns + now.time_since_epoch().count();
    for (const auto& event : cot.update(shown, now, unix_ns)) {
      output.record(Kind::xml, now, agencies::to_xml(event));
      output.record(Kind::protobuf, now, agencies::to_protobuf(event));
    }
    for (const auto& packet : mavlink.update(shown, now, unix_ns)) say(packet, now);
  };
  const hil::TeamResult result = hil::simulate_team(team, observer);
  std::fprintf(stderr, "mission: %d vehicles, %.0f s, %zu of %zu sites done\n", count,
               to_seconds(result.ended_at.time_since_epoch()), result.sites_done,
               team.sites.size() - 1);
  return 0;
}

}  // namespace
}  // namespace skein

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 50;
  const int seconds = argc > 2 ? std::atoi(argv[2]) : 3600;
  if (count < 1 || count > 250 || seconds < 10) {
    std::fprintf(stderr, "usage: agencies_mission_feed VEHICLES SECONDS\n");
    return 2;
  }
  return skein::run(count, seconds);
}
