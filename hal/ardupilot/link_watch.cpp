// SPDX-License-Identifier: Apache-2.0
#include "link_watch.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "skein/dronecan/messages.hpp"

namespace skein::ardupilot {
namespace {

constexpr int kNodesTold = 8;

}  // namespace

LinkWatch::LinkWatch(const LinkIds& ids, Instant now, Duration patience)
    : ids_{ids}, patience_{patience} {
  heard_.fill(now);
}

void LinkWatch::on_frame(const can::Frame& frame, Instant now) {
  if (frame.error) return;  // of our own controller, which nobody answers
  heard_[frames] = now;
  const auto header = dronecan::header_of(frame);
  if (!header || header->source == 0 || header->source >= kNodes) return;
  nodes_.at(header->source) = now;
  if (header->source == ids_.node_id) heard_[node] = now;
}

void LinkWatch::on_transfer(const dronecan::Transfer& transfer, Instant now) {
  if (!dronecan::is<dronecan::Targetted>(transfer)) return;
  const auto message = dronecan::decode<dronecan::Targetted>(transfer);
  if (!message || transfer.header.source >= kNodes) return;
  const bool is_ours =
      message->target_node == ids_.companion_node_id && message->serial_id == ids_.serial_id;
  if (is_ours && transfer.header.source == ids_.node_id) {
    heard_[tunnel] = now;
  } else {
    served_.at(transfer.header.source) = {message->target_node, message->serial_id, now};
  }
}

void LinkWatch::on_reboot(Instant now) { heard_[tunnel] = heard_[heartbeat] = now; }

void LinkWatch::on_heartbeat(std::uint8_t system, Instant now) {
  if (system == ids_.system_id) {
    heard_[heartbeat] = std::max(heard_[heartbeat], now);
  } else {
    other_system_ = system;
    other_system_at_ = now;
  }
}

std::optional<AutopilotNotice> LinkWatch::trouble(Instant now) {
  auto* const lowest =
      std::ranges::find_if(heard_, [&](Instant heard) { return now - heard >= patience_; });
  if (lowest == heard_.end()) return std::nullopt;
  std::fill(lowest + 1, heard_.end(), now);
  switch (static_cast<Layer>(lowest - heard_.begin())) {
    case frames:
      return AutopilotNotice{.news = AutopilotNews::no_bus_traffic, .detail = ids_.bus};
    case node:
      return node_missing(now);
    case tunnel:
      return tunnel_missing(now);
    default:
      return heartbeat_missing(now);
  }
}

AutopilotNotice LinkWatch::node_missing(Instant now) const {
  std::string heard;
  int count = 0;
  for (std::size_t id = 1; id < kNodes; ++id) {
    if (!heard_lately(nodes_.at(id), now) || ++count > kNodesTold) continue;
    heard += fmt::format("{}{}", heard.empty() ? "" : ", ", id);
    const auto& served = served_.at(id);
    if (!served || now - served->at >= patience_) continue;
    heard += fmt::format(" (its serial port is for node {})", served->target);
  }
  if (count > kNodesTold) heard += fmt::format(" and {} more", count - kNodesTold);
  if (heard.empty()) heard = "none, though frames come that are not DroneCAN's";
  return {.news = AutopilotNews::node_missing, .number = ids_.node_id, .detail = std::move(heard)};
}

AutopilotNotice LinkWatch::tunnel_missing(Instant now) const {
  const std::string wanted = fmt::format(
      "CAN_D1_UC_SER_EN 1, CAN_D1_UC_S1_NOD {}, "
      "CAN_D1_UC_S1_IDX {}, CAN_D1_UC_S1_PRO 2",
      ids_.companion_node_id, ids_.serial_id);
  const auto& served = served_.at(ids_.node_id);
  if (!served || now - served->at >= patience_) {
    return {.news = AutopilotNews::no_serial_port, .number = ids_.node_id, .detail = wanted};
  }
  return {.news = AutopilotNews::serial_port_elsewhere,
          .number = served->target,
          .detail = fmt::format("{} (port {}): set {}", served->target, served->serial_id, wanted)};
}

AutopilotNotice LinkWatch::heartbeat_missing(Instant now) const {
  if (heard_lately(other_system_at_, now)) {
    return {.news = AutopilotNews::other_system,
            .number = other_system_,
            .detail = "system " + std::to_string(ids_.system_id)};
  }
  return {.news = AutopilotNews::no_heartbeat, .number = ids_.node_id};
}

}  // namespace skein::ardupilot
