// SPDX-License-Identifier: Apache-2.0
#include "socketcan_bus.hpp"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

#include "queued_bus.hpp"
#include "socket.hpp"

namespace skein::can {
namespace {

class SocketCanBus final : public QueuedBus {
 public:
  SocketCanBus(const std::string& interface, std::size_t queue_frames)
      : QueuedBus{interface, queue_frames} {}

  Result<void> open(int receive_buffer_bytes);

  [[nodiscard]] int descriptor() const override { return socket_.get(); }
  [[nodiscard]] Result<void> set_filters(std::span<const Filter> filters) override;
  [[nodiscard]] bool fd() const override { return fd_; }

 protected:
  Written write(const Frame& frame) override;
  std::optional<Frame> read() override;
  bool reattach() override;

 private:
  [[nodiscard]] bool bind_to_interface();
  [[nodiscard]] bool apply_filters();
  void learn_from(const Frame& error_frame);

  Descriptor socket_;
  bool fd_ = false;
  std::vector<can_filter> filters_{{0, 0}};
};

ifreq request_for(const std::string& interface) {
  ifreq request{};
  std::copy(interface.begin(), interface.end(), std::begin(request.ifr_name));
  return request;
}

bool SocketCanBus::bind_to_interface() {
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(name().c_str()));
  return address.can_ifindex != 0 &&
         ::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
}

Result<void> SocketCanBus::open(int receive_buffer_bytes) {
  socket_ = Descriptor{::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW)};
  if (!socket_) {
    if (errno != EAFNOSUPPORT && errno != EPROTONOSUPPORT) return system_error(name());
    return Error{name() +
                 ": this kernel has no CAN; 'modprobe can_raw' loads it where it is built as a "
                 "module. Without it, 'mcast:0' carries the same frames over UDP"};
  }
  const auto flags = interface_flags(name());
  if (!flags) {
    return Error{name() +
                 ": there is no such interface; see 'ip link', or make a virtual one: 'ip "
                 "link add dev vcan0 type vcan'"};
  }
  ifreq request = request_for(name());
  if (::ioctl(socket_.get(), SIOCGIFHWADDR, &request) != 0 ||
      request.ifr_hwaddr.sa_family != ARPHRD_CAN) {
    return Error{name() + ": this is not a CAN interface; see 'ip -details link'"};
  }
  if ((*flags & IFF_UP) == 0) {
    return Error{name() + " is down; 'ip link set " + name() + " up' (a real bus: 'ip link set " +
                 name() + " up type can bitrate 1000000 restart-ms 100')"};
  }
  request = request_for(name());
  const bool takes_fd =
      ::ioctl(socket_.get(), SIOCGIFMTU, &request) == 0 && request.ifr_mtu == CANFD_MTU;
  constexpr int kOn = 1;
  constexpr can_err_mask_t kAllErrors = CAN_ERR_MASK;
  fd_ = set_option(socket_, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, kOn) && takes_fd;
  if (!set_option(socket_, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, kAllErrors) ||
      !ask_for_times_and_losses(socket_, receive_buffer_bytes) || !bind_to_interface()) {
    return system_error(name());
  }
  return {};
}

Result<void> SocketCanBus::set_filters(std::span<const Filter> filters) {
  filters_.clear();
  for (const Filter& filter : filters) {
    filters_.push_back(
        {filter.id | (filter.extended ? CAN_EFF_FLAG : 0), filter.mask | CAN_EFF_FLAG});
  }
  if (filters_.empty()) filters_.push_back({0, 0});
  if (!apply_filters()) return system_error(name() + ": filters");
  return {};
}

bool SocketCanBus::apply_filters() {
  return ::setsockopt(socket_.get(), SOL_CAN_RAW, CAN_RAW_FILTER, filters_.data(),
                      static_cast<socklen_t>(filters_.size() * sizeof(can_filter))) == 0;
}

QueuedBus::Written SocketCanBus::write(const Frame& frame) {
  canfd_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0) | (frame.rtr ? CAN_RTR_FLAG : 0);
  raw.len = frame.size;
  if (frame.brs) raw.flags = CANFD_BRS;
  std::copy_n(frame.data.begin(), frame.size, std::begin(raw.data));
  const std::size_t size = frame.fd ? CANFD_MTU : CAN_MTU;
  if (::write(socket_.get(), &raw, size) == static_cast<ssize_t>(size)) return Written::done;
  // ENOBUFS: the queue of the interface (txqueuelen) is full, and poll() does not tell.
  if (errno == ENOBUFS || errno == EAGAIN || errno == EINTR) return Written::no_room;
  return Written::gone;
}

std::optional<Frame> SocketCanBus::read() {
  canfd_frame raw{};
  std::array<std::uint8_t, CANFD_MTU> buffer{};
  for (;;) {
    const auto datagram = receive_datagram(socket_, buffer, count().lost);
    if (!datagram) {
      if (errno == EINTR) continue;
      if (errno == ENETDOWN || errno == ENODEV) enter(State::gone);
      return std::nullopt;
    }
    if (datagram->size != CAN_MTU && datagram->size != CANFD_MTU) {
      ++count().malformed;
      continue;
    }
    std::memcpy(&raw, buffer.data(), datagram->size);
    Frame frame;
    frame.fd = datagram->size == CANFD_MTU;
    frame.brs = frame.fd && (raw.flags & CANFD_BRS) != 0;
    frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
    frame.error = (raw.can_id & CAN_ERR_FLAG) != 0;
    frame.rtr = (raw.can_id & CAN_RTR_FLAG) != 0;
    frame.id = raw.can_id & (frame.extended || frame.error ? CAN_EFF_MASK : CAN_SFF_MASK);
    // The length of a frame that asks for data is what it asks for.
    frame.size = frame.rtr ? std::uint8_t{0} : raw.len;
    if (!is_valid(frame)) {
      ++count().malformed;
      continue;
    }
    std::copy_n(std::begin(raw.data), frame.size, frame.data.begin());
    frame.timestamp = datagram->timestamp;
    if (frame.error) {
      learn_from(frame);
    } else if (state() == State::bus_off) {
      enter(State::error_active);  // not every controller tells of its restart
    }
    return frame;
  }
}

void SocketCanBus::learn_from(const Frame& error_frame) {
  if ((error_frame.id & CAN_ERR_BUSOFF) != 0) {
    enter(State::bus_off);
  } else if ((error_frame.id & CAN_ERR_RESTARTED) != 0) {
    enter(State::error_active);
  } else if ((error_frame.id & CAN_ERR_CRTL) != 0) {
    const std::uint8_t controller = error_frame.data[1];
    const bool passive = (controller & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0;
    if (passive && state() != State::bus_off) {
      enter(State::error_passive);
    } else if ((controller & CAN_ERR_CRTL_ACTIVE) != 0) {
      enter(State::error_active);
    }
  }
}

bool SocketCanBus::reattach() {
  const auto flags = interface_flags(name());
  if (!flags || (*flags & IFF_UP) == 0) return false;
  // An adapter that was unplugged comes back as another interface of the same name, and the kernel
  // has forgotten the filters: without any, nothing is received.
  return apply_filters() && bind_to_interface();
}

}  // namespace

Result<std::unique_ptr<Bus>> open_socketcan(const std::string& interface,
                                            const BusOptions& options) {
  auto bus = std::make_unique<SocketCanBus>(interface, options.queue_frames);
  if (auto opened = bus->open(options.receive_buffer_bytes); !opened) return opened.error();
  return std::unique_ptr<Bus>{std::move(bus)};
}

}  // namespace skein::can
