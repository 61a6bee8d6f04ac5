// SPDX-License-Identifier: Apache-2.0
#include "skein/swap/swap.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace skein::swap {
namespace {

TEST(SeparationJudge, SeesWhatHappensBetweenTwoMoments) {
  SeparationJudge judge{2, {3.0, 3.0}};
  // They pass each other 1 m apart, half way; both moments are 10 m from it.
  judge.step(std::array<Vec3, 2>{Vec3{-5, 0, 0}, Vec3{5, 1, 0}},
             std::array<Vec3, 2>{Vec3{5, 0, 0}, Vec3{-5, 1, 0}});
  EXPECT_NEAR(judge.least_m(), 1.0, 1e-12);
  EXPECT_EQ(judge.breached_pairs(), 1U);
}

TEST(SeparationJudge, CountsAPairOnceAndStretchesHeights) {
  SeparationJudge judge{3, {3.0, 6.0}};
  const std::array<Vec3, 3> at{Vec3{0, 0, 0}, Vec3{0, 0, 5}, Vec3{3, 0, 0}};
  for (int i = 0; i < 4; ++i) judge.step(at, at);
  EXPECT_NEAR(judge.least_m(), 2.5, 1e-12);  // 5 m up count as 2.5; 3 m aside are enough
  EXPECT_EQ(judge.breached_pairs(), 1U);
}

TEST(SeparationJudge, MissesNothingByItsShortCut) {
  // Many that fly at random, against the plain formula.
  constexpr std::size_t kAgents = 12;
  SeparationJudge judge{kAgents, {3.0, 3.0}};
  std::vector<Vec3> from(kAgents, Vec3::Zero());
  std::vector<Vec3> to(kAgents, Vec3::Zero());
  std::uint64_t state = 1;
  const auto next = [&state] {
    state = state * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(state >> 40U) / 16777216.0;
  };
  double least = 1e9;
  std::vector<bool> breached(kAgents * kAgents, false);
  for (int step = 0; step < 200; ++step) {
    for (std::size_t i = 0; i < kAgents; ++i) {
      from[i] = Vec3{100.0 * next(), 100.0 * next(), 0.0};
      to[i] = from[i] + Vec3{8.0 * next(), 8.0 * next(), 0.0};
    }
    judge.step(from, to);
    for (std::size_t i = 0; i < kAgents; ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        for (int s = 0; s <= 1000; ++s) {
          const double t = 0.001 * s;
          const double d = ((1 - t) * (from[i] - from[k]) + t * (to[i] - to[k])).norm();
          least = std::min(least, d);
          if (d < 2.999) breached[i * kAgents + k] = true;
        }
      }
    }
  }
  EXPECT_NEAR(judge.least_m(), least, 0.02);
  EXPECT_GE(judge.breached_pairs(),
            static_cast<std::size_t>(std::count(breached.begin(), breached.end(), true)));
}

/// Integrates the profile that jumps between its limits of jerk as late as it may.
double flown_time_s(double way_m, const formation::MotionLimits& limits) {
  // Phases of a symmetric profile, found by halving the peak speed.
  const auto way_of = [&](double peak) {
    const double j = limits.jerk_mps3;
    const double a = std::min(limits.acceleration_mps2, std::sqrt(peak * j));
    return peak * (peak / a + a / j);
  };
  double low = 0.0;
  double high = limits.speed_mps;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (way_of(middle) < way_m ? low : high) = middle;
  }
  const double peak = low;
  const double a = std::min(limits.acceleration_mps2, std::sqrt(peak * limits.jerk_mps3));
  const double up_s = peak / a + a / limits.jerk_mps3;
  const double whole_s = 2.0 * up_s + (way_m - way_of(peak)) / peak;
  // Backwards from the goal by small steps, until it is kArrived away.
  double t = 0.0;
  double x = 0.0;
  double v = 0.0;
  double acceleration = 0.0;
  constexpr double kStep = 1e-5;
  while (x < kArrived) {
    acceleration = std::min(a, acceleration + limits.jerk_mps3 * kStep);
    v += acceleration * kStep;
    x += v * kStep;
    t += kStep;
  }
  return whole_s - t;
}

TEST(IdealTime, IsThatOfAProfileWithinTheLimits) {
  for (const formation::MotionLimits& limits :
       {formation::MotionLimits{5.0, 2.0, 4.0}, formation::MotionLimits{1.0, 3.0, 4.0},
        formation::MotionLimits{10.0, 2.0, 40.0}}) {
    for (const double way_m : {0.5, 1.0, 3.0, 10.0, 20.0, 80.0, 400.0}) {
      EXPECT_NEAR(ideal_time_s(way_m, limits), flown_time_s(way_m, limits), 2e-3)
          << limits.speed_mps << " m/s, " << way_m << " m";
    }
  }
  EXPECT_NEAR(ideal_time_s(80.0, {}), 80.0 / 5.0 + 5.0 / 2.0 + 2.0 / 4.0 - std::cbrt(0.075), 1e-9);
}

TEST(Swap, HasTheCirclesOfItsTable) {
  EXPECT_EQ(default_radius_m(2), 10.0);
  EXPECT_EQ(default_radius_m(5), 10.0);
  EXPECT_EQ(default_radius_m(32), 40.0);
  EXPECT_EQ(default_radius_m(100), 100.0);
  EXPECT_EQ(default_radius_m(250), 200.0);
  EXPECT_NEAR(default_radius_m(175), 150.0, 1e-9);
}

/// A method whose agents decide each for itself.
template <class Make>
MakeAvoiders each(Make make) {
  return [make](const Setting& setting,
                std::uint64_t) -> Result<std::vector<std::unique_ptr<Avoider>>> {
    std::vector<std::unique_ptr<Avoider>> out;
    for (std::size_t i = 0; i < setting.starts.size(); ++i) out.push_back(make(setting, i));
    return out;
  };
}

SwapRun flown(const SwapOptions& options, const MakeAvoiders& make, std::uint64_t seed) {
  auto run = fly_swap(options, make, seed, true);
  EXPECT_TRUE(run.ok()) << run.error().message;
  return run.ok() ? std::move(*run) : SwapRun{};
}

/// Straight to its goal, through everybody; it keeps what it hears.
class Blind final : public Avoider {
 public:
  struct Log {
    std::size_t messages = 0;
    double age_least_s = 1e9;
    double age_most_s = 0.0;
  };

  Blind(const Setting& setting, std::size_t index, Log* log)
      : setting_{setting}, goal_{setting.goals[index]}, log_{log} {}
  void on_message(const Message& message, double now_s) override {
    if (log_ == nullptr) return;
    ++log_->messages;
    log_->age_least_s = std::min(log_->age_least_s, now_s - message.sent_s);
    log_->age_most_s = std::max(log_->age_most_s, now_s - message.sent_s);
  }
  Vec3 step(const OwnMotion& own, double) override {
    const Vec3 way = goal_ - own.position_m;
    return way * std::min(1.0 / setting_.control_period_s,
                          setting_.limits.speed_mps / std::max(way.norm(), 1e-9));
  }

 private:
  const Setting& setting_;
  Vec3 goal_;
  Log* log_;
};

TEST(Swap, ThoseWhoDoNotAvoidBreachAndArriveAtOnce) {
  const auto blind = each([](const Setting& setting, std::size_t index) {
    return std::make_unique<Blind>(setting, index, nullptr);
  });
  SwapOptions options;
  options.agents = 8;
  const SwapRun run = flown(options, blind, 1);
  ASSERT_TRUE(run.arrived_s.has_value());
  EXPECT_LT(*run.arrived_s, run.ideal_s);  // it needs no time to be fast
  EXPECT_EQ(run.breached_pairs, 8U * 7U / 2U);
  EXPECT_LT(run.least_m, 0.5);
  EXPECT_NEAR(run.way_ratio, 1.0, 0.01);
}

TEST(Swap, MessagesAreLateAndSomeAreLost) {
  Blind::Log log;
  const auto blind = each([&log](const Setting& setting, std::size_t index) {
    return std::make_unique<Blind>(setting, index, &log);
  });
  SwapOptions options;
  options.agents = 8;
  options.setting.message_delay_s = 0.14;
  options.setting.message_loss = 0.25;
  const SwapRun run = flown(options, blind, 1);
  EXPECT_NEAR(log.age_least_s, 0.14, 1e-9);
  EXPECT_NEAR(log.age_most_s, 0.14, 1e-9);
  EXPECT_NEAR(static_cast<double>(log.messages), 0.75 * 7.0 * static_cast<double>(run.messages),
              0.05 * 7.0 * static_cast<double>(run.messages));
  EXPECT_NEAR(static_cast<double>(run.messages), 8.0 / 0.06 * (1.0 + *run.arrived_s), 16.0);
}

TEST(Swap, WhoNeverMovesIsADeadlock) {
  class Stuck final : public Avoider {
    void on_message(const Message&, double) override {}
    Vec3 step(const OwnMotion&, double) override { return Vec3::Zero(); }
  };
  SwapOptions options;
  options.agents = 3;
  const auto stuck = each([](const Setting&, std::size_t) { return std::make_unique<Stuck>(); });
  const SwapRun run = flown(options, stuck, 1);
  EXPECT_FALSE(run.arrived_s.has_value());
  EXPECT_EQ(run.not_arrived, 3U);
  EXPECT_EQ(run.breached_pairs, 0U);
}

TEST(Swap, TheSameSeedIsTheSameRunOnAnyNumberOfThreads) {
  SwapOptions options;
  options.agents = 6;
  for (const Method& method : methods()) {
    const auto one = fly_swaps(options, method.make, 3, 3, 1, {}).value();
    const auto three = fly_swaps(options, method.make, 3, 3, 3, {}).value();
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(one[i].least_m, three[i].least_m) << method.name;
      EXPECT_EQ(one[i].arrived_s, three[i].arrived_s) << method.name;
      EXPECT_EQ(one[i].way_ratio, three[i].way_ratio) << method.name;
    }
    EXPECT_NE(one[0].least_m, one[1].least_m) << method.name;
  }
}

TEST(Swap, EveryMethodBringsFiveThrough) {
  SwapOptions options;
  options.agents = 5;
  for (const Method& method : methods()) {
    const auto summary = summarise(*fly_swaps(options, method.make, 1, 5, 1, {}));
    EXPECT_EQ(summary.deadlocked, 0U) << method.name;
  }
}

TEST(Swap, PassageBreachesNothingAndKeepsToTheLimits) {
  SwapOptions options;
  options.agents = 12;
  const SwapRun run = flown(options, find_method("passage").value()->make, 2);
  ASSERT_TRUE(run.arrived_s.has_value());
  EXPECT_EQ(run.breached_pairs, 0U);
  EXPECT_GE(run.least_m, options.setting.separation.horizontal_m);
  for (const auto& track : run.tracks) {
    for (std::size_t i = 2; i < track.size(); ++i) {
      const Vec3 before = (track[i - 1] - track[i - 2]) / options.setting.control_period_s;
      const Vec3 after = (track[i] - track[i - 1]) / options.setting.control_period_s;
      EXPECT_LE(after.norm(), options.setting.limits.speed_mps * 1.01);
      EXPECT_LE((after - before).norm() / options.setting.control_period_s,
                options.setting.limits.acceleration_mps2 * 1.5);
    }
  }
}

TEST(Swap, AMethodThatCannotFlyTheSettingSaysWhy) {
  SwapOptions options;
  options.agents = 100;
  options.radius_m = 20.0;  // 1.3 m from each other
  const auto run = fly_swap(options, find_method("passage").value()->make, 1);
  ASSERT_FALSE(run.ok());
  EXPECT_FALSE(run.error().message.empty());
  EXPECT_FALSE(fly_swaps(options, find_method("passage").value()->make, 1, 3, 2, {}).ok());
}

TEST(Swap, AMethodThatIsNotThereIsRefusedWithTheNamesOfThoseThatAre) {
  EXPECT_TRUE(find_method("orca").ok());
  const auto none = find_method("orka");
  ASSERT_FALSE(none.ok());
  EXPECT_THAT(none.error().message, ::testing::HasSubstr("choose one of: passage, field, orca"));
}

TEST(Swap, ThePictureHasATrackForEachAgent) {
  SwapOptions options;
  options.agents = 4;
  const SwapRun run = flown(options, find_method("orca").value()->make, 1);
  const std::string svg = swap_svg("4 < 5", run);
  EXPECT_THAT(svg, ::testing::HasSubstr("4 &lt; 5"));
  std::size_t tracks = 0;
  for (std::size_t at = svg.find("<polyline"); at != std::string::npos;
       at = svg.find("<polyline", at + 1)) {
    ++tracks;
  }
  EXPECT_EQ(tracks, 4U);
}

}  // namespace
}  // namespace skein::swap
