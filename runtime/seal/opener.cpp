// SPDX-License-Identifier: Apache-2.0
#include "skein/seal/opener.hpp"

#include <algorithm>
#include <utility>

#include "cipher.hpp"

namespace skein::seal {

const char* to_text(Opened opened) {
  switch (opened) {
    case Opened::good:
      return "opened";
    case Opened::not_sealed:
      return "not_sealed";
    case Opened::unknown_epoch:
      return "unknown_epoch";
    case Opened::forged:
      return "forged";
    case Opened::replayed:
      return "replayed";
    case Opened::old_start:
      return "old_start";
    case Opened::no_room:
      return "no_room";
    case Opened::count:
      break;
  }
  return "";
}

Opener::Opener() = default;
Opener::~Opener() = default;

void Opener::accept(const EpochKey& key, Instant until) {
  const std::lock_guard lock{mutex_};
  const auto known = epochs_.find(key.epoch);
  if (known != epochs_.end() && known->second.key.secret != key.secret) {
    for (auto& [id, node] : nodes_) {
      for (auto& [random, start] : node.starts) start.ciphers.erase(key.epoch);
    }
  }
  epochs_.insert_or_assign(key.epoch, Epoch{key, until});
}

Opener::Outcome Opener::open(std::span<const std::uint8_t> datagram,
                             std::vector<std::uint8_t>& plain, Instant now) {
  const auto header = read_header(datagram);
  const std::lock_guard lock{mutex_};
  const Opened opened = header ? judge(*header, datagram, plain, now) : Opened::not_sealed;
  if (opened == Opened::good) {
    auto& newest = nodes_.at(header->from.sender).newest_epoch;
    newest = std::max(newest, header->epoch);
  }
  ++counts_.at(static_cast<std::size_t>(opened));
  return {opened, header ? header->from : SenderStart{}};
}

Opened Opener::judge(const Header& header, std::span<const std::uint8_t> datagram,
                     std::vector<std::uint8_t>& plain, Instant now) {
  const auto epoch = epochs_.find(header.epoch);
  if (epoch == epochs_.end() || now > epoch->second.until) return Opened::unknown_epoch;
  const EpochKey& key = epoch->second.key;

  const auto node = nodes_.find(header.from.sender);
  // Under a newer key all is believed anew: who had only the old one may have claimed any start.
  const bool is_newer_key = node != nodes_.end() && header.epoch > node->second.newest_epoch;
  if (node != nodes_.end() && !is_newer_key) {
    if (header.from.number < node->second.number) return Opened::old_start;
    const auto known = node->second.starts.find(header.from.random);
    if (header.from.number == node->second.number && known != node->second.starts.end()) {
      return open_known(known->second, header, key, datagram, plain);
    }
    if (header.epoch < node->second.newest_epoch) return Opened::old_start;
  }
  if (is_newer_key) return open_under_newer_key(node->second, header, key, datagram, plain);
  // Nothing is kept before it is proven.
  Start start;
  if (const Opened opened = open_known(start, header, key, datagram, plain);
      opened != Opened::good) {
    return opened;
  }
  if (node == nodes_.end() && nodes_.size() >= kNodesMax) return Opened::no_room;
  Node& kept = nodes_[header.from.sender];
  if (header.from.number > kept.number) kept.starts.clear();
  if (kept.starts.size() >= kTwinsMax) return Opened::no_room;
  kept.number = header.from.number;
  kept.starts.emplace(header.from.random, std::move(start));
  return Opened::good;
}

Opened Opener::open_under_newer_key(Node& node, const Header& header, const EpochKey& key,
                                    std::span<const std::uint8_t> datagram,
                                    std::vector<std::uint8_t>& plain) {
  const auto known =
      header.from.number == node.number ? node.starts.find(header.from.random) : node.starts.end();
  Start fresh;
  Start& start = known != node.starts.end() ? known->second : fresh;
  const Opened opened = open_known(start, header, key, datagram, plain);
  if (opened != Opened::good) return opened;
  Start kept = std::move(start);
  node.starts.clear();
  node.number = header.from.number;
  node.starts.emplace(header.from.random, std::move(kept));
  return Opened::good;
}

Opened Opener::open_known(Start& start, const Header& header, const EpochKey& key,
                          std::span<const std::uint8_t> datagram,
                          std::vector<std::uint8_t>& plain) {
  if (!start.window.is_new(header.counter)) return Opened::replayed;
  auto& cipher = start.ciphers[header.epoch];
  if (!cipher) cipher = std::make_unique<Cipher>(key, header.from, Cipher::Direction::open);
  plain.resize(datagram.size() - kOverheadBytes);
  if (!cipher->open(header, datagram, plain)) return Opened::forged;
  start.window.note(header.counter);
  return Opened::good;
}

bool Opener::has_opened(const Header& header) const {
  const std::lock_guard lock{mutex_};
  const auto node = nodes_.find(header.from.sender);
  if (node == nodes_.end() || node->second.number != header.from.number) return false;
  const auto start = node->second.starts.find(header.from.random);
  return start != node->second.starts.end() && !start->second.window.is_new(header.counter);
}

std::uint8_t Opener::newest_epoch_of(VehicleId node) const {
  const std::lock_guard lock{mutex_};
  const auto known = nodes_.find(node);
  return known == nodes_.end() ? std::uint8_t{0} : known->second.newest_epoch;
}

std::array<std::uint64_t, static_cast<std::size_t>(Opened::count)> Opener::counts() const {
  const std::lock_guard lock{mutex_};
  return counts_;
}

}  // namespace skein::seal
