// SPDX-License-Identifier: Apache-2.0
#include "skein/swap/swap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <utility>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"
#include "skein/base/geometry.hpp"
#include "skein/base/random.hpp"
#include "skein/formation/motion_profile.hpp"
#include "skein/hil/run_parallel.hpp"

namespace skein::swap {
namespace {

/// A path under 2 m/s2 leaves the chord of one control period by 0.1 mm: that is no breach.
constexpr double kChord = 1e-3;

/// Ticks of the control period in a time, at least that long.
std::size_t ticks_of(double seconds, double period_s) {
  return static_cast<std::size_t>(std::ceil(seconds / period_s - 1e-9));
}

class SwapFlight {
 public:
  SwapFlight(const SwapOptions& options, std::uint64_t seed)
      : options_{options},
        setting_{options.setting},
        random_{seed},
        message_every_{ticks_of(setting_.message_period_s, setting_.control_period_s)},
        delay_{ticks_of(setting_.message_delay_s, setting_.control_period_s)},
        start_{ticks_of(setting_.start_s, setting_.control_period_s)} {
    place_agents();
    const std::size_t n = options.agents;
    for (std::size_t i = 0; i < n; ++i) first_tick_.push_back(random_.index(message_every_));
    positions_ = setting_.starts;
    velocities_.assign(n, Vec3::Zero());
    next_.assign(n, Vec3::Zero());
    for (std::size_t i = 0; i < n; ++i) {
      run_.ideal_s = std::max(run_.ideal_s, ideal_time_s(way(i), setting_.limits));
    }
    run_.seed = seed;
  }

  Result<SwapRun> fly(const MakeAvoiders& make, bool with_tracks) {
    auto avoiders = make(setting_, random_.next());
    if (!avoiders) return avoiders.error();
    avoiders_ = std::move(*avoiders);
    SKEIN_ASSERT(avoiders_.size() == options_.agents);
    return fly(with_tracks);
  }

 private:
  SwapRun fly(bool with_tracks) {
    SeparationJudge judge{options_.agents, setting_.separation};
    const double deadline_s = options_.deadline_factor * run_.ideal_s;
    if (with_tracks) run_.tracks.resize(options_.agents);
    double flown_m = 0.0;
    for (std::size_t tick = 0;; ++tick) {
      const double now_s = static_cast<double>(tick) * setting_.control_period_s;
      if (with_tracks) {
        for (std::size_t i = 0; i < options_.agents; ++i) run_.tracks[i].push_back(positions_[i]);
      }
      run_.not_arrived = 0;
      for (std::size_t i = 0; i < options_.agents; ++i) run_.not_arrived += at_goal(i) ? 0 : 1;
      if (run_.not_arrived == 0) {
        run_.arrived_s = now_s - setting_.start_s;
        break;
      }
      if (now_s - setting_.start_s >= deadline_s) break;
      deliver(tick, now_s);
      for (std::size_t i = 0; i < options_.agents; ++i) {
        const Vec3 velocity = avoiders_[i]->step({positions_[i], velocities_[i]}, now_s);
        SKEIN_ASSERT(velocity.allFinite());
        if (tick >= start_) velocities_[i] = velocity;
        next_[i] = positions_[i] + velocities_[i] * setting_.control_period_s;
        flown_m += (next_[i] - positions_[i]).norm();
      }
      send(tick, now_s);
      judge.step(positions_, next_);
      std::swap(positions_, next_);
    }
    double straight_m = 0.0;
    for (std::size_t i = 0; i < options_.agents; ++i) straight_m += way(i);
    run_.way_ratio = flown_m / straight_m;
    run_.breached_pairs = judge.breached_pairs();
    run_.least_m = judge.least_m();
    run_.messages = sent_.size();
    return std::move(run_);
  }

  void place_agents() {
    const std::size_t n = options_.agents;
    SKEIN_ASSERT(n >= 2 && n <= 1000);
    const double radius =
        options_.radius_m > 0.0 ? options_.radius_m : default_radius_m(options_.agents);
    setting_.starts.clear();
    setting_.goals.clear();
    for (std::size_t i = 0; i < n; ++i) {
      const double angle = kTwoPi * static_cast<double>(i) / static_cast<double>(n);
      const Vec2 place = radius * unit_vector(angle);
      const double aside = options_.start_noise_m * std::sqrt(random_.uniform());
      const Vec2 start = place + aside * unit_vector(random_.uniform(0.0, kTwoPi));
      setting_.starts.emplace_back(start.x(), start.y(), 0.0);
      setting_.goals.emplace_back(-place.x(), -place.y(), 0.0);
    }
  }

  [[nodiscard]] double way(std::size_t i) const {
    return (setting_.goals[i] - setting_.starts[i]).norm();
  }
  [[nodiscard]] bool at_goal(std::size_t i) const {
    return (setting_.goals[i] - positions_[i]).norm() <= kArrived;
  }

  void send(std::size_t tick, double now_s) {
    for (std::size_t i = 0; i < options_.agents; ++i) {
      if (tick < first_tick_[i] || (tick - first_tick_[i]) % message_every_ != 0) continue;
      Message message{VehicleId{static_cast<std::uint16_t>(i + 1)},
                      now_s,
                      positions_[i],
                      velocities_[i],
                      at_goal(i),
                      std::nullopt};
      avoiders_[i]->tell(message);
      sent_.emplace_back(tick + delay_, std::move(message));
    }
  }

  void deliver(std::size_t tick, double now_s) {
    for (; delivered_ < sent_.size() && sent_[delivered_].first <= tick; ++delivered_) {
      const Message& message = sent_[delivered_].second;
      for (std::size_t i = 0; i < options_.agents; ++i) {
        if (i + 1 == message.from.value || random_.chance(setting_.message_loss)) continue;
        avoiders_[i]->on_message(message, now_s);
      }
    }
  }

  const SwapOptions& options_;
  Setting setting_;
  Random random_;
  std::vector<std::size_t> first_tick_;
  std::size_t message_every_;
  std::size_t delay_;
  std::size_t start_;
  std::deque<std::pair<std::size_t, Message>> sent_;  ///< with the tick when they arrive
  std::size_t delivered_ = 0;                         ///< of them; all are kept for the avoiders
  std::vector<std::unique_ptr<Avoider>> avoiders_;
  std::vector<Vec3> positions_;
  std::vector<Vec3> velocities_;
  std::vector<Vec3> next_;
  SwapRun run_;
};

}  // namespace

double default_radius_m(std::size_t agents) {
  static constexpr std::array<std::pair<double, double>, 4> kKnown{
      {{5.0, 10.0}, {32.0, 40.0}, {100.0, 100.0}, {250.0, 200.0}}};
  const auto n = static_cast<double>(agents);
  if (n <= kKnown.front().first) return kKnown.front().second;
  std::size_t after = 1;
  while (after + 1 < kKnown.size() && kKnown.at(after).first < n) ++after;
  const auto& [n0, r0] = kKnown.at(after - 1);
  const auto& [n1, r1] = kKnown.at(after);
  return r0 + (n - n0) / (n1 - n0) * (r1 - r0);
}

double ideal_time_s(double way_m, const formation::MotionLimits& limits) {
  const formation::MotionProfile profile{way_m, limits};
  // It comes to rest as it set out: the last metres take as long as the first.
  const double last_m = std::min(kArrived, 0.5 * way_m);
  double early_s = 0.0;
  double late_s = 0.5 * profile.duration_s();
  for (int i = 0; i < 60; ++i) {
    const double middle_s = 0.5 * (early_s + late_s);
    (profile.at(middle_s).distance_m < last_m ? early_s : late_s) = middle_s;
  }
  return profile.duration_s() - late_s;
}

SeparationJudge::SeparationJudge(std::size_t agents, const formation::Separation& separation)
    : agents_{agents},
      separation_{separation},
      breached_(agents * agents, false),
      least_m_{std::numeric_limits<double>::infinity()} {}

void SeparationJudge::step(std::span<const Vec3> from, std::span<const Vec3> to) {
  SKEIN_ASSERT(from.size() == agents_ && to.size() == agents_);
  const Vec3 stretched{1.0, 1.0, height_factor(separation_)};
  double farthest = 0.0;
  for (std::size_t i = 0; i < agents_; ++i) {
    farthest = std::max(farthest, (to[i] - from[i]).cwiseProduct(stretched).norm());
  }
  for (std::size_t i = 0; i < agents_; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const Vec3 apart = (from[i] - from[k]).cwiseProduct(stretched);
      // Nothing new can come of those that are too far from each other.
      const double heeded = std::max(least_m_, separation_.horizontal_m) + 2.0 * farthest;
      if (apart.squaredNorm() > heeded * heeded) continue;
      const Vec3 change = (to[i] - to[k]).cwiseProduct(stretched) - apart;
      const double change2 = change.squaredNorm();
      const double when = change2 > 0.0 ? std::clamp(-apart.dot(change) / change2, 0.0, 1.0) : 0.0;
      const double distance = (apart + when * change).norm();
      least_m_ = std::min(least_m_, distance);
      if (distance >= separation_.horizontal_m - kChord) continue;
      if (!breached_[i * agents_ + k]) ++breached_pairs_;
      breached_[i * agents_ + k] = true;
    }
  }
}

Result<SwapRun> fly_swap(const SwapOptions& options, const MakeAvoiders& make, std::uint64_t seed,
                         bool with_tracks) {
  return SwapFlight{options, seed}.fly(make, with_tracks);
}

Result<std::vector<SwapRun>> fly_swaps(const SwapOptions& options, const MakeAvoiders& make,
                                       std::uint64_t first_seed, std::size_t seeds,
                                       std::size_t jobs,
                                       const std::function<void(const SwapRun&)>& on_done) {
  const auto fly = [&](std::size_t i) { return fly_swap(options, make, first_seed + i); };
  return hil::run_parallel<SwapRun>(seeds, jobs, fly, on_done);
}

SwapSummary summarise(std::span<const SwapRun> runs) {
  SwapSummary s;
  s.runs = runs.size();
  s.least_m = std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (const SwapRun& run : runs) {
    s.runs_breached += run.breached_pairs > 0 ? 1 : 0;
    s.breached_pairs += run.breached_pairs;
    s.least_m = std::min(s.least_m, run.least_m);
    if (!run.arrived_s) {
      ++s.deadlocked;
      continue;
    }
    const double ratio = *run.arrived_s / run.ideal_s;
    sum += ratio;
    s.ratio_max = std::max(s.ratio_max.value_or(0.0), ratio);
  }
  if (s.deadlocked < s.runs) s.ratio_mean = sum / static_cast<double>(s.runs - s.deadlocked);
  return s;
}

}  // namespace skein::swap
