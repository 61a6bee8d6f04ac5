// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/path.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mission/messages.hpp"

/// What every process writes while it flies and every judge reads afterwards: one folder a node
/// with three CSV files, each with a header line; the ground station of a formation has a fourth.
///
/// track.csv   time_s,x_m,y_m,z_m,heading_rad,course_rad,groundspeed_mps,airspeed_mps,
///             distance_flown_m,plan_number,along_error_m,cross_error_m
/// events.csv  time_ns,vehicle,kind,leader,instance,coalition,round,site,task,index,value,text
/// plans.csv   plan_number,since_ns,start_time_ns,speed_mps,tail_curvature_per_m,x_m,y_m,
///             heading_rad,segments          (segments: curvature_per_m:length_m|...)
/// places.csv  change,start_ns,vehicle,x_m,y_m,z_m
///
/// Times are mission time. The track is rounded (0.1 mm, 1e-7 rad); events and plans are exact.
namespace skein::recording {

/// How a vehicle flew, at one moment.
struct TrackPoint {
  VehicleState state;
  std::uint32_t plan_number = 0;  ///< of the plan that control followed then; 0 before the first
  double along_error_m = 0.0;     ///< positive when ahead of time
  double cross_error_m = 0.0;     ///< positive when left of the path
};

/// A flight plan, and when control began to follow it. It was in force until the next one's
/// `since`.
struct PlanRecord {
  std::uint32_t number = 0;
  Instant since{};
  TimedPath plan;
};

/// Where a vehicle is to be at the end of a change of formation.
struct PlaceRecord {
  std::uint32_t change = 0;
  Instant start{};
  VehicleId vehicle;
  Vec3 place_m = Vec3::Zero();
};

/// All that one node recorded.
struct Recording {
  VehicleId vehicle;  ///< kGroundStation for the ground station, which has events only
  std::vector<TrackPoint> track;
  std::vector<mission::MissionEvent> events;
  std::vector<PlanRecord> plans;
  std::size_t truncated_lines =
      0;  ///< last lines that were cut off and left out: a process ended abruptly
  std::vector<PlaceRecord> places = {};  ///< of the ground station
};

/// The name of a node's folder within the folder of a run: "vehicle-07", "ground".
[[nodiscard]] std::string folder_name(VehicleId vehicle);

}  // namespace skein::recording
