// SPDX-License-Identifier: Apache-2.0
#include "skein/change_trials/change_trials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"
#include "skein/base/random.hpp"
#include "skein/formation/place_assignment.hpp"
#include "skein/formation/shapes.hpp"
#include "skein/hil/run_parallel.hpp"

namespace skein::change_trials {
namespace {

using formation::ChangeRequest;

constexpr std::uint64_t kTrialStream = 0x6368616e67657301;
constexpr Duration kLook = std::chrono::milliseconds{20};
/// Speeding up and turning at once.
constexpr double kAccelerationMore = 1.5;
constexpr double kRounding_m = 1e-6;

/// Anywhere on a square, at least so far apart seen from above.
std::vector<Vec3> free_places(std::size_t n, double apart_m, Random& random) {
  double width = 1.6 * apart_m * std::sqrt(static_cast<double>(n));
  std::vector<Vec3> places;
  for (std::size_t tries = 0; places.size() < n; ++tries) {
    if (tries > 200 * n) {
      width *= 1.1;  // it was too small for all
      tries = 0;
    }
    const Vec3 p{random.uniform(-width / 2.0, width / 2.0),
                 random.uniform(-width / 2.0, width / 2.0), random.uniform(15.0, 25.0)};
    const bool room = std::all_of(places.begin(), places.end(), [&](const Vec3& other) {
      return std::hypot(p.x() - other.x(), p.y() - other.y()) >= apart_m;
    });
    if (room) places.push_back(p);
  }
  return places;
}

std::vector<Vec3> some_places(std::size_t n, double apart_m, Random& random) {
  if (random.chance(0.4)) return free_places(n, apart_m, random);
  formation::ShapeSpec shape;
  shape.kind = static_cast<formation::ShapeKind>(
      random.index(static_cast<std::uint64_t>(formation::ShapeKind::free)));
  shape.spacing_m = apart_m * random.uniform(1.0, 2.0);
  shape.heading_rad = random.uniform(-kPi, kPi);
  shape.centre = {random.uniform(-30.0, 30.0), random.uniform(-30.0, 30.0),
                  random.uniform(15.0, 25.0)};
  const auto places = formation::places(shape, n);
  SKEIN_ASSERT(places.ok());
  return *places;
}

std::vector<int> shuffled(std::size_t n, Random& random) {
  std::vector<int> order(n);
  for (std::size_t i = 0; i < n; ++i) order[i] = static_cast<int>(i);
  for (std::size_t i = n; i > 1; --i) std::swap(order[i - 1], order[random.index(i)]);
  return order;
}

/// Flies a change and looks at all of its vehicles again and again. Heights are stretched, so that
/// one distance is the measure of all directions.
class FlownChange {
 public:
  FlownChange(const ChangeRequest& request, const formation::ChangeMotion& motion)
      : request_{request},
        motion_{motion},
        n_{request.transfers.size()},
        factor_{request.separation.horizontal_m / request.separation.vertical_m},
        ceiling_m_{request.ceiling_m},
        look_at_(n_ * n_, 1),
        before_(n_),
        now_(n_) {
    for (const auto& transfer : request.transfers) {
      ceiling_m_ = std::max(ceiling_m_, transfer.from.z());
    }
  }

  void fly() {
    for (std::size_t look = 0;; ++look) {
      const Duration t = std::min(kLook * static_cast<Duration::rep>(look), motion_.duration());
      for (std::size_t i = 0; i < n_; ++i) look_at_place(i, t);
      for (std::size_t i = 0; i < n_ && look > 0; ++i) look_at_way(i, look);
      std::swap(before_, now_);
      if (t >= motion_.duration()) break;
    }
    for (std::size_t i = 0; i < n_; ++i) {
      if ((unstretched(before_[i]) - request_.transfers[i].to).norm() > kRounding_m) {
        wrong("it ends elsewhere");
      }
    }
  }

  /// A way bends by a t^2 / 8 from its chord; both of two can.
  [[nodiscard]] double bend_m() const {
    return 2.0 * kAccelerationMore * request_.limits.acceleration_mps2 * std::max(1.0, factor_) *
           look_s_ * look_s_ / 8.0;
  }
  [[nodiscard]] double least_m() const { return least_m_; }
  [[nodiscard]] const std::string& violation() const { return violation_; }

 private:
  void wrong(const std::string& sentence) {
    if (violation_.empty()) violation_ = sentence;
  }
  [[nodiscard]] Vec3 unstretched(const Vec3& v) const { return {v.x(), v.y(), v.z() / factor_}; }

  void look_at_place(std::size_t i, Duration t) {
    now_[i] = motion_.position(i, t);
    if (now_[i].z() > std::max(ceiling_m_, request_.transfers[i].to.z()) + kRounding_m) {
      wrong(fmt::format("vehicle {} flies above the ceiling", i + 1));
    }
    now_[i].z() *= factor_;
    const double from_start_m = (unstretched(now_[i]) - request_.transfers[i].from).norm();
    if (t == Duration::zero() && from_start_m > kRounding_m) wrong("it starts elsewhere");
  }

  void look_at_way(std::size_t i, std::size_t look) {
    const Vec3 own = now_[i] - before_[i];
    if (unstretched(own).norm() > request_.limits.speed_mps * look_s_ * (1.0 + 1e-6)) {
      wrong(fmt::format("vehicle {} is faster than allowed", i + 1));
    }
    // Nobody is faster, heights stretched; so who is far away need not be looked at for a while.
    const double step_m = 2.0 * request_.limits.speed_mps * std::max(1.0, factor_) * look_s_;
    for (std::size_t k = 0; k < i; ++k) {
      if (look_at_[i * n_ + k] > look) continue;
      const Vec3 begin = before_[i] - before_[k];
      const Vec3 way = own - (now_[k] - before_[k]);
      const double squared = way.squaredNorm();
      const double share = squared > 0.0 ? std::clamp(-begin.dot(way) / squared, 0.0, 1.0) : 0.0;
      const double apart_m = (begin + share * way).norm();
      least_m_ = std::min(least_m_, apart_m);
      look_at_[i * n_ + k] = look + static_cast<std::size_t>((apart_m - least_m_) / step_m);
    }
  }

  const ChangeRequest& request_;
  const formation::ChangeMotion& motion_;
  std::size_t n_;
  double look_s_ = to_seconds(kLook);
  double factor_;
  double ceiling_m_;
  double least_m_ = std::numeric_limits<double>::infinity();
  std::vector<std::size_t> look_at_;  ///< the look at which a pair is measured next
  std::vector<Vec3> before_;
  std::vector<Vec3> now_;
  std::string violation_;
};

}  // namespace

ChangeTrial draw_change(std::uint64_t seed) {
  Random random{seed ^ kTrialStream};
  ChangeTrial trial;
  trial.seed = seed;
  ChangeRequest& request = trial.request;
  request.limits.speed_mps = random.uniform(1.0, 8.0);
  request.limits.acceleration_mps2 = random.uniform(1.5, 4.0);
  request.limits.jerk_mps3 = random.uniform(2.0, 10.0);
  request.separation.horizontal_m = random.uniform(1.5, 4.0);
  request.separation.vertical_m = random.uniform(1.0, 2.0) * request.separation.horizontal_m;
  request.reserve_m = random.uniform(0.0, 1.5);
  request.ceiling_m = 120.0;
  const std::size_t n = 5 + random.index(96);
  const double apart_m = request.separation.horizontal_m + request.reserve_m + 0.05;
  const auto from = some_places(n, apart_m, random);
  const auto to = some_places(n, apart_m, random);
  trial.random_assignment = random.chance(0.2);
  std::vector<int> place_of;
  if (trial.random_assignment) {
    place_of = shuffled(n, random);
  } else {
    const auto assigned = formation::assign_places({}, from, to, Random{seed});
    SKEIN_ASSERT(assigned.ok());
    place_of = assigned->place_of;
  }
  for (std::size_t i = 0; i < n; ++i) {
    request.transfers.push_back({VehicleId{static_cast<std::uint16_t>(i + 1)}, from[i],
                                 to[static_cast<std::size_t>(place_of[i])]});
  }
  return trial;
}

JudgedChange judge_change(const ChangeRequest& request, const formation::PlannedChange& planned) {
  JudgedChange judged;
  judged.vehicles = request.transfers.size();
  judged.way = planned.way;
  judged.wanted_m = request.separation.horizontal_m + request.reserve_m;
  if (!formation::valid(planned.change)) {
    judged.violation = "the change is not valid";
    return judged;
  }
  const formation::ChangeMotion motion{planned.change};
  if (motion.movers() != judged.vehicles) {
    judged.violation = "vehicles are missing";
    return judged;
  }
  FlownChange flown{request, motion};
  flown.fly();
  const double bend_m = flown.bend_m();
  judged.least_m = flown.least_m() - bend_m;
  judged.violation = flown.violation();
  if (!judged.violation.empty()) return judged;
  if (judged.least_m < judged.wanted_m - bend_m - kRounding_m) {
    judged.violation = fmt::format("two vehicles come within {:.3f} m; {:.3f} m are wanted",
                                   judged.least_m, judged.wanted_m);
  } else if (planned.least_separation_m > judged.least_m + 2.0 * bend_m + kRounding_m) {
    judged.violation = fmt::format("{:.3f} m are promised, and {:.3f} m flown",
                                   planned.least_separation_m, judged.least_m);
  }
  return judged;
}

JudgedChange try_change(std::uint64_t seed) {
  const ChangeTrial trial = draw_change(seed);
  const auto planned = formation::plan_change(trial.request);
  JudgedChange judged;
  if (planned) {
    judged = judge_change(trial.request, *planned);
  } else {
    judged.refused = planned.error().message;
    judged.vehicles = trial.request.transfers.size();
  }
  judged.seed = seed;
  judged.random_assignment = trial.random_assignment;
  return judged;
}

std::vector<JudgedChange> try_changes(std::uint64_t first_seed, std::size_t runs, std::size_t jobs,
                                      const std::function<void(const JudgedChange&)>& on_done) {
  const auto fly = [&](std::size_t i) { return try_change(first_seed + i); };
  auto all = hil::run_parallel<JudgedChange>(runs, jobs, fly, on_done);
  SKEIN_ASSERT(all.ok());
  return std::move(*all);
}

}  // namespace skein::change_trials
