// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "search_counter.hpp"
#include "skein/base/assert.hpp"
#include "skein/routes/optimiser.hpp"

namespace skein::routes {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Mean, step size and covariance, in coordinates that are 0 to 1 over the box. Names of Hansen's
/// tutorial.
class Distribution {
 public:
  Distribution(VectorXd mean, double sigma, std::size_t lambda)
      : mean_{std::move(mean)}, sigma_{sigma}, lambda_{lambda} {
    const auto n = static_cast<double>(mean_.size());
    const std::size_t mu = lambda / 2;
    weights_.resize(static_cast<Eigen::Index>(mu));
    for (std::size_t i = 0; i < mu; ++i) {
      weights_[static_cast<Eigen::Index>(i)] =
          std::log(0.5 * static_cast<double>(lambda + 1)) - std::log(static_cast<double>(i + 1));
    }
    weights_ /= weights_.sum();
    mu_eff_ = 1.0 / weights_.squaredNorm();
    c_c_ = (4.0 + mu_eff_ / n) / (n + 4.0 + 2.0 * mu_eff_ / n);
    c_s_ = (mu_eff_ + 2.0) / (n + mu_eff_ + 5.0);
    c_1_ = 2.0 / ((n + 1.3) * (n + 1.3) + mu_eff_);
    c_mu_ = std::min(1.0 - c_1_,
                     2.0 * (mu_eff_ - 2.0 + 1.0 / mu_eff_) / ((n + 2.0) * (n + 2.0) + mu_eff_));
    d_s_ = 1.0 + 2.0 * std::max(0.0, std::sqrt((mu_eff_ - 1.0) / (n + 1.0)) - 1.0) + c_s_;
    chi_n_ = std::sqrt(n) * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
    const Eigen::Index size = mean_.size();
    path_c_ = VectorXd::Zero(size);
    path_s_ = VectorXd::Zero(size);
    covariance_ = MatrixXd::Identity(size, size);
    axes_ = covariance_;
    scales_ = VectorXd::Ones(size);
    // Often enough for the distribution to be current, seldom enough not to cost more than the
    // objective.
    interval_ =
        std::max<std::uint64_t>(1, static_cast<std::uint64_t>(1.0 / (10.0 * n * (c_1_ + c_mu_))));
  }

  [[nodiscard]] VectorXd draw(Random& random) const {
    VectorXd z(mean_.size());
    for (double& component : z) component = random.normal(0.0, 1.0);
    return mean_ + sigma_ * (axes_ * scales_.cwiseProduct(z));
  }

  /// `ranked`: points drawn, best first.
  void update(const std::vector<const VectorXd*>& ranked) {
    ++generation_;
    const VectorXd old = mean_;
    mean_.setZero();
    for (Eigen::Index i = 0; i < weights_.size(); ++i) {
      mean_ += weights_[i] * *ranked[static_cast<std::size_t>(i)];
    }
    const VectorXd step = (mean_ - old) / sigma_;
    const VectorXd whitened =
        axes_ * (axes_.transpose() * step).cwiseQuotient(scales_);  // C^-1/2 step
    path_s_ = (1.0 - c_s_) * path_s_ + std::sqrt(c_s_ * (2.0 - c_s_) * mu_eff_) * whitened;
    const double expected =
        std::sqrt(1.0 - std::pow(1.0 - c_s_, 2.0 * static_cast<double>(generation_)));
    const auto n = static_cast<double>(mean_.size());
    const bool moving = path_s_.norm() / expected < (1.4 + 2.0 / (n + 1.0)) * chi_n_;
    path_c_ *= 1.0 - c_c_;
    if (moving) path_c_ += std::sqrt(c_c_ * (2.0 - c_c_) * mu_eff_) * step;
    const double lost = moving ? 0.0 : c_c_ * (2.0 - c_c_);
    covariance_ *= 1.0 - c_1_ - c_mu_ + c_1_ * lost;
    covariance_ += c_1_ * path_c_ * path_c_.transpose();
    for (Eigen::Index i = 0; i < weights_.size(); ++i) {
      const VectorXd y = (*ranked[static_cast<std::size_t>(i)] - old) / sigma_;
      covariance_ += (c_mu_ * weights_[i]) * y * y.transpose();
    }
    sigma_ *= std::exp(std::min(1.0, c_s_ / d_s_ * (path_s_.norm() / chi_n_ - 1.0)));
    if (generation_ % interval_ == 0) factorise();
  }

  [[nodiscard]] std::size_t population() const { return lambda_; }
  /// The largest standard deviation.
  [[nodiscard]] double width() const { return sigma_ * scales_.maxCoeff(); }
  [[nodiscard]] bool sound() const {
    return std::isfinite(sigma_) && scales_.allFinite() && scales_.minCoeff() > 0.0 &&
           scales_.maxCoeff() < 1e7 * scales_.minCoeff();
  }

 private:
  void factorise() {
    covariance_ = 0.5 * (covariance_ + covariance_.transpose().eval());
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver{covariance_};
    axes_ = solver.eigenvectors();
    scales_ = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  }

  VectorXd mean_;
  double sigma_;
  std::size_t lambda_;
  VectorXd weights_;
  double mu_eff_ = 0.0;
  double c_c_ = 0.0;
  double c_s_ = 0.0;
  double c_1_ = 0.0;
  double c_mu_ = 0.0;
  double d_s_ = 0.0;
  double chi_n_ = 0.0;
  VectorXd path_c_;
  VectorXd path_s_;
  MatrixXd covariance_;
  MatrixXd axes_;
  VectorXd scales_;
  std::uint64_t generation_ = 0;
  std::uint64_t interval_ = 1;
};

constexpr double kWidthMin = 1e-9;  ///< of the box
constexpr std::size_t kPopulationMax = 512;

class Run {
 public:
  Run(const Box& box, SearchCounter& counter, Random& random)
      : box_{box}, counter_{counter}, random_{random} {}

  /// Until converged (true), or the budget is spent.
  bool converge(Distribution& distribution, double tolerance) {
    std::vector<VectorXd> points(distribution.population());
    std::vector<double> values(points.size());
    std::vector<std::size_t> order(points.size());
    std::vector<const VectorXd*> ranked(points.size());
    while (!counter_.spent() && counter_.go_on()) {
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (counter_.spent()) return false;
        points[i] = distribution.draw(random_);
        values[i] = evaluate(points[i]);
      }
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::stable_sort(order.begin(), order.end(),
                       [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
      for (std::size_t i = 0; i < order.size(); ++i) ranked[i] = &points[order[i]];
      distribution.update(ranked);
      const double spread = values[order.back()] - values[order.front()];
      if (spread < tolerance || distribution.width() < kWidthMin || !distribution.sound()) {
        return true;
      }
    }
    return false;
  }

 private:
  double evaluate(const VectorXd& unit) {
    at_.resize(box_.dimension());
    double outside = 0.0;
    for (std::size_t j = 0; j < at_.size(); ++j) {
      const double u = unit[static_cast<Eigen::Index>(j)];
      const double within = std::clamp(u, 0.0, 1.0);
      outside += (u - within) * (u - within);
      at_[j] = box_.low[j] + within * (box_.high[j] - box_.low[j]);
    }
    if (outside == 0.0) return counter_.evaluate(at_, 0.0);
    return counter_.evaluate(at_, outside * (1.0 + std::abs(counter_.result().value)));
  }

  const Box& box_;
  SearchCounter& counter_;
  Random& random_;
  std::vector<double> at_;
};

}  // namespace

SearchResult cma_es(const Objective& objective, const SearchSpace& space, const CmaEsParams& params,
                    const SearchBudget& budget, Random random) {
  SearchCounter counter{objective, budget};
  const Box& box = space.box;
  const std::size_t n = box.dimension();
  std::size_t lambda = params.population > 0
                           ? std::max<std::size_t>(params.population, 4)
                           : 4 + static_cast<std::size_t>(3.0 * std::log(static_cast<double>(n)));
  std::vector<double> start =
      space.seeds.empty() ? uniform_point(box, random) : space.seeds.front();
  box.clamp(start);
  if (!counter.spent()) counter(start);
  Run run{box, counter, random};
  for (bool first = true; !counter.spent() && !counter.cancelled(); first = false) {
    if (!first) {
      if (!params.restarts) break;
      lambda = std::min(2 * lambda, kPopulationMax);
      start = uniform_point(box, random);
    }
    VectorXd mean(static_cast<Eigen::Index>(n));
    for (std::size_t j = 0; j < n; ++j) {
      mean[static_cast<Eigen::Index>(j)] = (start[j] - box.low[j]) / (box.high[j] - box.low[j]);
    }
    Distribution distribution{mean, params.sigma, lambda};
    if (!run.converge(distribution, params.tolerance)) break;
  }
  return counter.result();
}

}  // namespace skein::routes
