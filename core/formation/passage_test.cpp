// SPDX-License-Identifier: Apache-2.0
#include "skein/formation/passage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <limits>
#include <optional>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"
#include "skein/formation/change_planner.hpp"

namespace skein::formation {
namespace {

using std::chrono::milliseconds;

constexpr MotionLimits kLimits{.speed_mps = 3.0, .acceleration_mps2 = 2.0, .jerk_mps3 = 4.0};
constexpr Separation kSeparation{3.0, 3.0};

std::vector<Transfer> swap_on_circle(std::size_t n, double radius_m, Random& random) {
  std::vector<Transfer> transfers;
  for (std::size_t i = 0; i < n; ++i) {
    const double angle = 2.0 * kPi * static_cast<double>(i) / static_cast<double>(n);
    const Vec2 at = radius_m * unit_vector(angle);
    const Vec3 jitter{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 0.0};
    transfers.push_back({{static_cast<std::uint16_t>(i + 1)},
                         Vec3{at.x(), at.y(), 20.0} + jitter,
                         Vec3{-at.x(), -at.y(), 20.0}});
  }
  return transfers;
}

/// Vehicles that follow their references exactly, and messages between them.
struct Team {
  struct Network {
    Duration delay = milliseconds{200};
    double loss = 0.2;
    Duration period = milliseconds{50};
  };
  struct Sent {
    Instant due;
    std::size_t to;
    std::size_t from;
    Progress progress;
  };

  Team(const Change& planned, Network net, std::uint64_t seed)
      : change{planned}, network{net}, random{seed} {
    change.number = 1;
    change.start = at_seconds(1.0);
    PassageParams params;
    params.silent_after = silent_after(network.delay);
    for (std::size_t i = 0; i < change.movers.size(); ++i) {
      vehicles.emplace_back(change, i, params, now);
      clock.push_back(from_seconds(random.uniform(-0.01, 0.01)));
    }
  }

  void tick() {
    now += milliseconds{10};
    for (std::size_t i = 0; i < vehicles.size(); ++i) {
      const Instant local = now + clock[i];
      if (asleep && asleep(i, now)) continue;
      if (stalled) vehicles[i].hold(stalled(i, now));
      vehicles[i].step(local);
      if (now.time_since_epoch() % network.period == Duration{}) {
        for (std::size_t to = 0; to < vehicles.size(); ++to) {
          if (to == i || i == silent || random.chance(network.loss)) continue;
          air.push_back({now + network.delay, to, i, vehicles[i].progress()});
        }
      }
    }
    while (!air.empty() && air.front().due <= now) {
      if (!asleep || !asleep(air.front().to, now))
        vehicles[air.front().to].on_progress(air.front().from, air.front().progress);
      air.pop_front();
    }
    judge();
  }

  /// By the references alone: every 10 ms, and what can happen in between.
  void judge() {
    for (std::size_t i = 0; i < vehicles.size(); ++i) {
      const Vec3 at = vehicles[i].reference(now + clock[i]).position_m;
      if (i < places.size()) fastest = std::max(fastest, (at - places[i]).norm() / 0.01);
      if (i < places.size())
        places[i] = at;
      else
        places.push_back(at);
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
      for (std::size_t j = i + 1; j < places.size(); ++j) {
        least = std::min(least, (places[i] - places[j]).norm());
      }
    }
  }

  bool run(double limit_s) {
    const Instant end = now + from_seconds(limit_s);
    while (now < end) {
      tick();
      if (std::all_of(vehicles.begin(), vehicles.end(),
                      [](const Passage& p) { return p.finished(); }))
        return true;
    }
    return false;
  }

  Change change;
  Network network;
  Random random;
  std::optional<std::size_t> silent;
  Instant now{};
  std::vector<Passage> vehicles;
  std::vector<Duration> clock;
  std::deque<Sent> air;
  std::vector<Vec3> places;
  using When = std::function<bool(std::size_t, Instant)>;
  When stalled;  ///< it is held
  When asleep;   ///< its program does nothing
  double least = std::numeric_limits<double>::infinity();
  double fastest = 0.0;
};

PlannedChange swap_plan(std::size_t n, double radius_m, std::uint64_t seed,
                        double reserve_m = 1.0) {
  Random random{seed};
  const auto planned = plan_change({.transfers = swap_on_circle(n, radius_m, random),
                                    .keep_outs = {},
                                    .limits = kLimits,
                                    .separation = kSeparation,
                                    .reserve_m = reserve_m});
  EXPECT_TRUE(planned.ok()) << planned.error().message;
  return *planned;
}

/// The first crosses above the second, whose way is as long, and falls silent just there.
Team crossing(double before_m) {
  Change change;
  change.limits = kLimits;
  change.separation = kSeparation;
  const double after_m = 80.0 - before_m;
  change.movers = {{{1}, {{-20.0, 0.0, 30.0}, {60.0, 0.0, 30.0}}, 0},
                   {{2}, {{0.0, -before_m, 20.0}, {0.0, after_m, 20.0}}, 0}};
  Team team{change, {milliseconds{50}, 0.0}, 3};
  while (team.places.empty() || team.places[0].x() < -1.0) team.tick();
  team.silent = 0;
  return team;
}

TEST(Passage, StopsBeforeItIsBelowASilentVehicle) {
  Team team = crossing(50.0);
  for (int i = 0; i < 2000; ++i) team.tick();
  EXPECT_TRUE(team.vehicles[1].at_rest());
  EXPECT_EQ(team.vehicles[1].waits_for(), 0U);
  EXPECT_LE(team.places[1].y(), -kSeparation.horizontal_m);
  EXPECT_GE(team.places[1].y(), -kSeparation.horizontal_m - 2.0);  // no sooner than it must
  team.silent.reset();
  EXPECT_TRUE(team.run(60.0));
}

TEST(Passage, LeavesTheAirBelowASilentVehicle) {
  Team team = crossing(20.0);
  for (int i = 0; i < 300; ++i) team.tick();
  EXPECT_GE(team.places[1].y(), kSeparation.horizontal_m);
}

TEST(Passage, AloneKeepsTheChangesOwnTime) {
  Team team{swap_plan(1, 40.0, 1).change, {}, 1};
  ASSERT_TRUE(team.run(60.0));
  const double planned_s = to_seconds(team.vehicles[0].motion().duration());
  EXPECT_LE(to_seconds(team.now) - 1.0, planned_s + 0.15);
  EXPECT_LE(team.fastest, 3.0 * 1.001);
}

TEST(Passage, AntipodalSwapKeepsSeparationAndEnds) {
  for (const std::size_t n : {2U, 5U, 12U, 32U}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const auto planned = swap_plan(n, 40.0, seed);
      Team team{planned.change, {}, seed};
      ASSERT_TRUE(team.run(300.0)) << n << " vehicles, seed " << seed;
      EXPECT_GE(team.least, 3.0) << n << " vehicles, seed " << seed;
    }
  }
}

TEST(Passage, SwapOnLevelsKeepsSeparationWhateverIsLostAndWhoeverStalls) {
  const auto planned = swap_plan(32, 40.0, 5);
  EXPECT_TRUE(std::ranges::any_of(planned.change.movers,
                                  [](const Mover& mover) { return mover.level == 2; }));
  Team team{planned.change, {.delay = milliseconds{300}, .loss = 0.5}, 5};
  team.stalled = [](std::size_t i, Instant at) {
    const double from_s = 5.0 + static_cast<double>(i) * 0.5;  // one after the other, 4 at once
    return at > at_seconds(from_s) && at < at_seconds(from_s + 2.0);
  };
  ASSERT_TRUE(team.run(300.0));
  EXPECT_GE(team.least, 3.0);
}

/// Nine that swap, of whom one is so for a while: from `from_s` on or later, at least `least_s`.
Team swap_of_nine(std::uint64_t seed, double loss, Team::When Team::*so, Random random,
                  double from_s, double least_s) {
  Team team{swap_plan(9, 25.0, seed).change, {.delay = milliseconds{300}, .loss = loss}, seed};
  const auto victim = random.index(9);
  const Instant from = at_seconds(random.uniform(from_s, 12.0));
  const Instant until = from + from_seconds(random.uniform(least_s, 8.0));
  team.*so = [=](std::size_t i, Instant now) { return i == victim && now >= from && now < until; };
  return team;
}

TEST(Passage, WhoStallsIsNeverRunInto) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Team team = swap_of_nine(seed, 0.5, &Team::stalled, Random{seed + 1000}, 0.5, 0.2);
    ASSERT_TRUE(team.run(300.0)) << seed;
    EXPECT_GE(team.least, 3.0) << seed;
  }
}

TEST(Passage, WhoseProgramStandsStillGoesOnFromWhereItsTrackHasLed) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Team team = swap_of_nine(seed, 0.3, &Team::asleep, Random{seed + 2000}, 1.5, 0.1);
    ASSERT_TRUE(team.run(300.0)) << seed;
    EXPECT_GE(team.least, 3.0) << seed;
    EXPECT_LE(team.fastest, kLimits.speed_mps + 0.01) << seed;  // nobody jumps
  }
}

/// One flies under two that fall silent: under the one it cannot stop any more, before the other's
/// column, which begins before that of the first ends, it can.
TEST(Passage, AColumnThatIsLeftIsNoLeaveToEnterAnother) {
  const auto planned = plan_change({.transfers = {{{1}, {0, 0, 10}, {40, 0, 10}},
                                                  {{2}, {16, 1, 20}, {16, 1, 26}},
                                                  {{3}, {20, 0, 40}, {-20, 0, 40}}},
                                    .keep_outs = {},
                                    .limits = kLimits,
                                    .separation = kSeparation,
                                    .reserve_m = 1.0});
  ASSERT_TRUE(planned.ok()) << planned.error().message;
  Change change = planned->change;
  change.number = 1;
  std::vector<Passage> all;
  for (std::size_t i = 0; i < 3; ++i) all.emplace_back(change, i, PassageParams{}, Instant{});
  Passage& below = all[0];
  Instant now{};
  const auto x_m = [&] { return below.reference(now).position_m.x(); };
  while (now < at_seconds(30.0)) {
    now += kSlot;
    for (Passage& one : all) one.step(now);
    for (std::size_t i = 0; i < 3; ++i) {
      const bool is_heard = i == 1 ? now < at_seconds(1.0) : i == 0 || x_m() < 8.0;
      for (std::size_t to = 0; is_heard && to < 3; ++to) {
        if (to != i) all[to].on_progress(i, all[i].progress());
      }
    }
  }
  EXPECT_GT(x_m(), 8.0);
  EXPECT_LE(x_m(), 16.0 - std::sqrt(9.0 - 1.0) + 0.01);
  EXPECT_TRUE(below.at_rest());
  EXPECT_EQ(below.waits_for(), 1U);
}

/// One that flies along a line eastwards from the origin, under one that is heard until the first
/// is at `silent_at_m`.
struct UnderASilentOne {
  UnderASilentOne(Change change, double silent_at_m) {
    change.number = 1;
    const PassageParams params;
    Passage below{change, 0, params, Instant{}};
    Passage above{change, 1, params, Instant{}};
    std::optional<Instant> last_heard;
    for (Instant now{}; now < at_seconds(40.0); now += kSlot) {
      below.step(now);
      above.step(now);
      above.on_progress(0, below.progress());
      const auto moment = below.reference(now);
      at_m = moment.position_m.x();
      const double speed_mps = moment.velocity_mps.norm();
      if (at_m < silent_at_m) {
        below.on_progress(1, above.progress());
        last_heard = now;
      } else if (last_heard && !would_stop_m &&
                 now - *last_heard > params.silent_after + 2 * kSlot) {
        would_stop_m = at_m + speed_mps * speed_mps / (2.0 * kLimits.acceleration_mps2);
      }
    }
    rests = below.at_rest();
  }
  double at_m = 0.0;  ///< in the end
  bool rests = false;
  std::optional<double> would_stop_m;  ///< by full braking once the other is silent
};

TEST(Passage, WhoCanStopAtTheEdgeOfAColumnDoes) {
  const auto planned =
      plan_change({.transfers = {{{1}, {0, 0, 10}, {40, 0, 10}}, {{2}, {20, 1, 20}, {20, 1, 26}}},
                   .keep_outs = {},
                   .limits = kLimits,
                   .separation = kSeparation,
                   .reserve_m = 1.0});
  ASSERT_TRUE(planned.ok()) << planned.error().message;
  // Of the 3 m apart, 1 m is for what both may be off.
  const double edge_m = 20.0 - std::sqrt(4.0 - 1.0);
  int stopped = 0;
  int passed = 0;
  for (double silent_at_m = 2.0; silent_at_m < 20.0; silent_at_m += 0.25) {
    const UnderASilentOne run{planned->change, silent_at_m};
    ASSERT_TRUE(run.would_stop_m) << silent_at_m;
    if (*run.would_stop_m < edge_m - 0.3) {
      EXPECT_TRUE(run.rests) << silent_at_m;
      EXPECT_LE(run.at_m, edge_m) << silent_at_m;
      ++stopped;
    } else if (*run.would_stop_m > edge_m + 0.5) {
      EXPECT_NEAR(run.at_m, 40.0, 0.01) << "it leads out, from " << silent_at_m;
      ++passed;
    }
  }
  EXPECT_GT(stopped, 20);
  EXPECT_GT(passed, 5);
}

/// That crosses the line 2.8 m above it, just before the first would: going on would end at 1.1 m
/// from it.
TEST(Passage, WhoseWayOutTheSilentOneItselfBarsStopsAtOnce) {
  Change change;
  change.limits = kLimits;
  change.separation = kSeparation;
  change.movers = {{{1}, {{0, 0, 10}, {40, 0, 10}}, 0},
                   {{2}, {{20, -18.1, 12.8}, {20, 21.9, 12.8}}, 0}};
  const UnderASilentOne run{change, 15.1};
  const double core_m = 20.0 - 2.0;
  ASSERT_GT(run.would_stop_m, core_m);  // where who has a way out goes on
  EXPECT_TRUE(run.rests);
  EXPECT_LE(run.at_m, *run.would_stop_m + 0.1);
}

TEST(Passage, HaltsAndStays) {
  Team team{swap_plan(9, 25.0, 4).change, {}, 4};
  team.run(6.0);
  for (auto& vehicle : team.vehicles) vehicle.hold(true);
  team.run(3.0);
  for (const auto& vehicle : team.vehicles) {
    EXPECT_TRUE(vehicle.at_rest());
    EXPECT_FALSE(vehicle.finished());
  }
  EXPECT_GE(team.least, 3.0);
}

}  // namespace
}  // namespace skein::formation
