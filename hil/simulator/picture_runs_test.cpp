// SPDX-License-Identifier: Apache-2.0
// What the operator is shown, held against what the vehicles themselves are about, at every moment
// of whole missions: the console's sections and the table of `status` may be late by the radio, and
// never wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "skein/console/picture.hpp"
#include "skein/console/sections.hpp"
#include "skein/groundstation/views.hpp"
#include "skein/hil/team_mission.hpp"
#include "skein/hil/team_simulator.hpp"
#include "skein/mission/shown_state.hpp"

namespace skein::hil {
namespace {

using Json = nlohmann::json;
using mission::CommandKind;
using mission::EventKind;

/// Telemetry every 200 ms, and the radio's delay.
constexpr Duration kLate = std::chrono::milliseconds{500};
/// What reliable messages may take, where one is lost and said again.
constexpr Duration kWordLate = std::chrono::milliseconds{1500};
constexpr Duration kSilence = std::chrono::seconds{5};

/// What one vehicle was about, lately.
struct Own {
  struct Moment {
    Instant at{};
    std::string state;
    std::string task;
  };
  std::deque<Moment> lately;
  std::optional<Instant> ended;  ///< its program

  [[nodiscard]] bool was(const std::string& state) const {
    return std::ranges::any_of(lately, [&](const Moment& m) { return m.state == state; });
  }
  [[nodiscard]] bool had(const std::string& task) const {
    return std::ranges::any_of(lately, [&](const Moment& m) { return m.task == task; });
  }
};

/// What the vehicles' own events, which are told in true time, say of it besides.
struct Facts {
  std::optional<CommandKind> order;  ///< the newest that it obeys
  bool range_spent = false;
  bool authorised = false;  ///< its newest delivery
};

class Watch {
 public:
  /// `late`: what telemetry, and what reliable messages, may take.
  explicit Watch(const TeamMission& team, Duration late = kLate, Duration word_late = kWordLate)
      : late_{late}, word_late_{word_late}, origin_{*MissionOrigin::make({47.0, 8.0, 500.0})} {
    console::PictureParams params;
    for (const auto& v : team.vehicles) params.expected.push_back(v.spec.id);
    picture_.emplace(params);
  }

  TeamObserver observer() {
    TeamObserver observer;
    observer.event = [this](const mission::MissionEvent& e) { note(e); };
    observer.ground_message = [this](const mission::Message& m, VehicleId sender, Instant now) {
      picture_->on_message(m, sender, now);
    };
    observer.ground_event = [this](const mission::MissionEvent& e) { picture_->on_event(e); };
    observer.moment = [this](Instant now, const mission::GroundNode& node,
                             const std::vector<OwnWord>& words) { look(now, node, words); };
    return observer;
  }

  /// States that were shown, of any vehicle.
  std::set<std::string> seen;
  std::map<std::uint16_t, std::set<std::string>> seen_of;
  /// When a task of a vehicle was shown last.
  std::optional<Instant> task_shown;
  std::optional<Instant> refused_at;
  std::vector<mission::MissionEvent> events;
  int cards = 0;   ///< that waited, at some moment
  int marked = 0;  ///< deliveries in them
  std::set<std::string> reasons;
  std::map<std::uint16_t, std::set<std::string>> did_not_bid;

 private:
  static std::string text_of(const TaskId& task) {
    return task.site == SiteId{} ? "" : to_string(task);
  }

  void note(const mission::MissionEvent& e) {
    events.push_back(e);
    Facts& facts = facts_[e.vehicle];
    if (const auto* order = std::get_if<mission::event::Commanded>(&e.body)) {
      facts.order = order->command;
      if (order->command == CommandKind::resume) facts.order.reset();
    }
    facts.range_spent = facts.range_spent || e.kind() == EventKind::range_spent;
    if (e.kind() == EventKind::confirmed) facts.authorised = false;
    if (e.kind() == EventKind::authorised) facts.authorised = true;
    if (e.kind() == EventKind::authorisation_refused && e.vehicle == kGroundStation) {
      refused_at = e.time;
    }
  }

  void look(Instant now, const mission::GroundNode& node, const std::vector<OwnWord>& words) {
    for (const OwnWord& word : words) remember(word, now);
    const Json vehicles = section(console::Section::vehicles, node, now);
    const std::string table = groundstation::fleet_table(node.fleet().vehicles(), now);
    for (const Json& v : vehicles) {
      if (v["state"].is_null()) continue;  // not heard yet
      const VehicleId id{v["id"].get<std::uint16_t>()};
      const std::string state = v["state"];
      seen.insert(state);
      seen_of[id.value].insert(state);
      judge_state(id, state, now);
      if (state != "silent") judge_facts(id, state, now);
      judge_task(id, v["task"], state, now);
      judge_table(table, id, state);
    }
    judge_sites(section(console::Section::sites, node, now), now);
    judge_cards(section(console::Section::authorisations, node, now), now);
  }

  /// Of what can be decided: who has fallen silent is marked, and nobody else.
  void judge_cards(const Json& requests, Instant now) {
    for (const Json& request : requests) {
      if (!request["waiting"].get<bool>()) continue;
      ++cards;
      for (const Json& delivery : request["deliveries"]) {
        const Own& own = own_[VehicleId{delivery["vehicle"].get<std::uint16_t>()}];
        const std::string marks = delivery["marks"].dump();
        const bool is_marked = marks.find("silent for") != std::string::npos;
        marked += is_marked ? 1 : 0;
        EXPECT_FALSE(is_marked && !own.ended) << marks;
        EXPECT_FALSE(!is_marked && own.ended && now > *own.ended + kSilence + late_)
            << "vehicle " << delivery["vehicle"] << " is silent at " << to_seconds(now);
      }
      for (const Json& missing : request["missing"]) {
        reasons.insert(missing["why"].get<std::string>());
      }
      for (const Json& who : request["did_not_bid"]) {
        did_not_bid[who["vehicle"].get<std::uint16_t>()].insert(who["why"].get<std::string>());
      }
    }
  }

  Json section(console::Section which, const mission::GroundNode& node, Instant now) const {
    return Json::parse(console::section_of(which, *picture_, node.fleet(), origin_, "1", now));
  }

  void remember(const OwnWord& word, Instant now) {
    Own& own = own_[word.vehicle];
    if (!word.telemetry) {
      if (!own.ended && !own.lately.empty()) own.ended = now;
      return;
    }
    own.ended.reset();
    own.lately.push_back({now,
                          std::string{to_string(mission::shown_state(word.telemetry->activity,
                                                                     word.telemetry->detail))},
                          text_of(word.telemetry->task)});
    while (now - own.lately.front().at > late_) own.lately.pop_front();
  }

  void judge_state(VehicleId id, const std::string& state, Instant now) {
    const Own& own = own_[id];
    const bool is_gone = own.ended && now > *own.ended + kSilence + late_;
    if (state == "silent") {
      EXPECT_TRUE(own.ended) << id.value << " is heard at " << to_seconds(now);
    } else {
      EXPECT_FALSE(is_gone) << id.value << " is silent, and shown as " << state;
      EXPECT_TRUE(own.was(state)) << id.value << " is shown as " << state << " at "
                                  << to_seconds(now) << " s, and is "
                                  << (own.lately.empty() ? "not known" : own.lately.back().state);
    }
  }

  void judge_facts(VehicleId id, const std::string& state, Instant now) {
    const Facts& facts = facts_[id];
    // An order is obeyed before the telemetry that tells of it, and its end, too.
    const auto obeys = [&](CommandKind kind) { return facts.order == kind; };
    bool may_be = true;
    if (state == "holding_by_order") may_be = obeys(CommandKind::hold);
    if (state == "returning") may_be = obeys(CommandKind::return_home) || obeys(CommandKind::land);
    if (state == "range_reserve") may_be = facts.range_spent;
    if (state == "waiting_for_authorisation") may_be = !facts.authorised;
    if (state == "delivering") may_be = facts.authorised;
    tell_if_long(id, state, !may_be, now);
  }

  /// For longer than the radio takes.
  void tell_if_long(VehicleId id, const std::string& what, bool wrong, Instant now) {
    auto& since = wrong_since_[{id.value, what}];
    if (!wrong) since.reset();
    if (wrong && !since) since = now;
    EXPECT_FALSE(since && now - *since > word_late_)
        << id.value << ", " << what << ": not so since " << to_seconds(*since);
  }

  void judge_task(VehicleId id, const Json& task, const std::string& state, Instant now) {
    if (task.is_null()) return;
    const TaskId shown{SiteId{task["site"].get<std::uint16_t>()}, kind_of(task["kind"]),
                       task["index"].get<std::uint8_t>()};
    task_shown = now;
    EXPECT_TRUE(own_[id].had(to_string(shown)) || own_[id].ended)
        << id.value << " is shown with " << to_string(shown) << " at " << to_seconds(now);
    EXPECT_TRUE(state != "searching" && state != "holding_by_order" && state != "returning")
        << id.value << " is " << state << " with " << to_string(shown);
  }

  static TaskKind kind_of(const std::string& name) {
    if (name == "survey") return TaskKind::survey;
    return name == "deliver" ? TaskKind::deliver : TaskKind::assess;
  }

  static void judge_table(const std::string& table, VehicleId id, std::string state) {
    std::ranges::replace(state, '_', ' ');
    std::istringstream lines{table};
    for (std::string line; std::getline(lines, line);) {
      if (std::atoi(line.c_str()) != id.value) continue;
      EXPECT_NE(line.find(state), std::string::npos) << line << "\nis " << state;
    }
  }

  /// A task that a site is shown with is had by its vehicle.
  void judge_sites(const Json& sites, Instant now) {
    for (const Json& site : sites) {
      const SiteId id{site["id"].get<std::uint16_t>()};
      for (const Json& task : site["tasks"]) {
        const bool held = task["state"] == "planned" || task["state"] == "started";
        if (task["vehicle"].is_null()) continue;
        const VehicleId who{task["vehicle"].get<std::uint16_t>()};
        const TaskId shown{id, kind_of(task["kind"]), task["index"].get<std::uint8_t>()};
        const bool wrong = held && !own_[who].had(to_string(shown)) && !own_[who].ended;
        tell_if_long(who, to_string(shown), wrong, now);
      }
    }
  }

  Duration late_;
  Duration word_late_;
  MissionOrigin origin_;
  std::optional<console::Picture> picture_;
  std::map<VehicleId, Own> own_;
  std::map<VehicleId, Facts> facts_;
  std::map<std::pair<std::uint16_t, std::string>, std::optional<Instant>> wrong_since_;
};

TeamMission scenario(const std::string& name) {
  const auto loaded =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/" + name + ".yaml");
  if (!loaded) throw std::runtime_error(loaded.error().message);
  return team_mission(*loaded);
}

/// Its end is not waited for: somewhere is a site that nobody finds.
void goes_on_for(TeamMission& team, double seconds) {
  Site far;
  far.id = SiteId{99};
  far.position = {50'000.0, 0.0};
  team.sites.push_back(far);
  team.duration_max = from_seconds(seconds);
}

void order(TeamMission& team, double at_s, std::uint16_t vehicle, CommandKind kind) {
  team.faults.push_back({{.not_before = at_seconds(at_s)}, {}, Ordered{{vehicle}, kind}});
}

TEST(PictureRuns, AMissionIsShownAsItIs) {
  TeamMission team = scenario("coalition-6");
  Watch watch{team};
  const TeamResult result = simulate_team(team, watch.observer());
  EXPECT_EQ(result.sites_done, team.sites.size());
  for (const char* state :
       {"searching", "surveying", "waiting_for_authorisation", "delivering", "assessing"}) {
    EXPECT_TRUE(watch.seen.contains(state)) << state;
  }
}

TEST(PictureRuns, WhatTheOperatorRefusesIsShownNoMore) {
  TeamMission team = scenario("coalition-6");
  for (auto& decision : team.decisions) decision.grant = false;
  goes_on_for(team, 110.0);
  Watch watch{team};
  (void)simulate_team(team, watch.observer());
  ASSERT_TRUE(watch.refused_at);
  ASSERT_TRUE(watch.task_shown);
  EXPECT_LT(to_seconds(*watch.task_shown - *watch.refused_at), to_seconds(kLate));
}

TEST(PictureRuns, OrdersAndTheirEndAreToldApart) {
  TeamMission team = scenario("coalition-6");
  order(team, 6.0, 1, CommandKind::hold);
  order(team, 14.0, 1, CommandKind::resume);
  order(team, 8.0, 2, CommandKind::return_home);
  goes_on_for(team, 110.0);
  Watch watch{team};
  (void)simulate_team(team, watch.observer());
  EXPECT_TRUE(watch.seen_of[1].contains("holding_by_order"));
  EXPECT_TRUE(watch.seen_of[2].contains("returning"));
  EXPECT_TRUE(watch.seen_of[2].contains("at_home"));
  for (const char* state : {"holding", "holding_by_order"}) {
    EXPECT_FALSE(watch.seen_of[2].contains(state)) << "vehicle 2 was sent home: " << state;
  }
}

TEST(PictureRuns, WhoFliesHomeForItsRangeOrIsKilledIsShownSo) {
  TeamMission team = scenario("coalition-6");
  team.faults.push_back({{.not_before = at_seconds(12.0)}, {}, BatteryFalls{VehicleId{2}, 24.0}});
  team.faults.push_back({{.not_before = at_seconds(20.0)}, {}, ProgramsEnd{{VehicleId{3}}, {}}});
  goes_on_for(team, 110.0);
  Watch watch{team};
  (void)simulate_team(team, watch.observer());
  EXPECT_TRUE(watch.seen_of[2].contains("range_reserve"));
  EXPECT_FALSE(watch.seen_of[2].contains("holding"));
  EXPECT_TRUE(watch.seen_of[3].contains("silent"));
}

TEST(PictureRuns, ACardMarksWhoIsKilledWhileItWaits) {
  TeamMission team = scenario("coalition-6");
  team.protocol.authorisation_lead = std::chrono::seconds{25};
  team.decisions.clear();  // nobody decides
  team.duration_max = std::chrono::seconds{70};
  Watch whole{team};
  (void)simulate_team(team, whole.observer());
  ASSERT_GT(whole.cards, 0);
  EXPECT_EQ(whole.marked, 0);
  const auto formed = std::ranges::find_if(whole.events, [](const mission::MissionEvent& e) {
    return e.kind() == EventKind::coalition_formed;
  });
  ASSERT_NE(formed, whole.events.end());
  team.faults.push_back({{.not_before = formed->time + std::chrono::seconds{1}},
                         {},
                         ProgramsEnd{{VehicleId{3}}, {}}});
  Watch watch{team};
  (void)simulate_team(team, watch.observer());
  EXPECT_GT(watch.marked, 0);
}

/// Its delivery stays a killed vehicle's until its lease runs out: what is asked for meanwhile
/// lacks it.
TEST(PictureRuns, ACardSaysWhatIsMissingAndWhy) {
  TeamMission team = scenario("coalition-6");
  team.protocol.authorisation_lead = std::chrono::seconds{10};
  team.decisions.clear();                 // nobody decides
  team.vehicles[5].spec.range_m = 900.0;  // vehicle 6: not enough for the site and the way home
  team.duration_max = std::chrono::seconds{60};
  Watch whole{team};
  (void)simulate_team(team, whole.observer());
  const auto formed = std::ranges::find_if(whole.events, [](const mission::MissionEvent& e) {
    return e.kind() == EventKind::coalition_formed;
  });
  ASSERT_NE(formed, whole.events.end());
  EXPECT_TRUE(whole.reasons.empty());
  team.faults.push_back({{.not_before = formed->time + std::chrono::seconds{9}},
                         {},
                         ProgramsEnd{{VehicleId{3}}, {}}});
  Watch watch{team};
  (void)simulate_team(team, watch.observer());
  ASSERT_FALSE(watch.reasons.empty());
  EXPECT_TRUE(std::ranges::any_of(watch.reasons, [](const std::string& why) {
    return why.starts_with("vehicle 3 has it still");
  })) << ::testing::PrintToString(watch.reasons);
  EXPECT_TRUE(watch.did_not_bid[6].contains("not enough range left"))
      << ::testing::PrintToString(watch.did_not_bid);
  EXPECT_FALSE(watch.did_not_bid[3].empty());
}

TEST(PictureRuns, AlsoWhereTheRadioLosesAThird) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    TeamMission team = scenario("coalition-6");
    team.seed = seed;
    team.faults.push_back({{}, {}, radio::Disturbance{.loss = 0.3}});
    order(team, 20.0, 5, CommandKind::hold);
    order(team, 30.0, 2, CommandKind::return_home);
    goes_on_for(team, 80.0);
    Watch watch{team, std::chrono::seconds{2}, std::chrono::seconds{4}};
    (void)simulate_team(team, watch.observer());
    EXPECT_TRUE(watch.seen_of[2].contains("returning"));
    EXPECT_TRUE(watch.seen_of[5].contains("holding_by_order"));
  }
}

TEST(PictureRuns, FromTheGroundToTheGround) {
  TeamMission team = scenario("mixed-6");
  team.ends_landed = true;
  team.duration_max = std::chrono::seconds{900};
  for (SimulatedVehicle& v : team.vehicles) v.spec.range_m = 30e3;
  Watch watch{team};
  const TeamResult result = simulate_team(team, watch.observer());
  for (const VehicleEnd& end : result.vehicles) EXPECT_TRUE(end.landed) << end.vehicle.value;
  for (const char* state :
       {"taking_off", "searching", "returning", "at_home", "landing", "landed"}) {
    EXPECT_TRUE(watch.seen.contains(state)) << state;
  }
}

}  // namespace
}  // namespace skein::hil
