// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "skein/base/result.hpp"

namespace skein::ros2 {

struct Place {
  std::string host;  ///< IPv4
  std::uint16_t port = 0;
};

/// "127.0.0.1:7460"; without a port it has 0.
[[nodiscard]] Result<Place> parse_place(std::string_view text);
/// "http://127.0.0.1:7460", with or without the port and a slash at the end.
[[nodiscard]] Result<Place> parse_console(std::string_view url);

/// Logs in at a console and hears its socket; does so again kRetry after that has failed or ended.
/// On one thread, which runs it.
class ConsoleClient {
 public:
  static constexpr std::chrono::seconds kRetry{2};

  struct Config {
    Place address;
    std::string user;  ///< empty: `password` is an observer's token
    std::string password;
  };
  struct Events {
    /// A text of the server; gives what is to be answered, or nothing where that is empty. Fails
    /// where the connection is not to be used any more.
    std::function<Result<std::string>(const std::string& text)> on_text;
    /// What has changed and a person should know, once.
    std::function<void(const std::string& news)> on_news;
  };

  ConsoleClient(Config config, Events events);
  ~ConsoleClient();
  ConsoleClient(const ConsoleClient&) = delete;
  ConsoleClient& operator=(const ConsoleClient&) = delete;

  /// Goes on for that long.
  void run_for(std::chrono::milliseconds time);

 private:
  class Session;
  std::unique_ptr<Session> session_;
};

}  // namespace skein::ros2
