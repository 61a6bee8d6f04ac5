// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "skein/base/result.hpp"

namespace skein::groundstation {

/// What the ground station says to a line that somebody gave it.
struct Answer {
  bool done = false;  ///< otherwise refused, and the text says why
  std::string text;
  std::string data = {};  ///< the same for programs: JSON; empty where there is no more to say
  bool in_part = false;   ///< not done for all that it was asked for, but for some
};

/// The name under which a ground station with this network port listens, unless its configuration
/// gives another.
[[nodiscard]] std::string control_socket_name(std::uint16_t port);

/// Takes the lines of the prompt from other programs of the same user, of root and, where it is the
/// packages' service, of its group, `skein`, over a Unix socket: one line a connection, answered by
/// "done" or "refused" in a line, the text, and the end of the stream. The socket has a name and no
/// file (unix(7), abstract), so nothing is left of who is killed. In a thread of its own from
/// construction to destruction. Not more than 16 connections at once, each closed after 30 s.
class ControlSocket {
 public:
  struct Request {
    std::string line;
    std::function<void(const Answer&)> reply;  ///< from any thread, before the socket is destroyed
  };

  /// `on_line` is called from the socket's thread when a request can be taken. Fails where another
  /// program has that name, or it is longer than 107 bytes.
  [[nodiscard]] static Result<std::unique_ptr<ControlSocket>> open(const std::string& name,
                                                                   std::function<void()> on_line);
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

  [[nodiscard]] std::optional<Request> next();

 private:
  class Impl;
  explicit ControlSocket(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Gives a running ground station a line and waits for the answer. Fails with what to do where
/// nobody has that name, the program that has it is of another user, or it does not answer in time.
[[nodiscard]] Result<Answer> ask(const std::string& name, const std::string& line,
                                 std::chrono::milliseconds at_most);

}  // namespace skein::groundstation
