// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/decision_desk.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace skein::groundstation {
namespace {

using ::testing::HasSubstr;
constexpr SiteId kSite{3};

/// Vehicle 2 leads, and 2 and 4 are to deliver; 4 is not heard any more from 1 s on.
mission::GroundAgent asked() {
  mission::GroundAgentConfig config;
  config.expected = {{2}, {4}};
  mission::GroundAgent agent{config, Instant{}};
  mission::Telemetry telemetry;
  for (const double at_s : {1.0, 7.0}) {
    telemetry.state.time = at_seconds(at_s);
    telemetry.vehicle = {2};
    agent.on_message(mission::Message{telemetry}, at_seconds(at_s));
    telemetry.vehicle = {4};
    if (at_s == 1.0) agent.on_message(mission::Message{telemetry}, at_seconds(at_s));
  }
  mission::AuthorisationRequest request;
  request.round = {{{2}, {77}, 1}, 1};
  request.site = kSite;
  request.decide_by = at_seconds(30.0);
  request.deliveries = {{{{kSite, TaskKind::deliver, 0}, {2}, at_seconds(40.0)}, 0.0},
                        {{{kSite, TaskKind::deliver, 1}, {4}, at_seconds(44.0)}, 1.0}};
  agent.on_message(mission::Message{request}, at_seconds(8.0));
  return agent;
}

TEST(DecisionDesk, SaysWhatWasPassedOverWhatIsFlownOnAndWhoMayNotHear) {
  mission::GroundAgent agent = asked();
  const Answer plain = decision_answer(Decision{kSite, true}, agent, "ada", at_seconds(9.0));
  EXPECT_FALSE(plain.done);
  EXPECT_THAT(plain.text, HasSubstr("vehicle 4 is silent for 8 s"));
  const Answer early = decision_answer(TakeBack{kSite}, agent, "ada", at_seconds(9.0));
  EXPECT_FALSE(early.done);
  const Answer over =
      decision_answer(Decision{kSite, true, {}, true}, agent, "ada", at_seconds(9.0));
  EXPECT_TRUE(over.done);
  EXPECT_EQ(over.text, "done, although vehicle 4 is silent for 8 s\n");
  agent.on_message(mission::Message{mission::MissionEvent{{2},
                                                          at_seconds(10.0),
                                                          {{{2}, {77}, 1}, 1},
                                                          {kSite, TaskKind::deliver, 0},
                                                          mission::event::TaskStarted{}}},
                   at_seconds(10.0));
  const Answer back = decision_answer(TakeBack{kSite}, agent, "ada", at_seconds(11.0));
  EXPECT_TRUE(back.done);
  EXPECT_THAT(back.text, HasSubstr("has begun: vehicle 2 flies it to its end"));
  EXPECT_THAT(back.text, HasSubstr("vehicle 4 is silent: it may not hear this, and fly"));
}

}  // namespace
}  // namespace skein::groundstation
