// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "skein/swap/avoider.hpp"

/// The antipodal swap: agents evenly on a circle, each with the place opposite as its goal, all at
/// once. In virtual time; the same seed gives the same run. How methods of avoidance are compared.
namespace skein::swap {

struct SwapOptions {
  std::size_t agents = 32;       ///< 2 to 1000
  double radius_m = 0.0;         ///< of the circle; 0: default_radius_m(agents)
  double start_noise_m = 0.1;    ///< starts lie evenly in discs of this radius; goals have none
  double deadline_factor = 5.0;  ///< of the ideal time: who is not there then, never will be
  /// Of the setting, starts and goals are not read.
  Setting setting;
};

/// 10 m for 5 agents, 40 for 32, 100 for 100, 200 for 250; between and beyond on straight lines.
[[nodiscard]] double default_radius_m(std::size_t agents);

/// An agent has arrived when it is this near to its goal.
inline constexpr double kArrived = 0.05;

/// Of a straight way from rest to rest within the limits, until the goal is `kArrived` away.
[[nodiscard]] double ideal_time_s(double way_m, const formation::MotionLimits& limits);

/// Judges in continuous time, from positions alone: motion between two moments is straight.
class SeparationJudge {
 public:
  SeparationJudge(std::size_t agents, const formation::Separation& separation);

  /// All agents flew from `from` to `to`, straight and evenly.
  void step(std::span<const Vec3> from, std::span<const Vec3> to);
  /// Pairs that were once nearer than the separation, by more than 1 mm.
  [[nodiscard]] std::size_t breached_pairs() const { return breached_pairs_; }
  /// The least distance of any pair, heights stretched as Separation says; infinity before a step.
  [[nodiscard]] double least_m() const { return least_m_; }

 private:
  std::size_t agents_;
  formation::Separation separation_;
  std::vector<bool> breached_;
  std::size_t breached_pairs_ = 0;
  double least_m_;
};

struct SwapRun {
  std::uint64_t seed = 0;
  double ideal_s = 0.0;  ///< of the agent that has the longest way
  /// From Setting::start_s until all were at their goals together; none in a deadlock.
  std::optional<double> arrived_s;
  std::size_t not_arrived = 0;  ///< agents, at the end
  std::size_t breached_pairs = 0;
  double least_m = 0.0;
  double way_ratio = 0.0;  ///< flown by all together, over the straight ways
  std::size_t messages = 0;
  /// Of each agent, at every control period; empty unless asked for.
  std::vector<std::vector<Vec3>> tracks;
};

/// Starts are drawn from the seed; it ends when all are at their goals, or at the deadline.
/// Fails where the method cannot fly it.
[[nodiscard]] Result<SwapRun> fly_swap(const SwapOptions& options, const MakeAvoiders& make,
                                       std::uint64_t seed, bool with_tracks = false);

/// Seeds first_seed, first_seed + 1, ... on `jobs` threads; the result does not depend on them.
/// `on_done` is called after each run, from one thread at a time. Fails where one of them does.
[[nodiscard]] Result<std::vector<SwapRun>> fly_swaps(
    const SwapOptions& options, const MakeAvoiders& make, std::uint64_t first_seed,
    std::size_t seeds, std::size_t jobs, const std::function<void(const SwapRun&)>& on_done);

struct SwapSummary {
  std::size_t runs = 0;
  std::size_t runs_breached = 0;
  std::size_t breached_pairs = 0;  ///< of all runs
  double least_m = 0.0;            ///< of all runs
  std::size_t deadlocked = 0;      ///< runs
  /// Over the ideal time, of the runs that arrived; none where none did.
  std::optional<double> ratio_mean;
  std::optional<double> ratio_max;
};
[[nodiscard]] SwapSummary summarise(std::span<const SwapRun> runs);

/// Tracks of a run as an SVG file for light and dark pages, starts as rings, goals as dots.
[[nodiscard]] std::string swap_svg(const std::string& title, const SwapRun& run);

}  // namespace skein::swap
