// SPDX-License-Identifier: Apache-2.0
#include "skein/console/picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "skein/base/random.hpp"
#include "skein/console/sections.hpp"
#include "skein/mission/ground_agent.hpp"
#include "skein/mission/may_say.hpp"
#include "skein/random_messages/random_messages.hpp"

namespace skein::console {
namespace {

using Json = nlohmann::json;
using coalition::TaskState;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr VehicleId kLeader{1};
constexpr coalition::Round kRound{{kLeader, {77}, 1}, 1};

MissionOrigin origin() { return *MissionOrigin::make({47.0, 8.0, 500.0}); }

/// A picture, and short words for what it hears.
struct Desk {
  Picture picture{{.expected = {{1}, {2}, {3}}}};
  mission::Fleet fleet{{.expected = {{1}, {2}, {3}}}};

  void hear(const mission::Message& message, VehicleId sender, double seconds) {
    if (!mission::may_say(message, sender)) return;  // as the ground station's node has it
    fleet.on_message(message, at_seconds(seconds));
    picture.on_message(message, sender, at_seconds(seconds));
  }
  void telemetry(VehicleId vehicle, double sent_s, double heard_s, std::uint64_t instance = 1,
                 mission::Activity activity = mission::Activity::searching) {
    mission::Telemetry t;
    t.vehicle = vehicle;
    t.instance = {instance};
    t.activity = activity;
    t.state.time = at_seconds(sent_s);
    t.state.x_m = 10.0 * sent_s;
    t.range_left_m = 9000.0;
    hear(t, vehicle, heard_s);
  }
  void say(const coalition::Message& message, VehicleId sender, double seconds) {
    hear(mission::Message{message}, sender, seconds);
  }
  [[nodiscard]] Json section(Section section, double seconds) const {
    mission::Fleet then = fleet;
    then.on_timeout(at_seconds(seconds));
    return Json::parse(section_of(section, picture, then, origin(), "1.0", at_seconds(seconds)));
  }
  [[nodiscard]] std::vector<std::string> problems(std::size_t index, double seconds) const {
    std::vector<std::string> all;
    const Json vehicles = section(Section::vehicles, seconds);
    for (const Json& problem : vehicles[index]["problems"]) all.push_back(problem["text"]);
    return all;
  }
};

Site site() {
  Site site;
  site.id = {4};
  site.position = {100.0, 200.0};
  site.deliveries = {{0.0, {}}, {std::numbers::pi / 2.0, {}}};
  site.assessments = {{}};
  return site;
}

coalition::Announcement announcement() {
  coalition::Announcement a;
  a.round = kRound;
  a.site = site();
  a.tasks = tasks_after_survey(a.site);
  return a;
}

coalition::Award award() {
  coalition::Award a;
  a.round = kRound;
  a.site = site();
  a.assignments = {{{{4}, TaskKind::deliver, 0}, {2}, at_seconds(60.0)},
                   {{{4}, TaskKind::deliver, 1}, {3}, at_seconds(60.0)}};
  return a;
}

TEST(Picture, HasASectionOfChecks) {
  Desk desk;
  mission::Preflight told;
  told.vehicle = {2};
  told.instance = {1};
  told.complete = true;
  desk.telemetry({2}, 10.0, 10.1);
  desk.hear(told, {3}, 10.2);  // not its to say
  EXPECT_EQ(desk.section(Section::preflight, 10.3)["vehicles"][1]["readiness"], "not_known");
  desk.hear(told, {2}, 10.4);
  EXPECT_EQ(desk.section(Section::preflight, 10.5)["vehicles"][1]["readiness"], "ready");
  EXPECT_EQ(to_string(Section::preflight), "preflight");
}

TEST(Picture, NamesWhatNeedsAttention) {
  Desk desk;
  desk.telemetry({1}, 10.0, 10.1);
  desk.telemetry({2}, 10.0, 10.1);
  desk.telemetry({2}, 10.1, 10.2, 2);
  desk.telemetry({2}, 10.2, 10.3);
  desk.telemetry({9}, 9.0, 10.2);
  EXPECT_TRUE(desk.problems(0, 11.0).empty());
  EXPECT_THAT(desk.problems(1, 11.0), ElementsAre("two programs call themselves vehicle 2"));
  EXPECT_THAT(desk.problems(2, 11.0), ElementsAre("it was never heard"));
  EXPECT_THAT(desk.problems(3, 11.0),
              ElementsAre("it is not of this fleet", HasSubstr("its clock is 1.2 s off")));
  EXPECT_THAT(desk.problems(0, 16.0), ElementsAre(HasSubstr("not heard for 6 s")));
  mission::Health health;
  health.vehicle = {1};
  health.instance = {1};
  health.program = "skein-onboard 0.9";
  health.problems = {"no state"};
  desk.hear(health, {1}, 11.0);
  EXPECT_THAT(
      desk.problems(0, 11.0),
      ElementsAre("no state", "its program is of version 0.9, the ground station's of 1.0"));
}

TEST(Picture, NobodySpeaksForAnother) {
  Desk desk;
  mission::Telemetry t;
  t.vehicle = {1};
  desk.hear(t, {2}, 1.0);
  EXPECT_FALSE(desk.fleet.vehicles().at({1}).telemetry);
  EXPECT_TRUE(desk.picture.vehicles().at({1}).series.empty());
}

TEST(Picture, PutsTogetherWhatACoalitionSays) {
  Desk desk;
  desk.say(announcement(), kLeader, 10.0);
  coalition::Bid bid;
  bid.round = kRound;
  bid.bidder = {2};
  desk.say(bid, {2}, 11.0);
  desk.say(bid, {2}, 11.1);  // resent
  EXPECT_EQ(desk.section(Section::coalitions, 11.0)[0]["state"], "announced");
  desk.say(award(), kLeader, 12.0);
  desk.say(coalition::Confirmation{kRound, {2}, true, {}}, {2}, 12.1);
  Json coalition = desk.section(Section::coalitions, 12.2)[0];
  EXPECT_EQ(coalition["state"], "awarded");
  EXPECT_EQ(coalition["members"], Json::parse("[2, 3]"));
  EXPECT_EQ(coalition["rounds"][0]["bids"].size(), 1U);
  EXPECT_EQ(coalition["rounds"][0]["answers"][0]["accepted"], true);
  coalition::LeaseRenewal renewal;
  renewal.round = kRound;
  renewal.site = {4};
  renewal.members = {{2}, {3}};
  renewal.electors = {{2}};
  renewal.lease_until = at_seconds(99.0);
  desk.say(renewal, kLeader, 13.0);
  EXPECT_EQ(desk.section(Section::coalitions, 13.0)[0]["state"], "formed");
  desk.say(announcement(), kGroundStation, 14.0);  // passed on: nothing new
  EXPECT_EQ(desk.section(Section::coalitions, 14.0)[0]["state"], "formed");
  renewal.closed = true;
  desk.say(renewal, kLeader, 15.0);
  EXPECT_EQ(desk.section(Section::coalitions, 15.0)[0]["state"], "closed");
}

TEST(Picture, SaysWhyACoalitionFailed) {
  Desk desk;
  desk.say(announcement(), kLeader, 10.0);
  mission::MissionEvent event;
  event.round = kRound;
  event.task.site = {4};
  event.body = mission::event::AllocationFailed{3, "nobody can deliver from 090"};
  desk.picture.on_event(event);
  const Json coalition = desk.section(Section::coalitions, 11.0)[0];
  EXPECT_EQ(coalition["state"], "failed");
  EXPECT_EQ(coalition["why"], "nobody can deliver from 090");
}

TEST(Picture, ATaskIsNeverLessDoneThanItWas) {
  Desk desk;
  desk.say(award(), kLeader, 12.0);
  const TaskId task{{4}, TaskKind::deliver, 0};
  const auto state = [&] { return desk.picture.sites().at({4}).tasks.at(task).state; };
  EXPECT_EQ(state(), TaskState::planned);
  desk.say(coalition::MemberStatus{kRound, {2}, {{task, TaskState::done, {}}}}, {2}, 13.0);
  EXPECT_EQ(state(), TaskState::done);
  desk.say(coalition::MemberStatus{kRound, {2}, {{task, TaskState::started, {}}}}, {2}, 14.0);
  desk.say(award(), kLeader, 15.0);
  EXPECT_EQ(state(), TaskState::done);
  const Json tasks = desk.section(Section::sites, 15.0)[0]["tasks"];
  EXPECT_EQ(tasks[1]["state"], "done");
  EXPECT_EQ(tasks[1]["bearing_deg"], 90.0);  // flown towards the east
  EXPECT_EQ(tasks[2]["bearing_deg"], 0.0);
}

TEST(Picture, ATaskThatFailedSaysSoUntilANewRound) {
  Desk desk;
  desk.say(award(), kLeader, 12.0);
  const TaskId task{{4}, TaskKind::deliver, 0};
  const auto state = [&] { return desk.picture.sites().at({4}).tasks.at(task).state; };
  desk.say(coalition::MemberStatus{kRound, {2}, {{task, TaskState::started, {}}}}, {2}, 13.0);
  desk.say(coalition::MemberStatus{kRound, {2}, {{task, TaskState::failed, {}}}}, {2}, 14.0);
  EXPECT_EQ(state(), TaskState::failed);
  EXPECT_FALSE(desk.picture.task_of({2}));
  coalition::Award again = award();
  again.round.number = 2;
  desk.say(again, kLeader, 15.0);
  EXPECT_EQ(state(), TaskState::planned);
}

/// What the site says of its first delivery: who, and how far.
std::string first_delivery(const Desk& desk, double seconds) {
  const Json task = desk.section(Section::sites, seconds)[0]["tasks"][1];
  return (task["vehicle"].is_null() ? "nobody" : std::to_string(task["vehicle"].get<int>())) + " " +
         task["state"].get<std::string>();
}

TEST(Picture, WhatIsRefusedCancelledOrGivenBackNobodyHasAnyMore) {
  Desk desk;
  desk.say(announcement(), kLeader, 11.0);
  desk.say(award(), kLeader, 12.0);
  EXPECT_EQ(first_delivery(desk, 12.1), "2 planned");
  desk.say(coalition::Cancel{kRound, {coalition::Reason::not_confirmed}}, kLeader, 13.0);
  EXPECT_EQ(first_delivery(desk, 13.1), "nobody open");

  desk.say(award(), kLeader, 14.0);
  EXPECT_EQ(first_delivery(desk, 14.1), "2 planned");
  desk.say(coalition::Confirmation{kRound, {2}, false, {}}, {2}, 14.2);
  EXPECT_EQ(first_delivery(desk, 14.3), "nobody open");

  desk.say(award(), kLeader, 15.0);
  EXPECT_EQ(desk.section(Section::sites, 15.0)[0]["leader"], 1);
  desk.hear(mission::Authorisation{kRound, {4}, false, "ada", at_seconds(16.0)}, kGroundStation,
            16.0);
  EXPECT_EQ(first_delivery(desk, 16.1), "nobody open");
  const Json site = desk.section(Section::sites, 16.1)[0];
  EXPECT_EQ(site["status"], "refused");
  EXPECT_EQ(site["leader"], nullptr);
  // On its way before that was heard.
  const TaskId task{{4}, TaskKind::deliver, 0};
  desk.say(coalition::MemberStatus{kRound, {2}, {{task, TaskState::planned, {}}}}, {2}, 16.2);
  EXPECT_EQ(first_delivery(desk, 16.3), "nobody open");
}

TEST(Picture, WhoSaysThatItStillHasWhatNobodyElseHasIsShownWithIt) {
  Desk desk;
  desk.say(announcement(), kLeader, 11.0);
  desk.say(award(), kLeader, 12.0);
  desk.say(coalition::Cancel{kRound, {coalition::Reason::not_confirmed}}, kLeader, 13.0);
  EXPECT_EQ(first_delivery(desk, 13.1), "nobody open");
  mission::Telemetry told;
  told.vehicle = {2};
  told.activity = mission::Activity::executing;
  told.task = {{4}, TaskKind::deliver, 0};
  desk.hear(told, {2}, 14.0);  // it has not heard of that
  EXPECT_EQ(first_delivery(desk, 14.1), "2 planned");
  told.activity = mission::Activity::searching;
  told.task = {};
  desk.hear(told, {2}, 15.0);
  EXPECT_EQ(first_delivery(desk, 15.1), "nobody open");
  desk.hear(mission::Authorisation{kRound, {4}, false, "ada", at_seconds(16.0)}, kGroundStation,
            16.0);
  told.task = {{4}, TaskKind::deliver, 0};
  desk.hear(told, {2}, 16.1);  // of a refused site only what it says of its state is shown
  EXPECT_EQ(first_delivery(desk, 16.2), "nobody open");
}

TEST(Picture, WhatBecameOfATaskInOtherHandsIsNotOfWhoHasItNow) {
  Desk desk;
  const TaskId task{{4}, TaskKind::deliver, 0};
  desk.say(announcement(), kLeader, 11.0);
  desk.say(award(), kLeader, 12.0);
  const coalition::Round before{{{3}, {9}, 1}, 1};
  desk.picture.on_event({{3}, at_seconds(12.5), before, task, mission::event::TaskFailed{}});
  desk.say(coalition::MemberStatus{before, {3}, {{task, TaskState::failed, {}}}}, {3}, 12.6);
  EXPECT_EQ(first_delivery(desk, 12.7), "2 planned");
  desk.picture.on_event({{2}, at_seconds(12.8), kRound, task, mission::event::TaskFailed{}});
  EXPECT_EQ(first_delivery(desk, 12.9), "2 failed");
}

/// Its award or the end of it was heard here alone, or not here.
TEST(Picture, InTheEndVehiclesThemselvesKnowWhatTheyHave) {
  Desk desk;
  const TaskId task{{4}, TaskKind::deliver, 0};
  mission::Telemetry told;
  const auto tell = [&](VehicleId vehicle, bool has_it, double seconds) {
    told.vehicle = vehicle;
    told.activity = has_it ? mission::Activity::executing : mission::Activity::searching;
    told.task = has_it ? task : TaskId{};
    told.state.time = at_seconds(seconds);
    desk.hear(told, vehicle, seconds);
    return first_delivery(desk, seconds);
  };
  desk.say(announcement(), kLeader, 11.0);
  desk.say(award(), kLeader, 12.0);
  EXPECT_EQ(tell({2}, false, 12.5), "2 planned") << "it may not have heard the award yet";
  EXPECT_EQ(tell({2}, false, 13.5), "nobody open");
  EXPECT_EQ(tell({2}, true, 14.0), "2 planned");
  EXPECT_EQ(tell({3}, true, 14.5), "2 planned") << "who had it last may not have spoken yet";
  EXPECT_EQ(tell({3}, true, 15.5), "3 planned");
  desk.say(coalition::MemberStatus{kRound, {3}, {{task, TaskState::started, {}}}}, {3}, 16.0);
  EXPECT_EQ(tell({3}, false, 16.5), "3 started") << "that it is done may be on its way";
  EXPECT_EQ(tell({3}, false, 17.5), "3 unknown") << "started anew, it knows nothing of it";
}

TEST(Picture, AVehiclesOwnWordOnItsTaskCounts) {
  Desk desk;
  mission::Telemetry told;
  told.vehicle = {2};
  const auto tell = [&](double seconds) {
    told.state.time = at_seconds(seconds);
    desk.hear(told, {2}, seconds);
  };
  const auto shown = [&](double seconds) {
    const Json task = desk.section(Section::vehicles, seconds)[1]["task"];
    return task.is_null() ? "none" : task["kind"].get<std::string>();
  };
  desk.say(award(), kLeader, 12.0);
  tell(12.1);  // it has not heard the award
  EXPECT_EQ(shown(12.1), "none");
  EXPECT_EQ(first_delivery(desk, 12.1), "2 planned");
  told.task = {{4}, TaskKind::deliver, 0};
  told.activity = mission::Activity::executing;
  tell(12.3);
  EXPECT_EQ(shown(12.3), "deliver");
  told.task = {};
  told.activity = mission::Activity::searching;
  tell(12.5);
  EXPECT_EQ(shown(12.5), "none");
  EXPECT_EQ(first_delivery(desk, 12.5), "nobody open");
}

TEST(Picture, OfAnOlderReleaseTheAwardTellsTheTask) {
  Desk desk;
  desk.say(award(), kLeader, 12.0);
  desk.telemetry({2}, 12.5, 12.5, 1, mission::Activity::executing);
  EXPECT_EQ(desk.section(Section::vehicles, 12.5)[1]["task"]["kind"], "deliver");
  EXPECT_EQ(desk.section(Section::vehicles, 12.5)[1]["state"], "executing");
  desk.telemetry({2}, 13.0, 13.0, 1, mission::Activity::holding);
  EXPECT_EQ(desk.section(Section::vehicles, 13.0)[1]["task"], nullptr);
}

TEST(Picture, StatesAreToldApart) {
  Desk desk;
  using Detail = mission::ActivityDetail;
  const auto state = [&](Detail detail, double seconds) {
    mission::Telemetry t;
    t.vehicle = {1};
    t.activity = mission::Activity::holding;
    t.detail = detail;
    t.state.time = at_seconds(seconds);
    desk.hear(t, {1}, seconds);
    return desk.section(Section::vehicles, seconds)[0]["state"].get<std::string>();
  };
  EXPECT_EQ(state(Detail::none, 1.0), "holding");
  EXPECT_EQ(state(Detail::ordered, 2.0), "holding_by_order");
  EXPECT_EQ(state(Detail::returning, 3.0), "returning");
  EXPECT_EQ(state(Detail::range_reserve, 4.0), "range_reserve");
  EXPECT_EQ(desk.section(Section::vehicles, 10.0)[0]["state"], "silent");
}

TEST(Picture, ASilentVehicleIsSilentOnTheTimeLineToo) {
  Desk desk;
  desk.telemetry({1}, 1.0, 1.0);
  const Json silent = desk.section(Section::timeline, 8.0);
  EXPECT_EQ(silent["states"], Json::parse(R"(["searching", "silent"])"));
  EXPECT_EQ(silent["vehicles"][0], Json::parse(R"({"id": 1, "states": [0, 1],
                "from_s": [1.0, 1.0], "sites": [null, null]})"));
  desk.telemetry({1}, 9.0, 9.0);
  EXPECT_EQ(desk.section(Section::timeline, 9.5)["vehicles"][0],
            Json::parse(R"({"id": 1, "states": [0, 1, 0], "from_s": [1.0, 1.0, 9.0],
                            "sites": [null, null, null]})"));
}

/// A request of the plan that award() has, with one of its two deliveries.
mission::AuthorisationRequest half_a_request(std::uint32_t round = 1) {
  mission::AuthorisationRequest request;
  request.round = kRound;
  request.round.number = round;
  request.site = {4};
  request.site_position = {100.0, 200.0};
  request.decide_by = at_seconds(50.0);
  request.deliveries = {{award().assignments[0], 0.0}};
  return request;
}

TEST(AuthorisationCard, MarksWhoIsSilentLateOrLowOnRange) {
  Desk desk;
  mission::Telemetry told;
  told.vehicle = {2};
  told.task = {{4}, TaskKind::deliver, 0};
  told.activity = mission::Activity::executing;
  told.range_left_m = 9000.0;
  told.state.groundspeed_mps = 20.0;
  const auto tell = [&](double seconds) {
    told.state.time = at_seconds(seconds);
    desk.hear(told, {2}, seconds);
  };
  const auto marks = [&](double seconds) {
    std::vector<std::string> all;
    const Json requests = desk.section(Section::authorisations, seconds);
    for (const Json& mark : requests[0]["deliveries"][0]["marks"]) {
      all.push_back(mark["text"]);
    }
    return all;
  };
  desk.say(announcement(), kLeader, 10.0);
  tell(10.0);
  desk.hear(half_a_request(), kLeader, 10.0);
  EXPECT_THAT(marks(10.1), ElementsAre());
  told.range_left_m = 1200.0;  // 49 s at 20 m/s, and back to where it was heard first
  tell(11.0);
  EXPECT_THAT(marks(11.1),
              ElementsAre("low on range: 1.2 km left; 1.0 km to its delivery, 0.2 km home"));
  told.range_left_m = 9000.0;
  told.state.x_m = 1500.0;  // at 20 m/s over 1.4 km in 48 s
  tell(12.0);
  EXPECT_THAT(marks(12.1), ElementsAre(HasSubstr("late: by ")));
  told.state.x_m = 0.0;
  told.task = {};
  told.activity = mission::Activity::holding;
  told.detail = mission::ActivityDetail::range_reserve;
  tell(13.0);
  EXPECT_THAT(marks(13.1), ElementsAre("does not have this delivery any more: range reserve",
                                       "its range is used up, but for the way home"));
  EXPECT_THAT(marks(25.0), ::testing::Contains(HasSubstr("silent for 12 s")));
}

/// By its bid, 2 km of its range are for the way home.
TEST(AuthorisationCard, LowOnRangeIsAMatterOfTheAircraft) {
  for (const double left_m : {3600.0, 3200.0}) {
    Desk desk;
    mission::Telemetry told;
    told.vehicle = {2};
    told.task = {{4}, TaskKind::deliver, 0};
    told.activity = mission::Activity::executing;
    told.range_left_m = left_m;
    coalition::Announcement call = announcement();
    call.formed_at = at_seconds(10.0);
    desk.say(call, kLeader, 9.0);
    coalition::Bid bid;
    bid.round = kRound;
    bid.bidder = {2};
    bid.speed_mps = 20.0;
    bid.range_left_m = left_m - 2000.0;
    desk.say(bid, {2}, 9.5);
    told.state.time = at_seconds(10.0);
    desk.hear(told, {2}, 10.0);
    desk.hear(half_a_request(), kLeader, 10.0);
    const Json marks = desk.section(Section::authorisations, 10.1)[0]["deliveries"][0]["marks"];
    // 50 s at 20 m/s to its delivery, and 2 km home.
    ASSERT_EQ(marks.size(), left_m < 3300.0 ? 1U : 0U) << marks;
    if (marks.empty()) continue;
    EXPECT_EQ(marks[0]["text"], "low on range: 3.2 km left; 1.0 km to its delivery, 2.0 km home");
  }
}

TEST(Picture, WhatTheGroundStationLetsNobodyDecideDoesNotWait) {
  Desk desk;
  desk.say(announcement(), kLeader, 10.0);
  desk.say(award(), kLeader, 11.0);
  desk.hear(half_a_request(), kLeader, 12.0);
  EXPECT_EQ(desk.section(Section::authorisations, 12.1)[0]["waiting"], true);
  const mission::GroundAgent knows_of_none{{}, at_seconds(0.0)};
  desk.picture.on_decisions(knows_of_none, at_seconds(12.2));
  const Json shown = desk.section(Section::authorisations, 12.3)[0];
  EXPECT_EQ(shown["waiting"], false);
  EXPECT_EQ(shown["can_take_back"], false);
}

TEST(Picture, WhatWasGrantedAndTakenBackIsToldApartFromARefusal) {
  Desk desk;
  desk.say(announcement(), kLeader, 10.0);
  desk.say(award(), kLeader, 11.0);
  const mission::AuthorisationRequest request = half_a_request();
  desk.hear(request, kLeader, 12.0);
  mission::Authorisation grant{request.round,    request.site, true, "ada",
                               at_seconds(13.0), {},           {},   {}};
  mission::Authorisation back{request.round,    request.site, false, "bob",
                              at_seconds(14.0), {},           {},    {}};
  desk.hear(grant, kGroundStation, 13.0);
  Json shown = desk.section(Section::authorisations, 13.5)[0];
  EXPECT_EQ(shown["can_take_back"], true);
  EXPECT_EQ(shown["deliveries"][0]["before_gate"], true);
  EXPECT_EQ(desk.section(Section::authorisations, 60.5)[0]["can_take_back"], false);
  desk.hear(back, kGroundStation, 14.0);
  desk.hear(grant, kGroundStation, 14.5);  // a late copy
  shown = desk.section(Section::authorisations, 15.0)[0];
  EXPECT_EQ(shown["decision"]["granted"], false);
  EXPECT_EQ(shown["decision"]["taken_back"], true);
  EXPECT_EQ(shown["can_take_back"], false);
  EXPECT_EQ(desk.section(Section::sites, 15.0)[0]["status"], "taken_back");
}

TEST(AuthorisationCard, SaysWhatIsMissingAndWhyAndWhatHasChanged) {
  Desk desk;
  coalition::Announcement announced = announcement();
  coalition::Bid bid;
  bid.round = kRound;
  bid.bidder = {2};
  bid.capabilities.add(TaskKind::deliver);
  bid.loads = 1;
  desk.say(announced, kLeader, 10.0);
  desk.say(bid, {2}, 10.5);
  for (const std::uint16_t id : {std::uint16_t{1}, std::uint16_t{2}, std::uint16_t{3}}) {
    mission::Telemetry told;
    told.vehicle = {id};
    told.state.time = at_seconds(10.6);
    told.loads = 1;
    told.range_left_m = 9000.0;
    if (id == 3) {
      told.declined = {kRound, coalition::Reason::out_of_range};
    }
    desk.hear(told, {id}, 10.6);
  }
  desk.hear(half_a_request(), kLeader, 11.0);
  const Json card = desk.section(Section::authorisations, 11.1)[0];
  ASSERT_EQ(card["missing"].size(), 1U);
  EXPECT_EQ(card["missing"][0]["index"], 1);
  EXPECT_EQ(card["missing"][0]["why"], "1 that can deliver has bid");
  EXPECT_EQ(card["did_not_bid"], Json::parse(R"([
      {"vehicle": 1, "why": "no bid of it was heard"},
      {"vehicle": 3, "why": "not enough range left"}])"));
  EXPECT_TRUE(card["changes"].empty());

  announced.round.number = 2;
  desk.say(announced, kLeader, 20.0);
  auto next = half_a_request(2);
  next.deliveries[0].assignment.vehicle = {3};
  next.deliveries[0].assignment.time += from_seconds(12.0);
  desk.hear(next, kLeader, 21.0);
  const Json second = desk.section(Section::authorisations, 21.1)[1];
  EXPECT_EQ(second["changes"],
            Json::parse(R"(["round 1 was not decided", "delivery 1: vehicle 3 instead of 2",
                            "delivery 1: 12.0 s later"])"));
  EXPECT_TRUE(desk.section(Section::authorisations, 21.1)[0]["missing"].empty()) << "over";
}

TEST(Picture, AReplacedPlanDoesNotWait) {
  Desk desk;
  mission::AuthorisationRequest request;
  request.round = kRound;
  request.site = {4};
  request.decide_by = at_seconds(30.0);
  desk.hear(request, kLeader, 20.0);
  request.round.number = 2;
  desk.hear(request, kLeader, 21.0);
  request.round.number = 1;
  desk.hear(request, kLeader, 22.0);  // late
  const Json all = desk.section(Section::authorisations, 23.0);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0]["waiting"], false);
  EXPECT_EQ(all[1]["waiting"], true);
}

TEST(Picture, WhoHasStartedAnewIsNoDuplicate) {
  Desk desk;
  const auto duplicate = [&desk](double seconds) -> bool {
    return desk.section(Section::vehicles, seconds)[0]["duplicate"];
  };
  desk.telemetry({1}, 1.0, 1.0, 1);
  desk.telemetry({1}, 2.0, 2.0, 2);
  EXPECT_FALSE(duplicate(2.0));
  desk.telemetry({1}, 2.1, 2.1, 1);  // the first one speaks still
  EXPECT_TRUE(duplicate(2.1));
  EXPECT_FALSE(duplicate(9.0));
}

TEST(Picture, AFormationIsInPlaceWhenAllAre) {
  Desk desk;
  formation::Change change;
  change.number = 3;
  change.start = at_seconds(0.0);
  change.limits = {5.0, 2.0, 4.0};
  change.separation = {2.0, 4.0};
  change.movers = {{{1}, {{0.0, 0.0, 5.0}, {10.0, 0.0, 5.0}}, 0},
                   {{2}, {{0.0, 9.0, 5.0}, {10.0, 9.0, 5.0}}, 0}};
  desk.hear(change, kGroundStation, 0.0);
  const auto status = [&](VehicleId vehicle, std::uint32_t flown, const Vec3& at, double seconds) {
    mission::FormationStatus s;
    s.vehicle = vehicle;
    s.progress.change = flown;
    s.position_m = at;
    desk.hear(s, vehicle, seconds);
  };
  const auto in_place = [&](double seconds) -> bool {
    return desk.section(Section::formation, seconds)["in_place"];
  };
  status({1}, 3, {10.0, 0.1, 5.0}, 60.0);
  status({2}, 2, {10.0, 9.0, 5.0}, 60.0);  // has never taken the change
  EXPECT_FALSE(in_place(60.0));
  status({2}, 3, {8.0, 9.0, 5.0}, 61.0);  // stopped on its way
  EXPECT_FALSE(in_place(61.0));
  status({2}, 3, {10.0, 9.1, 5.0}, 62.0);
  EXPECT_TRUE(in_place(62.0));
  EXPECT_FALSE(in_place(70.0));  // not heard any more
}

TEST(Picture, APlaceOnATrackMovesAndIsKeptAllTheSame) {
  Desk desk;
  desk.picture = Picture{{.expected = {{1}, {2}}, .place_tolerance_m = 8.0}};
  for (const std::uint16_t id : {std::uint16_t{1}, std::uint16_t{2}}) {
    mission::TrackFlight flight;
    flight.vehicle = {id};
    flight.number = 4;
    flight.joined = at_seconds(50.0);
    desk.telemetry({id}, 1.0, 1.0, 1);
    desk.hear(flight, kGroundStation, 1.0);
  }
  const auto status = [&](VehicleId vehicle, double off_m, double seconds) {
    mission::FormationStatus s;
    s.vehicle = vehicle;
    s.progress.change = 4;
    s.progress.off_m = off_m;
    s.at_rest = false;
    desk.hear(s, vehicle, seconds);
  };
  const auto section = [&](double seconds) { return desk.section(Section::formation, seconds); };
  status({1}, 1.0, 40.0);
  status({2}, 1.0, 40.0);
  EXPECT_FALSE(section(40.0)["in_place"]);  // on their ways
  EXPECT_TRUE(section(40.0)["moving"]);
  status({1}, 1.0, 60.0);
  status({2}, 30.0, 60.0);
  EXPECT_FALSE(section(60.0)["in_place"]);
  status({2}, 2.0, 61.0);
  EXPECT_TRUE(section(61.0)["in_place"]);
  EXPECT_FALSE(section(61.0)["moving"]);
}

TEST(Picture, AnAuthorisationWaitsUntilItIsDecidedOrLate) {
  Desk desk;
  mission::AuthorisationRequest request;
  request.round = kRound;
  request.site = {4};
  request.decide_by = at_seconds(30.0);
  request.deliveries.push_back({award().assignments[0], 0.0});
  desk.hear(request, kLeader, 20.0);
  desk.hear(request, kLeader, 21.0);  // resent
  ASSERT_EQ(desk.section(Section::authorisations, 21.0).size(), 1U);
  EXPECT_EQ(desk.section(Section::authorisations, 29.0)[0]["waiting"], true);
  EXPECT_EQ(desk.section(Section::authorisations, 30.0)[0]["waiting"], false);
  desk.hear(mission::Authorisation{kRound, {4}, true, "ada", at_seconds(25.0)}, kGroundStation,
            25.0);
  const Json decided = desk.section(Section::authorisations, 26.0)[0];
  EXPECT_EQ(decided["waiting"], false);
  for (const Json& delivery : decided["deliveries"]) {
    EXPECT_EQ(delivery["marks"], Json::array()) << "the page counts on it";
  }
  EXPECT_EQ(decided["decision"]["by"], "ada");
  EXPECT_EQ(decided["coalition"], key_of(kRound.coalition));
}

TEST(Picture, ActivitiesMakeATimeLine) {
  Desk desk;
  for (int t = 0; t < 30; ++t) {
    desk.telemetry({1}, t, t, 1,
                   t < 10 ? mission::Activity::searching : mission::Activity::surveying);
  }
  mission::Telemetry assesses;
  assesses.vehicle = {2};
  assesses.instance = {2};
  assesses.state.time = at_seconds(20.0);
  assesses.activity = mission::Activity::executing;
  assesses.detail = mission::ActivityDetail::assessing;
  assesses.task = {{4}, TaskKind::assess, 1};
  desk.hear(assesses, {2}, 20.0);
  EXPECT_EQ(desk.section(Section::timeline, 30.0),
            Json::parse(R"({"states": ["searching", "surveying", "assessing", "silent"],
      "vehicles": [{"id": 1, "states": [0, 1], "from_s": [0.0, 10.0], "sites": [null, null]},
                   {"id": 2, "states": [2, 3], "from_s": [20.0, 20.0], "sites": [4, null]},
                   {"id": 3, "states": [], "from_s": [], "sites": []}]})"));
  EXPECT_EQ(Json::parse(series_of(desk.picture))[0]["t"].size(), 30U);
}

TEST(Picture, APlanIsDrawnFromItsStartToItsEnd) {
  Desk desk;
  mission::PlanReport report;
  report.vehicle = {1};
  report.plan.number = 3;
  report.plan.timed.start_time = at_seconds(10.0);
  report.plan.timed.speed_mps = 50.0;
  report.plan.timed.tail_curvature_per_m = 0.01;
  ASSERT_TRUE(report.plan.timed.path.append(Segment{0.0, 500.0}));
  ASSERT_TRUE(report.plan.timed.path.append(Segment{0.01, 100.0 * std::numbers::pi}));
  desk.hear(report, {1}, 10.0);
  const Json plan = desk.section(Section::plans, 10.0)[0];
  EXPECT_EQ(plan["points"].front(), Json::parse("[0.0, 0.0, 10.0]"));
  EXPECT_EQ(plan["points"].back()[0], 500.0);
  EXPECT_EQ(plan["points"].back()[1], 200.0);
  EXPECT_GT(plan["points"].size(), 15U);
  EXPECT_EQ(plan["hold"].front(), plan["hold"].back());
}

/// Whatever the network brings, the sections are JSON and memory is bounded.
TEST(Picture, AnyMessagesMakeAPicture) {
  Random random{5};
  PictureParams params{.expected = {{1}}};
  params.coalitions_max = 20;
  params.rounds_max = 5;
  params.authorisations_max = 20;
  params.sites_max = 20;
  Picture picture{params};
  mission::Fleet fleet{{.expected = {{1}}}};
  Instant now{};
  for (std::size_t i = 0; i < 1500; ++i) {
    now += from_seconds(random.uniform(0.0, 0.5));
    mission::Message message = codec::random_message(random.index(codec::kMessageKinds), random);
    // Several words of one coalition.
    const auto few = [&](auto& m) {
      if constexpr (requires { m.round; }) {
        m.round = {{{static_cast<std::uint16_t>(random.index(3))}, {1}, 1},
                   static_cast<std::uint32_t>(random.index(8))};
      }
    };
    if (auto* said = std::get_if<coalition::Message>(&message)) {
      std::visit(few, *said);
    } else {
      std::visit(few, message);
    }
    if (const auto* event = std::get_if<mission::MissionEvent>(&message)) picture.on_event(*event);
    fleet.on_message(message, now);
    picture.on_message(message, {static_cast<std::uint16_t>(random.index(4))}, now);
    if (i % 300 != 0) continue;
    for (std::size_t s = 0; s < static_cast<std::size_t>(Section::audit); ++s) {
      const auto section = static_cast<Section>(s);
      EXPECT_TRUE(Json::accept(section_of(section, picture, fleet, origin(), "1.0", now)))
          << to_string(section);
    }
  }
  EXPECT_LE(picture.coalitions().size(), 20U);
  EXPECT_LE(picture.authorisations().size(), 20U);
  EXPECT_EQ(picture.sites().size(), 20U);
  for (const auto& [id, coalition] : picture.coalitions()) EXPECT_LE(coalition.rounds.size(), 5U);
}

}  // namespace
}  // namespace skein::console
