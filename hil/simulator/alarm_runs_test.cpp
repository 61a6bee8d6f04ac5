// SPDX-License-Identifier: Apache-2.0
// Alarms held against what the vehicles themselves are about, at every moment of whole missions
// with faults: an alarm is there while its condition is, but for what the radio takes, and not
// without it.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string>

#include "skein/console/alarms.hpp"
#include "skein/console/picture.hpp"
#include "skein/hil/team_mission.hpp"
#include "skein/hil/team_simulator.hpp"
#include "skein/mission/shown_state.hpp"

namespace skein::hil {
namespace {

using console::AlarmKind;
using mission::CommandKind;
using mission::ShownState;

constexpr Duration kSilence = std::chrono::seconds{5};
/// Telemetry every 200 ms, the radio, and a look every 100 ms.
constexpr Duration kLate = std::chrono::milliseconds{700};
/// Reliable messages, where one is lost and said again.
constexpr Duration kWordLate = std::chrono::milliseconds{1600};
constexpr Duration kStep = std::chrono::milliseconds{50};
/// An alarm stays for as long after its end.
constexpr Duration kSteady = std::chrono::seconds{2};

/// What is so, by the vehicles' own programs.
struct Truth {
  std::map<VehicleId, mission::Telemetry> run;  ///< whose programs do
  std::map<VehicleId, Instant> ended;
  std::set<VehicleId> spent;               ///< that have said so themselves
  std::map<SiteId, std::uint32_t> lapses;  ///< that leaders have told of, since a decision
};

class AlarmWatch {
 public:
  explicit AlarmWatch(const TeamMission& team) {
    console::PictureParams params;
    for (const auto& v : team.vehicles) params.expected.push_back(v.spec.id);
    picture_.emplace(params);
  }

  TeamObserver observer() {
    TeamObserver observer;
    observer.event = [this](const mission::MissionEvent& e) { note(e); };
    observer.ground_message = [this](const mission::Message& m, VehicleId sender, Instant now) {
      picture_->on_message(m, sender, now);
      alarms.on_message(m, sender, now);
    };
    observer.ground_event = [this](const mission::MissionEvent& e) {
      picture_->on_event(e);
      alarms.on_event(e, now_);
    };
    observer.moment = [this](Instant now, const mission::GroundNode& node,
                             const std::vector<OwnWord>& words) { look(now, node, words); };
    return observer;
  }

  console::Alarms alarms;
  std::set<AlarmKind> seen;
  std::set<std::string> said;
  std::map<AlarmKind, Duration> stood;  ///< so long, all in all
  std::map<std::pair<CommandKind, VehicleId>, std::vector<Instant>> obeyed;

 private:
  void note(const mission::MissionEvent& e) {
    if (e.kind() == mission::EventKind::range_spent) truth_.spent.insert(e.vehicle);
    if (const auto* late = std::get_if<mission::event::AuthorisationLate>(&e.body)) {
      if (late->why == mission::event::Lateness::no_decision) ++truth_.lapses[e.task.site];
    }
    const bool decides = e.kind() == mission::EventKind::authorised ||
                         e.kind() == mission::EventKind::authorisation_refused;
    if (decides && e.vehicle == kGroundStation) truth_.lapses[e.task.site] = 0;
    if (e.kind() == mission::EventKind::site_done) truth_.lapses[e.task.site] = 0;
    if (const auto* order = std::get_if<mission::event::Commanded>(&e.body)) {
      obeyed[{order->command, e.vehicle}].push_back(e.time);
    }
  }

  void look(Instant now, const mission::GroundNode& node, const std::vector<OwnWord>& words) {
    const Duration step = now_ == Instant{} ? Duration{} : now - now_;
    now_ = now;
    for (const OwnWord& word : words) {
      if (word.telemetry) {
        truth_.run[word.vehicle] = *word.telemetry;
        truth_.ended.erase(word.vehicle);
      } else if (truth_.run.erase(word.vehicle) == 1) {
        truth_.ended[word.vehicle] = now;
      }
    }
    alarms.on_timeout(*picture_, node.fleet(), now);
    standing_.clear();
    for (const console::Alarm* alarm : alarms.list()) {
      if (alarm->over) continue;
      seen.insert(alarm->key.kind);
      said.insert(alarm->what);
      stood[alarm->key.kind] += step;
      standing_.insert({alarm->key.kind, alarm->key.vehicle, alarm->key.site});
    }
    judge(now);
  }

  void judge(Instant now) {
    for (const auto& [id, own] : truth_.run) {
      must_be({AlarmKind::vehicle_silent, id, {}}, false, kLate + kSteady, now);
      const bool lacks_range =
          truth_.spent.contains(id) && own.activity != mission::Activity::landed;
      must_be({AlarmKind::range_reserve, id, {}}, lacks_range, kWordLate + kSteady, now);
    }
    for (const auto& [id, at] : truth_.ended) {
      must_be({AlarmKind::vehicle_silent, id, {}}, now >= at + kSilence, kLate, now);
    }
    const bool nobody = truth_.run.empty() && !truth_.ended.empty() &&
                        std::ranges::all_of(truth_.ended, [&](const auto& one) {
                          return now >= one.second + kSilence;
                        });
    must_be({AlarmKind::nobody_heard, {}, {}}, nobody, kLate + kSteady, now);
    must_be({AlarmKind::all_held, {}, {}}, all_hold(now), kLate + kSteady, now);
    for (const auto& [site, count] : truth_.lapses) {
      must_be({AlarmKind::decision_lapsed, {}, site}, count > 0, kWordLate, now);
    }
  }

  /// By their own word, of those that run; who has just ended is not heard to be silent yet.
  [[nodiscard]] bool all_hold(Instant now) const {
    const bool unsure = std::ranges::any_of(
        truth_.ended, [&](const auto& one) { return now < one.second + kSilence + kLate; });
    bool any = false;
    for (const auto& [id, own] : truth_.run) {
      const ShownState state = mission::shown_state(own.activity, own.detail);
      if (state == ShownState::waiting_for_the_start || state == ShownState::landed) continue;
      if (state != ShownState::holding_by_order) return false;
      any = true;
    }
    return any && !unsure;
  }

  struct Which {
    AlarmKind kind{};
    VehicleId vehicle;
    SiteId site;
    auto operator<=>(const Which&) const = default;
  };

  /// The alarm is there, or not, but for so long after it has become so.
  void must_be(const Which& which, bool wanted, Duration within, Instant now) {
    auto& since = wrong_since_[which];
    if (standing_.contains(which) == wanted) {
      since.reset();
    } else if (!since) {
      since = now;
    }
    if (!since || now - *since <= within) return;
    ADD_FAILURE() << to_string(which.kind) << " of vehicle " << which.vehicle.value << ", site "
                  << which.site.value << (wanted ? " is missing" : " is there without a cause")
                  << " at " << to_seconds(now);
    since = now;
  }

  std::optional<console::Picture> picture_;
  Truth truth_;
  std::set<Which> standing_;
  std::map<Which, std::optional<Instant>> wrong_since_;
  Instant now_{};
};

TeamMission scenario(double seconds) {
  const auto loaded =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/coalition-6.yaml");
  if (!loaded) throw std::runtime_error(loaded.error().message);
  TeamMission team = team_mission(*loaded);
  // Its end is not waited for: somewhere is a site that nobody finds.
  Site far;
  far.id = SiteId{99};
  far.position = {50'000.0, 0.0};
  team.sites.push_back(far);
  team.duration_max = from_seconds(seconds);
  return team;
}

void order(TeamMission& team, double at_s, std::uint16_t vehicle, CommandKind kind) {
  team.faults.push_back({{.not_before = at_seconds(at_s)}, {}, Ordered{{vehicle}, kind}});
}

TEST(AlarmRuns, AMissionWithoutFaultsIsQuiet) {
  const TeamMission team = scenario(110.0);
  AlarmWatch watch{team};
  (void)simulate_team(team, watch.observer());
  for (const AlarmKind kind :
       {AlarmKind::nobody_heard, AlarmKind::vehicle_silent, AlarmKind::range_reserve,
        AlarmKind::all_held, AlarmKind::decision_lapsed, AlarmKind::no_answer}) {
    EXPECT_FALSE(watch.seen.contains(kind)) << to_string(kind);
  }
}

TEST(AlarmRuns, SilenceReserveHeldAndLapsedStandWhileTheyAreSo) {
  TeamMission team = scenario(110.0);
  team.decisions.clear();  // nobody decides
  team.faults.push_back({{.not_before = at_seconds(12.0)}, {}, BatteryFalls{VehicleId{2}, 24.0}});
  team.faults.push_back({{.not_before = at_seconds(20.0)},
                         std::chrono::seconds{15},
                         ProgramsEnd{{VehicleId{3}}, {}}});
  order(team, 80.0, 0, CommandKind::hold);
  order(team, 95.0, 0, CommandKind::resume);
  AlarmWatch watch{team};
  (void)simulate_team(team, watch.observer());
  for (const AlarmKind kind :
       {AlarmKind::vehicle_silent, AlarmKind::range_reserve, AlarmKind::all_held,
        AlarmKind::decision_lapsed, AlarmKind::decision_runs_out}) {
    EXPECT_TRUE(watch.seen.contains(kind)) << to_string(kind);
  }
  EXPECT_NEAR(to_seconds(watch.stood[AlarmKind::vehicle_silent]), 10.0 + 2.0, 3.0);
  EXPECT_NEAR(to_seconds(watch.stood[AlarmKind::all_held]), 15.0, 3.0);
}

TEST(AlarmRuns, NobodyIsHeardWhereAllProgramsEnd) {
  TeamMission team = scenario(60.0);
  ProgramsEnd all;
  for (const auto& v : team.vehicles) all.who.push_back(v.spec.id);
  team.faults.push_back({{.not_before = at_seconds(20.0)}, std::chrono::seconds{15}, all});
  AlarmWatch watch{team};
  (void)simulate_team(team, watch.observer());
  EXPECT_TRUE(watch.seen.contains(AlarmKind::nobody_heard));
}

TEST(AlarmRuns, EachAnswerIsTheVehiclesOwn) {
  TeamMission team = scenario(60.0);
  order(team, 15.0, 0, CommandKind::hold);
  order(team, 25.0, 2, CommandKind::resume);
  order(team, 35.0, 0, CommandKind::return_home);
  AlarmWatch watch{team};
  (void)simulate_team(team, watch.observer());
  std::size_t answers = 0;
  double slowest_s = 0.0;
  for (const console::GivenOrder& order : watch.alarms.orders().orders()) {
    if (!order.command) continue;
    EXPECT_TRUE(order.waiting.empty()) << line_of(order);
    for (const auto& [vehicle, after] : order.answered) {
      const auto& truly = watch.obeyed[{*order.command, vehicle}];
      const auto obeyed =
          std::ranges::find_if(truly, [&](Instant at) { return at >= order.given; });
      ASSERT_NE(obeyed, truly.end()) << line_of(order) << " of " << vehicle.value;
      // An event is heard within the step of the nodes that shows it.
      EXPECT_GE(order.given + after + kStep, *obeyed);
      EXPECT_LE(order.given + after, *obeyed + kWordLate);
      slowest_s = std::max(slowest_s, to_seconds(after));
      ++answers;
    }
  }
  EXPECT_EQ(answers, 13U);
  RecordProperty("slowest_answer_s", std::to_string(slowest_s));
}

TEST(AlarmRuns, AlsoWhereTheRadioLosesAThird) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    TeamMission team = scenario(70.0);
    team.seed = seed;
    team.faults.push_back({{}, {}, radio::Disturbance{.loss = 0.3}});
    order(team, 20.0, 5, CommandKind::hold);
    AlarmWatch watch{team};
    (void)simulate_team(team, watch.observer());
    EXPECT_FALSE(watch.seen.contains(AlarmKind::vehicle_silent));
    EXPECT_FALSE(watch.seen.contains(AlarmKind::no_answer)) << ::testing::PrintToString(watch.said);
  }
}

}  // namespace
}  // namespace skein::hil
