// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "activity.hpp"
#include "failsafe.hpp"
#include "leader.hpp"
#include "scout.hpp"
#include "task_flight.hpp"

namespace skein::mission {
namespace {

using State = TaskFlight::State;
using Event = TaskFlight::Event;

TaskFlight delivery() { return {{{{1}, {2}, 1}, 1}, {}, {{{3}, TaskKind::deliver, 0}, {4}, {}}}; }

TEST(TaskFlight, PassesTheGateOnlyByAGrantAndACommittedPlan) {
  TaskFlight task = delivery();
  EXPECT_FALSE(task.accepts(Event::committed));
  EXPECT_TRUE(task.grant(at_seconds(1)));
  EXPECT_FALSE(task.grant(at_seconds(1)));  // it is news once
  EXPECT_TRUE(task.authorised());
  task.fire(Event::committed);
  EXPECT_TRUE(task.in_run());
  task.fire(Event::began);
  task.fire(Event::finished);
  EXPECT_TRUE(task.in(State::over));
}

TEST(TaskFlight, AGrantIsForItsRound) {
  TaskFlight task = delivery();
  EXPECT_TRUE(task.grant(at_seconds(1)));
  task.pass_on({{{5}, {6}, 1}, 1});
  EXPECT_FALSE(task.authorised());
  EXPECT_FALSE(task.accepts(Event::committed));
  EXPECT_TRUE(task.grant(at_seconds(1)));
  EXPECT_TRUE(task.accepts(Event::committed));
}

TEST(TaskFlight, WhatLeadsPastTheGateStaysSoUnderASuccessor) {
  TaskFlight task = delivery();
  EXPECT_TRUE(task.grant(at_seconds(1)));
  task.fire(Event::committed);
  task.pass_on({{{5}, {6}, 1}, 1});
  EXPECT_TRUE(task.in(State::committed));
  EXPECT_TRUE(task.grant(at_seconds(1)));
  EXPECT_TRUE(task.in(State::committed));
}

TEST(TaskFlight, WhoIsLateBeginsNoMore) {
  TaskFlight task = delivery();
  EXPECT_TRUE(task.grant(at_seconds(1)));
  task.fire(Event::missed);
  for (const Event event : {Event::committed, Event::began, Event::finished}) {
    EXPECT_FALSE(task.accepts(event));
  }
}

template <class Part>
void expect_complete(std::string_view part) {
  const auto& table = Part::kTable;
  for (std::size_t i = 1; i < static_cast<std::size_t>(Part::State::count); ++i) {
    const auto state = static_cast<typename Part::State>(i);
    EXPECT_TRUE(
        std::any_of(table.begin(), table.end(), [&](const auto& t) { return t.to == state; }))
        << part << " never comes to " << to_string(state);
  }
  for (const auto& a : table) {
    EXPECT_EQ(std::count_if(table.begin(), table.end(),
                            [&](const auto& b) { return a.from == b.from && a.event == b.event; }),
              1)
        << part << ": " << to_string(a.from) << ", " << to_string(a.event);
  }
}

TEST(AgentTables, EveryStateIsReachedAndNoEntryStandsTwice) {
  expect_complete<TaskFlight>("TaskFlight");
  expect_complete<Scout>("Scout");
  expect_complete<Leader>("Leader");
}

TEST(AgentTables, AnActivityIsThatOfTheFirstRuleThatHolds) {
  EXPECT_EQ(activity_of({}), Activity::searching);
  EXPECT_EQ(activity_of({.bids = true, .en_route = true}), Activity::bidding);
  EXPECT_EQ(activity_of({.bids = true, .stands_by = true}), Activity::bidding);
  EXPECT_EQ(activity_of({.stands_by = true}), Activity::standing_by);
  EXPECT_EQ(activity_of({.leads = true, .bids = true}), Activity::leading);
  EXPECT_EQ(activity_of({.leads = true, .monitors = true}), Activity::monitoring);
  EXPECT_EQ(activity_of({.has_task = true, .leads = true}), Activity::executing);
  using Action = Failsafe::Action;
  EXPECT_EQ(activity_of({.failsafe = Action::come_home, .bids = true}), Activity::holding);
  EXPECT_EQ(activity_of({.failsafe = Action::come_home, .leads = true}), Activity::leading);
  EXPECT_EQ(activity_of({.failsafe = Action::obey, .has_task = true}), Activity::holding);
}

TEST(AgentTables, ADetailTellsWhatAnActivityLeavesOpen) {
  using Action = Failsafe::Action;
  EXPECT_EQ(detail_of({}), ActivityDetail::none);
  EXPECT_EQ(detail_of({.failsafe = Action::obey}), ActivityDetail::ordered);
  EXPECT_EQ(detail_of({.failsafe = Action::obey, .homes = true}), ActivityDetail::returning);
  EXPECT_EQ(detail_of({.failsafe = Action::obey, .homes = true, .at_home = true}),
            ActivityDetail::at_home);
  EXPECT_EQ(detail_of({.failsafe = Action::come_home, .homes = true, .range_spent = true}),
            ActivityDetail::range_reserve);
  EXPECT_EQ(detail_of({.failsafe = Action::come_home, .leads = true, .range_spent = true}),
            ActivityDetail::range_reserve);
  EXPECT_EQ(detail_of({.failsafe = Action::come_home, .homes = true}), ActivityDetail::left_fence);
  EXPECT_EQ(detail_of({.failsafe = Action::stay}), ActivityDetail::barred);
  const PartStates delivery{.has_task = true, .delivers = true};
  EXPECT_EQ(detail_of(delivery), ActivityDetail::delivering);
  EXPECT_EQ(detail_of({.has_task = true, .delivers = true, .awaits_decision = true}),
            ActivityDetail::awaiting_decision);
  EXPECT_EQ(detail_of({.has_task = true, .delivers = true, .late = true}), ActivityDetail::late);
  EXPECT_EQ(detail_of({.has_task = true}), ActivityDetail::assessing);
  EXPECT_EQ(detail_of({.leads = true, .awaits_decision = true}), ActivityDetail::awaiting_decision);
  EXPECT_EQ(detail_of({.takes_off = true, .begun = false}), ActivityDetail::taking_off);
  EXPECT_EQ(detail_of({.on_ground = true, .takes_off = true, .begun = false}),
            ActivityDetail::on_ground);
  EXPECT_EQ(detail_of({.begun = false}), ActivityDetail::not_begun);
  EXPECT_EQ(detail_of({.lands = true, .homes = true, .at_home = true}), ActivityDetail::none);
  EXPECT_EQ(detail_of({.failsafe = Action::stay, .piloted = true}), ActivityDetail::piloted);
  EXPECT_EQ(detail_of({.piloted = true, .lands = true}), ActivityDetail::piloted);
  EXPECT_EQ(detail_of({.piloted = true, .lands = true, .landed = true}), ActivityDetail::none);
  EXPECT_EQ(detail_of({.piloted = true, .on_ground = true}), ActivityDetail::on_ground);
}

/// After a change of a table, paste what this prints into docs/protocol.md.
TEST(AgentTables, AreInTheProtocolDocument) {
  std::ifstream file{SKEIN_SOURCE_DIR "/docs/protocol.md"};
  std::stringstream document;
  document << file.rdbuf();
  for (const std::string& table :
       {mermaid<State, Event>(TaskFlight::kTable, State::planned),
        mermaid<Scout::State, Scout::Event>(Scout::kTable, Scout::State::idle),
        mermaid<Leader::State, Leader::Event>(Leader::kTable, Leader::State::idle),
        failsafe_document(), responses_document()}) {
    EXPECT_NE(document.str().find(table), std::string::npos) << "docs/protocol.md lacks:\n"
                                                             << table;
  }
}

}  // namespace
}  // namespace skein::mission
