// SPDX-License-Identifier: Apache-2.0
#include "place_colony.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace skein::formation {
namespace {

constexpr int kFractions = 6;              ///< seven points
constexpr double kLeastDistance_m = 1e-3;  ///< nearer ones count as this
constexpr double kLeastCost = 1e-9;  ///< so that 1 / J stays finite where a leg is of no length

/// Vehicles i, k on their ways to places j, l, flown together: the paths and what they do to each
/// other.
class Legs {
 public:
  Legs(const PlaceColonyParams& params, std::span<const Vec3> vehicles,
       std::span<const Vec3> places)
      : params_{params}, vehicles_{vehicles}, places_{places}, length_(count() * count()) {
    for (std::size_t i = 0; i < count(); ++i) {
      for (std::size_t j = 0; j < count(); ++j) {
        length_[i * count() + j] = (places[j] - vehicles[i]).norm();
      }
    }
  }

  [[nodiscard]] std::size_t count() const { return vehicles_.size(); }
  [[nodiscard]] bool has_threat() const { return params_.threat_weight > 0.0; }

  /// J of the node (i, j) beside the greatest threat of the paths chosen before (eq. 1-2).
  [[nodiscard]] double cost(std::size_t i, std::size_t j, double threat) const {
    const double weight = params_.threat_weight;
    return length_[i * count() + j] * ((1.0 - weight) + weight * threat);
  }

  /// 1 / d^2 at the closest of the fractions.
  [[nodiscard]] double threat(std::size_t i, std::size_t j, std::size_t k, std::size_t l) const {
    const Vec3 start = vehicles_[i] - vehicles_[k];
    const Vec3 change = (places_[j] - places_[l]) - start;
    constexpr double kLeast = kLeastDistance_m * kLeastDistance_m;
    double nearest = start.squaredNorm();
    for (int f = 1; f <= kFractions; ++f) {
      const double fraction = static_cast<double>(f) / kFractions;
      nearest = std::min(nearest, (start + fraction * change).squaredNorm());
    }
    return 1.0 / std::max(kLeast, nearest);
  }

  /// Seen from above, in their inside, at like heights. Paths that touch or lie on one another do
  /// not cross.
  [[nodiscard]] bool cross(std::size_t i, std::size_t j, std::size_t k, std::size_t l) const {
    const Vec3& a = vehicles_[i];
    const Vec3& b = places_[j];
    const Vec3& c = vehicles_[k];
    const Vec3& d = places_[l];
    const auto side = [](const Vec3& from, const Vec3& to, const Vec3& point) {
      return (to.x() - from.x()) * (point.y() - from.y()) -
             (to.y() - from.y()) * (point.x() - from.x());
    };
    const double side_a = side(c, d, a);
    const double side_b = side(c, d, b);
    if (side_a * side_b >= 0.0) return false;
    const double side_c = side(a, b, c);
    const double side_d = side(a, b, d);
    if (side_c * side_d >= 0.0) return false;
    const double along_ab = side_a / (side_a - side_b);
    const double along_cd = side_c / (side_c - side_d);
    const double height_ab = a.z() + along_ab * (b.z() - a.z());
    const double height_cd = c.z() + along_cd * (d.z() - c.z());
    return std::abs(height_ab - height_cd) < params_.crossing_height_m;
  }

 private:
  const PlaceColonyParams& params_;
  std::span<const Vec3> vehicles_;
  std::span<const Vec3> places_;
  std::vector<double> length_;
};

/// An assignment, what each two of its paths do to each other, and its cost.
class Choice {
 public:
  explicit Choice(const Legs& legs)
      : legs_{&legs}, place_of_(legs.count()), threat_(pairs()), cross_(pairs()) {}

  [[nodiscard]] const std::vector<int>& place_of() const { return place_of_; }
  [[nodiscard]] const PlaceColonyCost& cost() const { return cost_; }

  void set(std::span<const int> place_of) {
    place_of_.assign(place_of.begin(), place_of.end());
    for (std::size_t i = 0; i < count(); ++i) look_at(i);
    cost_ = sum();
  }

  /// Exchanges places between two vehicles, and then among three, until none helps.
  void improve() {
    bool better = true;
    while (better) {
      better = false;
      for (std::size_t a = 0; a < count(); ++a) {
        for (std::size_t b = a + 1; b < count(); ++b) {
          if (attempt({a, b})) better = true;
        }
      }
      if (better) continue;
      for (std::size_t a = 0; a < count() && !better; ++a) {
        for (std::size_t b = a + 1; b < count() && !better; ++b) {
          for (std::size_t c = b + 1; c < count() && !better; ++c) {
            better = attempt({a, b, c}) || attempt({a, c, b});
          }
        }
      }
    }
  }

 private:
  [[nodiscard]] std::size_t count() const { return legs_->count(); }
  [[nodiscard]] std::size_t pairs() const { return legs_->count() * legs_->count(); }
  [[nodiscard]] std::size_t place(std::size_t i) const {
    return static_cast<std::size_t>(place_of_[i]);
  }

  void look_at(std::size_t i) {
    for (std::size_t k = 0; k < count(); ++k) {
      if (k == i) continue;
      const std::size_t at = std::max(i, k) * count() + std::min(i, k);
      cross_[at] = legs_->cross(i, place(i), k, place(k)) ? 1 : 0;
      if (legs_->has_threat()) threat_[at] = legs_->threat(i, place(i), k, place(k));
    }
  }

  [[nodiscard]] PlaceColonyCost sum() const {
    PlaceColonyCost result;
    for (std::size_t i = 0; i < count(); ++i) {
      double threat = 0.0;
      for (std::size_t k = 0; k < i; ++k) {
        result.crossings += cross_[i * count() + k];
        threat = std::max(threat, threat_[i * count() + k]);
      }
      result.total += legs_->cost(i, place(i), threat);
    }
    return result;
  }

  void rotate(std::initializer_list<std::size_t> ring) {
    const int first = place_of_[*ring.begin()];
    for (const std::size_t* i = ring.begin(); i + 1 != ring.end(); ++i) {
      place_of_[*i] = place_of_[*(i + 1)];
    }
    place_of_[*(ring.end() - 1)] = first;
  }

  /// Where threats do not count and nothing crosses, only a shorter sum helps: quick to see.
  [[nodiscard]] bool may_help(std::initializer_list<std::size_t> ring) const {
    if (legs_->has_threat() || cost_.crossings > 0) return true;
    double change = 0.0;
    std::size_t next = *ring.begin();
    for (const std::size_t* i = ring.end(); i-- != ring.begin(); next = *i) {
      change += legs_->cost(*i, place(next), 0.0) - legs_->cost(*i, place(*i), 0.0);
    }
    return change < 0.0;
  }

  bool attempt(std::initializer_list<std::size_t> ring) {
    if (!may_help(ring)) return false;
    rotate(ring);
    for (const std::size_t i : ring) look_at(i);
    const PlaceColonyCost now = sum();
    if (now < cost_) {
      cost_ = now;
      return true;
    }
    for (std::size_t turn = 1; turn < ring.size(); ++turn) rotate(ring);
    for (const std::size_t i : ring) look_at(i);
    return false;
  }

  const Legs* legs_;
  std::vector<int> place_of_;
  std::vector<double> threat_;  ///< of i, k < i; 0 without a threat term
  std::vector<char> cross_;     ///< of i, k < i
  PlaceColonyCost cost_;
};

class Colony {
 public:
  Colony(const PlaceColonyParams& params, std::span<const Vec3> vehicles,
         std::span<const Vec3> places, Random random)
      : params_{params},
        legs_{params, vehicles, places},
        random_{random},
        place_of_(legs_.count()),
        attraction_(legs_.count()),
        pheromone_(legs_.count() * legs_.count()) {}

  [[nodiscard]] std::vector<int> run(const planning::PlanningBudget& budget) {
    Choice ant{legs_};
    Choice best_of_iteration{legs_};
    Choice best{legs_};
    std::uint64_t sent = 0;
    for (int iteration = 0; iteration < params_.iterations; ++iteration) {
      int ants = 0;
      for (; ants < params_.ants && (sent == 0 || !budget.is_spent(sent)); ++ants) {
        if (sent++ == 0) start_pheromone(ant);
        walk();
        ant.set(place_of_);
        if (ants == 0 || ant.cost() < best_of_iteration.cost()) best_of_iteration = ant;
      }
      // An iteration that was cut short is not improved, lest a longer one fare worse.
      const bool whole = ants == params_.ants;
      if (whole && params_.exchanges) best_of_iteration.improve();
      const bool better = iteration == 0 || best_of_iteration.cost() < best.cost();
      if (ants > 0 && better) best = best_of_iteration;
      if (!whole) break;
      reward(best_of_iteration);
    }
    return best.place_of();
  }

 private:
  [[nodiscard]] std::size_t count() const { return legs_.count(); }

  /// tau0 is what an iteration leaves on a path n times as long as the greedy ant's.
  void start_pheromone(Choice& ant) {
    std::fill(pheromone_.begin(), pheromone_.end(), 1.0);
    first_pheromone_ = 1.0;
    greedy_ = true;
    walk();
    greedy_ = false;
    ant.set(place_of_);
    first_pheromone_ = 1.0 / (static_cast<double>(count()) * charged(ant.cost()));
    std::fill(pheromone_.begin(), pheromone_.end(), first_pheromone_);
  }

  /// What an assignment counts for in eq. 5: those that cross look worse.
  [[nodiscard]] static double charged(const PlaceColonyCost& cost) {
    return (cost.total + kLeastCost) * (1.0 + cost.crossings);
  }

  /// One ant: vehicle by vehicle, a place that is free and whose path crosses none that was chosen.
  /// Where there is none it takes one that crosses, which the cost shows.
  void walk() {
    std::fill(place_of_.begin(), place_of_.end(), -1);
    free_.assign(count(), 1);
    for (std::size_t i = 0; i < count(); ++i) {
      const std::size_t j = choose(i);
      place_of_[i] = static_cast<int>(j);
      free_[j] = 0;
      double& tau = pheromone_[i * count() + j];
      tau += params_.local_evaporation * (first_pheromone_ - tau);  // eq. 4
    }
  }

  [[nodiscard]] double visibility(std::size_t i, std::size_t j, bool& crosses) const {
    double threat = 0.0;
    crosses = false;
    for (std::size_t k = 0; k < i; ++k) {
      const auto l = static_cast<std::size_t>(place_of_[k]);
      crosses = crosses || legs_.cross(i, j, k, l);
      if (legs_.has_threat()) threat = std::max(threat, legs_.threat(i, j, k, l));
    }
    return 1.0 / (kLeastCost + legs_.cost(i, j, threat));
  }

  /// Eq. 3: the best with probability q0, else in proportion to tau^alpha eta^beta.
  [[nodiscard]] std::size_t choose(std::size_t i) {
    double sum = 0.0;
    double sum_of_crossing = 0.0;
    crossing_.assign(count(), 0);
    for (std::size_t j = 0; j < count(); ++j) {
      attraction_[j] = 0.0;
      if (free_[j] == 0) continue;
      bool crosses = false;
      const double eta = visibility(i, j, crosses);
      const double tau = pheromone_[i * count() + j];
      attraction_[j] =
          (params_.alpha == 1.0 ? tau : std::pow(tau, params_.alpha)) * std::pow(eta, params_.beta);
      crossing_[j] = crosses ? 1 : 0;
      (crosses ? sum_of_crossing : sum) += attraction_[j];
    }
    const bool must_cross = sum <= 0.0;
    const char wanted = must_cross ? 1 : 0;
    const bool take_best = greedy_ || random_.chance(params_.q0);
    double lot = take_best ? 0.0 : random_.uniform() * (must_cross ? sum_of_crossing : sum);
    std::size_t chosen = count();
    for (std::size_t j = 0; j < count(); ++j) {
      if (free_[j] == 0 || crossing_[j] != wanted) continue;
      if (take_best) {
        if (chosen == count() || attraction_[j] > attraction_[chosen]) chosen = j;
        continue;
      }
      chosen = j;
      lot -= attraction_[j];
      if (lot < 0.0) break;
    }
    return chosen;
  }

  void reward(const Choice& best) {
    const double gain = 1.0 / charged(best.cost());
    for (std::size_t i = 0; i < count(); ++i) {
      double& tau = pheromone_[i * count() + static_cast<std::size_t>(best.place_of()[i])];
      tau += params_.evaporation * (gain - tau);  // eq. 5
    }
  }

  const PlaceColonyParams& params_;
  Legs legs_;
  Random random_;
  bool greedy_ = false;
  double first_pheromone_ = 1.0;
  std::vector<int> place_of_;
  std::vector<char> free_;
  std::vector<char> crossing_;
  std::vector<double> attraction_;  ///< by place
  std::vector<double> pheromone_;   ///< by vehicle, then place
};

}  // namespace

PlaceColonyCost colony_cost(const PlaceColonyParams& params, std::span<const int> place_of,
                            std::span<const Vec3> vehicles, std::span<const Vec3> places) {
  const Legs legs{params, vehicles, places};
  Choice choice{legs};
  choice.set(place_of);
  return choice.cost();
}

std::vector<int> colony_places(const PlaceColonyParams& params, std::span<const Vec3> vehicles,
                               std::span<const Vec3> places, Random random,
                               const planning::PlanningBudget& budget) {
  if (vehicles.empty()) return {};
  return Colony{params, vehicles, places, random}.run(budget);
}

}  // namespace skein::formation
