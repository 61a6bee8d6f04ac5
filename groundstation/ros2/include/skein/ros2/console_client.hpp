// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "skein/base/result.hpp"

namespace skein::ros2 {

struct ConsoleAddress {
  std::string host = "127.0.0.1";  ///< IPv4
  std::uint16_t port = 7460;
};

/// "http://127.0.0.1:7460", with or without the port and a slash at the end.
[[nodiscard]] Result<ConsoleAddress> parse_console_address(const std::string& url);

/// Logs in at a console and hears its socket; does so again kRetry after that has failed or ended.
/// On one thread, which runs it.
class ConsoleClient {
 public:
  static constexpr std::chrono::seconds kRetry{2};

  struct Config {
    ConsoleAddress address;
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
