// SPDX-License-Identifier: Apache-2.0
#include "skein/ardupilot/can_link.hpp"

#include <algorithm>
#include <initializer_list>
#include <span>
#include <string_view>
#include <utility>

#include "can_link_parts.hpp"

namespace skein::ardupilot {
namespace {

constexpr std::string_view kUniqueIdStem = "skein.vehicle";
/// NodeStatus messages that cross may seem to go back by one.
constexpr std::uint32_t kUptimeSlack_s = 1;

/// That a state has been left in which commands went out that must not arrive late.
bool breaks_off(Companion::State before, Companion::State now) {
  using State = Companion::State;
  const auto is_own = [](State state) {
    return state == State::arming || state == State::climbing || state == State::taking_over ||
           state == State::flying;
  };
  return is_own(before) && !is_own(now);
}

}  // namespace

dronecan::NodeParams node_params(const CanLinkParams& params) {
  dronecan::NodeParams node;
  node.node_id = params.companion_node_id;
  auto& id = node.hardware_version.unique_id;
  for (std::size_t i = 0; i < kUniqueIdStem.size(); ++i) {
    id.at(i) = static_cast<std::uint8_t>(kUniqueIdStem[i]);
  }
  const std::uint16_t vehicle = params.companion.vehicle.id.value;
  id.at(kUniqueIdStem.size()) = static_cast<std::uint8_t>(vehicle >> 8U);
  id.at(kUniqueIdStem.size() + 1) = static_cast<std::uint8_t>(vehicle);
  id.at(kUniqueIdStem.size() + 2) = params.companion_node_id;
  return node;
}

dronecan::TunnelParams tunnel_params(const CanLinkParams& params) {
  dronecan::TunnelParams tunnel;
  tunnel.remote_node = params.node_id;
  tunnel.serial_id = params.serial_id;
  return tunnel;
}

LinkIds link_ids(const CanLinkParams& params, const std::string& bus) {
  return {.bus = bus,
          .node_id = params.node_id,
          .companion_node_id = params.companion_node_id,
          .serial_id = params.serial_id,
          .system_id = params.companion.system_id};
}

CanLink::CanLink(std::unique_ptr<can::Bus> bus, const CanLinkParams& params,
                 const MissionOrigin& origin, Instant now)
    : params_{params},
      bus_{std::move(bus)},
      node_{node_params(params), now},
      port_{tunnel_params(params), now},
      companion_{params.companion, origin, now},
      watch_{std::make_unique<LinkWatch>(link_ids(params, bus_->name()), now)} {}

CanLink::~CanLink() = default;

void CanLink::step(Instant now) {
  const Companion::State before = companion_.state();
  receive(now);
  std::array<std::uint8_t, 512> bytes{};
  while (const std::size_t size = port_.read(bytes)) {
    companion_.on_bytes(std::span{bytes}.first(size), now);
  }
  watch(now);
  companion_.step(now);
  if (breaks_off(before, companion_.state())) bus_->discard();
  transmit(now);
}

void CanLink::receive(Instant now) {
  while (const auto frame = bus_->receive()) {
    watch_->on_frame(*frame, now);
    const auto header = dronecan::header_of(*frame);
    if (header && header->source == params_.companion_node_id) {
      companion_.on_duplicate(params_.companion_node_id, now);
    }
    if (header && header->source == params_.node_id) companion_.on_frame_heard(now);
    if (const auto* transfer = node_.on_frame(*frame, 0, now)) on_transfer(*transfer, now);
  }
  while (const auto event = node_.poll_event()) {
    if (event->kind == dronecan::NodeEventKind::duplicate && event->node_id == params_.node_id) {
      companion_.on_duplicate(params_.node_id, now);
    }
  }
}

void CanLink::watch(Instant now) {
  if (const auto own = companion_.heartbeat()) watch_->on_heartbeat(own->system, own->at);
  if (const auto other = companion_.other_heartbeat()) {
    watch_->on_heartbeat(other->system, other->at);
  }
  companion_.on_link_trouble(watch_->trouble(now));
}

void CanLink::on_transfer(const dronecan::Transfer& transfer, Instant now) {
  watch_->on_transfer(transfer, now);
  port_.on_transfer(transfer, params_.companion_node_id, now);
  if (transfer.header.source != params_.node_id || !dronecan::is<dronecan::NodeStatus>(transfer)) {
    return;
  }
  const auto status = dronecan::decode<dronecan::NodeStatus>(transfer);
  if (!status) return;
  if (uptime_s_ && status->uptime_sec + kUptimeSlack_s < *uptime_s_) {
    watch_->on_reboot(now);
    companion_.on_reboot(now);
  }
  uptime_s_ = status->uptime_sec;
}

void CanLink::transmit(Instant now) {
  while (const auto packet = companion_.poll_packet()) {
    if (!port_.write(*packet)) ++transfers_dropped_;
  }
  if (companion_.may_send()) {
    port_.step(node_, now);
    node_.step(now);
  }
  for (auto frames = node_.front(); !frames.empty(); frames = node_.front()) {
    if (companion_.may_send() && !bus_->send(frames)) ++transfers_dropped_;
    node_.pop();
  }
  bus_->flush();
}

std::optional<AutopilotFacts> CanLink::facts(Instant now) const {
  auto facts = companion_.facts(now);
  if (!facts) return std::nullopt;
  const auto troubled = [&](std::initializer_list<AutopilotNews> any) {
    return facts->trouble && std::ranges::find(any, facts->trouble->news) != any.end();
  };
  using enum AutopilotNews;
  facts->own_id_taken =
      troubled({duplicate_node}) && facts->trouble->number == params_.companion_node_id;
  facts->frames = troubled({no_bus_traffic}) ? 0 : bus_->statistics().received;
  facts->node_heard = !troubled({no_bus_traffic, node_missing, duplicate_node});
  facts->serial_heard = facts->node_heard && !troubled({no_serial_port, serial_port_elsewhere});
  return facts;
}

}  // namespace skein::ardupilot
