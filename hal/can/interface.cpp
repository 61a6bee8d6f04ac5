// SPDX-License-Identifier: Apache-2.0
#include "skein/can/interface.hpp"

#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <span>

#include "mcast_bus.hpp"
#include "socket.hpp"

namespace skein::can {
namespace {

/// The attributes of a message or of one that holds others; calls `sink(type, payload)` for each.
template <class Sink>
void attributes(std::span<const std::uint8_t> bytes, const Sink& sink) {
  while (bytes.size() >= sizeof(rtattr)) {
    rtattr header{};
    std::memcpy(&header, bytes.data(), sizeof header);
    if (header.rta_len < sizeof header || header.rta_len > bytes.size()) return;
    sink(header.rta_type & NLA_TYPE_MASK,
         bytes.subspan(RTA_LENGTH(0), header.rta_len - RTA_LENGTH(0)));
    bytes = bytes.subspan(std::min<std::size_t>(RTA_ALIGN(header.rta_len), bytes.size()));
  }
}

template <class Value>
std::optional<Value> value_of(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < sizeof(Value)) return std::nullopt;
  Value value{};
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

State state_of(std::uint32_t state) {
  if (state == CAN_STATE_BUS_OFF) return State::bus_off;
  if (state == CAN_STATE_STOPPED || state == CAN_STATE_SLEEPING) return State::gone;
  return state == CAN_STATE_ERROR_PASSIVE ? State::error_passive : State::error_active;
}

void on_can_attribute(InterfaceFacts& facts, int type, std::span<const std::uint8_t> payload) {
  if (type == IFLA_CAN_BITTIMING) {
    const auto timing = value_of<can_bittiming>(payload);
    if (timing && timing->bitrate > 0) facts.bitrate = timing->bitrate;
  } else if (type == IFLA_CAN_STATE) {
    if (const auto state = value_of<std::uint32_t>(payload)) facts.state = state_of(*state);
  }
}

void on_attribute(InterfaceFacts& facts, int type, std::span<const std::uint8_t> payload) {
  if (type == IFLA_STATS64) {
    if (const auto counts = value_of<rtnl_link_stats64>(payload)) {
      facts.receive_errors = counts->rx_errors;
      facts.transmit_errors = counts->tx_errors;
    }
  } else if (type == IFLA_LINKINFO) {
    attributes(payload, [&facts](int kind, std::span<const std::uint8_t> info) {
      if (kind != IFLA_INFO_DATA) return;
      attributes(info, [&facts](int data, std::span<const std::uint8_t> value) {
        on_can_attribute(facts, data, value);
      });
    });
  }
}

void ask_kernel(InterfaceFacts& facts) {
  struct {
    nlmsghdr header;
    ifinfomsg link;
  } request{};
  request.header.nlmsg_len = NLMSG_LENGTH(sizeof(ifinfomsg));
  request.header.nlmsg_type = RTM_GETLINK;
  request.header.nlmsg_flags = NLM_F_REQUEST;
  request.link.ifi_family = AF_UNSPEC;
  request.link.ifi_index = static_cast<int>(::if_nametoindex(facts.name.c_str()));
  const Descriptor socket{::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE)};
  if (!socket || ::send(socket.get(), &request, request.header.nlmsg_len, 0) < 0) return;
  alignas(nlmsghdr) std::array<std::uint8_t, 16384> answer{};
  const ssize_t size = ::recv(socket.get(), answer.data(), answer.size(), 0);
  nlmsghdr header{};
  if (size < static_cast<ssize_t>(NLMSG_LENGTH(sizeof(ifinfomsg)))) return;
  std::memcpy(&header, answer.data(), sizeof header);
  if (header.nlmsg_type != RTM_NEWLINK || header.nlmsg_len > static_cast<std::size_t>(size)) return;
  attributes(std::span<const std::uint8_t>{answer}
                 .first(header.nlmsg_len)
                 .subspan(NLMSG_SPACE(sizeof(ifinfomsg))),
             [&facts](int type, std::span<const std::uint8_t> payload) {
               on_attribute(facts, type, payload);
             });
}

}  // namespace

InterfaceFacts interface_of(const std::string& bus) {
  InterfaceFacts facts;
  facts.over_udp = bus.starts_with(kMcast);
  facts.name = facts.over_udp ? interface_in(bus) : bus;
  const auto flags = interface_flags(facts.name);
  facts.is_there = flags.has_value();
  facts.is_up = flags && (*flags & IFF_UP) != 0;
  if (facts.is_there && !facts.over_udp) ask_kernel(facts);
  return facts;
}

}  // namespace skein::can
