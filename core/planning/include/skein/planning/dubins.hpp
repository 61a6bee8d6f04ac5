// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "skein/base/geometry.hpp"
#include "skein/domain/path.hpp"

namespace skein::planning {

/// The six words of Dubins (1957): arcs left and right, straight lines.
enum class DubinsWord : std::uint8_t { LSL, LSR, RSL, RSR, RLR, LRL, count };
[[nodiscard]] std::string_view to_string(DubinsWord word);

/// A path of one word: lengths in metres of its three pieces, each >= 0. The middle arc of a CCC
/// word has the radius of the first.
struct DubinsPath {
  DubinsWord word = DubinsWord::LSL;
  Pose2 start;
  double start_radius_m = 0.0;
  double end_radius_m = 0.0;  ///< equal to start_radius_m but for unequal radii (Wang 2022, eq. 18)
  std::array<double, 3> lengths_m{};

  [[nodiscard]] double length_m() const { return lengths_m[0] + lengths_m[1] + lengths_m[2]; }
  [[nodiscard]] Path to_path() const;
};

/// The path of that word, or nothing where the word cannot join the poses. Radii > 0.
/// Unequal radii are allowed for the CSC words only; a CCC word needs start = end radius.
[[nodiscard]] std::optional<DubinsPath> dubins_word(DubinsWord word, const Pose2& from,
                                                    const Pose2& to, double start_radius_m,
                                                    double end_radius_m);

/// A CCC word has two paths: the middle arc below a half turn, or above it (`major`). dubins_word
/// gives the shorter. Precondition: the word is RLR or LRL.
[[nodiscard]] std::optional<DubinsPath> dubins_ccc(DubinsWord word, const Pose2& from,
                                                   const Pose2& to, double radius_m, bool major);

/// The shortest path between two poses. Always exists for equal radii. Its end may miss the pose by
/// 1e-9 of the radius: a pose that rounding has put so far off a path costs no full circle.
[[nodiscard]] DubinsPath shortest_dubins(const Pose2& from, const Pose2& to, double radius_m);
[[nodiscard]] double shortest_dubins_length(const Pose2& from, const Pose2& to, double radius_m);

/// The shortest over the CSC words with unequal radii, where one exists (Wang 2022, eq. 18).
[[nodiscard]] std::optional<DubinsPath> shortest_dubins(const Pose2& from, const Pose2& to,
                                                        double start_radius_m, double end_radius_m);

/// The shortest path to a point with free final heading: used for the ETA in a bid (eq. 23).
[[nodiscard]] Path shortest_to_point(const Pose2& from, const Vec2& to, double radius_m);

}  // namespace skein::planning
