// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "skein/groundstation/control_socket.hpp"
#include "skein/groundstation/orders.hpp"
#include "skein/mission/ground_node.hpp"

namespace skein::groundstation {

/// Where the operator draws: areas that are searched, and hazards. Without I/O.
class AreaDesk {
 public:
  /// The node must outlive it.
  explicit AreaDesk(mission::GroundNode& node) : node_{&node} {}

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
  static constexpr Duration kJsonPeriod = std::chrono::milliseconds{500};

 private:
  [[nodiscard]] std::string made_json() const;

  mission::GroundNode* node_;
  std::string json_;
  Instant json_until_ = Instant::min();
};

}  // namespace skein::groundstation
