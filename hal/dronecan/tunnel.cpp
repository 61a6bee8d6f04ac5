// SPDX-License-Identifier: Apache-2.0
#include "skein/dronecan/tunnel.hpp"

#include <algorithm>
#include <array>

#include "skein/base/assert.hpp"

namespace skein::dronecan {
namespace {

constexpr std::size_t kChunkMax = decltype(Targetted::buffer)::capacity();

}  // namespace

std::size_t ByteRing::push(std::span<const std::uint8_t> bytes) {
  const std::size_t count = std::min(bytes.size(), room());
  for (std::size_t i = 0; i < count; ++i) bytes_[(first_ + size_ + i) % bytes_.size()] = bytes[i];
  size_ += count;
  return count;
}

std::size_t ByteRing::pop(std::span<std::uint8_t> out) {
  const std::size_t count = std::min(out.size(), size_);
  for (std::size_t i = 0; i < count; ++i) out[i] = bytes_[(first_ + i) % bytes_.size()];
  first_ = (first_ + count) % bytes_.size();
  size_ -= count;
  return count;
}

TunnelPort::TunnelPort(const TunnelParams& params, Instant now)
    : params_{params},
      outgoing_{params.buffer_bytes},
      incoming_{params.buffer_bytes},
      keepalive_at_{now} {
  SKEIN_ASSERT(params.chunk >= 1 && params.chunk <= kChunkMax);
  SKEIN_ASSERT(params.serial_id >= -16 && params.serial_id <= 15);
  SKEIN_ASSERT(params.buffer_bytes > 0);
}

bool TunnelPort::write(std::span<const std::uint8_t> bytes) {
  if (bytes.size() > outgoing_.room()) return false;
  outgoing_.push(bytes);
  return true;
}

void TunnelPort::on_transfer(const Transfer& transfer, std::uint8_t own_node, Instant now) {
  if (!is<Targetted>(transfer) || transfer.header.source != params_.remote_node) return;
  const auto message = decode<Targetted>(transfer);
  if (!message || message->serial_id != params_.serial_id) return;
  if (params_.check_target && message->target_node != own_node) {
    ++statistics_.misaddressed;
    return;
  }
  heard_ = now;
  ++statistics_.transfers_received;
  statistics_.bytes_received += message->buffer.size();
  statistics_.bytes_overflowed += message->buffer.size() - incoming_.push(message->buffer);
}

void TunnelPort::step(Node& node, Instant now) {
  while (outgoing_.size() > 0 || now >= keepalive_at_) {
    if (node.room() == 0) return;
    std::array<std::uint8_t, kChunkMax> chunk{};
    const std::size_t size = outgoing_.pop(std::span{chunk}.first(params_.chunk));
    Targetted message;
    message.protocol = params_.protocol;
    message.target_node = params_.remote_node;
    message.serial_id = params_.serial_id;
    message.options = params_.options;
    message.baudrate = params_.baudrate;
    for (std::size_t i = 0; i < size; ++i) message.buffer.push_back(chunk[i]);
    const bool queued = node.publish(message, params_.priority);
    SKEIN_ASSERT(queued);
    ++statistics_.transfers_sent;
    statistics_.bytes_sent += size;
    keepalive_at_ = now + params_.keepalive;
  }
}

Instant TunnelPort::next_timeout() const { return keepalive_at_; }

}  // namespace skein::dronecan
