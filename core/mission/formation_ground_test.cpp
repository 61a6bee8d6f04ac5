// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/formation_ground.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "skein/mission/formation_agent.hpp"

namespace skein::mission {
namespace {

using ::testing::HasSubstr;

/// A ground station and its vehicles, which hear each other at once and fly beside their references
/// by what each is pushed aside.
class Team {
 public:
  explicit Team(std::vector<Vec3> starts, const Fence& fence = {})
      : ground_{config_of(starts.size(), fence), Instant{}} {
    for (std::size_t i = 0; i < starts.size(); ++i) {
      const VehicleId id{static_cast<std::uint16_t>(i + 1)};
      FormationAgentConfig config;
      config.vehicle = id;
      vehicles_.push_back({id, starts[i], Vec3::Zero(), {config, Instant{}}});
    }
  }
  void lose(std::size_t index) { vehicles_.at(index).lost = true; }
  void come_back(std::size_t index) { vehicles_.at(index).lost = false; }
  void hold(std::size_t index) {
    Command command{.vehicle = vehicles_.at(index).id, .kind = CommandKind::hold};
    set_number(command, 1);
    vehicles_.at(index).agent.on_message(command, kGroundStation, now);
  }
  /// The ground station is not.
  void is_heard_by_nobody(bool so) { mute_ = so; }
  void start_anew(std::size_t index, const Vec3& place) {
    Vehicle& v = vehicles_.at(index);
    FormationAgentConfig config;
    config.vehicle = v.id;
    v.position = place;
    v.agent = FormationAgent{config, now};
  }
  void be_piloted(std::size_t index, bool piloted) {
    vehicles_.at(index).agent.on_piloted(piloted, now);
  }
  void push_aside(std::size_t index, const Vec3& aside) { vehicles_.at(index).aside = aside; }
  void step() {
    now += formation::kSlot;
    for (Vehicle& v : vehicles_) {
      if (v.lost) continue;
      if (v.agent.execution() != nullptr) {
        v.position = v.agent.execution()->reference(now).position_m + v.aside;
      }
      VehicleState state;
      state.time = now;
      state.x_m = v.position.x();
      state.y_m = v.position.y();
      state.z_m = v.position.z();
      v.agent.on_state(state, now);
      while (const auto message = v.agent.poll_message()) hear(*message, v.id);
      ground_.on_message(v.agent.telemetry(), now);
      static_cast<void>(v.agent.poll_guidance());
      while (v.agent.poll_event()) {
      }
    }
    ground_.on_timeout(now);
    while (const auto message = ground_.poll_message()) hear(*message, kGroundStation);
    while (const auto event = ground_.poll_event()) events.push_back(*event);
  }
  /// False where it did not happen within a minute.
  bool until(const std::function<bool()>& done) {
    for (int i = 0; i < 1200 && !done(); ++i) step();
    return done();
  }
  Result<FormationPreview> command(const FormationOrder& order) {
    return ground_.command(order, now);
  }
  /// Another process takes over that recalls what was said, or nothing of it.
  void start_ground_anew(bool recalls) {
    ground_ = FormationGround{config_of(vehicles_.size(), {}), now};
    for (const auto& [message, sender] : said) {
      if (recalls) ground_.recall(message, sender);
    }
  }
  bool take_off() {
    FormationOrder order;
    order.kind = OrderKind::take_off;
    return command(order).ok();
  }
  /// All are heard, take off, and hold their places.
  bool goes_up() {
    return until([this] { return ground_.members().size() == vehicles_.size(); }) && take_off() &&
           until([this] { return ground_.in_place(); });
  }
  [[nodiscard]] const FormationGround& ground() const { return ground_; }
  [[nodiscard]] const Vec3& position(std::size_t index) const {
    return vehicles_.at(index).position;
  }
  [[nodiscard]] std::size_t warnings() const {
    return static_cast<std::size_t>(std::count_if(
        events.begin(), events.end(), [](const auto& event) { return is_warning(event.kind()); }));
  }
  [[nodiscard]] std::size_t count(EventKind kind) const {
    return static_cast<std::size_t>(std::count_if(
        events.begin(), events.end(), [kind](const auto& event) { return event.kind() == kind; }));
  }

  Instant now{};
  std::vector<MissionEvent> events;
  std::vector<std::pair<Message, VehicleId>> said;

 private:
  struct Vehicle {
    VehicleId id;
    Vec3 position;
    Vec3 aside;
    FormationAgent agent;
    bool lost = false;
  };
  static FormationGroundConfig config_of(std::size_t vehicles, const Fence& fence) {
    FormationGroundConfig config;
    config.fence = fence;
    for (std::size_t i = 0; i < vehicles; ++i) {
      config.vehicles.push_back({static_cast<std::uint16_t>(i + 1)});
    }
    config.rally.spacing_m = 6.0;
    config.rally.centre = {0.0, 0.0, 10.0};
    return config;
  }
  void hear(const Message& message, VehicleId sender) {
    said.emplace_back(message, sender);
    if (sender != kGroundStation) ground_.on_message(message, now);
    if (sender == kGroundStation && mute_) return;
    for (Vehicle& v : vehicles_) {
      if (v.id != sender) v.agent.on_message(message, sender, now);
    }
  }

  FormationGround ground_;
  std::vector<Vehicle> vehicles_;
  bool mute_ = false;
};

/// Abreast, 4 m apart.
FormationOrder line_around(const Vec3& centre) {
  FormationOrder order;
  order.kind = OrderKind::form;
  order.shape.kind = formation::ShapeKind::line_abreast;
  order.shape.spacing_m = 4.0;
  order.shape.centre = centre;
  return order;
}

TEST(FormationGround, SendsNobodyAboveTheCeilingOrBelowTheGround) {
  Team team{{{0.0, 0.0, 0.0}, {6.0, 0.0, 0.0}}};
  ASSERT_TRUE(team.goes_up());
  FormationOrder order;
  order.kind = OrderKind::form;
  order.shape.spacing_m = 6.0;
  order.shape.centre = {0.0, 0.0, 119.0};
  EXPECT_TRUE(team.ground().preview(order).ok());
  order.shape.centre.z() = 121.0;
  const auto high = team.ground().preview(order);
  ASSERT_FALSE(high.ok());
  EXPECT_THAT(high.error().message, HasSubstr("121.0 m high, and the ceiling is 120.0 m"));
  order.shape.centre.z() = -1.0;
  const auto low = team.ground().preview(order);
  ASSERT_FALSE(low.ok());
  EXPECT_THAT(low.error().message, HasSubstr("1.0 m below the ground"));
}

TEST(FormationGround, LeadsNobodyOutOfTheFence) {
  const Fence fence{{{-40.0, -40.0}, {40.0, -40.0}, {40.0, 40.0}, {-40.0, 40.0}}, 50.0};
  Team team{{{0.0, 0.0, 0.0}, {6.0, 0.0, 0.0}}, fence};
  ASSERT_TRUE(team.goes_up());
  FormationOrder order;
  order.kind = OrderKind::form;
  order.shape.spacing_m = 6.0;
  order.shape.centre = {15.0, 0.0, 20.0};
  const auto good = team.ground().preview(order);
  EXPECT_TRUE(good.ok()) << good.error().message;
  order.shape.centre.x() = 50.0;
  const auto out = team.ground().preview(order);
  ASSERT_FALSE(out.ok());
  EXPECT_THAT(out.error().message, HasSubstr("the way of vehicle "));
  EXPECT_THAT(out.error().message, HasSubstr(" leads out of the fence at [4"));
  EXPECT_FALSE(team.command(order).ok());
  order.shape.centre = {15.0, 0.0, 60.0};
  const auto high = team.ground().preview(order);
  ASSERT_FALSE(high.ok());
  EXPECT_THAT(high.error().message, HasSubstr("60.0 m high, and the fence ends at 50.0 m"));
}

TEST(FormationGround, LeadsNobodyAroundOutsideOfTheFence) {
  FormationOrder order;  // past the second vehicle, which comes to the rally
  order.kind = OrderKind::form;
  order.shape.centre = {-12.0, 0.0, 10.0};
  order.places = 1;
  for (const double half_width_m : {20.0, 0.5}) {
    const Fence fence{{{-20.0, -half_width_m},
                       {20.0, -half_width_m},
                       {20.0, half_width_m},
                       {-20.0, half_width_m}},
                      50.0};
    Team team{{{12.0, 0.0, 0.0}, {-12.0, 0.0, 0.0}}, fence};
    ASSERT_TRUE(team.goes_up());
    const auto around = team.ground().preview(order);
    if (half_width_m > 10.0) {
      ASSERT_TRUE(around.ok()) << around.error().message;
      EXPECT_EQ(around->planned.way, formation::Way::roundabout);
    } else {
      ASSERT_FALSE(around.ok());
      EXPECT_THAT(around.error().message, HasSubstr(" leads out of the fence at ["));
    }
  }
}

TEST(FormationGround, WhoIsOutsideOfTheFenceMayLandAndComeIn) {
  const Fence fence{{{10.0, -20.0}, {50.0, -20.0}, {50.0, 20.0}, {10.0, 20.0}}, 50.0};
  Team team{{{0.0, 0.0, 0.0}}, fence};
  ASSERT_TRUE(team.goes_up());
  FormationOrder order;
  order.kind = OrderKind::land;
  EXPECT_TRUE(team.ground().preview(order).ok());
  order.kind = OrderKind::form;
  order.shape.centre = {30.0, 0.0, 10.0};
  EXPECT_TRUE(team.ground().preview(order).ok());
  order.shape.centre.x() = -5.0;
  EXPECT_FALSE(team.ground().preview(order).ok());
}

TEST(FormationGround, FliesNobodyToTheSideFromTheGroundOrNearIt) {
  Team team{{{0.0, 0.0, 0.0}, {6.0, 0.0, 0.0}}};
  ASSERT_TRUE(team.until([&] { return team.ground().members().size() == 2; }));
  FormationOrder order;
  order.kind = OrderKind::form;
  order.shape.kind = formation::ShapeKind::wedge;
  order.shape.spacing_m = 6.0;
  order.shape.centre = {24.0, 0.0, 10.0};
  const auto from_ground = team.command(order);
  ASSERT_FALSE(from_ground.ok());
  EXPECT_THAT(from_ground.error().message, HasSubstr("is 0.0 m high"));
  EXPECT_THAT(from_ground.error().message, HasSubstr("order 'take-off' first"));
  for (int i = 0; i < 200; ++i) team.step();
  EXPECT_EQ(team.position(0).z(), 0.0) << "nobody has moved";
  order.kind = OrderKind::rally;
  EXPECT_FALSE(team.ground().preview(order).ok());
  ASSERT_TRUE(team.take_off());
  ASSERT_TRUE(team.until([&] { return team.ground().in_place(); }));
  order.kind = OrderKind::form;
  order.shape.centre.z() = 1.0;
  const auto low = team.ground().preview(order);
  ASSERT_FALSE(low.ok());
  EXPECT_THAT(low.error().message,
              HasSubstr("1.0 m high, and nobody is flown to the side below 2.0 m"));
  order.shape.centre.z() = 10.0;
  EXPECT_TRUE(team.command(order).ok());
}

TEST(FormationGround, APlaceWhereASilentVehicleIsStaysEmpty) {
  Team team{{{0.0, 0.0, 0.0}, {6.0, 0.0, 0.0}, {12.0, 0.0, 0.0}}};
  ASSERT_TRUE(team.goes_up());
  team.lose(1);
  ASSERT_TRUE(team.until([&] { return team.ground().members().at({2}).lost; }));
  // Two places would be 2 m beside it.
  const auto given = team.command(line_around(team.position(1)));
  ASSERT_TRUE(given.ok()) << given.error().message;
  ASSERT_TRUE(team.until([&] { return team.ground().in_place(); }));
  for (const std::size_t index : {0U, 2U}) {
    EXPECT_NEAR((team.position(index) - team.position(1)).norm(), 4.0, 1e-6);
  }
}

TEST(FormationGround, PlacesAreClearOfWhereWhoIsLostWasHeardToBe) {
  Team team{{{0.0, 0.0, 0.0}, {6.0, 0.0, 0.0}, {12.0, 0.0, 0.0}}};
  ASSERT_TRUE(team.goes_up());
  FormationOrder line = line_around(Vec3::Zero());
  const auto places = formation::places(line.shape, 2);
  const Vec3 along = (places->back() - places->front()).normalized();
  const Vec3 reference = team.position(1);
  team.push_aside(1, 0.9 * along);
  for (int i = 0; i < 20; ++i) team.step();
  team.lose(1);
  ASSERT_TRUE(team.until([&] { return team.ground().members().at({2}).lost; }));
  // A place would be 4.1 m from its reference, and 3.2 m from where it is.
  line.shape.spacing_m = 4.1;
  line.shape.centre = reference;
  const auto given = team.command(line);
  ASSERT_TRUE(given.ok()) << given.error().message;
  EXPECT_TRUE(team.until([&] { return team.ground().in_place(); }));
  for (const std::size_t index : {0U, 2U}) {
    EXPECT_GE((team.position(index) - team.position(1)).norm(), 4.0 - 1e-6);
  }
}

TEST(FormationGround, NobodyIsLedUpThroughWhereASilentVehicleIs) {
  Team team{{{0.0, 0.0, 0.0}, {6.0, 0.0, 0.0}, {12.0, 0.0, 0.0}}};
  ASSERT_TRUE(team.goes_up());
  team.lose(1);
  ASSERT_TRUE(team.until([&] { return team.ground().members().at({2}).lost; }));
  const Vec3 lost = team.position(1);
  // One is below it after a new start, nearer to the side than they may come to each other.
  team.start_anew(0, lost + Vec3{1.7, 0.0, -4.0});
  for (int i = 0; i < 200; ++i) team.step();
  double least_m = 1e9;
  for (const double height_m : {10.0, 15.0, 25.0}) {
    const auto given = team.command(line_around({0.0, 0.0, height_m}));
    for (int i = 0; i < 1200; ++i) {
      team.step();
      least_m = std::min(least_m, (team.position(0) - lost).norm());
    }
  }
  EXPECT_GE(least_m, 3.0 - 1e-6);
}

TEST(FormationGround, WhoStandsBesideItsPlaceIsToldAndHasLanded) {
  Team team{{{-3.0, 0.0, 0.0}, {3.0, 0.0, 0.0}}};
  ASSERT_TRUE(team.goes_up());
  FormationOrder land;
  land.kind = OrderKind::land;
  ASSERT_TRUE(team.command(land).ok());
  team.push_aside(1, {1.0, 0.0, 0.0});
  ASSERT_TRUE(team.until([&] { return team.warnings() > 0; }));
  const auto warning = std::find_if(team.events.begin(), team.events.end(),
                                    [](const auto& event) { return is_warning(event.kind()); });
  EXPECT_EQ(warning->body,
            EventBody{(event::FormationWarning{event::FormationNews::off_place, {{2}}})});
  EXPECT_TRUE(team.until([&] { return team.ground().in_place(); }));
  EXPECT_EQ(team.warnings(), 1U);
}

TEST(FormationGround, CorrectsASteadyDriftOnceAndKeepsThePlaces) {
  Team team{{{-3.0, 0.0, 0.0}, {3.0, 0.0, 0.0}}};
  ASSERT_TRUE(team.goes_up());
  EXPECT_EQ(team.warnings(), 0U);
  const Vec3 place = team.position(1);
  team.push_aside(1, {0.25, 0.0, 0.0});  // within the tolerance of 0.3 m
  ASSERT_TRUE(team.until([&] { return team.warnings() > 0; }));
  const auto warning = std::find_if(team.events.begin(), team.events.end(),
                                    [](const auto& event) { return is_warning(event.kind()); });
  EXPECT_EQ(warning->body,
            EventBody{(event::FormationWarning{event::FormationNews::drift_corrected, {{2}}})});
  for (int i = 0; i < 600; ++i) team.step();
  EXPECT_LT((team.position(1) - place).norm(), 0.08);
  EXPECT_EQ(team.warnings(), 1U);
  EXPECT_TRUE(team.ground().in_place());
  EXPECT_EQ(team.count(EventKind::formation_held), 1U);  // it is no new formation
}

TEST(FormationGround, LeavesASmallDriftAlone) {
  Team team{{{-3.0, 0.0, 0.0}, {3.0, 0.0, 0.0}}};
  ASSERT_TRUE(team.goes_up());
  team.push_aside(1, {0.1, 0.0, 0.0});
  for (int i = 0; i < 1200; ++i) team.step();
  EXPECT_EQ(team.warnings(), 0U);
}

TEST(FormationGround, WhoRestTooNearAreLedApartFirst) {
  Team team{{{0.0, 0.0, 0.0}, {6.0, 0.0, 0.0}}};
  ASSERT_TRUE(team.goes_up());
  // One hovers elsewhere after a new start, 3.1 m beside the other, where 3.3 m are needed. The
  // order is given again, once there is room.
  team.start_anew(1, team.position(0) + Vec3{3.1, 0.0, 0.0});
  ASSERT_TRUE(team.until([&] { return (team.position(0) - team.position(1)).norm() > 3.9; }));
  ASSERT_TRUE(team.until([&] { return team.ground().in_place(); }));
  EXPECT_EQ(team.count(EventKind::change_begun), 3U);
  EXPECT_EQ(team.count(EventKind::formation_held), 2U) << "that room is made is no formation";
}

TEST(FormationGround, WhoHasNotHeardOfTheRoomToBeMadeIsToldAgain) {
  Team team{{{0.0, 0.0, 0.0}, {6.0, 0.0, 0.0}}};
  ASSERT_TRUE(team.goes_up());
  team.start_anew(1, team.position(0) + Vec3{3.1, 0.0, 0.0});
  team.is_heard_by_nobody(true);
  ASSERT_TRUE(team.until([&] { return team.count(EventKind::change_begun) == 2; }));
  team.is_heard_by_nobody(false);
  ASSERT_TRUE(team.until([&] { return (team.position(0) - team.position(1)).norm() > 3.9; }));
  EXPECT_EQ(team.count(EventKind::change_begun), 2U) << "by the same change";
}

/// The second is led over the first, the third far along; the second is lost above the first, which
/// was silent when the order was given.
struct LostAboveOne : Team {
  explicit LostAboveOne(bool has_pilot = false)
      : Team{{{0.0, 0.0, 0.0}, {0.0, 6.0, 0.0}, {0.0, 120.0, 0.0}}} {
    EXPECT_TRUE(goes_up());
    lose(0);
    EXPECT_TRUE(until([this] { return ground().members().at({1}).lost; }));
    FormationOrder order = line_around({0.0, 0.0, 10.0});
    order.shape.spacing_m = 12.0;
    EXPECT_TRUE(command(order).ok());
    EXPECT_TRUE(until([this] { return beside_m() < 0.5; }));
    if (has_pilot) {
      be_piloted(1, true);
      EXPECT_TRUE(until([this] { return ground().members().at({2}).piloted; }));
    }
    lose(1);
    come_back(0);
  }
  [[nodiscard]] double beside_m() const { return (position(1) - position(0)).head<2>().norm(); }
};

TEST(FormationGround, WhoRestsBelowOneThatIsLostLeavesWhileOthersStillFly) {
  LostAboveOne team;
  ASSERT_TRUE(team.until([&] { return team.beside_m() > 2.99; }));
  EXPECT_FALSE(team.ground().members().at({3}).status.at_rest);
  EXPECT_GT((team.position(2) - Vec3{0.0, 6.0, 10.0}).norm(), 3.0);
  EXPECT_EQ(team.count(EventKind::change_begun), 3U);
  ASSERT_TRUE(team.until([&] { return team.ground().in_place(); })) << "the order is given again";
  EXPECT_FALSE(team.ground().members().at({1}).lost);
  EXPECT_EQ(team.count(EventKind::change_begun), 4U);
}

TEST(FormationGround, WhoRestsBelowOneThatIsSilentSinceAPilotHasItLeaves) {
  LostAboveOne team{true};
  EXPECT_TRUE(team.until([&] { return team.beside_m() > 2.99; }));
}

TEST(FormationGround, WhoCannotLeaveIsToldSoOnceAndNotForEver) {
  LostAboveOne team;
  team.hold(0);
  ASSERT_TRUE(team.until([&] { return team.count(EventKind::order_waits) > 0; }));
  EXPECT_EQ(team.count(EventKind::change_begun), 3U);
  EXPECT_LT(team.beside_m(), 0.5);
  for (int i = 0; i < 200; ++i) team.step();
  EXPECT_EQ(team.count(EventKind::change_begun), 3U);
  EXPECT_FALSE(team.ground().moving());
  EXPECT_TRUE(team.command({.kind = OrderKind::land}).ok());
}

TEST(FormationGround, WhoStandTooNearAreNotLedApart) {
  Team team{{{0.0, 0.0, 0.0}, {3.1, 0.0, 0.0}}};
  ASSERT_TRUE(team.until([&] { return team.ground().members().size() == 2; }));
  FormationOrder order;
  order.kind = OrderKind::take_off;
  const auto refused = team.command(order);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("3.10 m of each other"));
}

TEST(FormationGround, ANewProcessThatRecallsKnowsWhereASilentVehicleMayBe) {
  for (const bool recalls : {true, false}) {
    Team team{{{0.0, 0.0, 0.0}, {6.0, 0.0, 0.0}, {12.0, 0.0, 0.0}}};
    ASSERT_TRUE(team.goes_up());
    team.lose(1);
    for (int i = 0; i < 100; ++i) team.step();
    team.start_ground_anew(recalls);
    for (int i = 0; i < 100; ++i) team.step();
    // Two places would be 2 m beside it.
    const auto given = team.command(line_around(team.position(1)));
    if (!recalls) {
      ASSERT_FALSE(given.ok());
      EXPECT_THAT(given.error().message, HasSubstr("vehicle 2 was not heard"));
      continue;
    }
    ASSERT_TRUE(given.ok()) << given.error().message;
    EXPECT_EQ(given->lost, std::vector<VehicleId>{{2}});
    ASSERT_TRUE(team.until([&] { return team.ground().in_place(); }));
    for (const std::size_t index : {0U, 2U}) {
      EXPECT_NEAR((team.position(index) - team.position(1)).norm(), 4.0, 1e-6);
    }
  }
}

TEST(FormationGround, AChangeThatIsNotRecalledMayBeFlownByWhoIsSilent) {
  Team team{{{0.0, 0.0, 0.0}, {6.0, 0.0, 0.0}, {12.0, 0.0, 0.0}}};
  ASSERT_TRUE(team.goes_up());
  const auto recorded = team.said.size();
  FormationOrder order;
  order.kind = OrderKind::rally;
  ASSERT_TRUE(team.command(order).ok());
  ASSERT_TRUE(team.until([&] { return team.ground().in_place(); }));
  team.lose(1);
  team.said.resize(recorded);  // of the newest change nothing
  team.start_ground_anew(true);
  for (int i = 0; i < 100; ++i) team.step();
  const auto given = team.command(order);
  ASSERT_FALSE(given.ok());
  EXPECT_THAT(given.error().message, HasSubstr("vehicle 2 is silent, where it flew to"));
}

TEST(FormationGround, WhomItsPilotHasIsKeptClearOfWhereItIsAndTakenAlongOnceItIsBack) {
  Team team{{{0.0, 0.0, 0.0}, {6.0, 0.0, 0.0}, {12.0, 0.0, 0.0}}};
  ASSERT_TRUE(team.goes_up());
  const Vec3 aside{-3.0, 1.0, 0.0};
  const Vec3 there = team.position(1) + aside;
  team.be_piloted(1, true);
  team.push_aside(1, aside);
  ASSERT_TRUE(team.until([&] { return team.ground().members().at({2}).lost; }));
  EXPECT_EQ(team.warnings(), 1U);
  const auto given = team.command(line_around(there));
  ASSERT_TRUE(given.ok()) << given.error().message;
  EXPECT_EQ(given->lost, std::vector<VehicleId>{{2}});
  ASSERT_TRUE(team.until([&] { return team.ground().in_place(); }));
  for (const std::size_t index : {0U, 2U}) {
    EXPECT_NEAR((team.position(index) - there).norm(), 4.0, 1e-6);
  }
  team.push_aside(1, {0.0, 0.0, 0.0});
  team.be_piloted(1, false);
  ASSERT_TRUE(team.until([&] { return !team.ground().members().at({2}).lost; }));
  EXPECT_LT((team.position(1) - there).norm(), 1e-6);
  ASSERT_TRUE(team.command({.kind = OrderKind::rally}).ok());
  ASSERT_TRUE(team.until([&] { return team.ground().in_place(); }));
  EXPECT_GT((team.position(1) - there).norm(), 1.0);
}

TEST(FormationGround, WhoIsGivenBackIsLedToItsPlaceAgain) {
  Team team{{{0.0, 0.0, 0.0}, {6.0, 0.0, 0.0}}};
  ASSERT_TRUE(team.goes_up());
  ASSERT_TRUE(team.command({.kind = OrderKind::rally}).ok());
  ASSERT_TRUE(team.until([&] { return team.ground().in_place(); }));
  const Vec3 place = team.position(1);
  team.be_piloted(1, true);
  team.push_aside(1, {4.0, 4.0, 0.0});
  for (int i = 0; i < 40; ++i) team.step();
  team.push_aside(1, {0.0, 0.0, 0.0});
  team.be_piloted(1, false);
  ASSERT_TRUE(team.until([&] { return (team.position(1) - place).norm() < 1e-6; }));
}

}  // namespace
}  // namespace skein::mission
