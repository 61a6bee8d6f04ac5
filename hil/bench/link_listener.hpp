// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/hil/child_process.hpp"
#include "skein/hil/radio/radio_model.hpp"

namespace skein::hil {

/// A program outside that makes the links what the bench says: a real network in place of the
/// modelled radio. On its input is a line for each link that has changed, all of them at first:
/// "FROM TO up DELAY_MS JITTER_MS LOSS" (delay mean and most either way; loss 0 to 1), or
/// "FROM TO down"; its input ends with the run, and it is to end, too.
class LinkListener {
 public:
  /// `command` is a shell's; what it says goes to `log`.
  [[nodiscard]] static Result<LinkListener> start(const std::string& command,
                                                  const std::filesystem::path& log);
  ~LinkListener();
  LinkListener(LinkListener&& other) noexcept;
  LinkListener& operator=(LinkListener&&) = delete;
  LinkListener(const LinkListener&) = delete;
  LinkListener& operator=(const LinkListener&) = delete;

  void tell(VehicleId from, VehicleId to, const radio::Link& link);
  /// Hands on what was told, without waiting: the rest goes with the next call, of a link that has
  /// changed again meanwhile only what it is by then.
  void hand_on();
  /// How it ended, while it should not have.
  [[nodiscard]] std::optional<std::string> ended() { return program_.ended(); }
  /// Ends its input and waits for its end; false where it had to be killed.
  bool stop();

 private:
  LinkListener(ChildProcess program, int socket) : program_{std::move(program)}, socket_{socket} {}
  void close();

  ChildProcess program_;
  int socket_;
  using Ends = std::pair<VehicleId, VehicleId>;
  std::map<Ends, std::string> told_;
  std::set<Ends> waiting_;  ///< have changed
  std::string handing_;     ///< lines; a part of them was handed on
};

}  // namespace skein::hil
