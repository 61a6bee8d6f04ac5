// SPDX-License-Identifier: Apache-2.0
#include "mcast_bus.hpp"

#include <arpa/inet.h>
#include <net/if.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

#include "queued_bus.hpp"
#include "skein/can/mcast_datagram.hpp"
#include "socket.hpp"

namespace skein::can {
namespace {

sockaddr_in group_address(std::uint8_t index) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(kMcastPort);
  address.sin_addr.s_addr = htonl(kMcastGroup | index);
  return address;
}

class McastBus final : public QueuedBus {
 public:
  McastBus(const std::string& name, std::uint8_t index, std::string interface,
           std::size_t queue_frames)
      : QueuedBus{name, queue_frames}, interface_{std::move(interface)}, index_{index} {}

  Result<void> open(int receive_buffer_bytes);

  [[nodiscard]] int descriptor() const override { return in_.get(); }
  [[nodiscard]] Result<void> set_filters(std::span<const Filter> filters) override {
    filters_.assign(filters.begin(), filters.end());
    return {};
  }
  [[nodiscard]] bool fd() const override { return true; }

 protected:
  Written write(const Frame& frame) override;
  std::optional<Frame> read() override;
  bool reattach() override;

 private:
  bool join();
  [[nodiscard]] bool is_own(const sockaddr_storage& source) const;
  [[nodiscard]] bool passes(const Frame& frame) const;

  std::string interface_;
  std::uint8_t index_;
  // Two sockets, because the one that sends needs an address that no other program has, by which
  // its own frames are known when the kernel loops them back; and all that receive share one.
  Descriptor out_;
  Descriptor in_;
  sockaddr_in own_{};
  std::vector<Filter> filters_;
};

bool McastBus::join() {
  ip_mreqn membership{};
  membership.imr_multiaddr = group_address(index_).sin_addr;
  membership.imr_ifindex = static_cast<int>(::if_nametoindex(interface_.c_str()));
  if (membership.imr_ifindex == 0) return false;
  const bool joined = set_option(in_, IPPROTO_IP, IP_ADD_MEMBERSHIP, membership) ||
                      errno == EADDRINUSE;  // still in it
  return joined && set_option(out_, IPPROTO_IP, IP_MULTICAST_IF, membership);
}

Result<void> McastBus::open(int receive_buffer_bytes) {
  in_ = Descriptor{::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)};
  out_ = Descriptor{::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)};
  if (!in_ || !out_) return system_error(name() + ": no socket");

  const auto flags = interface_flags(interface_);
  if (!flags) return Error{name() + ": there is no interface '" + interface_ + "'; see 'ip link'"};
  if ((*flags & IFF_UP) == 0) {
    return Error{name() + ": " + interface_ + " is down; 'ip link set " + interface_ + " up'"};
  }
  constexpr int kOn = 1;
  constexpr int kOff = 0;
  const sockaddr_in group = group_address(index_);
  const auto* address = reinterpret_cast<const sockaddr*>(&group);
  if (!set_option(in_, SOL_SOCKET, SO_REUSEADDR, kOn) ||
      !set_option(in_, IPPROTO_IP, IP_MULTICAST_ALL, kOff) ||
      !ask_for_times_and_losses(in_, receive_buffer_bytes) ||
      ::bind(in_.get(), address, sizeof(group)) != 0) {
    return system_error(name() + ": cannot listen on UDP port " + std::to_string(kMcastPort));
  }
  if (!join() || !set_option(out_, IPPROTO_IP, IP_MULTICAST_LOOP, kOn) ||
      ::connect(out_.get(), address, sizeof(group)) != 0) {
    return system_error(name() + ": no multicast on " + interface_);
  }
  socklen_t size = sizeof(own_);
  if (::getsockname(out_.get(), reinterpret_cast<sockaddr*>(&own_), &size) != 0) {
    return system_error(name() + ": no address");
  }
  return {};
}

QueuedBus::Written McastBus::write(const Frame& frame) {
  const McastDatagram datagram = to_mcast(frame);
  if (::send(out_.get(), datagram.begin(), datagram.size(), 0) >= 0) return Written::done;
  switch (errno) {
    case EAGAIN:
    case ENOBUFS:
    case EINTR:
      return Written::no_room;
    case ECONNREFUSED:
      return Written::done;  // an ICMP answer to an earlier one: somebody's bus, not this one's
    default:
      return Written::gone;
  }
}

bool McastBus::is_own(const sockaddr_storage& source) const {
  sockaddr_in from{};
  std::memcpy(&from, &source, sizeof(from));
  return from.sin_port == own_.sin_port && from.sin_addr.s_addr == own_.sin_addr.s_addr;
}

bool McastBus::passes(const Frame& frame) const {
  if (filters_.empty() || frame.error) return true;
  return std::any_of(filters_.begin(), filters_.end(), [&](const Filter& filter) {
    return filter.extended == frame.extended && ((frame.id ^ filter.id) & filter.mask) == 0;
  });
}

std::optional<Frame> McastBus::read() {
  std::array<std::uint8_t, kMcastHeader + kFdDataMax + 1> buffer{};
  for (;;) {
    const auto datagram = receive_datagram(in_, buffer, count().lost);
    if (!datagram) {
      if (errno == EINTR) continue;
      if (errno == ENETDOWN) enter(State::gone);
      return std::nullopt;
    }
    if (is_own(datagram->source)) continue;
    auto frame = from_mcast(std::span{buffer}.first(datagram->size));
    if (!frame) {
      ++count().malformed;
      continue;
    }
    if (!passes(*frame)) continue;
    frame->timestamp = datagram->timestamp;
    return frame;
  }
}

bool McastBus::reattach() {
  const auto flags = interface_flags(interface_);
  return flags && (*flags & IFF_UP) != 0 && join();
}

}  // namespace

Result<std::unique_ptr<Bus>> open_mcast(const std::string& name, std::uint8_t index,
                                        const std::string& interface, const BusOptions& options) {
  auto bus = std::make_unique<McastBus>(name, index, interface, options.queue_frames);
  if (auto opened = bus->open(options.receive_buffer_bytes); !opened) return opened.error();
  return std::unique_ptr<Bus>{std::move(bus)};
}

}  // namespace skein::can
