// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/mavlink/enums.hpp"
#include "skein/mavlink/messages.hpp"

namespace skein::ardupilot {

/// How often a command is sent before it counts as unanswered, and how long each answer may take.
struct Patience {
  int attempts = 4;
  Duration each = std::chrono::milliseconds{300};
};

enum class Answer : std::uint8_t { accepted, refused, unanswered };

/// What became of a command.
struct Outcome {
  mavlink::CommandLong command;
  Answer answer = Answer::accepted;
  std::uint8_t result = 0;  ///< mavlink::CommandResult, if answered
};

/// Commands and their answers. COMMAND_ACK names no more than the kind of command, so of each kind
/// one is under way at a time. A lost answer does not mean a lost command: all that is asked here
/// may be sent again without harm.
class CommandDesk {
 public:
  /// Of a kind that only the newest matters of, pass `latest`: it takes the place of one that
  /// waits.
  void ask(const mavlink::CommandLong& command, const Patience& patience, bool latest);
  /// The next one to be sent at `now`, or nothing.
  [[nodiscard]] std::optional<mavlink::CommandLong> next(Instant now);
  [[nodiscard]] std::optional<Outcome> on_ack(const mavlink::CommandAck& ack);
  /// One that has been waited for in vain.
  [[nodiscard]] std::optional<Outcome> give_up(Instant now);

  [[nodiscard]] bool asks(mavlink::Command command) const;
  [[nodiscard]] bool idle() const { return entries_.empty(); }
  void clear() { entries_.clear(); }

 private:
  struct Entry {
    mavlink::CommandLong command;
    Patience patience;
    int sent = 0;
    Instant answer_by;
  };
  std::vector<Entry> entries_;  ///< in the order that they were asked in
};

/// "COMPONENT_ARM_DISARM"; the number of one that is not in use.
[[nodiscard]] std::string name_of_command(std::uint16_t command);
/// "temporarily rejected".
[[nodiscard]] std::string name_of_result(std::uint8_t result);

}  // namespace skein::ardupilot
