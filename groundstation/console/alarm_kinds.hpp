// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/console/alarms.hpp"

namespace skein::console {

/// What alarms are found in.
struct Scene {
  const Picture& picture;
  const mission::Fleet& fleet;
  const AlarmNews& news;
  const OrderAnswers& orders;
  const std::optional<EndedSearch>& search;  ///< that nobody has acknowledged
  Instant begun{};                           ///< this ground station, or the recording
  Instant now{};
};

/// A condition that holds now.
struct Found {
  AlarmKey key;
  Instant since{};
  std::string what;
  std::uint32_t edition = 0;             ///< greater: it has become worse, and is told anew
  std::optional<AlarmLevel> level = {};  ///< another than its kind's
  std::optional<Instant> closest = {};   ///< as Alarm::closest
};

struct KindRow {
  AlarmKind kind{};
  std::string_view name;
  AlarmLevel level{};
  /// It must be gone for that long before it is over, so that it does not come and go.
  Duration steady{};
  std::string_view panel;  ///< of the page, where one acts
  /// Orders that may help, to its vehicle or to all; count: none.
  std::array<mission::CommandKind, 2> offers{};
  std::string_view remedy;
  void (*find)(const Scene&, std::vector<Found>&) = nullptr;
};

/// In the order of AlarmKind: the next one is a row, and a name in that enumeration.
[[nodiscard]] const std::array<KindRow, static_cast<std::size_t>(AlarmKind::count)>& alarm_kinds();
[[nodiscard]] const KindRow& row_of(AlarmKind kind);

/// What the picture shows to be over ends here, where no event ends it.
void settle(AlarmNews& news, const Picture& picture, const mission::Fleet& fleet, Instant now);

}  // namespace skein::console
