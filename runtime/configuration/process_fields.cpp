// SPDX-License-Identifier: Apache-2.0
#include "process_fields.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "skein/base/stations.hpp"
#include "skein/formation/change.hpp"
#include "skein/mission/may_say.hpp"
#include "skein/planning/fence_check.hpp"

namespace skein::configuration {
namespace {

constexpr std::array<std::string_view, static_cast<std::size_t>(TaskKind::count)> kTaskKinds{
    "survey", "deliver", "assess"};
constexpr std::array<std::string_view, static_cast<std::size_t>(FlightControllerKind::count)>
    kFlightControllers{"simulated", "ardupilot"};
constexpr std::array<std::string_view, static_cast<std::size_t>(Recovery::count)> kRecoveries{
    "home", "anywhere"};
constexpr std::array kAirframes{to_string(Airframe::plane), to_string(Airframe::copter),
                                to_string(Airframe::quadplane)};
static_assert(kAirframes.size() == static_cast<std::size_t>(Airframe::count));
/// Of formations: a quadplane flies in those of planes.
constexpr std::array kFormationAirframes{to_string(Airframe::plane), to_string(Airframe::copter)};
constexpr std::array<std::string_view, static_cast<std::size_t>(TakeOverKind::count)> kTakeOvers{
    "when_guided", "in_flight", "from_ground"};
constexpr std::array<std::string_view, 2> kDecisions{"refuse", "grant"};
constexpr double kPlaneTurnMax_mps2 = 59.0;
constexpr Range kPort{1.0, 65535.0};
constexpr std::int64_t kYear2020_unix_ns = 1'577'836'800'000'000'000;
constexpr double kCopterHeightMin_m = 5.0;

template <class Choice, std::size_t Count>
void choice_of(FieldVisitor& v, const Field& field,
               const std::array<std::string_view, Count>& names, Choice& value) {
  auto index = static_cast<std::size_t>(value);
  v.choice(field, names, index);
  value = static_cast<Choice>(index);
}

}  // namespace

void task_kinds(FieldVisitor& v, const Field& field, Capabilities& value) {
  std::vector<std::size_t> kinds;
  for (std::size_t k = 0; k < kTaskKinds.size(); ++k) {
    if (value.has(static_cast<TaskKind>(k))) kinds.push_back(k);
  }
  v.list(field, list_of(kinds, kTaskKinds.size(), [](FieldVisitor& inner, std::size_t& kind) {
           inner.choice({}, kTaskKinds, kind);
         }));
  value = {};
  for (const std::size_t kind : kinds) value.add(static_cast<TaskKind>(kind));
}

void flight_controller_fields(FieldVisitor& v, FlightControllerConfig& config, Airframe& airframe,
                              bool bus_required) {
  const Range node{1.0, 127.0};
  ArdupilotConfig& fc = config.ardupilot;
  choice_of(v, {"kind", "what flies the vehicle; the keys below `can` are for an ardupilot"},
            kFlightControllers, config.kind);
  choice_of(
      v,
      {"airframe",
       "plane: a fixed wing; copter: a multirotor, which takes off to its height_m and does what "
       "its capabilities say; without any it flies in formations; quadplane: a plane that rotors "
       "lift off and set down"},
      kAirframes, airframe);
  v.text({"can", bus_required ? "bus of an ardupilot: can0, vcan0, mcast:0"
                              : "bus of an ardupilot: vcan0, mcast:0; empty: the bench chooses bus "
                                "and nodes"},
         fc.can);
  whole(v, {"node_id", "of the autopilot on the bus: its CAN_D1_UC_NODE"}, node, fc.node_id);
  whole(v, {"companion_node_id", "of this companion: the autopilot's CAN_D1_UC_S1_NOD"}, node,
        fc.companion_node_id);
  whole(v, {"system_id", "of the autopilot: its SYSID_THISMAV; others are not heeded"},
        {1.0, 255.0}, fc.system_id);
  whole(v, {"serial_id", "of the tunnel: the autopilot's CAN_D1_UC_S1_IDX"}, {0.0, 15.0},
        fc.serial_id);
  v.text(
      {"signing_key",
       "path of the file with the key of MAVLink's signatures: 64 hexadecimal digits, or the "
       "passphrase that a ground station was given; its mode 600 or 400. Packets are signed, and "
       "unsigned ones not heeded. Empty: neither"},
      fc.signing_key);
  choice_of(v,
            {"take_over",
             "when the companion takes the aircraft: once its pilot switches to GUIDED; once it is "
             "in the air; or it arms and takes off itself"},
            kTakeOvers, fc.take_over);
  v.number({"takeoff_height_m", "above the ground, from_ground"}, {5.0, 1000.0, "m"},
           fc.takeoff_height_m);
  v.number({"geoid_height_m",
            "of the geoid above the ellipsoid at the origin: autopilots count heights from it"},
           {-120.0, 100.0, "m"}, fc.geoid_height_m);
  v.number({"turn_lead_s", "turns are begun so much earlier: the time that rolling takes"},
           {0.0, 5.0, "s"}, fc.turn_lead_s);
  v.number({"airspeed_lead_s",
            "changes of airspeed are begun so much earlier: the time that a plane takes"},
           {0.0, 10.0, "s"}, fc.airspeed_lead_s);
  v.require(!bus_required || config.kind != FlightControllerKind::ardupilot || !fc.can.empty(),
            "can", "an ardupilot needs a CAN bus; name one, such as can0 or mcast:0");
  v.require(fc.node_id != fc.companion_node_id, "companion_node_id",
            "is the autopilot's node_id too; every node on a bus has its own");
}

void version_field(FieldVisitor& v) {
  std::int64_t version = kVersion;
  v.integer({"version", "of this format; always 1", kRequired}, {0.0, 1e9}, version);
  v.require(version == kVersion, "version",
            "this program reads version 1 only; write 1 and compare the keys with the reference");
}

void origin_section(FieldVisitor& v, Wgs84& origin) {
  v.section({"origin", "of the mission frame: WGS84", kRequired}, [&origin](FieldVisitor& inner) {
    inner.number({"latitude_deg", "north positive", kRequired}, {-90.0, 90.0, "deg"},
                 origin.latitude_deg);
    inner.number({"longitude_deg", "east positive", kRequired}, {-180.0, 180.0, "deg"},
                 origin.longitude_deg);
    inner.number({"height_m", "above the ellipsoid"}, {-500.0, 9000.0, "m"}, origin.height_m);
  });
}

void wind_fields(FieldVisitor& v, WindConfig& wind, const std::string& prefix) {
  const std::string speed = prefix + "speed_mps";
  const std::string from = prefix + "from_deg";
  v.number({speed, "steady wind"}, {0.0, 60.0, "m/s"}, wind.speed_mps);
  compass(v, {from, "compass direction that the wind comes from"}, wind.from_rad);
  v.number({"gust_mps", "standard deviation of the gusts"}, {0.0, 20.0, "m/s"}, wind.gust_mps);
}

void pose_fields(FieldVisitor& v, Pose2& pose) {
  v.number({"east_m", "start position, east of the origin", kRequired}, kMetres, pose.x_m);
  v.number({"north_m", "start position, north of the origin", kRequired}, kMetres, pose.y_m);
  compass(v, {"heading_deg", "compass heading at the start", kRequired}, pose.heading_rad);
}

/// Steeper, a plane gains speed on its way down.
constexpr double kDescentMax = 0.12;

void landing_fields(FieldVisitor& v, LandingSpec& landing) {
  v.number({"east_m", "touch-down; without both, the start"}, kMetres, landing.x_m);
  v.number({"north_m", "touch-down"}, kMetres, landing.y_m);
  v.require(landing.x_m.has_value() == landing.y_m.has_value(), "east_m",
            "and north_m name a place together; give both, or none for the start");
  compass(v,
          {"heading_deg", "of a plane's final approach, into the wind; without, that of the start"},
          landing.heading_rad);
  v.number({"approach_m", "length of a plane's final approach"}, {50.0, 5000.0, "m"},
           landing.approach_m);
  v.number({"approach_height_m", "above home, where it begins"}, {5.0, 500.0, "m"},
           landing.approach_height_m);
  v.require(landing.approach_height_m <= kDescentMax * landing.approach_m, "approach_m",
            "is a descent steeper than 12 in 100; raise it to approach_height_m / 0.12 or more, or "
            "lower approach_height_m");
}

void spec_fields(FieldVisitor& v, VehicleSpec& spec) {
  id(v, {"id", "number of the vehicle, its own in the fleet; below 65001, and not 255", kRequired},
     spec.id);
  v.require(spec.id != mission::kSensors, "id", "is of the sensors; give the vehicle another");
  v.require(!is_station(spec.id), "id", "is of a ground station; give the vehicle one below 65001");
  v.number({"cruise_speed_mps", "speed that paths are planned at", kRequired}, {1.0, 200.0, "m/s"},
           spec.cruise_speed_mps);
  v.number({"speed_min_mps", "least airspeed", kRequired}, {0.5, 200.0, "m/s"}, spec.speed_min_mps);
  v.number({"speed_max_mps", "greatest airspeed", kRequired}, {1.0, 300.0, "m/s"},
           spec.speed_max_mps);
  v.require(
      spec.speed_min_mps <= spec.cruise_speed_mps && spec.cruise_speed_mps <= spec.speed_max_mps,
      "cruise_speed_mps", "must lie between speed_min_mps and speed_max_mps; mend one of them");
  v.number({"turn_radius_m", "least turn radius, at cruise speed", kRequired}, {1.0, 5000.0, "m"},
           spec.turn_radius_m);
  v.number(
      {"turn_radius_margin",
       "paths are planned at this many times the turn radius; to be held in wind w at speed v it "
       "takes (v / (v - w))^2"},
      {1.0, 3.0}, spec.turn_radius_margin);
  v.number({"acceleration_max_mps2", "of a copter, horizontal: what its turns may take"},
           {0.1, 20.0, "m/s2"}, spec.acceleration_max_mps2);
  v.number({"heading_gain_per_s", "of the autopilot: turn rate per radian of heading error"},
           {0.05, 20.0, "1/s"}, spec.heading_gain_per_s);
  v.number({"range_m", "distance that the vehicle can fly", kRequired}, {100.0, 1e7, "m"},
           spec.range_m);
  v.number(
      {"battery_reserve_percent",
       "kept in the battery, where the flight controller tells how full that is: range_m is what "
       "a full one flies down to it, until flying has shown how far it does"},
      {0.0, 90.0, "%"}, spec.battery_reserve_percent);
  auto recovery = static_cast<std::size_t>(spec.recovery);
  v.choice({"recovery",
            "where the flight ends: `home`, its start, for which it keeps enough of its range, or "
            "`anywhere`, where its range ends; there it lands without an order, a plane on an "
            "ArduPilot only at home and where all of `landing`'s place and heading are given"},
           kRecoveries, recovery);
  spec.recovery = static_cast<Recovery>(recovery);
  task_kinds(v, {"capabilities", "tasks that the vehicle can do", kRequired}, spec.capabilities);
  v.number({"sensor_radius_m", "detects sites within it and surveys on a circle of it"},
           {0.0, 20000.0, "m"}, spec.sensor_radius_m);
  v.number({"assess_radius_m", "assesses on a circle of it"}, {0.0, 20000.0, "m"},
           spec.assess_radius_m);
  whole(v, {"loads", "deliveries on board"}, {0.0, 255.0}, spec.loads);
  v.number({"final_approach_m", "straight run into a delivery"}, {0.0, 20000.0, "m"},
           spec.final_approach_m);
  v.number({"height_m", "the vehicle's layer, above the origin", kRequired}, {0.0, 10000.0, "m"},
           spec.height_m);
  v.section({"landing", "where it lands, by the operator's order"},
            [&spec](FieldVisitor& inner) { landing_fields(inner, spec.landing); });
}

void turn_rules(FieldVisitor& v, const VehicleSpec& spec, const std::string& prefix) {
  const bool flies_plans = spec.is_copter() && !flies_formation(spec);
  const double turn_mps2 = spec.cruise_speed_mps * spec.cruise_speed_mps / spec.turn_radius_m;
  v.require(!flies_plans || turn_mps2 <= spec.acceleration_max_mps2 * (1.0 + 1e-9),
            prefix + "turn_radius_m",
            "is less than cruise_speed_mps^2 / acceleration_max_mps2, which a copter's turn takes; "
            "raise it or lower cruise_speed_mps");
  const bool unread = spec.turn_radius_m <= 0.0;  // which is told already
  v.require(spec.is_copter() || unread || turn_mps2 <= kPlaneTurnMax_mps2, prefix + "turn_radius_m",
            "is less than cruise_speed_mps^2 / 59 m/s2, a turn of 6 g; raise it or lower "
            "cruise_speed_mps");
  const bool lower = spec.landing.approach_height_m < spec.height_m;
  const bool given = spec.landing.approach_height_m != LandingSpec{}.approach_height_m;
  v.require(spec.is_copter() || lower || !given, prefix + "landing.approach_height_m",
            "is not below height_m, from which a plane comes down to it; lower it or raise "
            "height_m");
  v.require(!flies_plans || spec.height_m >= kCopterHeightMin_m, prefix + "height_m",
            "is below 5 m, and a copter takes off to it; raise it");
}

void search_list(FieldVisitor& v, std::vector<Vec2>& search) {
  v.list({"search", "points of the search route; the vehicle orbits the last one"},
         list_of(search, kListMax,
                 [](FieldVisitor& inner, Vec2& point) { inner.point({}, kMetres, point); }));
}

void fence_section(FieldVisitor& v, Fence& fence) {
  v.section({"fence", "where vehicles may be; what happens at it: docs/protocol.md"},
            [&fence](FieldVisitor& inner) {
              inner.list(
                  {"corners", "of a polygon whose edges do not cross; none: no fence"},
                  list_of(fence.corners, Fence::kCornersMax, [](FieldVisitor& point, Vec2& corner) {
                    point.point({}, kMetres, corner);
                  }));
              inner.number({"height_max_m", "above the origin"}, {10.0, 10'000.0, "m"},
                           fence.height_max_m);
              inner.require(fence.corners.empty() || fence.corners.size() >= 3, "corners",
                            "has fewer than three corners; give the polygon's, or none");
              inner.require(fence.corners.size() < 3 || is_simple_polygon(fence.corners), "corners",
                            "crosses or touches itself; give its corners in the order in which one "
                            "walks around it");
            });
}

/// What lies outside the fence is a mistake of the file.
void fence_rules(FieldVisitor& v, const VehicleConfig& config) {
  const Fence& fence = config.fence;
  if (fence.corners.size() < 3) return;
  v.require(fence.inside_m(config.start.position()) > 0.0, "start",
            "is outside the fence; move it, or widen fence.corners");
  const auto inside = [&fence](const Vec2& point) { return fence.inside_m(point) > 0.0; };
  v.require(std::ranges::all_of(config.search, inside), "search",
            "has a point outside the fence; move it, or widen fence.corners");
  const double radius_m = config.vehicle.planning_radius_m();
  const auto flown_over = [&](const Vec2& point) {
    return planning::can_be_flown_over(fence, point, radius_m);
  };
  v.require(
      !std::ranges::all_of(config.search, inside) || std::ranges::all_of(config.search, flown_over),
      "search",
      "has a point in a corner of the fence where the vehicle cannot turn within it "
      "(vehicle.turn_radius_m * turn_radius_margin); move it, or widen fence.corners");
  const auto route = timed_path(config.route, config.vehicle);
  v.require(!route || !*route || !planning::first_outside(fence, **route), "route",
            "leads out of the fence, the circle beyond its end included; plan it anew, or widen "
            "fence.corners");
  v.require(config.vehicle.height_m < fence.height_max_m, "vehicle.height_m",
            "is not below fence.height_max_m; lower it or raise that");
}

void hazard_fields(FieldVisitor& v, Hazard& hazard) {
  id(v, {"id", "number of the hazard, its own", kRequired}, hazard.id);
  v.number({"east_m", "centre", kRequired}, kMetres, hazard.centre.x());
  v.number({"north_m", "centre", kRequired}, kMetres, hazard.centre.y());
  v.number({"radius_m", "no path enters it", kRequired}, {1.0, 1e5, "m"}, hazard.radius_m);
}

namespace {

void separation_fields(FieldVisitor& v, coalition::ProtocolParams& p) {
  v.number({"separation_horizontal_m",
            "in flight, two vehicles that will be closer than this and less than "
            "separation_vertical_m apart in height are warned of, and one of them gives way"},
           {1.0, 1000.0, "m"}, p.separation_horizontal_m);
  v.number({"separation_vertical_m",
            "and who gives way leaves its height by 2 m more; less than the layers of the vehicles "
            "are apart, by 3 m or more"},
           {1.0, 1000.0, "m"}, p.separation_vertical_m);
  seconds(v, {"separation_look_ahead_s", "so far ahead that is looked at; 0: it is not"},
          {0.0, 120.0, "s"}, p.separation_look_ahead);
  v.number({"separation_floor_m",
            "above the origin: nobody gives way downwards to less; ground and trees below count "
            "from there"},
           {0.0, 10000.0, "m"}, p.separation_floor_m);
  v.number({"separation_ceiling_m", "nobody gives way upwards to more"}, {1.0, 20000.0, "m"},
           p.separation_ceiling_m);
  v.require(p.separation_floor_m < p.separation_ceiling_m, "separation_ceiling_m",
            "must be above separation_floor_m; mend one of them");
}

}  // namespace

void protocol_fields(FieldVisitor& v, coalition::ProtocolParams& p) {
  const Range short_time{0.001, 60.0, "s"};
  const Range long_time{0.1, 600.0, "s"};
  v.number({"radio_range_m", "a bidder stays within it of the leader until the coalition stands"},
           {10.0, 1e6, "m"}, p.radio_range_m);
  v.number(
      {"relay_orbit_m",
       "relay orbits: free vehicles stay this near to a site whose leader lacks vehicles; half "
       "of a radio's range does well; 0: they search on"},
      {0.0, 1e6, "m"}, p.relay_orbit_m);
  seconds(v, {"message_delay_s", "longest delay of a message"}, short_time, p.message_delay);
  seconds(v, {"allocation_time_s", "time to allocate the tasks"}, short_time, p.allocation_time);
  seconds(v, {"formation_margin_s", "margin in the time to form a coalition"}, {0.0, 60.0, "s"},
          p.margin);
  seconds(v, {"lease_s", "how far one renewal reaches"}, long_time, p.lease);
  seconds(v, {"heartbeat_s", "of leader and members"}, long_time, p.heartbeat);
  seconds(v, {"silence_s", "after it a member counts as lost"}, long_time, p.silence);
  v.require(p.heartbeat < p.silence && p.silence < p.lease, "silence_s",
            "must be longer than heartbeat_s and shorter than lease_s; mend one of them");
  seconds(v, {"clock_guard_s", "largest difference of two clocks"}, {0.0, 60.0, "s"},
          p.clock_guard);
  seconds(v,
          {"cut_max_s",
           "longest that parts of the team may work without hearing each other; after it a lost "
           "leader's site is taken up anew"},
          long_time, p.cut_max);
  seconds(v, {"monitoring_interval_s", "between two attempts of a leader to form a coalition"},
          long_time, p.monitoring_interval);
  seconds(v, {"authorisation_lead_s", "time that the operator has at least to decide"},
          {0.0, 600.0, "s"}, p.authorisation_lead);
  separation_fields(v, p);
}

namespace {

/// Of the shapes that need no points.
void rally_fields(FieldVisitor& v, formation::ShapeSpec& rally) {
  std::array<std::string_view, static_cast<std::size_t>(formation::ShapeKind::free)> kinds;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    kinds.at(i) = formation::to_string(static_cast<formation::ShapeKind>(i));
  }
  auto kind = static_cast<std::size_t>(rally.kind);
  v.choice({"shape", "in which vehicles gather"}, kinds, kind);
  rally.kind = static_cast<formation::ShapeKind>(kind);
  v.number({"spacing_m", "between neighbours"}, {0.5, 1000.0, "m"}, rally.spacing_m);
  compass(v, {"heading_deg", "compass direction that it faces"}, rally.heading_rad);
  v.number({"east_m", "centre"}, kMetres, rally.centre.x());
  v.number({"north_m", "centre"}, kMetres, rally.centre.y());
  v.number({"height_m", "centre, above the origin"}, {1.0, 1000.0, "m"}, rally.centre.z());
}

void formation_fields(FieldVisitor& v, FormationConfig& f) {
  std::size_t planes = f.planes ? 0 : 1;
  v.choice({"airframe",
            "what flies it: multirotors, from place to place; or planes, along tracks: of them "
            "the keys rally, speeds and accelerations, reserve_m, assignment and avoidance are not "
            "read"},
           kFormationAirframes, planes);
  f.planes = planes == 0;
  v.section({"rally", "where vehicles gather, and wait that have no place"},
            [&f](FieldVisitor& inner) { rally_fields(inner, f.rally); });
  v.number({"speed_mps", "of whoever has the longest way"}, {0.1, 30.0, "m/s"}, f.limits.speed_mps);
  v.number({"acceleration_mps2", "greatest, at starts, stops and turns"}, {0.1, 20.0, "m/s2"},
           f.limits.acceleration_mps2);
  v.number({"jerk_mps3", "greatest, at starts and stops"}, {0.1, 100.0, "m/s3"},
           f.limits.jerk_mps3);
  v.require(f.limits.speed_mps <= formation::kStopWithin_s * f.limits.acceleration_mps2,
            "speed_mps", "could not be braked from in 6 s; lower it or raise acceleration_mps2");
  v.number({"separation_m", "least distance of two vehicles, to the side"}, {0.2, 100.0, "m"},
           f.separation.horizontal_m);
  v.number({"vertical_separation_m", "and straight above each other: a rotor's wake goes down"},
           {0.2, 100.0, "m"}, f.separation.vertical_m);
  v.number({"tracking_m", "how far a vehicle may be from where it is to be, in gusts"},
           {0.05, 20.0, "m"}, f.tracking_m);
  v.number({"reserve_m", "planned beyond separation and tracking, for vehicles that are late"},
           {0.1, 50.0, "m"}, f.reserve_m);
  v.number({"ceiling_m", "nobody is led above it"}, {1.0, 1000.0, "m"}, f.ceiling_m);
  v.number({"place_tolerance_m", "to be in place"}, {0.01, 50.0, "m"}, f.place_tolerance_m);
  v.number({"wind_mps",
            "that the airspeeds of planes leave room for, with gusts, and what corrections take"},
           {0.0, 60.0, "m/s"}, f.wind_mps);
  std::array<std::string_view, static_cast<std::size_t>(formation::PlaceMethod::count)> methods;
  for (std::size_t i = 0; i < methods.size(); ++i) {
    methods.at(i) = formation::to_string(static_cast<formation::PlaceMethod>(i));
  }
  auto method = static_cast<std::size_t>(f.assignment);
  v.choice({"assignment", "method by which vehicles are given places"}, methods, method);
  f.assignment = static_cast<formation::PlaceMethod>(method);
  std::array<std::string_view, static_cast<std::size_t>(formation::Avoidance::count)> avoidances;
  for (std::size_t i = 0; i < avoidances.size(); ++i) {
    avoidances.at(i) = formation::to_string(static_cast<formation::Avoidance>(i));
  }
  auto avoidance = static_cast<std::size_t>(f.avoidance);
  v.choice({"avoidance",
            "how vehicles keep clear of each other in a change; the field is the published one, "
            "to compare with, and guarantees nothing"},
           avoidances, avoidance);
  f.avoidance = static_cast<formation::Avoidance>(avoidance);
  v.list({"shapes", "free shapes that orders can name"},
         groups_of(f.shapes, kListMax, [](FieldVisitor& inner, NamedShape& shape) {
           inner.text({"name", "as in `form NAME`", kRequired}, shape.name);
           inner.text({"file", "its points; in a scenario relative to the scenario", kRequired},
                      shape.file);
         }));
  v.list({"tracks", "that planes fly along, and orders can name"},
         groups_of(f.tracks, kListMax, [](FieldVisitor& inner, NamedTrack& track) {
           inner.text({"name", "as in `fly-along NAME in wedge`", kRequired}, track.name);
           inner.text({"file", "its waypoints; in a scenario relative to the scenario", kRequired},
                      track.file);
         }));
  v.list({"script",
          "orders as the operator would type them, one after the other; without any the "
          "operator types them"},
         list_of(f.script, kListMax,
                 [](FieldVisitor& inner, std::string& line) { inner.text({}, line); }));
}

}  // namespace

void planning_fields(FieldVisitor& v, planning::AllocationParams& p) {
  const Range weight{0.0, 1000.0};
  std::array<std::string_view, static_cast<std::size_t>(planning::AllocationMethod::count)> methods;
  for (std::size_t i = 0; i < methods.size(); ++i) {
    methods[i] = planning::to_string(static_cast<planning::AllocationMethod>(i));
  }
  auto method = static_cast<std::size_t>(p.method);
  v.choice({"allocation", "method by which a leader gives its site's tasks to the bidders"},
           methods, method);
  p.method = static_cast<planning::AllocationMethod>(method);
  v.number(
      {"reward_weight", "of the reward, as a share of what could be had, in the value of a plan"},
      weight, p.weights.reward);
  v.number({"range_weight", "of the range that the bidders have left, as a share of what they had"},
           weight, p.weights.range);
  v.number({"timing_weight", "of the timing errors, as a share of timing_reference_s a task"},
           weight, p.weights.timing);
  seconds(v, {"timing_reference_s", "timing error of a task that counts as 1"},
          {0.001, 3600.0, "s"}, p.weights.timing_reference);
}

void formation_section(FieldVisitor& v, FormationConfig& formation) {
  v.section(
      {"formation", "how multirotors, or planes, fly in formation; the same for the whole team"},
      [&formation](FieldVisitor& inner) { formation_fields(inner, formation); });
}

void operator_decisions_list(FieldVisitor& v, std::vector<OperatorDecision>& decisions) {
  v.list({"operator_decisions",
          "taken by the script in the operator's place; without any the operator types them"},
         groups_of(decisions, kListMax, [](FieldVisitor& inner, OperatorDecision& decision) {
           id(inner, {"site", "that the decision is for", kRequired}, decision.site);
           std::size_t grant = decision.grant ? 1 : 0;
           inner.choice({"decision", "on the request", kRequired}, kDecisions, grant);
           decision.grant = grant == 1;
           seconds(inner, {"reaction_s", "from the request to the decision"}, kSeconds,
                   decision.reaction);
           seconds(inner, {"not_before_s", "mission time before which nothing is decided"},
                   kSeconds, decision.not_before);
         }));
}

void ipv4(FieldVisitor& v, const Field& field, std::string& address) {
  v.text(field, address);
  in_addr parsed{};
  const bool read = inet_pton(AF_INET, address.c_str(), &parsed) == 1;
  v.require(read, field.key, "is no IPv4 address; write one such as 192.168.1.7");
  constexpr std::uint32_t kFirstGroup = 224U << 24U;
  const std::uint32_t number = ntohl(parsed.s_addr);
  v.require(!read || (number != 0 && number < kFirstGroup), field.key,
            "is of no one machine; write the machine's own");
}

namespace {

bool is_address(const std::string& text) {
  in6_addr parsed{};
  return inet_pton(AF_INET, text.c_str(), &parsed) == 1 ||
         inet_pton(AF_INET6, text.c_str(), &parsed) == 1;
}

}  // namespace

void air_fields(FieldVisitor& v, AirConfig& air) {
  v.text({"group",
          "IPv4 address where all listen: of a multicast or a broadcast; everything is said once, "
          "for all who hear it"},
         air.group);
  in_addr group{};
  v.require(inet_pton(AF_INET, air.group.c_str(), &group) == 1, "group",
            "is no IPv4 address; write one such as 239.255.83.1");
  v.number({"limit_bytes_per_s",
            "of the air that a node may take, headers included; 0: no limit. Where it is too "
            "little reports give way first, then what people look at, then telemetry"},
           {0.0, 1e9, "bytes/s"}, air.limit_bytes_per_s);
  whole(v,
        {"hops_max",
         "how many nodes may say a message until it arrives, its author included; the same for the "
         "whole team. 1: none passes on what others say, for radios that all reach each other, or "
         "pass on themselves"},
        {1.0, 32.0}, air.hops_max);
}

namespace {

constexpr std::array<std::string_view, 2> kNetworkProcesses{"own", "same"};

void network_fields(FieldVisitor& v, NetworkConfig& network) {
  whole(v, {"domain_id", "tells teams apart that share a network"}, {0.0, 230.0},
        network.domain_id);
  ipv4(v, {"address", "IPv4 address of this node"}, network.address);
  whole(
      v,
      {"port", "UDP: of all nodes the same one, or, with `peers`, of this node, with the next one",
       kRequired},
      kPort, network.port);
  v.list(
      {"peers",
       "the nodes that this one may hear, by Fast DDS, which speaks to each by itself; none: all "
       "that are heard, by the air"},
      unique_groups_of(
          network.peers, kNodesMax,
          [](FieldVisitor& inner, NetworkPeer& peer) {
            id(inner, {"id", "of the vehicle; 0 is the ground station", kRequired}, peer.id, 0);
            ipv4(inner, {"address", "IPv4 address"}, peer.address);
            whole(inner, {"port", "UDP port", kRequired}, kPort, peer.port);
          },
          "peer", [](const NetworkPeer& peer) { return peer.id.value; }));
  air_fields(v, network.air);
  v.text({"keys", "folder of this node's keys; empty: it speaks in clear, on loopback only"},
         network.keys);
  v.text({"transport_plugin", "shared library that carries the messages; empty: plain UDP"},
         network.transport_plugin);
  std::size_t process = network.isolated ? 0 : 1;
  v.choice({"process",
            "where Fast DDS runs: in one of its `own`, so that a fault of it costs the "
            "network for less than a second, or in the `same`, which takes a seventh "
            "less of a machine with many nodes"},
           kNetworkProcesses, process);
  network.isolated = process == 0;
}

void process_fields(FieldVisitor& v, NetworkConfig& network, TimeConfig& time,
                    std::string& recording_folder, std::uint32_t& recording_limit_mb) {
  v.section({"network", "the mission network", kRequired},
            [&network](FieldVisitor& inner) { network_fields(inner, network); });
  v.section({"time", "mission time", kRequired}, [&time](FieldVisitor& inner) {
    inner.integer(
        {"epoch_unix_ns", "mission time zero, Unix time; the same for the whole fleet", kRequired},
        {1.0, 9e18, "ns"}, time.epoch_unix_ns);
    // Of a clock without a battery, or a number in seconds.
    inner.require(time.epoch_unix_ns >= kYear2020_unix_ns, "epoch_unix_ns",
                  "is before the year 2020; write Unix time in nanoseconds, as `date +%s%N` prints "
                  "it");
    inner.number({"rate", "mission seconds in a second"}, {0.01, 100.0}, time.rate);
  });
  v.text({"recording_folder", "where the process writes what happened; empty: nowhere"},
         recording_folder);
  whole(v,
        {"recording_limit_mb", "size of what is kept: the newest half of it, at least, always is"},
        {2.0, 1e6, "MB"}, recording_limit_mb);
}

bool is_plain(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_';
  });
}

/// What a browser or a player opens, and no script: of one of these schemes, with a host, in
/// printable characters that no address has to escape.
bool is_video_url(const std::string& url) {
  constexpr std::size_t kUrlMax = 500;
  const bool plain = std::ranges::all_of(
      url, [](unsigned char c) { return c > ' ' && c < 0x7F && c != '"' && c != '<' && c != '>'; });
  if (!plain || url.size() > kUrlMax) return false;
  return std::ranges::any_of(std::array<std::string_view, 3>{"http://", "https://", "rtsp://"},
                             [&url](std::string_view scheme) {
                               if (!url.starts_with(scheme) || url.size() == scheme.size())
                                 return false;
                               const char host = url[scheme.size()];
                               return std::isalnum(static_cast<unsigned char>(host)) != 0 ||
                                      host == '[';
                             });
}

void video_fields(FieldVisitor& v, ConsoleConfig::Video& video) {
  id(v, {"vehicle", "whose pictures they are", kRequired}, video.vehicle);
  v.text({"url", "where they are: http, https or rtsp; opened by the operator's browser alone",
          kRequired},
         video.url);
  v.require(is_video_url(video.url), "url",
            "is no address of pictures; write one such as rtsp://192.168.1.23/stream or "
            "https://camera.example/3");
}

void console_fields(FieldVisitor& v, ConsoleConfig& config) {
  whole(v, {"port", "where it is served; 0: not at all"}, {0.0, 65535.0}, config.port);
  v.text({"address", "any but 127.0.0.1 or ::1 needs passwords, certificate and key"},
         config.address);
  v.require(is_address(config.address), "address",
            "is no address; write one such as 127.0.0.1, 192.168.1.7 or ::1");
  v.text({"passwords",
          "file of who may use it, with lines as 'skein-ground password NAME' makes "
          "them, its mode 600 or 640; empty: who knows the token that 'skein-ground tell console' "
          "prints"},
         config.passwords);
  v.text({"certificate", "PEM file; with it the page is served by HTTPS"}, config.certificate);
  v.text({"key", "PEM file of the certificate's key"}, config.key);
  v.text({"tiles", "map: a folder z/x/y.png (jpg, webp) or an MBTiles file; empty: a metric grid"},
         config.tiles);
  v.list({"overlays", "drawn on the map"},
         groups_of(
             config.overlays, kListMax, [](FieldVisitor& inner, ConsoleConfig::Overlay& overlay) {
               inner.text({"name", "what the map calls it; of letters, digits, - and _", kRequired},
                          overlay.name);
               inner.require(
                   is_plain(overlay.name), "name",
                   "may have letters, digits, - and _ only; it becomes part of an address");
               inner.text({"file", "GeoJSON, WGS84", kRequired}, overlay.file);
             }));
  v.list({"groups", "of vehicles, that every operator can select by name or key"},
         groups_of(config.groups, kListMax, [](FieldVisitor& inner, ConsoleConfig::Group& group) {
           inner.text({"name", "what the page calls it, 24 characters at most", kRequired},
                      group.name);
           inner.require(!group.name.empty() && group.name.size() <= 24, "name",
                         "has 1 to 24 characters");
           ids(inner, {"vehicles", "their ids", kRequired}, group.vehicles, "vehicle");
         }));
  v.list({"videos", "of vehicles, as links in their details"},
         unique_groups_of(config.videos, kListMax, video_fields, "vehicle",
                          [](const ConsoleConfig::Video& video) { return video.vehicle.value; }));
  v.require(config.certificate.empty() == config.key.empty(), "key",
            "a certificate needs its key, and a key its certificate; give both or neither");
}

void operator_fields(FieldVisitor& v, OperatorConfig& config) {
  v.text({"name", "as `skein-ground mission operator NAME` made it"}, config.name);
  v.text({"password_file", "its first line is the password; its mode is 600"},
         config.password_file);
  v.require(config.name.empty() == config.password_file.empty(), "password_file",
            "an operator needs the file of the password, and a password its operator; give both or "
            "neither");
}

constexpr std::array<std::string_view, 2> kCommandRoles{"commanding", "watching"};

void command_fields(FieldVisitor& v, CommandConfig& config) {
  whole(v,
        {"station",
         "number of this one of several ground stations, of which one has the command; 0: there is "
         "no other"},
        {0.0, double{kStationsMax}}, config.station);
  v.text({"name", "by which the operators of the others know it; empty: ground station N"},
         config.name);
  v.require(config.name.size() <= 32, "name", "is longer than 32 bytes; shorten it");
  std::size_t watches = config.watches ? 1 : 0;
  v.choice({"role",
            "commanding: it takes the command where it hears for 3 s that nobody has it; watching: "
            "its operator takes it (`take command`)"},
           kCommandRoles, watches);
  config.watches = watches == 1;
}

void coalition_sections(FieldVisitor& v, coalition::ProtocolParams& protocol,
                        planning::AllocationParams& planning) {
  v.section({"protocol", "the contract net; the same for the whole fleet"},
            [&protocol](FieldVisitor& inner) { protocol_fields(inner, protocol); });
  v.section({"planning", "how tasks are given to vehicles; the same for the whole fleet"},
            [&planning](FieldVisitor& inner) { planning_fields(inner, planning); });
}

}  // namespace

void console_section(FieldVisitor& v, ConsoleConfig& config) {
  v.section({"console", "the page for the operator's browser"},
            [&config](FieldVisitor& inner) { console_fields(inner, config); });
}

bool flies_formation(const VehicleSpec& vehicle) {
  return vehicle.is_copter() && vehicle.capabilities == Capabilities{};
}

void fields(FieldVisitor& v, VehicleConfig& config) {
  version_field(v);
  v.section({"vehicle", "what it is", kRequired},
            [&config](FieldVisitor& inner) { spec_fields(inner, config.vehicle); });
  origin_section(v, config.origin);
  v.section({"start", "where it starts", kRequired},
            [&config](FieldVisitor& inner) { pose_fields(inner, config.start); });
  search_list(v, config.search);
  flight_route_section(v, config.route);
  v.section({"flight_controller", "what flies it"}, [&config](FieldVisitor& inner) {
    flight_controller_fields(inner, config.flight_controller, config.vehicle.airframe, true);
    wind_fields(inner, config.flight_controller.wind, "wind_");
  });
  turn_rules(v, config.vehicle, "vehicle.");
  coalition_sections(v, config.protocol, config.planning);
  traffic_section(v, config.traffic);
  remote_id_section(v, config.remote_id);
  v.require(!config.remote_id.required ||
                config.flight_controller.kind == FlightControllerKind::ardupilot,
            "remote_id.required", "asks an ardupilot's transmitter; leave it out for the others");
  v.require(!config.remote_id.required || config.flight_controller.ardupilot.signing_key.empty(),
            "remote_id.required",
            "would wait in vain: the transmitter's word comes through the autopilot unsigned, and "
            "with flight_controller.signing_key that is not heeded; leave one of them out");
  v.list({"hazards", "known before the mission"},
         unique_groups_of(config.hazards, kListMax, hazard_fields, "hazard",
                          [](const Hazard& hazard) { return hazard.id.value; }));
  fence_section(v, config.fence);
  fence_rules(v, config);
  v.section({"detections", "what detectors on this machine tell"}, [&config](FieldVisitor& inner) {
    inner.text({"socket",
                "path of the Unix datagram socket where they tell it (docs/detections.md), such as "
                "/run/skein/detections-3.sock; empty: nowhere"},
               config.detections_socket);
  });
  formation_section(v, config.formation);
  process_fields(v, config.network, config.time, config.recording_folder,
                 config.recording_limit_mb);
  whole(v, {"seed", "of the vehicle's generators"}, {0.0, 9e18}, config.seed);
}

void fields(FieldVisitor& v, GroundConfig& config) {
  version_field(v);
  origin_section(v, config.origin);
  ids(v, {"vehicles", "ids of the fleet that is expected", kRequired}, config.vehicles, "vehicle");
  operator_decisions_list(v, config.operator_decisions);
  coalition_sections(v, config.protocol, config.planning);
  traffic_section(v, config.traffic);
  v.list({"hazards", "known before the mission, for the map"},
         unique_groups_of(config.hazards, kListMax, hazard_fields, "hazard",
                          [](const Hazard& hazard) { return hazard.id.value; }));
  fence_section(v, config.fence);
  site_templates_list(v, config.site_templates);
  v.section({"detections", "of sites, by detectors on board"},
            [&config](FieldVisitor& inner) { detections_fields(inner, config.detections); });
  formation_section(v, config.formation);
  v.list({"planes",
          "what each can do, as in its own file: for formations of planes, and to search areas"},
         unique_groups_of(config.planes, kVehiclesMax, spec_fields, "vehicle",
                          [](const VehicleSpec& spec) { return spec.id.value; }));
  console_section(v, config.console);
  agencies_section(v, config.agencies);
  team_remote_id_section(v, config.remote_id);
  v.section({"command",
             "of one of several ground stations, of which one has the command and the others watch "
             "(docs/console.md)"},
            [&config](FieldVisitor& inner) { command_fields(inner, config.command); });
  v.section({"operator",
             "whose key signs what is authorised here, from the start on; else "
             "`skein-ground unlock` or a login at the console unlocks one"},
            [&config](FieldVisitor& inner) { operator_fields(inner, config.op); });
  v.text({"control_socket",
          "name of the Unix socket where `skein-ground tell` reaches it; empty: "
          "skein-ground-PORT"},
         config.control_socket);
  process_fields(v, config.network, config.time, config.recording_folder,
                 config.recording_limit_mb);
  v.require(config.command.station == 0 || config.network.peers.empty(), "command",
            "of several ground stations needs the air: leave network.peers out");
}

}  // namespace skein::configuration
