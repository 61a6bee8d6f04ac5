// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "skein/groundstation/command_desk.hpp"
#include "skein/groundstation/control_socket.hpp"
#include "skein/groundstation/orders.hpp"
#include "skein/mission/ground_node.hpp"
#include "skein/network/node.hpp"
#include "station_network.hpp"

namespace skein::groundstation {

/// Does what CommandDesk decides: speaks and falls silent on the network, has the node watch or
/// take the command. Of one thread.
class Commanding {
 public:
  using Tell = std::function<void(const mission::MissionEvent&)>;

  Commanding(configuration::CommandConfig config, InstanceId start, StationNetwork& network,
             mission::GroundNode& node, Instant now);

  /// The next message that is to be taken in; none where none waits. `tell`: this one's own log and
  /// page.
  [[nodiscard]] std::optional<network::Received> next(Instant now);
  /// Takes the command where it is to do so by itself, tells others who has it; a line for the
  /// prompt where that has changed.
  [[nodiscard]] std::optional<std::string> on_timeout(const Tell& tell, Instant now);

  /// Why that is not done here now: another has the command, or it is not one of several.
  [[nodiscard]] std::optional<Answer> why_not(const Input& input, Instant now) const;
  [[nodiscard]] Answer answer(const TakeCommand& order, const std::string& by, Instant now);
  [[nodiscard]] Answer answer(const HandOver& order, const std::string& by, Instant now);

  [[nodiscard]] const CommandDesk& desk() const { return desk_; }
  [[nodiscard]] bool is_commanding() const { return desk_.is_commanding(); }

 private:
  [[nodiscard]] Result<void> take(const std::string& by, const std::string& reason, Instant now);

  CommandDesk desk_;
  StationNetwork& network_;
  mission::GroundNode& node_;
  std::optional<InstanceId> noted_;
  std::string trouble_;
  Instant try_again_{};
};

}  // namespace skein::groundstation
