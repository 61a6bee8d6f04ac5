// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/track_ground.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "skein/mission/track_agent.hpp"

namespace skein::mission {
namespace {

using ::testing::HasSubstr;

/// A ground station and planes that hear each other at once and are where their plans have them.
class Team {
 public:
  explicit Team(std::size_t n, const Fence& fence = {}) {
    TrackGroundConfig config;
    config.fence = fence;
    for (std::size_t i = 0; i < n; ++i) {
      VehicleSpec spec;
      spec.id = {static_cast<std::uint16_t>(i + 1)};
      spec.cruise_speed_mps = 20.0;
      spec.speed_min_mps = 9.0;
      spec.speed_max_mps = 31.0;
      spec.turn_radius_m = 60.0;
      spec.turn_radius_margin = 1.5;
      spec.range_m = 50'000.0;
      spec.height_m = 100.0 + 10.0 * static_cast<double>(i);
      config.planes.push_back(spec);
      TrackAgentConfig agent;
      agent.vehicle = spec;
      Plane plane;
      plane.agent = std::make_unique<TrackAgent>(agent, Instant{});
      plane.state.x_m = 200.0 * static_cast<double>(i);
      plane.state.y_m = -500.0;
      planes_.push_back(std::move(plane));
    }
    config.rules.separation = {20.0, 8.0};
    config.rules.tracking_m = 5.0;
    config.rules.wind_mps = 4.0;
    config.rules.ceiling_m = 200.0 + 10.0 * static_cast<double>(n);
    ground = std::make_unique<TrackGround>(config, Instant{});
  }

  void step() {
    now += std::chrono::milliseconds{100};
    for (std::size_t i = 0; i < planes_.size(); ++i) fly(i);
    ground->on_timeout(now);
    while (const auto message = ground->poll_message()) {
      for (std::size_t i = 0; i < planes_.size(); ++i) {
        if (!deaf.contains(i)) planes_[i].agent->on_message(*message, kGroundStation, now);
      }
    }
    while (const auto event = ground->poll_event()) events.push_back(*event);
  }
  bool until(const std::function<bool()>& done, double seconds = 300.0) {
    for (int i = 0; i < static_cast<int>(10.0 * seconds) && !done(); ++i) step();
    return done();
  }
  void run(double seconds) {
    until([] { return false; }, seconds);
  }
  [[nodiscard]] bool told(event::FormationNews news) const {
    for (const auto& event : events) {
      const auto* warning = std::get_if<event::FormationWarning>(&event.body);
      if (warning != nullptr && warning->news == news) return true;
    }
    return false;
  }
  [[nodiscard]] Vec2 at(std::size_t i) const {
    return {planes_[i].state.x_m, planes_[i].state.y_m};
  }
  void be_piloted(std::size_t i, bool piloted) { planes_[i].agent->on_piloted(piloted, now); }
  void order(std::size_t i, CommandKind kind) {
    planes_[i].agent->on_message(Command{kGroundStation, ++command_, kind}, kGroundStation, now);
  }

  Instant now{};
  std::unique_ptr<TrackGround> ground;
  std::set<std::size_t> silent;  ///< say nothing
  std::set<std::size_t> deaf;    ///< hear nothing
  std::vector<MissionEvent> events;

 private:
  struct Plane {
    std::unique_ptr<TrackAgent> agent;
    VehicleState state;
    std::optional<FlightPlan> plan;
  };

  void fly(std::size_t i) {
    Plane& plane = planes_[i];
    if (plane.plan) {
      const Pose2 pose = plane.plan->timed.pose_at(now);
      plane.state.x_m = pose.x_m;
      plane.state.y_m = pose.y_m;
      plane.state.heading_rad = pose.heading_rad;
    }
    plane.state.time = now;
    plane.agent->on_state(plane.state, now);
    const VehicleId id{static_cast<std::uint16_t>(i + 1)};
    while (const auto guidance = plane.agent->poll_guidance()) {
      plane.plan = std::get<FlightPlan>(*guidance);
    }
    while (plane.agent->poll_event()) {
    }
    std::vector<Message> said;
    while (const auto message = plane.agent->poll_message()) said.push_back(*message);
    if (silent.contains(i)) return;
    for (const Message& message : said) ground->on_message(message, now);
    ground->on_message(PlanReport{id, *plane.plan}, now);
    ground->on_message(plane.agent->telemetry(), now);
  }

  std::vector<Plane> planes_;
  std::uint32_t command_ = 0;
};

TrackOrder along() {
  TrackOrder order;
  order.track = {{{0, 0}, {2000, 0}, {2000, 900}, {900, 900}, {900, 2000}, {0, 2000}}, true, 300.0};
  order.shape.kind = formation::ShapeKind::wedge;
  order.shape.spacing_m = 45.0;
  return order;
}

TEST(TrackGround, LeadsAFormationAlongATrackAndIntoAnotherShape) {
  Team team{5};
  team.run(3.0);
  const auto begun = team.ground->command(along(), team.now);
  ASSERT_TRUE(begun.ok()) << begun.error().message;
  ASSERT_TRUE(team.until([&] { return team.ground->in_place(); }));
  EXPECT_TRUE(team.ground->on_track(team.now));
  TrackOrder column;
  column.kind = OrderKind::reshape;
  column.shape.kind = formation::ShapeKind::column;
  column.shape.spacing_m = 45.0;
  const auto slides = team.ground->command(column, team.now);
  ASSERT_TRUE(slides.ok()) << slides.error().message;
  EXPECT_FALSE(team.ground->in_place());
  ASSERT_TRUE(team.until([&] { return team.ground->in_place(); }));
  EXPECT_LT(team.now, slides->planned.ends);
  ASSERT_TRUE(team.until([&] { return !team.ground->on_track(team.now); }, 600.0));
  EXPECT_FALSE(team.told(event::FormationNews::not_begun));
}

TEST(TrackGround, LeadsNoPlaneOutOfTheFence) {
  Fence fence{{{-900, -900}, {2900, -900}, {2900, 2900}, {-900, 2900}}, 400.0};
  Team wide{3, fence};
  wide.run(3.0);
  const auto good = wide.ground->preview(along(), wide.now);
  EXPECT_TRUE(good.ok()) << good.error().message;
  fence.corners[1].x() = fence.corners[2].x() = 1990.0;  // the track's corners are at 2000
  Team narrow{3, fence};
  narrow.run(3.0);
  const auto out = narrow.ground->command(along(), narrow.now);
  ASSERT_FALSE(out.ok());
  EXPECT_THAT(out.error().message, HasSubstr("the way of vehicle "));
  EXPECT_THAT(out.error().message, HasSubstr("leads out of the fence at [199"));
}

TEST(TrackGround, SaysWhyItGivesNoOrder) {
  Team team{3};
  TrackOrder column = along();
  column.kind = OrderKind::reshape;
  const auto none = team.ground->command(along(), team.now);
  ASSERT_FALSE(none.ok());
  EXPECT_THAT(none.error().message, HasSubstr("no plane is heard"));
  team.run(2.0);
  const auto nowhere = team.ground->command(column, team.now);
  ASSERT_FALSE(nowhere.ok());
  EXPECT_THAT(nowhere.error().message, HasSubstr("order fly-along TRACK in SHAPE"));
  ASSERT_TRUE(team.ground->command(along(), team.now).ok());
  team.run(5.0);
  const auto early = team.ground->command(column, team.now);
  ASSERT_FALSE(early.ok());
  EXPECT_THAT(early.error().message, HasSubstr("wait until the formation holds"));
}

TEST(TrackGround, TellsOfWhoFallsSilentAndGoesOnWithTheOthers) {
  Team team{4};
  team.run(2.0);
  ASSERT_TRUE(team.ground->command(along(), team.now).ok());
  team.run(10.0);
  team.silent.insert(2);
  team.run(4.0);
  EXPECT_TRUE(team.told(event::FormationNews::lost_on_track));
  EXPECT_TRUE(team.until([&] { return team.ground->in_place(); }));
  TrackOrder column = along();
  column.kind = OrderKind::reshape;
  column.shape.kind = formation::ShapeKind::column;
  const auto slides = team.ground->preview(column, team.now);
  ASSERT_TRUE(slides.ok()) << slides.error().message;
  EXPECT_EQ(slides->planned.flights.size(), 3U);
  EXPECT_EQ(slides->lost, std::vector<VehicleId>{VehicleId{3}});
  team.silent.clear();
  team.run(1.0);
  EXPECT_TRUE(team.told(event::FormationNews::back));
}

TEST(TrackGround, GivesTheOrderAgainToWhoHasNotHeardOfIt) {
  Team team{4};
  team.run(2.0);
  team.deaf.insert(1);
  ASSERT_TRUE(team.ground->command(along(), team.now).ok());
  team.run(6.0);
  EXPECT_TRUE(team.told(event::FormationNews::not_begun));
  team.deaf.clear();
  ASSERT_TRUE(team.until([&] { return team.ground->in_place(); }));
  EXPECT_GT((team.at(1) - team.at(0)).norm(), 30.0);
}

TEST(TrackGround, ManyAreToldInTurn) {
  Team team{40};
  team.run(2.0);
  for (std::size_t i = 0; i < 40; ++i) team.deaf.insert(i);
  TrackOrder column = along();
  column.shape.kind = formation::ShapeKind::column;
  const auto given = team.ground->command(column, team.now);
  ASSERT_TRUE(given.ok()) << given.error().message;
  std::vector<std::set<VehicleId>> told(1);
  for (int i = 0; i < 3; ++i) {
    while (const auto message = team.ground->poll_message()) {
      told.back().insert(std::get<TrackFlight>(*message).vehicle);
    }
    told.emplace_back();
    team.now += std::chrono::milliseconds{100};
    team.ground->on_timeout(team.now);
  }
  EXPECT_EQ(told[0].size(), 32U);
  EXPECT_EQ(told[1].size(), 8U) << "the rest";
  EXPECT_EQ(told[2].size(), 0U) << "and again after a while";
}

TEST(TrackGround, WhoIsToldToHoldIsMissedByNobody) {
  Team team{4};
  team.run(2.0);
  ASSERT_TRUE(team.ground->command(along(), team.now).ok());
  team.run(10.0);
  team.order(3, CommandKind::hold);
  EXPECT_TRUE(team.until([&] { return team.ground->in_place(); }));
}

TEST(TrackGround, WhomItsPilotHasIsGivenNoPlaceUntilItIsBack) {
  Team team{4};
  team.run(2.0);
  ASSERT_TRUE(team.ground->command(along(), team.now).ok());
  team.run(10.0);
  team.be_piloted(2, true);
  ASSERT_TRUE(team.until([&] { return team.ground->in_place(); })) << "the others need it not";
  const auto without = team.ground->preview(along(), team.now);
  ASSERT_TRUE(without.ok()) << without.error().message;
  EXPECT_EQ(without->lost, std::vector<VehicleId>{{3}});
  EXPECT_EQ(without->planned.flights.size(), 3U);
  team.be_piloted(2, false);
  team.run(1.0);
  const auto with = team.ground->preview(along(), team.now);
  ASSERT_TRUE(with.ok()) << with.error().message;
  EXPECT_EQ(with->planned.flights.size(), 4U);
}

}  // namespace
}  // namespace skein::mission
