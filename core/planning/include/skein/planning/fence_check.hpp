// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "skein/domain/fence.hpp"
#include "skein/domain/path.hpp"

namespace skein::planning {

/// Where a path leaves the fence, for a message; none where it does not, or there is no fence. Who
/// begins outside may come in.
[[nodiscard]] std::optional<Vec2> first_outside(const Fence& fence, const Path& path);
/// The same of a straight line.
[[nodiscard]] std::optional<Vec2> first_outside(const Fence& fence, const Vec2& from,
                                                const Vec2& to);
/// The same of a flight and a lap of the orbit at its end.
[[nodiscard]] std::optional<Vec2> first_outside(const Fence& fence, const TimedPath& timed);

/// Does the place lie on a circle of that radius that is within the fence? Then a vehicle that
/// turns on it can come from anywhere in a fence whose corners all point outwards, and go on.
[[nodiscard]] bool orbit_leads_over(const Fence& fence, const Vec2& place, double radius_m);
/// Can a vehicle that turns on that radius fly over the place without leaving the fence? Not in a
/// corner that none of its circles reaches into, nor a straight line of two radii across it. No
/// vehicle can that is told that it cannot; in sharp corners one may not that is told that it can.
[[nodiscard]] bool can_be_flown_over(const Fence& fence, const Vec2& place, double radius_m);

/// Such as "[120, -40]": east and north, in metres.
[[nodiscard]] std::string place_text(const Vec2& place);

}  // namespace skein::planning
