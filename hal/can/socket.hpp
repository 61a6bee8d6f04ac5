// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "skein/base/result.hpp"
#include "skein/base/time.hpp"

namespace skein::can {

/// Owns a file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_{fd} {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor(Descriptor&& other) noexcept : fd_{std::exchange(other.fd_, -1)} {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  [[nodiscard]] int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }

 private:
  int fd_;
};

/// "what: reason", the reason that of errno.
[[nodiscard]] Error system_error(const std::string& what);

template <class Value>
[[nodiscard]] bool set_option(const Descriptor& socket, int level, int option, const Value& value) {
  return ::setsockopt(socket.get(), level, option, &value, sizeof(value)) == 0;
}

struct Datagram {
  std::size_t size = 0;
  sockaddr_storage source{};
  Duration timestamp{};  ///< by the kernel, since the Unix epoch
  int flags = 0;         ///< of recvmsg
};

/// Reads one, with its time and the kernel's count of those that it dropped before it (kept in
/// `lost`: it counts up). Nothing when there is none; errno says why.
[[nodiscard]] std::optional<Datagram> receive_datagram(const Descriptor& socket,
                                                       std::span<std::uint8_t> buffer,
                                                       std::uint64_t& lost);

/// Asks the kernel for times, drop counts and a receive buffer.
[[nodiscard]] bool ask_for_times_and_losses(const Descriptor& socket, int receive_buffer_bytes);

/// IFF_* of an interface, or nothing if there is none of this name.
[[nodiscard]] std::optional<unsigned> interface_flags(const std::string& interface);

}  // namespace skein::can
