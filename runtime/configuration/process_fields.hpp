// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "field_types.hpp"
#include "skein/base/frames.hpp"
#include "skein/coalition/protocol_params.hpp"
#include "skein/configuration/formation_config.hpp"
#include "skein/configuration/ground_config.hpp"
#include "skein/configuration/remote_id_config.hpp"
#include "skein/configuration/routes_config.hpp"
#include "skein/configuration/site_config.hpp"
#include "skein/domain/traffic_params.hpp"
#include "skein/planning/allocation.hpp"

/// The parts that several tables share.
namespace skein::configuration {

struct PassingAircraft;
struct TaskingConfig;

inline constexpr int kVersion = 1;

void version_field(FieldVisitor& v);
void task_kinds(FieldVisitor& v, const Field& field, Capabilities& value);
void origin_section(FieldVisitor& v, Wgs84& origin);
void wind_fields(FieldVisitor& v, WindConfig& wind, const std::string& prefix);
/// `bus_required`: whether a flight controller on CAN must name its bus.
void flight_controller_fields(FieldVisitor& v, FlightControllerConfig& config, Airframe& airframe,
                              bool bus_required);
void pose_fields(FieldVisitor& v, Pose2& pose);
void spec_fields(FieldVisitor& v, VehicleSpec& spec);
/// What turns may take of a plane, and turns and height of a copter that takes tasks; after spec
/// and flight controller.
void turn_rules(FieldVisitor& v, const VehicleSpec& spec, const std::string& prefix);
/// Of the whole team.
void fence_section(FieldVisitor& v, Fence& fence);
void search_list(FieldVisitor& v, std::vector<Vec2>& search);
void hazard_fields(FieldVisitor& v, Hazard& hazard);
void site_fields(FieldVisitor& v, Site& site);
void site_templates_list(FieldVisitor& v, std::vector<SiteTemplate>& templates);
void detections_fields(FieldVisitor& v, DetectionsConfig& config);
void protocol_fields(FieldVisitor& v, coalition::ProtocolParams& protocol);
void planning_fields(FieldVisitor& v, planning::AllocationParams& planning);
void flight_route_fields(FieldVisitor& v, FlightRoute& route);
void flight_route_section(FieldVisitor& v, FlightRoute& route);
void routes_section(FieldVisitor& v, RoutesConfig& config);
void tasking_section(FieldVisitor& v, TaskingConfig& config);
void formation_section(FieldVisitor& v, FormationConfig& formation);
void ipv4(FieldVisitor& v, const Field& field, std::string& address);
void air_fields(FieldVisitor& v, AirConfig& air);
void agencies_section(FieldVisitor& v, AgenciesConfig& config);
void traffic_section(FieldVisitor& v, TrafficParams& params);
void traffic_fields(FieldVisitor& v, TrafficParams& params);
void passing_aircraft_list(FieldVisitor& v, std::vector<PassingAircraft>& aircraft);
void remote_id_section(FieldVisitor& v, RemoteId& config);
void team_remote_id_section(FieldVisitor& v, TeamRemoteId& team);
void console_section(FieldVisitor& v, ConsoleConfig& config);
void operator_decisions_list(FieldVisitor& v, std::vector<OperatorDecision>& decisions);

}  // namespace skein::configuration
