// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "skein/base/result.hpp"

/// The sockets of this module. None of them ever blocks; all belong to one thread.
namespace skein::agencies {

/// One place that others are told at.
class Outlet {
 public:
  Outlet() = default;
  Outlet(const Outlet&) = delete;
  Outlet& operator=(const Outlet&) = delete;
  virtual ~Outlet() = default;

  /// What cannot be sent is lost, and counted.
  virtual void send(std::string_view bytes) = 0;
  /// Goes on with what takes time. What comes in is read and dropped.
  virtual void poll(std::chrono::steady_clock::time_point now) = 0;
  [[nodiscard]] virtual std::uint64_t lost() const = 0;
  /// What has changed and a person should know, once.
  [[nodiscard]] virtual std::optional<std::string> poll_news() = 0;
};

/// Datagrams to an IPv4 address, of a multicast too; that leaves by `interface`, or by the routes
/// where it is empty. Fails where the system has no such address.
[[nodiscard]] Result<std::unique_ptr<Outlet>> open_udp(const std::string& address,
                                                       std::uint16_t port,
                                                       const std::string& interface);
/// A connection, made anew kTcpRetry after it has failed or ended.
[[nodiscard]] std::unique_ptr<Outlet> open_tcp(const std::string& address, std::uint16_t port);
inline constexpr std::chrono::seconds kTcpRetry{3};

/// Where datagrams of others come in.
class Inlet {
 public:
  /// Bound to `address`, or to `group`, which is joined by it. Fails where that cannot be had.
  [[nodiscard]] static Result<Inlet> open(const std::string& address, std::uint16_t port,
                                          const std::string& group);
  Inlet(const Inlet&) = delete;
  Inlet& operator=(const Inlet&) = delete;
  Inlet(Inlet&&) noexcept;
  Inlet& operator=(Inlet&&) noexcept;
  ~Inlet();

  /// The next one, of `size_max` bytes at most; of longer ones that many and one.
  [[nodiscard]] std::optional<std::string> poll(std::size_t size_max);
  /// Where it is bound: the port that the system chose for 0.
  [[nodiscard]] std::uint16_t port() const;

 private:
  struct Socket;
  explicit Inlet(std::unique_ptr<Socket> socket);
  std::unique_ptr<Socket> socket_;
};

}  // namespace skein::agencies
