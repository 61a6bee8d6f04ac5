// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "failsafe.hpp"
#include "task_flight.hpp"

namespace skein::mission {
namespace {

using State = TaskFlight::State;
using Event = TaskFlight::Event;

TaskFlight delivery() { return {{{{1}, {2}, 1}, 1}, {}, {{{3}, TaskKind::deliver, 0}, {4}, {}}}; }

TEST(TaskFlight, PassesTheGateOnlyByAGrantAndACommittedPlan) {
  TaskFlight task = delivery();
  EXPECT_FALSE(task.accepts(Event::committed));
  EXPECT_TRUE(task.grant());
  EXPECT_FALSE(task.grant());  // it is news once
  EXPECT_TRUE(task.authorised());
  task.fire(Event::committed);
  EXPECT_TRUE(task.in_run());
  task.fire(Event::began);
  task.fire(Event::finished);
  EXPECT_TRUE(task.in(State::over));
}

TEST(TaskFlight, AGrantIsForItsRound) {
  TaskFlight task = delivery();
  EXPECT_TRUE(task.grant());
  task.pass_on({{{5}, {6}, 1}, 1});
  EXPECT_FALSE(task.authorised());
  EXPECT_FALSE(task.accepts(Event::committed));
  EXPECT_TRUE(task.grant());
  EXPECT_TRUE(task.accepts(Event::committed));
}

TEST(TaskFlight, WhatLeadsPastTheGateStaysSoUnderASuccessor) {
  TaskFlight task = delivery();
  EXPECT_TRUE(task.grant());
  task.fire(Event::committed);
  task.pass_on({{{5}, {6}, 1}, 1});
  EXPECT_TRUE(task.in(State::committed));
  EXPECT_TRUE(task.grant());
  EXPECT_TRUE(task.in(State::committed));
}

TEST(TaskFlight, WhoIsLateBeginsNoMore) {
  TaskFlight task = delivery();
  EXPECT_TRUE(task.grant());
  task.fire(Event::missed);
  for (const Event event : {Event::committed, Event::began, Event::finished}) {
    EXPECT_FALSE(task.accepts(event));
  }
}

TEST(TaskFlight, EveryStateIsReachedAndNoEntryStandsTwice) {
  for (std::size_t i = 1; i < static_cast<std::size_t>(State::count); ++i) {
    EXPECT_TRUE(std::any_of(TaskFlight::kTable.begin(), TaskFlight::kTable.end(),
                            [&](const auto& t) { return t.to == static_cast<State>(i); }));
  }
  for (const auto& a : TaskFlight::kTable) {
    EXPECT_EQ(std::count_if(TaskFlight::kTable.begin(), TaskFlight::kTable.end(),
                            [&](const auto& b) { return a.from == b.from && a.event == b.event; }),
              1);
  }
}

TEST(Failsafe, LaterRulesTakePrecedence) {
  using Action = Failsafe::Action;
  Failsafe failsafe;
  EXPECT_EQ(failsafe.update({}), Action::none);
  EXPECT_EQ(failsafe.reason(), coalition::Reason::none);
  EXPECT_EQ(failsafe.update({.id_in_use = true}), Action::take_up_nothing);
  EXPECT_EQ(failsafe.update({.id_in_use = true, .range_spent = true}), Action::come_home);
  EXPECT_EQ(failsafe.update({.id_in_use = true, .range_spent = true, .ordered = true}),
            Action::obey);
  EXPECT_EQ(failsafe.reason(), coalition::Reason::held_by_operator);
  EXPECT_EQ(failsafe.update({.range_spent = true}), Action::come_home);
}

/// After a change of a table, paste what this prints into docs/protocol.md.
TEST(AgentTables, AreInTheProtocolDocument) {
  std::ifstream file{SKEIN_SOURCE_DIR "/docs/protocol.md"};
  std::stringstream document;
  document << file.rdbuf();
  for (const std::string& table :
       {mermaid<State, Event>(TaskFlight::kTable, State::planned), failsafe_document()}) {
    EXPECT_NE(document.str().find(table), std::string::npos) << "docs/protocol.md lacks:\n"
                                                             << table;
  }
}

}  // namespace
}  // namespace skein::mission
