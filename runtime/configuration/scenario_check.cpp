// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "number_text.hpp"
#include "skein/base/geometry.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/planning/fence_check.hpp"

namespace skein::configuration {
namespace {

std::string rounded(double value) { return number_text(std::round(value * 10.0) / 10.0); }
std::string milliseconds(Duration d) { return rounded(static_cast<double>(d.count()) * 1e-6); }
std::string name(const ScenarioVehicle& v) { return "vehicle " + std::to_string(v.spec.id.value); }
std::string name(const Site& s) { return "site " + std::to_string(s.id.value); }
std::string name(const TimedHazard& h) { return "hazard " + std::to_string(h.hazard.id.value); }
std::string counted(std::size_t n, const std::string& one, const std::string& many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

/// Collects one sentence for each thing that no planner could mend.
class Check {
 public:
  explicit Check(const Scenario& scenario) : s_{scenario} {}

  Result<void> run() {
    check_numbers();
    for (const ScenarioVehicle& vehicle : s_.vehicles) check_vehicle(vehicle);
    check_heights();
    check_formation();
    check_copters_fly();
    check_buses();
    for (const Site& site : s_.sites) check_site(site);
    check_names();
    check_faults();
    if (problems_.empty()) return {};
    if (count_ > kProblemsMax) {
      problems_ += "\nand " + std::to_string(count_ - kProblemsMax) + " more of the kind";
    }
    return Error{problems_};
  }

 private:
  void problem(const std::string& sentence) {
    if (++count_ > kProblemsMax) return;
    if (!problems_.empty()) problems_ += '\n';
    problems_ += sentence;
  }

  void check_numbers() {
    if (s_.vehicles.empty()) problem("the fleet has no vehicle; add one under vehicles");
    if (s_.sites.empty() && !s_.flies_formation() && !s_.flies_routes())
      problem("the mission has no site; add one under sites");
    const Duration slowest = s_.radio.delay_mean + s_.radio.delay_jitter;
    if (slowest > s_.protocol.message_delay) {
      problem("the radio delays messages by up to " + milliseconds(slowest) +
              " ms, the protocol allows " + milliseconds(s_.protocol.message_delay) +
              " ms; lower radio.delay_ms_mean or raise protocol.message_delay_s");
    }
    if (s_.expect.coalitions > static_cast<int>(s_.sites.size())) {
      problem("expect.coalitions is " + std::to_string(s_.expect.coalitions) +
              ", but there are only " + counted(s_.sites.size(), "site", "sites") + "; lower it");
    }
  }

  /// Of a formation of planes.
  void check_planes() {
    for (const ScenarioVehicle& v : s_.vehicles) {
      if (!v.spec.is_copter()) continue;
      problem("formation.airframe is plane, and " + name(v) +
              " is a copter; fly them in two missions");
    }
    if (!s_.sites.empty()) {
      problem("planes in formation do no tasks at sites; take the sites away");
    }
    if (s_.flies_routes()) {
      problem("planes in formation fly by no planned routes; take the routes away");
    }
  }

  /// A mission is of coalitions or of a formation.
  void check_formation() {
    if (s_.flies_formation() && s_.ends == Ending::landed) {
      problem(
          "ends is landed, and vehicles fly in formation, which is not ordered home: copters end "
          "on "
          "the ground by 'land' in formation.script, planes by their pilots; leave ends out");
    }
    if (s_.formation.planes) return check_planes();
    if (!s_.formation.tracks.empty()) {
      problem("multirotors fly along no tracks; give formation airframe: plane, or take them away");
    }
    const auto in_formation = [](const ScenarioVehicle& v) { return flies_formation(v.spec); };
    const auto one = std::find_if(s_.vehicles.begin(), s_.vehicles.end(), in_formation);
    if (one == s_.vehicles.end()) {
      if (s_.formation.script.empty()) return;
      problem(
          "formation.script has orders, but no vehicle flies in formation; give vehicles "
          "flight_controller: {airframe: copter} and capabilities: []");
      return;
    }
    const std::string who = name(*one) + " is a copter without capabilities, which flies in ";
    if (!std::all_of(s_.vehicles.begin(), s_.vehicles.end(), in_formation)) {
      problem(who +
              "formation, and others do not; give it capabilities such as [survey, assess], or "
              "fly them in two missions");
    }
    if (!s_.sites.empty()) {
      problem(who +
              "formation and does no tasks at sites; give it capabilities such as [survey, "
              "assess], or take the sites away");
    }
    if (s_.flies_routes()) {
      problem(who + "formation and by no planned routes; take the routes away");
    }
  }

  /// A copter that takes tasks climbs where it stands to its height.
  void check_take_off(const ScenarioVehicle& copter) {
    const double wind_mps = s_.wind.speed_mps + s_.wind.gust_mps;
    if (copter.spec.cruise_speed_mps + wind_mps > copter.spec.speed_max_mps) {
      problem(name(copter) + " cannot keep its cruise_speed_mps " +
              rounded(copter.spec.cruise_speed_mps) + " m/s against the wind of " +
              rounded(wind_mps) + " m/s with gusts: its speed_max_mps is " +
              rounded(copter.spec.speed_max_mps) + " m/s; lower cruise_speed_mps or the wind");
    }
    for (const ScenarioVehicle& other : s_.vehicles) {
      if (&other == &copter) continue;
      if (!other.spec.is_copter() && other.spec.height_m < copter.spec.height_m) {
        problem(name(copter) + " would take off through the height of " + name(other) +
                ", a plane at " + rounded(other.spec.height_m) +
                " m; give copters a lower height_m than planes");
      }
      const double apart = (other.start.position() - copter.start.position()).norm();
      const bool once = other.spec.id < copter.spec.id;  // a pair is told of once
      if (other.spec.is_copter() && once && apart < s_.expect.separation_horizontal_m) {
        problem(name(other) + " and " + name(copter) + " take off only " + rounded(apart) +
                " m from each other, expect.separation_horizontal_m is " +
                rounded(s_.expect.separation_horizontal_m) + " m; move one's start");
      }
    }
    for (const RouteApproach& approach : s_.routes.approaches) {
      if (approach.vehicle != copter.spec.id) continue;
      problem("routes.approaches names " + name(copter) +
              ", a copter; routes are flown by planes: take its approach away");
    }
  }

  void check_vehicle(const ScenarioVehicle& v) {
    const VehicleSpec& spec = v.spec;
    const auto needs_arc = [&](TaskKind kind, double radius_m, const std::string& key) {
      if (!spec.capabilities.has(kind) || radius_m >= spec.planning_radius_m()) return;
      problem(name(v) + " cannot fly circles of its " + key + " " + rounded(radius_m) +
              " m: it turns on " + rounded(spec.planning_radius_m()) +
              " m (turn_radius_m * turn_radius_margin); raise " + key);
    };
    needs_arc(TaskKind::survey, spec.sensor_radius_m, "sensor_radius_m");
    needs_arc(TaskKind::assess, spec.assess_radius_m, "assess_radius_m");
    if (spec.capabilities.has(TaskKind::deliver) && spec.loads == 0) {
      problem(name(v) + " can deliver but has no loads; give it loads or take the capability away");
    }
    if (v.spec.is_copter() && !flies_formation(v.spec)) check_take_off(v);
    if (!v.spec.is_copter() && s_.wind.speed_mps + s_.wind.gust_mps >= spec.speed_min_mps) {
      problem(name(v) + " cannot hold its course: the wind of " +
              rounded(s_.wind.speed_mps + s_.wind.gust_mps) +
              " m/s with gusts reaches its speed_min_mps " + rounded(spec.speed_min_mps) +
              " m/s; lower the wind");
    }
    if (s_.fence.exists()) check_in_fence(v);
    for (const TimedHazard& h : s_.hazards) {
      if ((v.start.position() - h.hazard.centre).norm() < h.hazard.radius_m) {
        problem(name(v) + " starts inside " + name(h) + "; move one of them");
      }
      for (const Vec2& point : v.search) {
        if ((point - h.hazard.centre).norm() < h.hazard.radius_m) {
          problem("the search route of " + name(v) + " has the point [" + rounded(point.x()) +
                  ", " + rounded(point.y()) + "] inside " + name(h) + "; move one of them");
        }
      }
    }
  }

  void check_in_fence(const ScenarioVehicle& v) {
    if (s_.fence.inside_m(v.start.position()) <= 0.0) {
      problem(name(v) + " starts outside the fence; move it, or widen fence.corners");
    }
    for (const Vec2& point : v.search) {
      const std::string it = "the search route of " + name(v) + " has the point [" +
                             rounded(point.x()) + ", " + rounded(point.y()) + "] ";
      const double radius_m = v.spec.planning_radius_m();
      if (s_.fence.inside_m(point) <= 0.0) {
        problem(it + "outside the fence; move it, or widen fence.corners");
      } else if (!planning::can_be_flown_over(s_.fence, point, radius_m)) {
        problem(it + "in a corner of the fence, where it cannot turn on " + rounded(radius_m) +
                " m (turn_radius_m * turn_radius_margin) within it; move it, or widen "
                "fence.corners");
      }
    }
    if (v.spec.height_m >= s_.fence.height_max_m) {
      problem(name(v) + " flies at " + rounded(v.spec.height_m) + " m, fence.height_max_m is " +
              rounded(s_.fence.height_max_m) + " m; lower its height_m or raise that");
    }
  }

  void check_heights() {
    for (std::size_t i = 0; i < s_.vehicles.size(); ++i) {
      for (std::size_t j = i + 1; j < s_.vehicles.size(); ++j) {
        if (flies_formation(s_.vehicles[i].spec) || flies_formation(s_.vehicles[j].spec)) continue;
        const double apart = std::abs(s_.vehicles[i].spec.height_m - s_.vehicles[j].spec.height_m);
        if (apart >= s_.expect.separation_vertical_m) continue;
        problem(name(s_.vehicles[i]) + " and " + name(s_.vehicles[j]) + " fly only " +
                rounded(apart) + " m apart in height, expect.separation_vertical_m is " +
                rounded(s_.expect.separation_vertical_m) + " m; give each its own height_m");
      }
    }
  }

  void check_copters_fly() {
    for (const TaskKind kind : {TaskKind::survey, TaskKind::deliver, TaskKind::assess}) {
      if (!s_.expect.copters_fly.has(kind)) continue;
      if (std::any_of(s_.vehicles.begin(), s_.vehicles.end(), [kind](const ScenarioVehicle& v) {
            return v.spec.is_copter() && v.spec.capabilities.has(kind);
          })) {
        continue;
      }
      problem("expect.copters_fly names " + std::string{to_string(kind)} +
              ", but no copter has it among its capabilities; give it to one or take it away");
    }
  }

  /// Can the vehicle get to the site at all, by the straight line?
  [[nodiscard]] bool reaches(const ScenarioVehicle& v, const Site& site) const {
    return (v.start.position() - site.position).norm() <= v.spec.range_m;
  }

  void check_site(const Site& site) {
    std::size_t surveyors = 0;
    std::size_t surveyors_in_range = 0;
    std::size_t deliverers = 0;
    std::size_t assessors = 0;
    std::size_t either = 0;
    for (const ScenarioVehicle& v : s_.vehicles) {
      const bool survey = v.spec.capabilities.has(TaskKind::survey);
      const double arc_m = v.spec.cruise_speed_mps * to_seconds(site.survey.dwell);
      const double way_m = (v.start.position() - site.position).norm() - v.spec.sensor_radius_m;
      surveyors += survey ? 1U : 0U;
      surveyors_in_range += survey && way_m + arc_m <= v.spec.range_m ? 1U : 0U;
      const bool deliver =
          v.spec.capabilities.has(TaskKind::deliver) && v.spec.loads > 0 && reaches(v, site);
      const bool assess = v.spec.capabilities.has(TaskKind::assess) && reaches(v, site);
      deliverers += deliver ? 1U : 0U;
      assessors += assess ? 1U : 0U;
      either += deliver || assess ? 1U : 0U;
    }
    const std::size_t d = site.deliveries.size();
    const std::size_t a = site.assessments.size();
    if (surveyors == 0) {
      problem(name(site) +
              " cannot be surveyed: no vehicle has the capability survey; give it to one");
    } else if (surveyors_in_range == 0) {
      problem(
          name(site) + " cannot be surveyed: none of the " +
          counted(surveyors, "vehicle", "vehicles") +
          " that can survey has the range to fly there and around it; raise range_m or move one");
    }
    if (deliverers < d) {
      problem(name(site) + " needs " + counted(d, "delivery", "deliveries") +
              ", but the whole fleet has only " + counted(deliverers, "vehicle", "vehicles") +
              " with the capability deliver, a load and the range; add vehicles or take deliveries "
              "away");
    }
    if (assessors < a) {
      problem(name(site) + " needs " + counted(a, "assessment", "assessments") +
              ", but the whole fleet has only " + counted(assessors, "vehicle", "vehicles") +
              " with the capability assess and the range; add vehicles or take assessments away");
    }
    if (deliverers >= d && assessors >= a && either < d + a) {
      problem(name(site) + " needs " + counted(d, "delivery", "deliveries") + " and " +
              counted(a, "assessment", "assessments") + ", one task a vehicle, but only " +
              counted(either, "vehicle", "vehicles") + " can do either; add vehicles");
    }
    check_hazards_of(site);
    if (s_.fence.exists() && s_.fence.inside_m(site.position) <= 0.0) {
      problem(name(site) + " is outside the fence; move it, or widen fence.corners");
    }
  }

  void check_hazards_of(const Site& site) {
    double approach_m = 0.0;  // the least among those who can deliver
    for (const ScenarioVehicle& v : s_.vehicles) {
      if (!v.spec.capabilities.has(TaskKind::deliver)) continue;
      approach_m = approach_m == 0.0 ? v.spec.final_approach_m
                                     : std::min(approach_m, v.spec.final_approach_m);
    }
    for (const TimedHazard& h : s_.hazards) {
      const Hazard& hazard = h.hazard;
      if ((site.position - hazard.centre).norm() < hazard.radius_m) {
        problem(name(site) + " lies inside " + name(h) + "; move one of them");
        continue;
      }
      for (const DeliveryRequirement& delivery : site.deliveries) {
        const Pose2 over{site.position.x(), site.position.y(), delivery.bearing_rad};
        const Pose2 entry = advance(over, 0.0, -approach_m);
        if (distance_to_piece(hazard.centre, entry, 0.0, approach_m) < hazard.radius_m) {
          problem("the final approach to " + name(site) + " on bearing " +
                  rounded(compass_deg_from_heading(delivery.bearing_rad)) + " deg crosses " +
                  name(h) + "; move one of them or change the bearing");
        }
      }
    }
  }

  [[nodiscard]] bool has_vehicle(VehicleId id) const {
    return std::any_of(s_.vehicles.begin(), s_.vehicles.end(),
                       [id](const ScenarioVehicle& v) { return v.spec.id == id; });
  }
  void need_vehicle(VehicleId id, const std::string& where) {
    if (!has_vehicle(id)) {
      problem(where + " names vehicle " + std::to_string(id.value) + ", which is not in the fleet");
    }
  }
  void need_site(SiteId id, const std::string& where) {
    if (std::none_of(s_.sites.begin(), s_.sites.end(),
                     [id](const Site& site) { return site.id == id; })) {
      problem(where + " names site " + std::to_string(id.value) + ", which is not among the sites");
    }
  }

  /// Node ids on a bus that the scenario names are the scenario's to keep apart.
  void check_buses() {
    std::map<std::pair<std::string, std::uint8_t>, std::string> taken;
    for (const ScenarioVehicle& v : s_.vehicles) {
      const ArdupilotConfig& fc = v.flight_controller.ardupilot;
      if (v.flight_controller.kind != FlightControllerKind::ardupilot || fc.can.empty()) continue;
      for (const std::uint8_t node : {fc.node_id, fc.companion_node_id}) {
        const auto [other, is_new] = taken.emplace(std::pair{fc.can, node}, name(v));
        if (!is_new) {
          problem(name(v) + " and " + other->second + " have node " + std::to_string(node) +
                  " on bus " + fc.can + "; give each node its own id");
        }
      }
    }
  }

  void check_names() {
    for (const OperatorDecision& d : s_.operator_decisions) need_site(d.site, "operator_decisions");
    for (const ReferenceSite& r : s_.reference) {
      need_site(r.site, "reference");
      if (r.found_by) need_vehicle(*r.found_by, "reference");
    }
    for (const RouteApproach& a : s_.routes.approaches)
      need_vehicle(a.vehicle, "routes.approaches");
    for (const SiteId id : s_.tasking.known) need_site(id, "tasking.known");
    for (const SiteId id : s_.tasking.optional) {
      if (std::ranges::find(s_.tasking.known, id) != s_.tasking.known.end()) continue;
      problem("tasking.optional has site " + std::to_string(id.value) +
              ", which is not known before take-off; add it to tasking.known");
    }
    if (!s_.tasking.optional.empty() && s_.tasking.criterion != planning::Criterion::value) {
      problem("tasking.optional is for the criterion reward; choose it or take the sites away");
    }
    if (s_.tasks_sites() && (s_.flies_routes() || s_.flies_formation())) {
      problem("a mission of routes or of a formation tasks no sites; take tasking.known away");
    }
    for (const SiteId id : s_.expect.first_attempt_fails)
      need_site(id, "expect.first_attempt_fails");
    for (const VehicleId id : s_.expect.vehicles_lost) need_vehicle(id, "expect.vehicles_lost");
  }

  void check_faults() {
    for (const Fault& fault : s_.faults) {
      const std::string at = "the fault at " + number_text(to_seconds(fault.at)) + " s";
      if (to_seconds(fault.at) >= to_seconds(s_.duration_max)) {
        problem(at + " comes after duration_max_s; move one of them");
      }
      const bool names_one = fault.kind == FaultKind::kill_vehicle ||
                             fault.kind == FaultKind::flood || fault.kind == FaultKind::battery;
      if (names_one && fault.vehicle != kGroundStation) {
        need_vehicle(fault.vehicle, at);
      }
      std::set<VehicleId> seen;
      for (const std::vector<VehicleId>& group : fault.groups) {
        for (const VehicleId id : group) {
          if (id != kGroundStation) need_vehicle(id, at);
          if (!seen.insert(id).second) {
            problem(at + " has vehicle " + std::to_string(id.value) +
                    " in two groups; leave it in one");
          }
        }
      }
    }
  }

  static constexpr std::size_t kProblemsMax = 20;

  const Scenario& s_;
  std::string problems_;
  std::size_t count_ = 0;
};

}  // namespace

bool Scenario::flies_formation() const {
  return formation.planes ||
         std::any_of(vehicles.begin(), vehicles.end(), [](const ScenarioVehicle& v) {
           return configuration::flies_formation(v.spec);
         });
}

Result<void> check(const Scenario& scenario) { return Check{scenario}.run(); }

}  // namespace skein::configuration
