// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/avoidance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "skein/base/angles.hpp"
#include "skein/planning/dubins.hpp"

namespace skein::planning {
namespace {

constexpr int kTangentPoints = 16;  ///< tried on each safety circle, in both senses
constexpr int kViaPointsMax = 2;    ///< on one path

bool segment_clear(const Pose2& from, const Segment& segment, const Hazard& hazard) {
  return distance_to_piece(hazard.centre, from, segment.curvature_per_m, segment.length_m) >=
         hazard.radius_m - 1e-6;
}

/// The first hazard on the way, or nullptr.
const Hazard* first_met(const Path& path, std::span<const Hazard> hazards) {
  Pose2 at = path.start;
  for (const auto& segment : path.segments) {
    for (const auto& hazard : hazards) {
      if (!segment_clear(at, segment, hazard)) return &hazard;
    }
    at = advance(at, segment.curvature_per_m, segment.length_m);
  }
  return nullptr;
}

/// The shortest clear word, if any is clear.
std::optional<Path> clear_word(const Pose2& from, const Pose2& to, double radius,
                               std::span<const Hazard> hazards, double shorter_than) {
  std::optional<Path> best;
  for (std::size_t i = 0; i < static_cast<std::size_t>(DubinsWord::count); ++i) {
    const auto word = dubins_word(static_cast<DubinsWord>(i), from, to, radius, radius);
    if (!word || word->length_m() >= shorter_than) continue;
    const Path path = word->to_path();
    if (!is_clear(path, hazards)) continue;
    best = path;
    shorter_than = word->length_m();
  }
  return best;
}

std::optional<Path> clear_path(double kappa, const Pose2& from, const Pose2& to, double radius,
                               std::span<const Hazard> hazards, double shorter_than, int via_left) {
  const auto direct = shortest_dubins(from, to, radius);
  if (direct.length_m() >= shorter_than) return std::nullopt;
  const Hazard* hazard = first_met(direct.to_path(), hazards);
  if (hazard == nullptr) return direct.to_path();
  auto best = clear_word(from, to, radius, hazards, shorter_than);
  if (via_left == 0) return best;
  if (best) shorter_than = best->length_m();
  const double safe = kappa * hazard->radius_m;
  for (int i = 0; i < kTangentPoints; ++i) {
    const double angle = kTwoPi * i / kTangentPoints;
    const Vec2 point = hazard->centre + safe * unit_vector(angle);
    for (const double sense : {1.0, -1.0}) {
      const Pose2 via{point.x(), point.y(), wrap_pi(angle + sense * kPi / 2.0)};
      const auto first = clear_word(from, via, radius, hazards, shorter_than);
      if (!first) continue;
      const auto second = clear_path(kappa, via, to, radius, hazards,
                                     shorter_than - first->length_m(), via_left - 1);
      if (!second) continue;
      Path joined = *first;
      if (!joined.append(*second)) continue;
      shorter_than = joined.length_m();
      best = joined;
    }
  }
  return best;
}

}  // namespace

bool is_clear(const Path& path, std::span<const Hazard> hazards) {
  return first_met(path, hazards) == nullptr;
}

Result<Path> shortest_clear_path(const AvoidanceParams& params, const Pose2& from, const Pose2& to,
                                 double radius_m, std::span<const Hazard> hazards) {
  for (const auto& hazard : hazards) {
    const auto inside = [&](const Pose2& p) {
      return (p.position() - hazard.centre).norm() < hazard.radius_m - 1e-6;
    };
    const std::string name = "hazard " + std::to_string(hazard.id.value);
    if (inside(from)) return Error{"the path would start inside " + name};
    if (inside(to)) return Error{"the path would end inside " + name};
  }
  const auto path = clear_path(params.kappa, from, to, radius_m, hazards, 1e12, kViaPointsMax);
  if (!path)
    return Error{"no way round the hazards was found with a turn radius of " +
                 std::to_string(static_cast<int>(radius_m)) + " m"};
  return *path;
}

}  // namespace skein::planning
