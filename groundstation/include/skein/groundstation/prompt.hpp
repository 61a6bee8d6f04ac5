// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/mission/formation_ground.hpp"
#include "skein/mission/messages.hpp"

/// What the operator can type.
namespace skein::groundstation {

enum class View { help, status, sites, pending, places, coalitions, hazards, audit };
/// The operator's decision on the deliveries at a site.
struct Decision {
  SiteId site;
  bool grant = false;
};
/// A command to a vehicle, or to all (kGroundStation).
struct Order {
  VehicleId vehicle;
  mission::CommandKind kind = mission::CommandKind::hold;
};
/// A circle to keep out of, told to all. Mission frame.
struct NewHazard {
  Vec2 centre_m{0.0, 0.0};
  double radius_m = 0.0;
};
/// To the formation. A free shape has its name or file, and no points yet.
struct Formation {
  mission::FormationOrder order;
  std::string shape;         ///< of a free shape
  bool preview = false;      ///< only show what it would do
  bool has_centre = false;   ///< otherwise where the formation is
  bool has_spacing = false;  ///< otherwise the rally's
  bool has_heading = false;  ///< otherwise the rally's
};
/// Of a script: the formation stays so long before the next order.
struct Wait {
  Duration duration{};
};
/// Everything is recorded into that folder from now on, in place of where it was before.
struct Record {
  std::string folder;  ///< empty: nothing is recorded any more
};
struct Quit {};
/// monostate: an empty line.
using Input =
    std::variant<std::monostate, View, Decision, Order, NewHazard, Formation, Wait, Record, Quit>;

/// Fails with what is wrong and what would be right.
[[nodiscard]] Result<Input> parse_input(std::string_view line);

/// Whether the line is an order to the formation, its preview, or a question about its places.
[[nodiscard]] bool is_of_formation(std::string_view line);

/// The answer to "help".
[[nodiscard]] std::string help_text();

}  // namespace skein::groundstation
