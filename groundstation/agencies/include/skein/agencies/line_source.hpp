// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace skein::agencies {

/// Lines of text from another program's TCP port, which is tried again kTcpRetry (outlet.hpp) after
/// a connection failed or ended. Nothing is sent. Never blocks; belongs to one thread.
class LineSource {
 public:
  /// `address`: IPv4. Of lines of more than `line_max` bytes nothing is taken.
  LineSource(const std::string& address, std::uint16_t port, std::size_t line_max);
  LineSource(const LineSource&) = delete;
  LineSource& operator=(const LineSource&) = delete;
  LineSource(LineSource&&) noexcept;
  LineSource& operator=(LineSource&&) noexcept;
  ~LineSource();

  /// Connects and reads what has come, up to a limit: a flood waits in the other program.
  void poll(std::chrono::steady_clock::time_point now);
  /// The next one, without its end.
  [[nodiscard]] std::optional<std::string> next();
  [[nodiscard]] bool connected() const;
  /// Lines that were too long.
  [[nodiscard]] std::uint64_t dropped() const;
  /// What has changed and a person should know, once.
  [[nodiscard]] std::optional<std::string> poll_news();

 private:
  class Connection;
  std::unique_ptr<Connection> connection_;
};

}  // namespace skein::agencies
