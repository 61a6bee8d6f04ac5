// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "skein/formation/place_assignment.hpp"

namespace skein::formation {
namespace {

/// A square must be this share off before it counts as longer or shorter: less than what the solver
/// takes for equal, so that a leg is never forbidden to it that is allowed here.
constexpr double kRounding = 0.25 * kEqualLegs;
constexpr double kProof = 1e-12;

bool is_assignment(std::span<const int> place_of, std::size_t count) {
  if (place_of.size() != count) return false;
  std::vector<char> used(count, 0);
  for (const int place : place_of) {
    if (place < 0 || static_cast<std::size_t>(place) >= count) return false;
    if (used[static_cast<std::size_t>(place)]++ != 0) return false;
  }
  return true;
}

bool are_distinct(std::vector<int> indices, std::size_t count) {
  std::sort(indices.begin(), indices.end());
  if (std::adjacent_find(indices.begin(), indices.end()) != indices.end()) return false;
  return indices.empty() ||
         (indices.front() >= 0 && static_cast<std::size_t>(indices.back()) < count);
}

double square_of(const Vec3& a, const Vec3& b) {
  const double dx = a.x() - b.x();
  const double dy = a.y() - b.y();
  const double dz = a.z() - b.z();
  return dx * dx + dy * dy + dz * dz;
}

/// The square that the longest leg of any assignment reaches, as the certificate shows.
Result<double> least_longest_of(const PlaceCertificate& certificate, std::span<const Vec3> vehicles,
                                std::span<const Vec3> places) {
  const auto& crowded = certificate.crowded_vehicles;
  const auto& near = certificate.near_places;
  if (!are_distinct(crowded, vehicles.size()) || !are_distinct(near, places.size())) {
    return Error{"the certificate names a vehicle or place twice, or one that there is not"};
  }
  if (near.size() >= crowded.size()) {
    return Error{"the certificate's places are not fewer than its vehicles"};
  }
  std::vector<char> is_near(places.size(), 0);
  for (const int place : near) is_near[static_cast<std::size_t>(place)] = 1;
  double least = std::numeric_limits<double>::infinity();
  for (const int vehicle : crowded) {
    for (std::size_t j = 0; j < places.size(); ++j) {
      if (is_near[j] != 0) continue;
      least = std::min(least, square_of(vehicles[static_cast<std::size_t>(vehicle)], places[j]));
    }
  }
  return least;
}

}  // namespace

Result<void> verify(const PlaceAssignment& assignment, std::span<const Vec3> vehicles,
                    std::span<const Vec3> places) {
  const std::size_t count = vehicles.size();
  const PlaceMethod method = assignment.method;
  if (method >= PlaceMethod::colony) return Error{"the colony proves nothing"};
  if (places.size() != count || !is_assignment(assignment.place_of, count)) {
    return Error{"this does not give each of the vehicles one of the places"};
  }
  const std::vector<double>& price = assignment.certificate.place_price;
  if (price.size() != count) return Error{"the certificate has not one price for each place"};

  double allowed = std::numeric_limits<double>::infinity();
  if (method == PlaceMethod::least_longest && count > 0) {
    const auto least = least_longest_of(assignment.certificate, vehicles, places);
    if (!least) return least.error();
    double longest = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const auto place = static_cast<std::size_t>(assignment.place_of[i]);
      longest = std::max(longest, square_of(vehicles[i], places[place]));
    }
    if (!(longest <= *least * (1.0 + kEqualLegs + kRounding))) {
      return Error{"the longest leg is " + std::to_string(std::sqrt(longest)) +
                   " m and the certificate shows only that it is at least " +
                   std::to_string(std::sqrt(*least)) + " m"};
    }
    allowed = *least * (1.0 + kEqualLegs - kRounding);
  }

  double cost = 0.0;
  double bound = 0.0;
  double scale = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto own = static_cast<std::size_t>(assignment.place_of[i]);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < count; ++j) {
      const double square = square_of(vehicles[i], places[j]);
      if (square > allowed && j != own) continue;
      const double entry = method == PlaceMethod::least_sum ? std::sqrt(square) : square;
      least = std::min(least, entry - price[j]);
      scale = std::max({scale, entry, std::abs(price[j])});
      if (j == own) cost += entry;
    }
    bound += least + price[i];
  }
  const double gap = cost - bound;
  if (gap <= kProof * scale * static_cast<double>(count)) return {};  // false for not a number
  return Error{"the prices leave a gap of " + std::to_string(gap) + " to the sum"};
}

}  // namespace skein::formation
