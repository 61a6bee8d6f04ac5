// SPDX-License-Identifier: Apache-2.0
#include "skein/console/alarms.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "alarm_kinds.hpp"

namespace skein::console {
namespace {

using Json = nlohmann::json;
using mission::ActivityDetail;
using mission::CommandKind;
using ::testing::HasSubstr;
namespace event = mission::event;

constexpr SiteId kSite{4};
constexpr TaskId kTask{kSite, TaskKind::deliver, 1};
constexpr coalition::CoalitionId kCoalition{{1}, {77}, 1};

/// A ground station with three vehicles that report ten times a second.
class Desk {
 public:
  explicit Desk(const std::vector<VehicleId>& expected = {{1}, {2}, {3}})
      : picture_{{.expected = expected}}, fleet_{{.expected = expected}} {
    for (const VehicleId id : {VehicleId{1}, VehicleId{2}, VehicleId{3}}) {
      mission::Telemetry& t = said[id];
      t.vehicle = id;
      t.instance = {id.value};
      t.range_left_m = 9000.0;
    }
  }

  /// What each says; who is not in it is silent.
  std::map<VehicleId, mission::Telemetry> said;
  std::optional<mission::Telemetry> twin;
  std::uint32_t round = 0;
  std::uint64_t command = 1;

  [[nodiscard]] Instant now() const { return now_; }
  void run(double seconds) {
    const Instant end = now_ + from_seconds(seconds);
    for (; now_ < end; now_ += std::chrono::milliseconds{100}) {
      for (auto& [id, telemetry] : said) {
        telemetry.state.time = now_;
        hear(telemetry, id);
      }
      if (twin) {
        twin->state.time = now_;
        hear(*twin, twin->vehicle);
      }
      fleet_.on_timeout(now_);
      while (fleet_.poll_news()) continue;
      alarms.on_timeout(picture_, fleet_, now_);
    }
  }
  void hear(const mission::Message& message, VehicleId sender) {
    fleet_.on_message(message, now_);
    picture_.on_message(message, sender, now_);
    alarms.on_message(message, sender, now_);
  }
  void tell(VehicleId who, mission::EventBody body, const TaskId& task = {},
            const coalition::Round& of = {}) {
    const mission::MissionEvent event{who, now_, of, task, std::move(body)};
    fleet_.on_message(event, now_);
    picture_.on_event(event);
    alarms.on_event(event, now_);
  }
  void ask(double for_s) {
    mission::AuthorisationRequest request;
    request.round = {kCoalition, ++round};
    request.site = kSite;
    request.deliveries = {{{kTask, {2}, now_ + from_seconds(for_s + 5.0)}, 0.0}};
    request.decide_by = now_ + from_seconds(for_s);
    hear(request, {1});
  }
  void decide(bool granted) {
    mission::Authorisation decision{{kCoalition, round}, kSite, granted, "ada", now_, {}, {}, {}};
    decision.deliveries = {{{kTask, {2}, now_ + from_seconds(60.0)}, 0.0}};
    decision.until = now_ + from_seconds(60.0);
    hear(decision, kGroundStation);
  }
  /// What was asked for, a second before.
  void grant() {
    run(1.0);
    ask(30.0);
    run(1.0);
    decide(true);
  }
  void order(CommandKind kind, VehicleId to = kGroundStation) {
    mission::Command said_now;
    said_now.vehicle = to;
    said_now.kind = kind;
    mission::set_number(said_now, ++command);
    hear(said_now, kGroundStation);
  }
  void award(coalition::TaskState state) {
    said[{2}].task = kTask;  // by its own word
    hear(mission::Message{coalition::Message{
             coalition::MemberStatus{{kCoalition, 1}, {2}, {{kTask, state, now_}}}}},
         {2});
  }
  void revoke(const std::set<VehicleId>& who) { fleet_.set_revoked(who); }
  void be_ill(const std::vector<std::string>& problems) {
    mission::Health health;
    health.vehicle = {3};
    health.time = now_;
    health.problems = problems;
    hear(health, {3});
  }

  [[nodiscard]] std::vector<const Alarm*> of(AlarmKind kind) const {
    std::vector<const Alarm*> all;
    for (const Alarm* alarm : alarms.list()) {
      if (alarm->key.kind == kind) all.push_back(alarm);
    }
    return all;
  }
  void acknowledge(AlarmKind kind) {
    std::vector<std::uint32_t> numbers;
    for (const Alarm* alarm : of(kind)) numbers.push_back(alarm->number);
    EXPECT_TRUE(alarms.acknowledge(numbers, "ada", now_).ok()) << to_string(kind);
  }

  Alarms alarms;

 private:
  Picture picture_;
  mission::Fleet fleet_;
  Instant now_{at_seconds(100.0)};
};

struct Case {
  std::function<void(Desk&)> begin;  ///< and what must pass until it is told
  std::function<void(Desk&)> end;
  bool comes_back = true;
  std::vector<VehicleId> expected = {{1}, {2}, {3}};
};

template <class Body>
std::function<void(Desk&)> tells(VehicleId who, const Body& body, const TaskId& task = {}) {
  return [=](Desk& desk) {
    desk.tell(who, body, task);
    desk.run(0.2);
  };
}
std::function<void(Desk&)> is(ActivityDetail detail) {
  return [detail](Desk& desk) {
    desk.said[{3}].detail = detail;
    desk.run(0.5);
  };
}
std::function<void(Desk&)> nobody(bool commands) {
  return [commands](Desk& desk) {
    desk.alarms.on_command(commands, desk.now());
    desk.run(0.2);
  };
}
std::function<void(Desk&)> receivers(const std::string& trouble) {
  return [trouble](Desk& desk) {
    desk.alarms.on_receivers(trouble, desk.now());
    desk.run(2.5);
  };
}
void command_is_taken(Desk& desk) {
  desk.tell(kGroundStation, event::CommandHanded{true, "ada"});
  desk.tell(kGroundStation, event::CommandHanded{false, "ben"});
  desk.run(0.2);
}
void is_on_ground(Desk& desk) { desk.said[{3}].detail = ActivityDetail::on_ground; }
void is_flying(Desk& desk) { desk.said[{3}].detail = ActivityDetail::none; }
std::function<void(Desk&)> flight(AutopilotNews news) {
  AutopilotNotice notice;
  notice.news = news;
  return tells(VehicleId{3}, event::FlightWarning{notice});
}
event::FormationWarning formation(event::FormationNews news) { return {news, {{3}}, 0}; }
std::function<void(Desk&)> falls_silent(std::vector<VehicleId> who) {
  return [who = std::move(who)](Desk& desk) {
    for (const VehicleId id : who) desk.said.erase(id);
    desk.run(6.0);
  };
}
void is_heard_again(Desk& desk) {
  const Desk fresh;
  for (const auto& [id, telemetry] : fresh.said) desk.said.try_emplace(id, telemetry);
}
void holds(Desk& desk, ActivityDetail detail) {
  for (auto& [id, telemetry] : desk.said) telemetry.detail = detail;
}

std::function<void(Desk&)> searches(std::optional<EndedSearch> ended) {
  return [ended = std::move(ended)](Desk& desk) {
    desk.alarms.on_search(ended);
    desk.run(0.2);
  };
}
/// To acknowledge it is to have done with it.
bool is_read_once(AlarmKind kind) {
  return kind == AlarmKind::told || kind == AlarmKind::search_ended;
}

/// Those that are no alarms.
void add_what_is_less(std::map<AlarmKind, Case>& all) {
  using enum AlarmKind;
  const VehicleId v3{3};
  all[separation] = {tells(v3, event::SeparationWarning{{2}, 10, 2, {}, v3}),
                     tells(v3, event::SeparationRestored{{2}})};
  all[traffic] = {tells(v3, event::TrafficWarning{0xabc, 100, 20, {}, true}),
                  tells(v3, event::TrafficClear{0xabc})};
  all[all_held] = {[](Desk& desk) {
                     holds(desk, ActivityDetail::ordered);
                     desk.run(0.5);
                   },
                   [](Desk& desk) { holds(desk, ActivityDetail::none); }};
  all[formation_waits] = {tells(v3, event::Waiting{1, event::WaitsFor::order, {}}),
                          tells(v3, event::PlaceReached{1})};
  all[order_waits] = {tells(kGroundStation, event::OrderWaits{1, "rally", "why"}),
                      tells(kGroundStation, event::ScriptDone{1})};
  all[task_lost] = {
      [](Desk& desk) {
        desk.tell({1}, event::TaskLost{{coalition::Reason::owner_silent, {2}, ""}}, kTask);
        desk.run(0.2);
      },
      [](Desk& desk) { desk.award(coalition::TaskState::planned); }, false};
  all[search_ended] = {searches(EndedSearch{at_seconds(5.0), at_seconds(6.0), "ended", 1, false}),
                       searches(std::nullopt)};
  all[proposal_waits] = {
      tells(kGroundStation,
            event::SiteProposed{1, {3}, mission::IncidentKind::fire, 1, 2, "d", 0.9}),
      tells(kGroundStation, event::ProposalAnswered{1, false, "ada"})};
  all[not_landed] = {
      [](Desk& desk) {
        desk.said[{3}].detail = ActivityDetail::at_home;
        desk.run(0.2);
        desk.tell(kGroundStation, event::FleetWarning{event::FleetNews::not_landed, {3}, {}});
        desk.run(0.2);
      },
      is_on_ground};
  all[vehicle_missing] = {[](Desk& desk) { desk.run(16.0); },
                          [](Desk& desk) {
                            desk.said[{9}] = desk.said[{3}];
                            desk.said[{9}].vehicle = {9};
                          },
                          false,
                          {{1}, {2}, {3}, {9}}};
  all[stranger] = {[](Desk& desk) {
                     desk.said[{9}] = desk.said[{3}];
                     desk.said[{9}].vehicle = {9};
                     desk.run(0.5);
                   },
                   [](Desk& desk) {
                     desk.said.erase({9});
                     desk.run(6.0);
                   }};
  all[revoked] = {[](Desk& desk) {
                    desk.revoke({{3}});
                    desk.run(0.5);
                  },
                  [](Desk& desk) { desk.revoke({}); }};
  all[autopilot_warning] = {flight(AutopilotNews::mode_changed), flight(AutopilotNews::flying)};
  all[vehicle_warning] = {tells(v3, event::ChangeRefused{1, event::ChangeRefusal::too_fast}),
                          tells(v3, event::ChangeTakenUp{2})};
  all[vehicle_problem] = {[](Desk& desk) {
                            desk.be_ill({"no state from its flight controller for 2.0 s"});
                            desk.run(0.5);
                          },
                          [](Desk& desk) { desk.be_ill({}); }};
  all[told] = {tells(v3, event::VehicleTrouble{event::Trouble::untimely}),
               [](Desk& desk) { desk.run(61.0); }};
}

/// What begins and ends every kind.
std::map<AlarmKind, Case> cases() {
  using enum AlarmKind;
  const VehicleId v3{3};
  std::map<AlarmKind, Case> all;
  all[nobody_heard] = {falls_silent({{1}, {2}, {3}}), is_heard_again};
  all[separation_no_room] = {tells(v3, event::SeparationWarning{{2}, 10, 2, {}, {}}),
                             tells(v3, event::SeparationRestored{{2}})};
  all[traffic_no_room] = {tells(v3, event::TrafficWarning{0xabc, 100, 20, {}, false}),
                          tells(v3, event::TrafficClear{0xabc})};
  all[left_fence] = {is(ActivityDetail::left_fence), is_flying};
  all[vehicle_silent] = {falls_silent({v3}), is_heard_again};
  all[decision_runs_out] = {[](Desk& desk) {
                              desk.ask(60.0);
                              desk.run(41.0);
                            },
                            [](Desk& desk) { desk.decide(false); }};
  all[decision_lapsed] = {[](Desk& desk) {
                            desk.ask(1.0);
                            desk.run(2.0);
                          },
                          [](Desk& desk) { desk.decide(false); }};
  all[no_answer] = {[](Desk& desk) {
                      desk.order(CommandKind::hold, {3});
                      desk.run(10.5);
                    },
                    tells(v3, event::Commanded{CommandKind::hold})};
  all[range_reserve] = {[](Desk& desk) {
                          is_flying(desk);
                          desk.run(1.0);
                          desk.tell({3}, event::RangeSpent{500, true, 400, false});
                          desk.run(0.2);
                        },
                        is_on_ground};
  all[range_overdrawn] = {[](Desk& desk) {
                            desk.said[{3}].range_left_m = -1.0;
                            desk.run(0.5);
                          },
                          [](Desk& desk) { desk.said[{3}].range_left_m = 9000.0; }};
  all[autopilot_trouble] = {flight(AutopilotNews::not_obeying), flight(AutopilotNews::flying)};
  all[vehicle_trouble] = {tells(v3, event::VehicleTrouble{event::Trouble::orders_unknown}),
                          tells(v3, event::OrdersKnown{kGroundStation})};
  all[task_unknown] = {[](Desk& desk) {
                         desk.tell({1}, event::TaskUnknown{{2}}, kTask);
                         desk.run(0.2);
                       },
                       [](Desk& desk) { desk.award(coalition::TaskState::done); }, false};
  all[duplicate_id] = {[](Desk& desk) {
                         desk.twin = desk.said[{3}];
                         desk.twin->instance = {99};
                         desk.run(0.5);
                       },
                       [](Desk& desk) {
                         desk.twin.reset();
                         desk.run(6.0);
                       }};
  all[setup_differs] = {tells(kGroundStation, event::SetupDiffers{{3}, "protocol", 0.0}),
                        tells(kGroundStation, event::SetupAgrees{{3}})};
  all[formation_lost] = {tells(kGroundStation, formation(event::FormationNews::lost)),
                         tells(kGroundStation, formation(event::FormationNews::back))};
  all[traffic_unseen] = {receivers("10.0.0.7:30003 is not connected"), receivers("")};
  all[nobody_commands] = {nobody(true), nobody(false)};
  all[command_elsewhere] = {command_is_taken,
                            tells(kGroundStation, event::CommandHanded{true, "ada"})};
  add_what_is_less(all);
  return all;
}

class Kinds : public ::testing::TestWithParam<AlarmKind> {};

/// Begins, stands, is acknowledged, ends; comes back as a new one, and is kept as over.
TEST_P(Kinds, LiveAsTheirConditions) {
  const AlarmKind kind = GetParam();
  const auto all = cases();
  ASSERT_TRUE(all.contains(kind)) << to_string(kind);
  const Case& one = all.at(kind);
  Desk desk{one.expected};
  desk.run(1.0);
  EXPECT_TRUE(desk.of(kind).empty());

  one.begin(desk);
  ASSERT_EQ(desk.of(kind).size(), 1U);
  const Alarm begun = *desk.of(kind)[0];
  EXPECT_EQ(begun.level, row_of(kind).level);
  EXPECT_FALSE(begun.acknowledged);
  EXPECT_FALSE(begun.over);
  EXPECT_FALSE(begun.what.empty());
  EXPECT_EQ(begun.remedy.empty(), kind == AlarmKind::told);
  EXPECT_LE(begun.since, desk.now());

  desk.run(15.0);
  ASSERT_EQ(desk.of(kind).size(), 1U) << "it stands";
  EXPECT_EQ(desk.of(kind)[0]->number, begun.number);
  EXPECT_EQ(desk.of(kind)[0]->since, begun.since);
  desk.acknowledge(kind);
  desk.run(0.2);
  if (!is_read_once(kind)) {
    ASSERT_EQ(desk.of(kind).size(), 1U) << "acknowledged, it stays";
    EXPECT_EQ(desk.of(kind)[0]->acknowledged->by, "ada");
  }
  one.end(desk);
  desk.run(3.0);
  EXPECT_TRUE(desk.of(kind).empty()) << "over, and it was acknowledged";
  if (!one.comes_back || kind == AlarmKind::search_ended) return;

  one.begin(desk);
  ASSERT_EQ(desk.of(kind).size(), 1U);
  EXPECT_GT(desk.of(kind)[0]->number, begun.number) << "it is a new one";
  EXPECT_FALSE(desk.of(kind)[0]->acknowledged);
  one.end(desk);
  desk.run(3.0);
  if (kind == AlarmKind::told) return;
  ASSERT_EQ(desk.of(kind).size(), 1U) << "over, and nobody has acknowledged it";
  EXPECT_TRUE(desk.of(kind)[0]->over);
  desk.acknowledge(kind);
  EXPECT_TRUE(desk.of(kind).empty());
}

INSTANTIATE_TEST_SUITE_P(All, Kinds, ::testing::ValuesIn([] {
                           std::vector<AlarmKind> all;
                           for (const KindRow& row : alarm_kinds()) all.push_back(row.kind);
                           return all;
                         }()),
                         [](const auto& one) { return std::string{to_string(one.param)}; });

TEST(Alarms, AQuietTeamHasNone) {
  Desk desk;
  desk.run(60.0);
  EXPECT_TRUE(desk.alarms.list().empty());
}

TEST(Alarms, WhatComesAndGoesIsOne) {
  Desk desk;
  desk.run(1.0);
  desk.said.erase({3});
  desk.run(5.5);
  ASSERT_EQ(desk.of(AlarmKind::vehicle_silent).size(), 1U);
  const auto number = desk.of(AlarmKind::vehicle_silent)[0]->number;
  is_heard_again(desk);
  desk.run(1.0);  // for less than it takes to be over
  desk.said.erase({3});
  desk.run(5.5);
  ASSERT_EQ(desk.of(AlarmKind::vehicle_silent).size(), 1U);
  EXPECT_NE(desk.of(AlarmKind::vehicle_silent)[0]->number, number);
  EXPECT_EQ(desk.of(AlarmKind::vehicle_silent)[0]->times, 2U);
}

TEST(Alarms, ASearchThatEndedStandsUntilItIsReadOrOrderedAgain) {
  const auto kind = AlarmKind::search_ended;
  EndedSearch ended{at_seconds(5.0), at_seconds(6.0), "3 searches no more", 1, false};
  Desk desk;
  searches(ended)(desk);
  ASSERT_EQ(desk.of(kind).size(), 1U);
  const auto number = desk.of(kind)[0]->number;
  desk.acknowledge(kind);
  desk.run(1.0);
  EXPECT_TRUE(desk.of(kind).empty());
  ended.edition = 2;  // another one has left
  searches(ended)(desk);
  ASSERT_EQ(desk.of(kind).size(), 1U);
  EXPECT_GT(desk.of(kind)[0]->number, number);
  EXPECT_EQ(desk.of(kind)[0]->level, AlarmLevel::warning);
  searches(std::nullopt)(desk);  // it is ordered again
  EXPECT_TRUE(desk.of(kind).empty()) << "nobody needs to acknowledge what was mended";
  ended.begun = at_seconds(50.0);
  ended.edition = 1;
  ended.is_wanted = true;
  searches(ended)(desk);
  ASSERT_EQ(desk.of(kind).size(), 1U) << "of another search";
  EXPECT_EQ(desk.of(kind)[0]->level, AlarmLevel::notice);
}

TEST(Alarms, WhatComesNearHasAMomentThatIsCountedDownTo) {
  Desk desk;
  desk.run(1.0);
  const Instant closest = desk.now() + from_seconds(78.0);
  desk.tell({3}, event::TrafficWarning{0xabc, 100, 20, from_seconds(78.0), true});
  desk.run(0.5);
  ASSERT_EQ(desk.of(AlarmKind::traffic).size(), 1U);
  const Alarm alarm = *desk.of(AlarmKind::traffic)[0];
  EXPECT_EQ(alarm.closest, closest);
  EXPECT_THAT(alarm.what, ::testing::Not(HasSubstr("78 s")));
  EXPECT_THAT(alarm.what, HasSubstr("aircraft 000abc: 100 m to the side"));
  EXPECT_THAT(alarms_text(desk.alarms, closest - from_seconds(40.0)), HasSubstr("closest in 40 s"));
  EXPECT_THAT(alarms_text(desk.alarms, closest + from_seconds(3.0)),
              HasSubstr("was closest 3 s ago"));
  const Json json = Json::parse(alarms_json(desk.alarms));
  EXPECT_DOUBLE_EQ(json["list"][0]["closest_s"], to_seconds(closest));
  // It is told anew.
  desk.tell({3}, event::TrafficWarning{0xabc, 90, 20, from_seconds(30.0), true});
  desk.run(0.2);
  EXPECT_LT(desk.of(AlarmKind::traffic).at(0)->closest, closest);
  EXPECT_EQ(desk.of(AlarmKind::traffic)[0]->number, alarm.number);
}

TEST(Alarms, ToBeClearAgainIsNoNewWarning) {
  Desk desk;
  desk.run(1.0);
  desk.tell({3}, event::TrafficWarning{0xabc, 100, 20, {}, true});
  desk.run(0.5);
  desk.be_ill({"aircraft 000abc comes too near: it gives way by its height"});
  desk.run(1.0);
  desk.tell({3}, event::TrafficClear{0xabc});
  desk.run(4.0);
  EXPECT_TRUE(desk.of(AlarmKind::vehicle_problem).empty()) << "that was said before";
  EXPECT_TRUE(desk.of(AlarmKind::told).empty());
  ASSERT_EQ(desk.of(AlarmKind::traffic).size(), 1U);
  EXPECT_TRUE(desk.of(AlarmKind::traffic)[0]->over);
  desk.be_ill({"3 control periods missed"});
  desk.run(0.5);
  EXPECT_EQ(desk.of(AlarmKind::vehicle_problem).size(), 1U) << "what it says since is heeded";
}

TEST(Alarms, WhoHoldsByOrderAndKeepsClearIsHeld) {
  Desk desk;
  desk.run(1.0);
  for (auto& [id, telemetry] : desk.said) {
    telemetry.activity = mission::Activity::holding;
    telemetry.detail = ActivityDetail::avoiding_traffic;
    desk.tell(id, event::Commanded{CommandKind::hold});
  }
  desk.run(0.5);
  EXPECT_EQ(desk.of(AlarmKind::all_held).size(), 1U);
}

TEST(Alarms, AShortGapDoesNotEndIt) {
  Desk desk;
  desk.run(1.0);
  is(ActivityDetail::left_fence)(desk);
  const auto number = desk.of(AlarmKind::left_fence).at(0)->number;
  is_flying(desk);
  desk.run(1.0);
  is(ActivityDetail::left_fence)(desk);
  ASSERT_EQ(desk.of(AlarmKind::left_fence).size(), 1U);
  EXPECT_EQ(desk.of(AlarmKind::left_fence)[0]->number, number);
  EXPECT_FALSE(desk.of(AlarmKind::left_fence)[0]->over);
}

TEST(Alarms, EveryLapseIsToldAnew) {
  Desk desk;
  desk.run(1.0);
  desk.ask(1.0);
  desk.run(2.0);
  desk.acknowledge(AlarmKind::decision_lapsed);
  desk.ask(1.0);
  desk.run(0.5);
  EXPECT_TRUE(desk.of(AlarmKind::decision_lapsed).at(0)->acknowledged);
  desk.run(1.0);
  ASSERT_EQ(desk.of(AlarmKind::decision_lapsed).size(), 1U);
  EXPECT_FALSE(desk.of(AlarmKind::decision_lapsed)[0]->acknowledged);
  EXPECT_THAT(desk.of(AlarmKind::decision_lapsed)[0]->what, HasSubstr("2 times"));
}

TEST(Alarms, APlanThatWasReplacedInTimeHasNotLapsed) {
  Desk desk;
  desk.run(1.0);
  desk.ask(5.0);
  desk.run(2.0);
  desk.ask(30.0);
  desk.run(10.0);
  EXPECT_TRUE(desk.of(AlarmKind::decision_lapsed).empty());
}

TEST(Alarms, TheWorstComesFirstAndWhatIsSeenLater) {
  Desk desk;
  desk.run(1.0);
  desk.tell({3}, event::SeparationWarning{{2}, 10, 2, {}, {3}});
  desk.said.erase({1});
  desk.run(6.0);
  auto list = desk.alarms.list();
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0]->key.kind, AlarmKind::vehicle_silent);
  desk.acknowledge(AlarmKind::vehicle_silent);
  list = desk.alarms.list();
  EXPECT_EQ(list[0]->key.kind, AlarmKind::separation);
  EXPECT_EQ(desk.alarms.counts().alarms, 1U);
  EXPECT_EQ(desk.alarms.counts().warnings, 1U);
  EXPECT_EQ(desk.alarms.counts().unacknowledged, 1U);
  EXPECT_TRUE(desk.alarms.acknowledge({}, "ada", desk.now()).ok());
  EXPECT_FALSE(desk.alarms.acknowledge({}, "ada", desk.now()).ok()) << "nothing waits any more";
  EXPECT_FALSE(desk.alarms.acknowledge({77}, "ada", desk.now()).ok());
}

TEST(Alarms, WhoHasLandedMayBeSwitchedOff) {
  Desk desk;
  for (auto& [id, telemetry] : desk.said) telemetry.activity = mission::Activity::landed;
  desk.run(1.0);
  desk.said.clear();
  desk.run(60.0);
  EXPECT_TRUE(desk.alarms.list().empty());
}

TEST(Alarms, ItDoesNotMatterWhenOneLooks) {
  Desk often;
  often.run(1.0);
  Desk seldom = often;
  often.said.erase({3});
  seldom.said.erase({3});
  often.run(20.0);
  seldom.run(20.0);
  Alarms again = seldom.alarms;  // a copy goes on as the first
  EXPECT_EQ(alarms_json(often.alarms), alarms_json(again));
}

TEST(Alarms, TheirWordsAndTheirSection) {
  Desk desk;
  desk.run(1.0);
  desk.said.erase({3});
  desk.run(6.0);
  const Json section = Json::parse(alarms_json(desk.alarms));
  EXPECT_EQ(section["counts"]["alarm"], 1);
  const Json& alarm = section["list"][0];
  EXPECT_EQ(alarm["key"], "vehicle_silent-3");
  EXPECT_EQ(alarm["vehicle"], 3);
  EXPECT_EQ(alarm["panel"], "fleet");
  EXPECT_NEAR(alarm["since_s"].get<double>(), 105.9, 0.2);
  EXPECT_TRUE(alarm["over_s"].is_null());
  const std::string text = alarms_text(desk.alarms, desk.now());
  EXPECT_THAT(text, HasSubstr("vehicle 3 is silent: heard last at 100.9 s, searching"));
  EXPECT_THAT(text, HasSubstr("what to do: look for it"));
  const Desk quiet;
  EXPECT_EQ(alarms_text(quiet.alarms, quiet.now()), "no alarms\n");
}

TEST(Alarms, WhoHasOnlyWatchedIsNotAlarmedThatAnotherHasTheCommand) {
  Desk desk;
  desk.run(0.5);
  desk.tell(kGroundStation, event::CommandHanded{false, "ben"});
  desk.run(0.5);
  EXPECT_TRUE(desk.of(AlarmKind::command_elsewhere).empty());
  EXPECT_EQ(desk.of(AlarmKind::told).size(), 1U);
  desk.alarms.on_command(true, desk.now());
  desk.run(0.5);
  EXPECT_EQ(desk.of(AlarmKind::nobody_commands).size(), 1U);
}

// --- how long it takes until vehicles obey ---

TEST(OrderAnswers, EachVehiclesOwnWordEndsItsWait) {
  Desk desk;
  desk.run(1.0);
  desk.order(CommandKind::hold);
  desk.run(0.4);
  desk.tell({1}, event::Commanded{CommandKind::hold});
  desk.said[{2}].detail = ActivityDetail::ordered;
  desk.run(0.5);
  const GivenOrder& order = desk.alarms.orders().orders().back();
  EXPECT_EQ(line_of(order), "hold all");
  EXPECT_EQ(order.waiting, (std::set<VehicleId>{{3}}));
  EXPECT_NEAR(to_seconds(order.answered.at({1})), 0.4, 0.01);
  EXPECT_NEAR(to_seconds(order.answered.at({2})), 0.4, 0.11);
  desk.run(9.5);
  ASSERT_EQ(desk.of(AlarmKind::no_answer).size(), 1U);
  EXPECT_THAT(desk.of(AlarmKind::no_answer)[0]->what,
              HasSubstr("vehicle 3 has not answered 'hold all'"));
  desk.order(CommandKind::resume);
  desk.run(0.3);
  EXPECT_TRUE(desk.of(AlarmKind::no_answer).at(0)->over) << "something else was ordered";
}

TEST(OrderAnswers, WhoStandsOnTheGroundIsNotAsked) {
  Desk desk;
  is_on_ground(desk);
  desk.run(1.0);
  desk.order(CommandKind::hold);
  desk.run(0.2);
  EXPECT_EQ(desk.alarms.orders().orders().back().waiting, (std::set<VehicleId>{{1}, {2}}));
}

TEST(OrderAnswers, AnOrderToSeveralIsOne) {
  Desk desk;
  desk.run(1.0);
  desk.order(CommandKind::hold, {1});
  desk.order(CommandKind::hold, {3});
  desk.run(0.2);
  ASSERT_EQ(desk.alarms.orders().orders().size(), 1U);
  const GivenOrder& order = desk.alarms.orders().orders().back();
  EXPECT_EQ(line_of(order), "hold 1, 3");
  EXPECT_EQ(order.waiting, (std::set<VehicleId>{{1}, {3}}));
  desk.run(1.0);
  desk.order(CommandKind::hold, {2});
  EXPECT_EQ(desk.alarms.orders().orders().size(), 2U);
}

TEST(OrderAnswers, AnOrderThatIsSaidAgainIsOne) {
  Desk desk;
  desk.run(1.0);
  desk.order(CommandKind::hold);
  desk.run(1.0);
  --desk.command;
  desk.order(CommandKind::hold);
  EXPECT_EQ(desk.alarms.orders().orders().size(), 1U);
}

TEST(OrderAnswers, ADecisionIsAnsweredByWhoIsToDeliver) {
  Desk desk;
  desk.grant();
  desk.run(0.3);
  EXPECT_EQ(desk.alarms.orders().orders().back().waiting, (std::set<VehicleId>{{2}}));
  desk.tell({2}, event::Authorised{"ada"}, kTask, {kCoalition, desk.round});
  const GivenOrder& order = desk.alarms.orders().orders().back();
  EXPECT_EQ(line_of(order), "authorise site 4");
  EXPECT_TRUE(order.waiting.empty());
  EXPECT_NEAR(to_seconds(order.answered.at({2})), 0.3, 0.01);
}

TEST(OrderAnswers, WhatIsTakenBackIsSaidAsItWasOrderedAndAnsweredByItsEnd) {
  Desk desk;
  desk.grant();
  desk.run(1.0);
  desk.decide(false);
  desk.run(0.3);
  const GivenOrder& order = desk.alarms.orders().orders().back();
  EXPECT_EQ(line_of(order), "withdraw decision 4");
  EXPECT_EQ(order.waiting.size(), 1U);
  const VehicleId leader = kCoalition.leader;
  desk.tell(leader, event::Cancelled{{coalition::Reason::grant_taken_back}}, kTask,
            {kCoalition, desk.round});
  EXPECT_TRUE(order.waiting.empty());
  desk.run(15.0);
  EXPECT_TRUE(desk.of(AlarmKind::no_answer).empty());
}

TEST(OrderAnswers, NobodyIsMissedWhereAnotherPlanIsAsked) {
  Desk desk;
  desk.grant();
  desk.run(1.0);
  desk.ask(30.0);
  desk.run(15.0);
  EXPECT_TRUE(desk.of(AlarmKind::no_answer).empty());
}

}  // namespace
}  // namespace skein::console
