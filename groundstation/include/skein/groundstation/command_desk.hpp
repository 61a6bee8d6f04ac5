// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/configuration/command_config.hpp"
#include "skein/mission/messages.hpp"

namespace skein::groundstation {

/// Who of several ground stations has the command, without I/O: what is heard of the one that has
/// it, when this one is superseded, what it tells the others. One alone has it from the start on,
/// and steps back all the same where another speaks as the ground station with a newer start.
class CommandDesk {
 public:
  /// How long one that may take the command by itself first listens whether another has it.
  static constexpr Duration kListen = std::chrono::seconds{3};
  /// Nobody has it when who had it was not heard for so long.
  static constexpr Duration kNobodyAfter = std::chrono::seconds{10};
  static constexpr Duration kTellAgain = std::chrono::seconds{3};
  /// A vehicle that is heard, and has not heard the one in command for so long, heeds another.
  static constexpr Duration kHeeds = std::chrono::seconds{8};

  enum class State : std::uint8_t { listening, watching, commanding, count };

  /// `start` is that of the ground station that one alone speaks as.
  CommandDesk(configuration::CommandConfig config, InstanceId start, Instant now);

  enum class Heard : std::uint8_t {
    others,      ///< to be taken in
    own,         ///< what this one has said
    word,        ///< who has the command: for this desk alone
    superseded,  ///< to be taken in; this one has the command no more, from now on
  };
  [[nodiscard]] Heard on_message(const mission::Message& message, VehicleId sender,
                                 InstanceId instance, Instant now);

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] bool is_commanding() const { return state_ == State::commanding; }
  [[nodiscard]] bool is_one_of_several() const { return config_.station != 0; }
  /// It has listened, and heard nobody.
  [[nodiscard]] bool takes_by_itself(Instant now) const;
  /// None: nobody was ever heard.
  [[nodiscard]] std::optional<InstanceId> newest() const { return newest_; }
  /// It is known who has the command, or nobody was heard for so long.
  [[nodiscard]] bool nobody_commands(Instant now) const;

  /// Vehicles that are heard and do not heed this one, though it has the command: they have heard a
  /// start that is newer than all that it knows of, or do not hear it at all. Taken again, it
  /// speaks with a start that is newer by far.
  [[nodiscard]] std::vector<VehicleId> unheeding(Instant now) const;

  /// Why it cannot be taken.
  [[nodiscard]] std::optional<std::string> why_not_take(Instant now) const;
  /// Precondition: it can be. `by` is the operator; the start is the one it speaks as from now on.
  /// What it tells all.
  [[nodiscard]] mission::MissionEvent take(InstanceId start, const std::string& by,
                                           const std::string& reason, Instant now);
  /// This one has it, and asks nobody any more to take it.
  [[nodiscard]] mission::MissionEvent keep(const std::string& by, const std::string& reason,
                                           Instant now);
  /// Asks others to take it: what it tells all.
  [[nodiscard]] Result<mission::MissionEvent> hand_over(const std::string& by, Instant now);

  /// Said again now and then, for who has come since: who has the command.
  [[nodiscard]] std::optional<mission::MissionEvent> poll_word(Instant now);
  /// For this one's own log and page: another has the command, once each.
  [[nodiscard]] std::optional<mission::MissionEvent> poll_news(Instant now);

  /// A line for the prompt where that has changed: who has the command, or that nobody has it.
  [[nodiscard]] std::optional<std::string> poll_notice(Instant now);

  /// "ridge-1 (ada) has the command"
  [[nodiscard]] std::string text(Instant now) const;
  /// The section `command` of docs/console-socket.md.
  [[nodiscard]] std::string json(Instant now) const;
  [[nodiscard]] std::string why_no_orders(Instant now) const;

 private:
  [[nodiscard]] std::string own_name() const;
  [[nodiscard]] std::string other() const;
  void on_health(const mission::Health& health, Instant now);

  configuration::CommandConfig config_;
  State state_;
  std::optional<InstanceId> own_;            ///< that it speaks as
  std::optional<InstanceId> newest_;         ///< of others
  std::optional<Instant> heard_at_;          ///< who has it
  Instant since_;                            ///< of the state
  std::string who_;                          ///< has it; empty: not known
  std::string offered_by_;                   ///< who has it asks others to take it; empty: no
  std::optional<Instant> changed_at_;        ///< who has it, and not told yet
  std::map<VehicleId, Instant> unheard_by_;  ///< and since when, of who is heard
  std::string noticed_;                      ///< what poll_notice() told last, without ages
  std::optional<mission::MissionEvent> word_;
  Instant word_again_{};
};

}  // namespace skein::groundstation
