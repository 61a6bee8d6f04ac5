// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

#include "skein/checks/checks.hpp"
#include "skein/idl/autopilot_fields.hpp"
#include "skein/idl/coalition_fields.hpp"
#include "skein/idl/domain_fields.hpp"
#include "skein/idl/events_fields.hpp"

/// A small mission without fault, built by hand, for the tests to spoil.
namespace skein::checks::testing {

inline constexpr double kSpeed = 50.0;
inline constexpr SiteId kSite{1};
/// Leader and surveyor; two deliverers from west and south; an assessor.
inline constexpr VehicleId kSurveyor{1};
inline constexpr VehicleId kFromWest{2};
inline constexpr VehicleId kFromSouth{3};
inline constexpr VehicleId kAssessor{4};
inline constexpr TaskId kSurvey{kSite, TaskKind::survey, 0};
inline constexpr TaskId kEastward{kSite, TaskKind::deliver, 0};
inline constexpr TaskId kNorthward{kSite, TaskKind::deliver, 1};
inline constexpr TaskId kAssessment{kSite, TaskKind::assess, 0};
inline const coalition::Round kRound{{kSurveyor, InstanceId{77}, 1}, 1};

inline TimedPath plan_from(const Pose2& start, double start_s, const std::vector<Segment>& pieces) {
  TimedPath plan;
  plan.start_time = at_seconds(start_s);
  plan.speed_mps = kSpeed;
  plan.tail_curvature_per_m = 1.0 / 200.0;
  plan.path.start = start;
  for (const Segment& piece : pieces) plan.path.segments.push_back(piece);
  return plan;
}

/// The track of a vehicle that follows its plans exactly, at 20 Hz.
inline void fly(recording::Recording& recorded, double until_s, double height_m) {
  recorded.track.clear();
  for (int i = 0; i <= static_cast<int>(until_s * 20.0); ++i) {
    recording::TrackPoint point;
    point.state.time = at_seconds(i * 0.05);
    const auto next = std::find_if(recorded.plans.begin(), recorded.plans.end(),
                                   [&](const auto& p) { return p.since > point.state.time; });
    const auto& current = *(next - 1);
    const Pose2 pose = current.plan.pose_at(point.state.time);
    point.state.x_m = pose.x_m;
    point.state.y_m = pose.y_m;
    point.state.z_m = height_m;
    point.state.heading_rad = wrap_pi(pose.heading_rad);
    point.state.course_rad = point.state.heading_rad;
    point.state.groundspeed_mps = kSpeed;
    point.state.airspeed_mps = kSpeed;
    point.state.distance_flown_m = kSpeed * i * 0.05;
    point.plan_number = current.number;
    recorded.track.push_back(point);
  }
}

/// The moment that the event speaks of: when a lease ends, for when a task was planned.
inline void set_moment(mission::MissionEvent& event, double time_s) {
  const auto set = [time_s](auto /*name*/, auto& value) {
    if constexpr (std::is_same_v<decltype(value), Instant&>) value = at_seconds(time_s);
  };
  std::visit([&](auto& body) { codec::for_each_field(body, set); }, event.body);
}
inline mission::MissionEvent event(VehicleId vehicle, double time_s, mission::EventKind kind,
                                   const TaskId& task, double moment_s = 0.0) {
  mission::MissionEvent made{vehicle, at_seconds(time_s), kRound, task, mission::body_of(kind)};
  set_moment(made, moment_s);
  return made;
}

/// Spoil a track.
inline void delay(recording::Recording& recorded, double seconds) {
  for (auto& point : recorded.track) point.state.time += from_seconds(seconds);
}
inline void shift(recording::Recording& recorded, const Vec2& by) {
  for (auto& point : recorded.track) {
    point.state.x_m += by.x();
    point.state.y_m += by.y();
  }
}

inline recording::Recording& of(RunRecord& record, VehicleId vehicle) {
  return *std::find_if(record.recordings.begin(), record.recordings.end(),
                       [&](const auto& r) { return r.vehicle == vehicle; });
}
inline VehicleSpec& spec(RunRecord& record, VehicleId vehicle) {
  return *std::find_if(record.vehicles.begin(), record.vehicles.end(),
                       [&](const auto& v) { return v.id == vehicle; });
}
inline mission::MissionEvent& event_of(RunRecord& record, VehicleId vehicle,
                                       mission::EventKind kind) {
  auto& events = of(record, vehicle).events;
  return *std::find_if(events.begin(), events.end(),
                       [&](const auto& e) { return e.kind() == kind; });
}
inline void erase_events(RunRecord& record, VehicleId vehicle, mission::EventKind kind) {
  std::erase_if(of(record, vehicle).events, [&](const auto& e) { return e.kind() == kind; });
}

inline RunRecord good_record() {
  using mission::EventKind;
  RunRecord record;
  Site site;
  site.id = kSite;
  site.survey = {0.0, from_seconds(20.0)};
  site.deliveries = {{0.0, Duration{}}, {kPi / 2.0, Duration{}}};
  site.assess_wait = from_seconds(10.0);
  site.assessments = {{0.0, from_seconds(20.0)}};
  record.sites = {site};

  double height = 300.0;
  for (const VehicleId id : {kSurveyor, kFromWest, kFromSouth, kAssessor}) {
    VehicleSpec vehicle;
    vehicle.id = id;
    vehicle.cruise_speed_mps = kSpeed;
    vehicle.turn_radius_m = 150.0;
    vehicle.range_m = 18000.0;
    vehicle.capabilities.add(TaskKind::survey).add(TaskKind::deliver).add(TaskKind::assess);
    vehicle.sensor_radius_m = 300.0;
    vehicle.assess_radius_m = 200.0;
    vehicle.loads = 1;
    vehicle.height_m = height;
    record.vehicles.push_back(vehicle);
    record.recordings.push_back({id, {}, {}, {}, 0});
    height += 50.0;
  }
  const Instant zero{};
  of(record, kSurveyor).plans = {
      {1, zero, plan_from({300.0, -500.0, kPi / 2.0}, 0.0, {{0.0, 500.0}, {1.0 / 300.0, 1050.0}})}};
  of(record, kFromWest).plans = {
      {1, zero, plan_from({-3000.0, 0.0, 0.0}, 0.0, {{0.0, 6000.0}})},
      {2, at_seconds(40.0), plan_from({-1000.0, 0.0, 0.0}, 40.0, {{0.0, 3000.0}})}};
  of(record, kFromSouth).plans = {
      {1, zero, plan_from({0.0, -3000.0, kPi / 2.0}, 0.0, {{0.0, 6000.0}})}};
  of(record, kAssessor).plans = {
      {1, zero,
       plan_from({200.0, -3500.0, kPi / 2.0}, 0.0, {{0.0, 3500.0}, {1.0 / 200.0, 1050.0}})}};
  for (const VehicleSpec& vehicle : record.vehicles) {
    fly(of(record, vehicle.id), 100.0, vehicle.height_m);
  }

  of(record, kSurveyor).events = {event(kSurveyor, 10.0, EventKind::survey_started, kSurvey),
                                  event(kSurveyor, 30.0, EventKind::survey_done, kSurvey),
                                  event(kSurveyor, 30.0, EventKind::task_done, kSurvey, 10.0)};
  const auto work = [&](VehicleId id, const TaskId& task, double start_s, double done_s,
                        double planned_s) {
    auto& events = of(record, id).events;
    events = {event(id, 35.0, EventKind::lease_granted, task, 45.0),
              event(id, 44.0, EventKind::lease_granted, task, 120.0)};
    if (task.kind == TaskKind::deliver) {
      events.push_back(event(id, 36.2, EventKind::authorised, task));
    }
    events.push_back(event(id, start_s, EventKind::task_started, task));
    events.push_back(event(id, done_s, EventKind::task_done, task, planned_s));
    events.push_back(event(id, done_s, EventKind::lease_ended, task));
  };
  work(kFromWest, kEastward, 54.0, 60.1, 60.0);
  work(kFromSouth, kNorthward, 54.0, 60.1, 60.0);
  work(kAssessor, kAssessment, 70.0, 91.0, 70.0);
  record.ground_events = {
      event(kGroundStation, 36.0, EventKind::authorised, {kSite, TaskKind::survey, 0})};
  return record;
}

inline std::vector<std::string> failed(const RunRecord& record, const Limits& limits = {}) {
  std::vector<std::string> names;
  for (const CheckResult& result : judge(record, limits)) {
    if (!result.held()) names.push_back(result.name);
  }
  return names;
}

/// The only violation of a check.
inline std::string only_sentence(const CheckResult& result) {
  EXPECT_EQ(result.violations.size(), 1U);
  return result.violations.empty() ? "" : result.violations.front().sentence;
}

}  // namespace skein::checks::testing
