// SPDX-License-Identifier: Apache-2.0
#include "csv.hpp"

#include <fmt/format.h>

#include "skein/wording/wording.hpp"

namespace skein::recording_export {
namespace {

std::string quoted(const std::string& text) {
  std::string line = "\"";
  for (const char c : text) {
    if (c == '"') line += '"';
    line += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return line + '"';
}

std::int64_t ns(Instant t) { return t.time_since_epoch().count(); }

}  // namespace

std::string track_csv(const recording::Recording& flight) {
  std::string text =
      "time_s,x_m,y_m,z_m,heading_rad,course_rad,groundspeed_mps,airspeed_mps,distance_flown_m,"
      "plan_number,along_error_m,cross_error_m\n";
  for (const auto& point : flight.track) {
    const VehicleState& s = point.state;
    text += fmt::format("{:.9f},{},{},{},{},{},{},{},{},{},{},{}\n", to_seconds(s.time), s.x_m,
                        s.y_m, s.z_m, s.heading_rad, s.course_rad, s.groundspeed_mps,
                        s.airspeed_mps, s.distance_flown_m, point.plan_number, point.along_error_m,
                        point.cross_error_m);
  }
  return text;
}

std::string events_csv(const recording::Recording& flight) {
  std::string text = "time_ns,vehicle,kind,leader,instance,coalition,round,site,task,index,text\n";
  for (const auto& e : flight.events) {
    const coalition::CoalitionId& coalition = e.round.coalition;
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", ns(e.time), e.vehicle.value,
                        to_string(e.kind()), coalition.leader.value, coalition.instance.value,
                        coalition.number, e.round.number, e.task.site.value, to_string(e.task.kind),
                        e.task.index, quoted(wording::news_of(e)));
  }
  return text;
}

std::string plans_csv(const recording::Recording& flight) {
  std::string text =
      "plan_number,since_ns,start_time_ns,speed_mps,tail_curvature_per_m,x_m,y_m,heading_rad,"
      "segments\n";
  for (const auto& record : flight.plans) {
    const TimedPath& plan = record.plan;
    const Pose2& start = plan.path.start;
    text += fmt::format("{},{},{},{},{},{},{},{},", record.number, ns(record.since),
                        ns(plan.start_time), plan.speed_mps, plan.tail_curvature_per_m, start.x_m,
                        start.y_m, start.heading_rad);
    bool first = true;
    for (const Segment& segment : plan.path.segments) {
      text += fmt::format("{}{}:{}", first ? "" : "|", segment.curvature_per_m, segment.length_m);
      first = false;
    }
    text += '\n';
  }
  return text;
}

std::string places_csv(const recording::Recording& flight) {
  std::string text = "change,start_ns,vehicle,x_m,y_m,z_m\n";
  for (const auto& place : flight.places) {
    text += fmt::format("{},{},{},{},{},{}\n", place.change, ns(place.start), place.vehicle.value,
                        place.place_m.x(), place.place_m.y(), place.place_m.z());
  }
  return text;
}

}  // namespace skein::recording_export
