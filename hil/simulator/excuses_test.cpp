// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/excuses.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "skein/mission/events.hpp"

namespace skein::hil {
namespace {

using mission::EventKind;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

constexpr SiteId kSite{1};
constexpr TaskId kSurvey{kSite, TaskKind::survey, 0};
constexpr TaskId kDelivery{kSite, TaskKind::deliver, 0};
constexpr TaskId kAssessment{kSite, TaskKind::assess, 0};
constexpr VehicleId kFirst{1};
constexpr VehicleId kSecond{2};

/// A site that is surveyed, with a delivery and an assessment, and two vehicles that can do all.
struct Mission {
  Mission() {
    Site site;
    site.id = kSite;
    site.deliveries.resize(1);
    site.assessments.resize(1);
    record.sites = {site};
    for (const VehicleId id : {kFirst, kSecond}) {
      VehicleSpec spec;
      spec.id = id;
      spec.capabilities.add(TaskKind::survey).add(TaskKind::deliver).add(TaskKind::assess);
      spec.loads = 1;
      record.vehicles.push_back(spec);
      record.recordings.push_back({id, {}, {}, {}, 0});
      VehicleEnd end;
      end.vehicle = id;
      end.loads = 1;
      ends.push_back(end);
    }
    tells(kFirst, 10, EventKind::survey_started, kSurvey);
    tells(kFirst, 30, EventKind::survey_done, kSurvey);
  }
  static mission::MissionEvent event(VehicleId who, int at_s, EventKind kind, const TaskId& task) {
    return {who, Instant{} + std::chrono::seconds{at_s}, {}, task, mission::body_of(kind)};
  }
  void tells(VehicleId who, int at_s, EventKind kind, const TaskId& task) {
    record.recordings[who.value - 1U].events.push_back(event(who, at_s, kind, task));
  }
  void ground_tells(int at_s, EventKind kind) {
    record.ground_events.push_back(event(kGroundStation, at_s, kind, kDelivery));
  }
  [[nodiscard]] std::vector<TaskId> excused() const {
    std::vector<TaskId> tasks;
    for (const auto& excuse : excuses(record, ends)) tasks.push_back(excuse.task);
    return tasks;
  }

  checks::RunRecord record;
  std::vector<VehicleEnd> ends;
};

TEST(Excuses, ATeamThatCanDoAllIsExcusedNothing) { EXPECT_THAT(Mission{}.excused(), IsEmpty()); }

TEST(Excuses, ADeliveryMayHaveBeenFlownOnlyWhereItWasGranted) {
  Mission mission;
  mission.tells(kFirst, 60, EventKind::task_unknown, kDelivery);
  EXPECT_THAT(mission.excused(), IsEmpty());
  mission.ground_tells(50, EventKind::authorised);
  EXPECT_THAT(mission.excused(), UnorderedElementsAre(kDelivery));
  mission.tells(kSecond, 55, EventKind::task_started, kDelivery);
  mission.tells(kSecond, 58, EventKind::task_done, kDelivery);
  EXPECT_THAT(mission.excused(), IsEmpty()) << "it was";
}

TEST(Excuses, WhoIsLeftMustBeEnoughWithTheLoadsThatAreLeft) {
  Mission mission;
  mission.ends[0].loads = 0;
  EXPECT_THAT(mission.excused(), IsEmpty()) << "the other one has a load";
  mission.ends[1].loads = 0;
  EXPECT_THAT(mission.excused(), UnorderedElementsAre(kDelivery, kAssessment));
  mission = {};
  mission.ends[0].gone = true;
  EXPECT_THAT(mission.excused(), UnorderedElementsAre(kDelivery, kAssessment))
      << "one for two tasks";
  mission = {};
  mission.ends[0].barred = true;
  EXPECT_THAT(mission.excused(), UnorderedElementsAre(kDelivery, kAssessment));
}

TEST(Excuses, WhatTheOperatorHasWithdrawnNeedNotBeDone) {
  Mission mission;
  mission.ground_tells(40, EventKind::site_withdrawn);
  EXPECT_THAT(mission.excused(), UnorderedElementsAre(kDelivery, kAssessment));
}

}  // namespace
}  // namespace skein::hil
