// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/console/picture.hpp"
#include "skein/mission/fleet.hpp"
#include "skein/mission/messages.hpp"

namespace skein::console {

/// An order that was given, and who has shown since that he obeys.
struct GivenOrder {
  std::string kind;        ///< a command's name, "authorise", "refuse", "take back"
  std::set<VehicleId> to;  ///< empty: all, or a decision
  SiteId site;             ///< of a decision
  Instant given{};
  std::map<VehicleId, Duration> answered;  ///< by its own event or telemetry, so long after it
  std::set<VehicleId> waiting;             ///< nothing of them shows it yet

  // How it is known.
  std::optional<mission::CommandKind> command;
  std::optional<mission::Authorisation> decision;
  bool asked = false;  ///< `waiting` is filled
};
/// "hold all", "return home 3, 7", "authorise site 4"
[[nodiscard]] std::string line_of(const GivenOrder& order);

/// How long it takes from an operator's word until what the vehicle itself says shows that it
/// obeys. Pure and copyable.
class OrderAnswers {
 public:
  static constexpr std::size_t kOrdersMax = 32;
  /// So much later something is wrong.
  static constexpr Duration kPatience = std::chrono::seconds{10};

  /// Orders that the ground station says, and vehicles' telemetry.
  void on_message(const mission::Message& message, VehicleId sender, Instant now);
  void on_event(const mission::MissionEvent& event, Instant now);
  /// Who is asked by new orders, and which are of no more use.
  void on_timeout(const Picture& picture, const mission::Fleet& fleet, Instant now);

  /// Oldest first.
  [[nodiscard]] const std::deque<GivenOrder>& orders() const { return orders_; }

 private:
  void take(const mission::Command& command, Instant now);
  void take(const mission::Authorisation& decision, Instant now);
  void take(const mission::Telemetry& telemetry, Instant now);
  [[nodiscard]] bool add_to_last(const mission::Command& command, Instant now);
  void add(GivenOrder order);

  std::deque<GivenOrder> orders_;
  std::uint64_t newest_command_ = 0;
  std::set<std::pair<coalition::Round, bool>> decided_;  ///< that were said
};

}  // namespace skein::console
