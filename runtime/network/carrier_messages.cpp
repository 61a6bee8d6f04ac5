// SPDX-License-Identifier: Apache-2.0
#include "carrier_messages.hpp"

#include <algorithm>
#include <utility>

#include "skein/base/assert.hpp"

namespace skein::network {
namespace {

class Writer {
 public:
  Writer& number(std::uint64_t value, unsigned bytes) {
    for (; bytes-- > 0; value >>= 8U) out_.push_back(static_cast<std::uint8_t>(value));
    return *this;
  }
  Writer& rest(std::span<const std::uint8_t> bytes) {
    out_.insert(out_.end(), bytes.begin(), bytes.end());
    return *this;
  }
  Writer& blob(std::span<const std::uint8_t> bytes) { return number(bytes.size(), 2).rest(bytes); }
  Writer& text(const std::string& text) {
    number(text.size(), 2);
    out_.insert(out_.end(), text.begin(), text.end());
    return *this;
  }
  Writer& endpoint(const Endpoint& endpoint) {
    return text(endpoint.address).number(endpoint.port, 2);
  }
  Writer& key(const seal::EpochKey& key) { return number(key.epoch, 1).rest(key.secret); }
  [[nodiscard]] std::vector<std::uint8_t> take() {
    SKEIN_ASSERT(out_.size() <= kCarrierMessageBytesMax);
    return std::move(out_);
  }

 private:
  std::vector<std::uint8_t> out_;
};

/// Reads no further than there is; after the first field that is not there all is zero and empty.
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : left_{bytes} {}

  std::uint64_t number(unsigned bytes) {
    std::uint64_t value = 0;
    const auto digits = take(bytes);
    for (std::size_t i = 0; i < digits.size(); ++i) value |= std::uint64_t{digits[i]} << (8U * i);
    return value;
  }
  template <class T>
  T number() {
    return static_cast<T>(number(sizeof(T)));
  }
  std::span<const std::uint8_t> rest(std::size_t max) {
    require(left_.size() <= max);
    return take(left_.size());
  }
  std::span<const std::uint8_t> blob(std::size_t max) {
    const std::size_t size = number(2);
    require(size <= max);
    return take(size);
  }
  std::string text() {
    const auto bytes = blob(kCarrierTextMax);
    return {bytes.begin(), bytes.end()};
  }
  /// How many follow, of so many bytes each or more.
  std::size_t count(std::size_t each) {
    const std::size_t count = number(2);
    require(count <= kCarrierPeersMax && count * each <= left_.size());
    return whole_ ? count : 0;
  }
  Endpoint endpoint() {
    Endpoint endpoint;
    endpoint.address = text();
    endpoint.port = number<std::uint16_t>();
    return endpoint;
  }
  seal::EpochKey key() {
    seal::EpochKey key{.epoch = number<std::uint8_t>()};
    std::ranges::copy(take(key.secret.size()), key.secret.begin());
    return key;
  }
  codec::Role role() {
    const auto value = number<std::uint8_t>();
    if (value == static_cast<std::uint8_t>(codec::Role::ground)) return codec::Role::ground;
    require(value == static_cast<std::uint8_t>(codec::Role::vehicle));
    return codec::Role::vehicle;
  }
  codec::Topic topic() {
    const auto value = number<std::uint8_t>();
    require(value < codec::kTopicCount);
    return whole_ ? static_cast<codec::Topic>(value) : codec::Topic{};
  }
  void require(bool held) { whole_ = whole_ && held; }
  [[nodiscard]] bool is_whole() const { return whole_ && left_.empty(); }

 private:
  std::span<const std::uint8_t> take(std::size_t count) {
    require(count <= left_.size());
    if (!whole_) return {};
    const auto taken = left_.first(count);
    left_ = left_.subspan(count);
    return taken;
  }
  std::span<const std::uint8_t> left_;
  bool whole_ = true;
};

void write(Writer& out, const CarrierConfig& config) {
  out.number(config.domain, 4).number(config.self.value, 2).number(config.instance.value, 8);
  out.number(config.run, 1).number(static_cast<std::uint64_t>(config.role), 1);
  out.endpoint(config.endpoint).number(config.peers.size(), 2);
  for (const PeerConfig& peer : config.peers) {
    out.number(peer.id.value, 2).endpoint(peer.endpoint);
  }
  out.number(config.seal ? 1 : 0, 1);
  if (config.seal) {
    const auto& [start, key, counters] = *config.seal;
    out.number(start.sender.value, 2).number(start.number, 2).number(start.random, 4).key(key);
    out.number(counters.first, 8).number(counters.end, 8);
  }
  out.blob(config.certificate).text(config.transport_plugin);
}
void write(Writer& out, const WriteSample& sample) {
  out.number(static_cast<std::uint64_t>(sample.topic), 1).rest(sample.bytes);
}
void write(Writer& out, const Ping& ping) {
  out.number(ping.number, 4).number(ping.counters_end, 8);
}
void write(Writer& out, const ChangeKey& change) {
  out.key(change.key).number(static_cast<std::uint64_t>(change.old_for.count()), 8);
}
void write(Writer&, const ForgetNews&) {}
void write(Writer& out, const TellNews& tell) {
  out.number(tell.news.member.value, 2).number(tell.news.epoch, 1);
  out.blob(tell.news.change).number(tell.is_last ? 1 : 0, 1);
}
void write(Writer& out, const Joined& joined) { out.text(joined.unconfined); }
void write(Writer& out, const Refused& refused) {
  out.text(refused.why.substr(0, kCarrierTextMax));
}
void write(Writer&, const Stuck&) {}
void write(Writer& out, const HeardSample& heard) {
  out.number(static_cast<std::uint64_t>(heard.topic), 1).number(heard.sender.value, 2);
  out.number(heard.instance.value, 8).rest(heard.bytes);
}
void write(Writer& out, const HeardCertificate& heard) { out.rest(heard.bytes); }
void write(Writer& out, const HeardNews& heard) { out.rest(heard.bytes); }
void write(Writer& out, const PeersNow& now) {
  out.number(now.peers.size(), 2);
  for (const Peer& peer : now.peers) {
    out.number(peer.id.value, 2).number(peer.instance.value, 8);
    out.number(static_cast<std::uint64_t>(peer.role), 1);
  }
}
void write(Writer& out, const ReceptionsNow& now) {
  out.number(now.receptions.size(), 2);
  for (const Reception& reception : now.receptions) {
    out.number(reception.sender.value, 2).number(reception.datagrams, 2);
    out.number(reception.lost_percent, 1).number(reception.bytes, 4);
  }
}
void write(Writer& out, const Pong& pong) {
  out.number(pong.number, 4).number(pong.next_counter, 8);
  for (const std::uint64_t count : pong.counts) out.number(count, 8);
}

void read(Reader& in, CarrierConfig& config) {
  config.domain = in.number<std::uint32_t>();
  config.self.value = in.number<std::uint16_t>();
  config.instance.value = in.number<std::uint64_t>();
  config.run = in.number<std::uint8_t>();
  config.role = in.role();
  config.endpoint = in.endpoint();
  constexpr std::size_t kPeerBytesMin = 2 + 2 + 2;
  for (std::size_t left = in.count(kPeerBytesMin); left > 0; --left) {
    PeerConfig& peer = config.peers.emplace_back();
    peer.id.value = in.number<std::uint16_t>();
    peer.endpoint = in.endpoint();
  }
  if (in.number<std::uint8_t>() != 0) {
    auto& [start, key, counters] = config.seal.emplace();
    start.sender.value = in.number<std::uint16_t>();
    start.number = in.number<std::uint16_t>();
    start.random = in.number<std::uint32_t>();
    key = in.key();
    counters.first = in.number<std::uint64_t>();
    counters.end = in.number<std::uint64_t>();
  }
  const auto certificate = in.blob(kCarrierBlobMax);
  config.certificate.assign(certificate.begin(), certificate.end());
  config.transport_plugin = in.text();
}
void read(Reader& in, WriteSample& sample) {
  sample.topic = in.topic();
  sample.bytes = in.rest(kCarrierMessageBytesMax);
}
void read(Reader& in, Ping& ping) {
  ping.number = in.number<std::uint32_t>();
  ping.counters_end = in.number<std::uint64_t>();
}
void read(Reader& in, ChangeKey& change) {
  change.key = in.key();
  change.old_for = Duration{in.number<std::int64_t>()};
}
void read(Reader&, ForgetNews&) {}
void read(Reader& in, TellNews& tell) {
  tell.news.member.value = in.number<std::uint16_t>();
  tell.news.epoch = in.number<std::uint8_t>();
  const auto change = in.blob(kCarrierBlobMax);
  tell.news.change.assign(change.begin(), change.end());
  tell.is_last = in.number<std::uint8_t>() != 0;
}
void read(Reader& in, Joined& joined) { joined.unconfined = in.text(); }
void read(Reader& in, Refused& refused) { refused.why = in.text(); }
void read(Reader&, Stuck&) {}
void read(Reader& in, HeardSample& heard) {
  heard.topic = in.topic();
  heard.sender.value = in.number<std::uint16_t>();
  heard.instance.value = in.number<std::uint64_t>();
  heard.bytes = in.rest(kCarrierMessageBytesMax);
}
void read(Reader& in, HeardCertificate& heard) { heard.bytes = in.rest(kCarrierBlobMax); }
void read(Reader& in, HeardNews& heard) { heard.bytes = in.rest(kCarrierBlobMax); }
void read(Reader& in, PeersNow& now) {
  constexpr std::size_t kPeerBytes = 2 + 8 + 1;
  for (std::size_t left = in.count(kPeerBytes); left > 0; --left) {
    Peer& peer = now.peers.emplace_back();
    peer.id.value = in.number<std::uint16_t>();
    peer.instance.value = in.number<std::uint64_t>();
    peer.role = in.role();
  }
}
void read(Reader& in, ReceptionsNow& now) {
  constexpr std::size_t kReceptionBytes = 2 + 2 + 1 + 4;
  for (std::size_t left = in.count(kReceptionBytes); left > 0; --left) {
    Reception& reception = now.receptions.emplace_back();
    reception.sender.value = in.number<std::uint16_t>();
    reception.datagrams = in.number<std::uint16_t>();
    reception.lost_percent = in.number<std::uint8_t>();
    reception.bytes = in.number<std::uint32_t>();
  }
}
void read(Reader& in, Pong& pong) {
  pong.number = in.number<std::uint32_t>();
  pong.next_counter = in.number<std::uint64_t>();
  for (std::uint64_t& count : pong.counts) count = in.number<std::uint64_t>();
}

/// The kind of a message is its place in the variant.
template <class Message>
std::vector<std::uint8_t> bytes_of(const Message& message) {
  Writer out;
  out.number(message.index(), 1);
  std::visit([&out](const auto& m) { write(out, m); }, message);
  return out.take();
}

template <class Message, std::size_t Kind = 0>
std::optional<Message> read_kind(std::size_t kind, Reader& in) {
  if constexpr (Kind < std::variant_size_v<Message>) {
    if (kind != Kind) return read_kind<Message, Kind + 1>(kind, in);
    std::optional<Message> message{std::in_place, std::in_place_index<Kind>};
    read(in, *std::get_if<Kind>(&*message));
    return in.is_whole() ? std::move(message) : std::nullopt;
  } else {
    return std::nullopt;
  }
}

template <class Message>
std::optional<Message> message_from(std::span<const std::uint8_t> bytes) {
  if (bytes.empty() || bytes.size() > kCarrierMessageBytesMax) return std::nullopt;
  Reader in{bytes.subspan(1)};
  return read_kind<Message>(bytes[0], in);
}

}  // namespace

std::vector<std::uint8_t> to_bytes(const ToCarrier& message) { return bytes_of(message); }
std::vector<std::uint8_t> to_bytes(const FromCarrier& message) { return bytes_of(message); }

std::optional<ToCarrier> to_carrier_from(std::span<const std::uint8_t> bytes) {
  return message_from<ToCarrier>(bytes);
}
std::optional<FromCarrier> from_carrier_from(std::span<const std::uint8_t> bytes) {
  return message_from<FromCarrier>(bytes);
}

}  // namespace skein::network
