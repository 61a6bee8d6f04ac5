// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "skein/console/alarms.hpp"
#include "skein/groundstation/control_socket.hpp"
#include "skein/groundstation/orders.hpp"
#include "skein/mission/ground_node.hpp"

namespace skein::groundstation {

/// Where the operator draws: areas that are searched, and hazards. Without I/O.
class AreaDesk {
 public:
  /// The node must outlive it.
  AreaDesk(mission::GroundNode& node, std::int64_t epoch_unix_ns)
      : node_{&node}, epoch_unix_ns_{epoch_unix_ns} {}

  // What came of it, for the operator.
  [[nodiscard]] Answer answer(const SearchArea& order, Instant now);
  [[nodiscard]] Answer answer(const NewHazard& order, Instant now);
  [[nodiscard]] Answer answer(const WithdrawHazard& order, Instant now);
  /// What is kept out of: circles, and polygons by their one number.
  [[nodiscard]] std::string hazards_text() const;
  /// The area that is searched, and each vehicle's share.
  [[nodiscard]] std::string text(Instant now) const;
  /// The section `areas` of docs/console-socket.md, as it was within the last kJsonPeriod.
  [[nodiscard]] const std::string& json(Instant now);
  /// For the alarms, as it was then.
  [[nodiscard]] const std::optional<console::EndedSearch>& ended() const { return ended_; }
  static constexpr Duration kJsonPeriod = std::chrono::milliseconds{500};

 private:
  [[nodiscard]] std::string made_json(Instant now) const;
  [[nodiscard]] std::string bars_text(const NewHazard& order, Instant now) const;

  mission::GroundNode* node_;
  std::int64_t epoch_unix_ns_;
  std::optional<console::EndedSearch> ended_;
  std::string json_;
  Instant json_until_ = Instant::min();
};

}  // namespace skein::groundstation
