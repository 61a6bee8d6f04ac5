// SPDX-License-Identifier: Apache-2.0
#include "curve_polish.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace skein::routes {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The slope of a keep-out, over the straight distance: steeper than anything is gained by entering
/// one, so that what is best does not.
constexpr double kSlope = 10.0;
/// How far a curve stays outside, and how near a keep-out is looked at, over the straight distance.
constexpr double kMargin = 2e-5;
constexpr double kNear = 0.04;
/// Parts of a curve whose room to a keep-out is looked at each: it may pass one in several places.
constexpr std::size_t kParts = 24;
constexpr double kDifference = 1e-4;
constexpr double kEnough = 1e-6;  ///< of an improvement
/// Of the damping, which keeps a step as short as the model holds.
constexpr double kDampingFirst = 1.0;
constexpr double kDampingMin = 1e-3;
constexpr double kDampingMax = 1e4;
constexpr double kCurvatureFirst = 0.05;
constexpr int kSweeps = 300;

/// min g.d + d.H.d / 2 + sum of w_i |o_i + a_i.d| or slope max(0, -(o_i + a_i.d)): a row is as much
/// as its multiplier's bounds allow. By coordinate ascent over the multipliers.
struct Subproblem {
  VectorXd gradient;
  MatrixXd hessian;
  MatrixXd rows;  ///< a_i
  VectorXd offset, low, high;

  [[nodiscard]] VectorXd solve(VectorXd& multipliers) const {
    const MatrixXd inverse = hessian.inverse();
    const MatrixXd moves = inverse * rows.transpose();
    const MatrixXd gram = rows * moves;
    const VectorXd free = -inverse * gradient;
    VectorXd at = offset + rows * free - gram * multipliers;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      double moved = 0.0;
      for (Index i = 0; i < at.size(); ++i) {
        if (gram(i, i) < 1e-14) continue;
        const double next = std::clamp(multipliers[i] + at[i] / gram(i, i), low[i], high[i]);
        const double change = next - multipliers[i];
        if (change == 0.0) continue;
        multipliers[i] = next;
        at -= change * gram.col(i);
        moved = std::max(moved, std::abs(change) * std::sqrt(gram(i, i)));
      }
      if (moved < 1e-10) break;
    }
    return free - moves * multipliers;
  }
};

/// One descent. Works on turns' differences themselves, without the step that counts as none.
class Descent {
 public:
  Descent(const CurveProblem& problem, CurveEvaluator& evaluator, std::uint64_t evaluations)
      : problem_{problem},
        evaluator_{evaluator},
        evaluations_{evaluations},
        turns_{static_cast<Index>(problem.waypoints)},
        size_{2 * turns_ + 1},
        hessian_{kCurvatureFirst * MatrixXd::Identity(size_, size_)},
        turn_multipliers_{VectorXd::Zero(std::max<Index>(turns_ - 1, 0))} {}

  CurvePolish::Polished run(std::span<const double> from) {
    if (evaluations_ == 0) return best_;
    here_ = look(numbers_of(from));
    multipliers_.assign(here_.room.size(), 0.0);
    double damping = kDampingFirst;
    int small = 0;
    for (bool fresh = true; damping <= kDampingMax && small < 3;) {
      if (fresh && best_.evaluations + static_cast<std::uint64_t>(size_) >= evaluations_) break;
      if (fresh) differentiate();
      fresh = false;
      const auto [next, expected] = step(damping);
      if (!(expected > kEnough)) {
        if (damping >= 5.0) break;
        damping *= 6.0;  // it was not solved to the end
        continue;
      }
      if (best_.evaluations >= evaluations_) break;
      Look there = look(next);
      const double gain = here_.merit - there.merit;
      if (!(gain > 0.0)) {
        damping *= 5.0;
        continue;
      }
      if (gain > 0.5 * expected) damping = std::max(0.3 * damping, kDampingMin);
      if (gain < 0.1 * expected) damping *= 3.0;
      small = gain < kEnough ? small + 1 : 0;
      here_ = std::move(there);
      fresh = true;
    }
    return best_;
  }

 private:
  struct Look {
    VectorXd at;
    double smooth = 0.0;  ///< exposure and length, weighed
    double merit = 0.0;
    std::vector<double> room;
  };

  [[nodiscard]] bool is_difference(Index j) const { return j > 0 && j < turns_; }
  [[nodiscard]] VectorXd numbers_of(std::span<const double> point) const {
    VectorXd numbers(size_);
    for (Index j = 0; j < size_; ++j) {
      const double number = point[static_cast<std::size_t>(j)];
      numbers[j] = is_difference(j) ? beyond_turn_step(number)
                   : j < turns_     ? number
                                    : std::log(number);
    }
    return numbers;
  }
  [[nodiscard]] std::vector<double> point_of(const VectorXd& numbers) const {
    std::vector<double> point(numbers.begin(), numbers.end());
    for (Index j = 1; j < turns_; ++j) {
      double& number = point[static_cast<std::size_t>(j)];
      number = with_turn_step(number);
    }
    for (Index j = turns_; j < size_; ++j) {
      double& number = point[static_cast<std::size_t>(j)];
      number = std::exp(number);
    }
    evaluator_.box().clamp(point);
    return point;
  }
  /// Of one radian.
  [[nodiscard]] double turning_weight() const {
    return turns_ > 1 ? problem_.weights.turning / static_cast<double>(turns_ - 1) : 0.0;
  }
  [[nodiscard]] double turning(const VectorXd& numbers) const {
    return turns_ > 1 ? turning_weight() * numbers.segment(1, turns_ - 1).lpNorm<1>() : 0.0;
  }

  Look look(const VectorXd& numbers) {
    const std::vector<double> point = point_of(numbers);
    const RouteCosts costs = evaluator_.costs(point);
    ++best_.evaluations;
    if (costs.total < best_.value) {
      best_.value = costs.total;
      best_.point = point;
    }
    Look look{.at = numbers, .smooth = 0.0, .merit = 0.0, .room = {}};
    look.smooth =
        problem_.weights.exposure * costs.exposure + problem_.weights.length * costs.length_ratio;
    evaluator_.keep_out_room(kParts, kNear, look.room);
    look.merit = look.smooth + turning(numbers);
    for (double& room : look.room) {
      room -= kMargin;
      look.merit += kSlope * std::max(0.0, -room);
    }
    return look;
  }

  /// Gradients here, by differences away from the kinks at 0; and what they tell of curvature.
  void differentiate() {
    const VectorXd gradient_before = gradient_;
    const MatrixXd rows_before = rows_;
    const std::vector<std::size_t> near_before = near_;
    near_.clear();
    for (std::size_t i = 0; i < here_.room.size(); ++i) {
      if (here_.room[i] < kNear - kMargin) near_.push_back(i);
    }
    gradient_.resize(size_);
    rows_.resize(static_cast<Index>(near_.size()), size_);
    for (Index j = 0; j < size_; ++j) {
      VectorXd beside = here_.at;
      const double step = is_difference(j) && beside[j] > 0.0 ? -kDifference : kDifference;
      beside[j] += step;
      const Look there = look(beside);
      gradient_[j] = (there.smooth - here_.smooth) / step;
      for (std::size_t i = 0; i < near_.size(); ++i) {
        rows_(static_cast<Index>(i), j) = (there.room[near_[i]] - here_.room[near_[i]]) / step;
      }
    }
    if (gradient_before.size() > 0) {
      VectorXd change = gradient_ - gradient_before;
      for (std::size_t i = 0; i < near_.size(); ++i) {
        change += multipliers_[near_[i]] * rows_.row(static_cast<Index>(i)).transpose();
      }
      for (std::size_t i = 0; i < near_before.size(); ++i) {
        change -= multipliers_[near_before[i]] * rows_before.row(static_cast<Index>(i)).transpose();
      }
      learn(here_.at - before_, change);
    }
    before_ = here_.at;
  }

  void learn(const VectorXd& moved, const VectorXd& change) {
    if (moved.squaredNorm() < 1e-14) return;
    const VectorXd known = hessian_ * moved;
    const double curved = moved.dot(known);
    const double seen = moved.dot(change);
    const double share = seen >= 0.2 * curved ? 1.0 : 0.8 * curved / (curved - seen);
    const VectorXd damped = share * change + (1.0 - share) * known;
    hessian_ +=
        damped * damped.transpose() / moved.dot(damped) - known * known.transpose() / curved;
  }

  /// Where to, and what the model expects of it.
  [[nodiscard]] std::pair<VectorXd, double> step(double damping) {
    const Index differences = std::max<Index>(turns_ - 1, 0);
    const auto near = static_cast<Index>(near_.size());
    Subproblem sub{.gradient = gradient_,
                   .hessian = hessian_ + damping * MatrixXd::Identity(size_, size_),
                   .rows = MatrixXd::Zero(differences + near, size_),
                   .offset = VectorXd::Zero(differences + near),
                   .low = VectorXd::Constant(differences + near, -turning_weight()),
                   .high = VectorXd::Constant(differences + near, turning_weight())};
    VectorXd multipliers(differences + near);
    multipliers.head(differences) = turn_multipliers_;
    for (Index j = 0; j < differences; ++j) {
      sub.rows(j, j + 1) = 1.0;
      sub.offset[j] = here_.at[j + 1];
    }
    for (Index i = 0; i < near; ++i) {
      const std::size_t id = near_[static_cast<std::size_t>(i)];
      sub.rows.row(differences + i) = rows_.row(i);
      sub.offset[differences + i] = here_.room[id];
      sub.low[differences + i] = -kSlope;
      sub.high[differences + i] = 0.0;
      multipliers[differences + i] = multipliers_[id];
    }
    VectorXd next = here_.at + sub.solve(multipliers);
    turn_multipliers_ = multipliers.head(differences);
    std::fill(multipliers_.begin(), multipliers_.end(), 0.0);
    for (Index i = 0; i < near; ++i) {
      multipliers_[near_[static_cast<std::size_t>(i)]] = multipliers[differences + i];
    }
    for (Index j = 1; j < turns_; ++j) {
      if (std::abs(next[j]) < 1e-7) next[j] = 0.0;
    }
    next = numbers_of(point_of(next));  // within the box
    const VectorXd d = next - here_.at;
    double expected = here_.smooth + gradient_.dot(d) + 0.5 * d.dot(hessian_ * d) + turning(next);
    for (Index i = 0; i < near; ++i) {
      const double room = here_.room[near_[static_cast<std::size_t>(i)]] + rows_.row(i).dot(d);
      expected += kSlope * std::max(0.0, -room);
    }
    return {std::move(next), here_.merit - expected};
  }

  const CurveProblem& problem_;
  CurveEvaluator& evaluator_;
  std::uint64_t evaluations_;
  Index turns_;
  Index size_;
  CurvePolish::Polished best_;
  Look here_;
  VectorXd before_;    ///< where the gradients were taken before
  VectorXd gradient_;  ///< of the smooth costs
  MatrixXd rows_;      ///< gradients of the rooms that are near
  std::vector<std::size_t> near_;
  MatrixXd hessian_;
  VectorXd turn_multipliers_;
  std::vector<double> multipliers_;  ///< of all rooms
};

}  // namespace

double cost_with_slopes(const CostWeights& weights, const RouteCosts& costs) {
  if (costs.total < kBarredCost) return costs.total;
  const double sum = weights.exposure * costs.exposure + weights.length * costs.length_ratio +
                     weights.turning * costs.turning;
  return sum + kSlope * ((costs.total - sum) / kBarredCost - 1.0);
}

CurvePolish::Polished CurvePolish::polish(std::span<const double> from, std::uint64_t evaluations) {
  return Descent{problem_, evaluator_, evaluations}.run(from);
}

}  // namespace skein::routes
