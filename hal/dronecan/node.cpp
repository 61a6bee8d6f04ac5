// SPDX-License-Identifier: Apache-2.0
#include "skein/dronecan/node.hpp"

#include <algorithm>

#include "skein/base/assert.hpp"

namespace skein::dronecan {
namespace {

constexpr unsigned kQuestionsMax = 5;
/// One node that restarts this often within the time is taken for two that count each for itself.
constexpr unsigned kRestartsOfTwo = 3;
constexpr Duration kRestartsWithin = std::chrono::seconds{10};
constexpr Duration kDuplicateAgain = std::chrono::seconds{1};
constexpr std::uint8_t kTransferIds = 32;
/// NodeStatus of two frames that cross may seem to go back by one.
constexpr std::uint32_t kUptimeSlack_s = 1;

}  // namespace

Node::Node(const NodeParams& params, Instant now)
    : params_{params}, started_{now}, status_at_{now} {
  SKEIN_ASSERT(params.node_id >= 1 && params.node_id <= kNodeIdMax);
  SKEIN_ASSERT(params.name.size() <= decltype(GetNodeInfoResponse::name)::capacity());
  outgoing_.reserve(params.transmit_limit);
  others_.reserve(kNodeIdMax);
  watches_.reserve(kNodeIdMax);
}

const Transfer* Node::on_frame(const can::Frame& frame, std::uint8_t interface, Instant now) {
  const auto header = header_of(frame);
  if (header && header->source == params_.node_id) {
    if (!duplicate_reported_ || now - *duplicate_reported_ >= kDuplicateAgain) {
      report(NodeEventKind::duplicate_own, params_.node_id, now);
      duplicate_reported_ = now;
    }
    return nullptr;
  }
  const bool is_service =
      header && (header->kind == TransferKind::request || header->kind == TransferKind::response);
  if (is_service && header->destination != params_.node_id) return nullptr;
  const Transfer* transfer = reassembler_.on_frame(frame, interface, now);
  if (transfer == nullptr) return nullptr;
  if (is<NodeStatus>(*transfer)) on_status(*transfer, now);
  if (is<GetNodeInfoRequest>(*transfer)) answer_info(transfer->header, now);
  if (is<GetNodeInfoResponse>(*transfer)) on_info(*transfer, now);
  return transfer;
}

void Node::step(Instant now) {
  if (now >= status_at_) {
    (void)publish(status(now), kPriorityLowest);
    // A late step does not make the next one early, nor a long pause a burst.
    status_at_ = std::max(status_at_ + params_.status_period, now);
  }
  for (std::size_t i = 0; i < others_.size(); ++i) {
    RemoteNode& other = others_[i];
    if (other.online && now - other.heard >= params_.offline_after) {
      other.online = false;
      report(NodeEventKind::silent, other.node_id, now);
    }
    const Watch& watch = watches_[i];
    if (other.online && watch.asked && watch.questions < kQuestionsMax &&
        now - *watch.asked >= params_.answer_within) {
      ask(i, now);
    }
  }
}

Instant Node::next_timeout() const {
  Instant next = status_at_;
  for (std::size_t i = 0; i < others_.size(); ++i) {
    if (!others_[i].online) continue;
    next = std::min(next, others_[i].heard + params_.offline_after);
    const Watch& watch = watches_[i];
    if (watch.asked && watch.questions < kQuestionsMax) {
      next = std::min(next, *watch.asked + params_.answer_within);
    }
  }
  return next;
}

std::span<const can::Frame> Node::front() {
  if (outgoing_.empty()) return {};
  // Stays the same until it is popped: its first frames may be on the bus already.
  if (!front_order_) {
    const auto next = std::min_element(
        outgoing_.begin(), outgoing_.end(), [](const Outgoing& a, const Outgoing& b) {
          return std::pair{a.header.priority, a.order} < std::pair{b.header.priority, b.order};
        });
    front_order_ = next->order;
    front_ = to_frames(next->header, next->signature, next->payload, params_.fd);
  }
  return front_;
}

void Node::pop() {
  SKEIN_ASSERT(front_order_.has_value());
  std::erase_if(outgoing_, [this](const Outgoing& o) { return o.order == *front_order_; });
  front_order_.reset();
}

void Node::set_status(Health health, Mode mode, std::uint16_t vendor_specific) {
  health_ = health;
  mode_ = mode;
  vendor_specific_ = vendor_specific;
}

const RemoteNode* Node::find(std::uint8_t node_id) const {
  const auto found =
      std::find_if(others_.begin(), others_.end(),
                   [node_id](const RemoteNode& other) { return other.node_id == node_id; });
  return found == others_.end() ? nullptr : &*found;
}

bool Node::enqueue(Header header, std::uint64_t signature, const Payload& payload) {
  if (outgoing_.size() >= params_.transmit_limit) {
    ++refused_;
    return false;
  }
  header.source = params_.node_id;
  if (header.kind != TransferKind::response) header.transfer_id = take_transfer_id(header);
  outgoing_.push_back({header, signature, payload, next_order_++});
  return true;
}

std::uint8_t Node::take_transfer_id(const Header& header) {
  const std::uint32_t key = std::uint32_t{header.type} << 16U |
                            std::uint32_t{header.destination} << 8U |
                            static_cast<std::uint32_t>(header.kind);
  for (Counter& counter : counters_) {
    if (counter.key != key) continue;
    const std::uint8_t taken = counter.next;
    counter.next = static_cast<std::uint8_t>((taken + 1) % kTransferIds);
    return taken;
  }
  counters_.push_back({key, 1});
  return 0;
}

void Node::report(NodeEventKind kind, std::uint8_t node_id, Instant now) {
  events_.push({kind, node_id, now});
}

NodeStatus Node::status(Instant now) const {
  NodeStatus status;
  status.uptime_sec = static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::seconds>(now - started_).count());
  status.health = health_;
  status.mode = mode_;
  status.vendor_specific_status_code = vendor_specific_;
  return status;
}

std::size_t Node::index_of(std::uint8_t node_id) {
  for (std::size_t i = 0; i < others_.size(); ++i) {
    if (others_[i].node_id == node_id) return i;
  }
  others_.emplace_back().node_id = node_id;
  watches_.emplace_back();
  return others_.size() - 1;
}

void Node::on_status(const Transfer& transfer, Instant now) {
  const auto status = decode<NodeStatus>(transfer);
  if (!status) return;
  const std::size_t i = index_of(transfer.header.source);
  RemoteNode& other = others_[i];
  Watch& watch = watches_[i];
  const bool restarted =
      other.online && status->uptime_sec + kUptimeSlack_s < other.status.uptime_sec;
  const bool appeared = !other.online;
  other.online = true;
  other.status = *status;
  other.heard = now;
  if (appeared) report(NodeEventKind::appeared, other.node_id, now);
  if (restarted) {
    report(NodeEventKind::restarted, other.node_id, now);
    watch.restarts = now - watch.last_restart <= kRestartsWithin ? watch.restarts + 1 : 1;
    watch.last_restart = now;
    if (watch.restarts >= kRestartsOfTwo) report_duplicate(i, now);
  }
  if ((appeared || restarted) && params_.ask_for_info) {
    watch.questions = 0;
    ask(i, now);
  }
}

void Node::ask(std::size_t other, Instant now) {
  Watch& watch = watches_[other];
  watch.asked = now;
  ++watch.questions;
  Header header;
  header.kind = TransferKind::request;
  header.type = GetNodeInfoRequest::kDefinition.id;
  header.destination = others_[other].node_id;
  (void)enqueue(header, GetNodeInfoRequest::kDefinition.signature,
                to_payload(GetNodeInfoRequest{}, params_.fd));
}

void Node::on_info(const Transfer& transfer, Instant now) {
  const auto info = decode<GetNodeInfoResponse>(transfer);
  if (!info) return;
  const std::size_t i = index_of(transfer.header.source);
  RemoteNode& other = others_[i];
  const bool changed =
      other.info && other.info->hardware_version.unique_id != info->hardware_version.unique_id;
  other.info = info;
  watches_[i].asked.reset();
  report(NodeEventKind::informed, other.node_id, now);
  if (changed) report_duplicate(i, now);
}

void Node::report_duplicate(std::size_t other, Instant now) {
  std::optional<Instant>& reported = watches_[other].duplicate_reported;
  if (reported && now - *reported < kDuplicateAgain) return;
  reported = now;
  report(NodeEventKind::duplicate, others_[other].node_id, now);
}

void Node::answer_info(const Header& request, Instant now) {
  GetNodeInfoResponse answer;
  answer.status = status(now);
  answer.software_version = params_.software_version;
  answer.hardware_version = params_.hardware_version;
  for (const char c : params_.name) answer.name.push_back(static_cast<std::uint8_t>(c));
  Header header;
  header.kind = TransferKind::response;
  header.type = request.type;
  header.priority = request.priority;
  header.destination = request.source;
  header.transfer_id = request.transfer_id;
  (void)enqueue(header, GetNodeInfoResponse::kDefinition.signature, to_payload(answer, params_.fd));
}

}  // namespace skein::dronecan
