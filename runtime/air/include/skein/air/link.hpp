// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"

namespace skein::air {

/// Who says something: a node, and which start of its program.
struct Author {
  VehicleId node;
  InstanceId instance;
  friend auto operator<=>(const Author&, const Author&) = default;
};

/// What goes first where the air has too little room, and how long it may wait for others to share
/// a datagram with (kPatience).
enum class Urgency : std::uint8_t {
  decision,  ///< the contract net, orders
  motion,    ///< where others are, from which they keep clear
  state,     ///< what people look at
  report,    ///< what can be read later
  count
};
inline constexpr std::size_t kUrgencies = static_cast<std::size_t>(Urgency::count);

/// How a kind of message is carried.
struct Channel {
  bool reliable = false;  ///< what is lost is asked for again; each author's come in their order
  Urgency urgency = Urgency::state;
  std::size_t kept = 1;  ///< how many may wait, or be asked for again; the oldest gives way
};

/// What a datagram was found to be.
struct Opened {
  Author author;
  std::uint64_t counter = 0;  ///< of its author's datagrams: each has a greater one than before
  std::optional<std::span<const std::uint8_t>> content;  ///< none: it was opened before
};

/// What a link tells of others. Must not call the link.
class LinkSink {
 public:
  /// A datagram that was passed on, as it was on the air. None where it is not good, which is for
  /// the sink to count, or this node's own. The content must stay valid until the next call.
  virtual std::optional<Opened> open(std::span<const std::uint8_t> datagram) = 0;
  virtual void on_sample(std::uint8_t channel, const Author& author,
                         std::span<const std::uint8_t> bytes) = 0;
  virtual void on_certificate(const Author& author, std::span<const std::uint8_t> bytes) = 0;

 protected:
  ~LinkSink() = default;
};

struct LinkConfig {
  Author self;
  std::uint8_t role = 0;                  ///< told to all
  std::vector<Channel> channels;          ///< by their numbers; the same for all
  std::vector<std::uint8_t> certificate;  ///< told to all; may be empty
  std::size_t datagram_bytes = 1200;      ///< at most, without `overhead_bytes`
  std::size_t overhead_bytes = 58;  ///< what each datagram has more on the air: IPv4, UDP, seal
  std::size_t mtu_bytes = 1500;     ///< of the air: of datagrams that pass on others, with overhead
  /// How many nodes may say a datagram until it arrives, its author included; 1: what others say is
  /// not passed on.
  std::uint8_t hops_max = 1;
  std::optional<double> bytes_per_s;  ///< of the air that this node may take; none: no limit
  std::uint64_t seed = 0;
};

struct LinkPeer {
  Author author;
  std::uint8_t role = 0;
  friend bool operator==(const LinkPeer&, const LinkPeer&) = default;
};

struct LinkCounts {
  std::uint64_t datagrams = 0;  ///< sent
  std::uint64_t bytes = 0;      ///< sent, with their overhead
  std::uint64_t repairs = 0;    ///< parts that were sent again
  std::uint64_t passed_on = 0;  ///< datagrams of others
  std::uint64_t gave_way = 0;   ///< samples that waited until newer ones took their place, and
                                ///< datagrams to be passed on
  std::uint64_t lost = 0;       ///< parts that could not be had again
  std::uint64_t malformed = 0;  ///< datagrams
  std::uint64_t too_many = 0;   ///< authors beyond kAuthorsMax
};

/// One node of the air: everything is said once, for all who hear it (broadcast or multicast), with
/// as much as is ready in one datagram. Every author numbers what must not be lost; who misses a
/// part asks for it, and it is said again, once for all who miss it. There is no list of members:
/// who is heard is there. Where not everybody hears everybody, nodes pass on what others say, as it
/// was on the air, so that all seals and signatures stay their authors'. Without I/O, clock or
/// threads; nothing depends on anything but its calls.
class Link {
 public:
  static constexpr std::size_t kAuthorsMax = 4096;

  Link(LinkConfig config, LinkSink& sink, Instant now);
  ~Link();
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  /// False where the sample is larger than kSampleMax.
  bool send(std::uint8_t channel, std::vector<std::uint8_t> bytes, Instant now);
  /// The longest message there is (topics.md), signed: 100 parts of the 255 that can be had again.
  static constexpr std::size_t kSampleMax = 120'000;

  /// What a datagram of its transmitter's own was found to be, and as it was on the air. Any bytes.
  /// Precondition: it has a content.
  void hear(const Opened& opened, std::span<const std::uint8_t> datagram, Instant now);

  /// When poll() is to be called next.
  [[nodiscard]] Instant due() const;
  /// What a datagram to all is to say; to be called until there is none.
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> poll(Instant now);

  /// Whom it has heard in the last kPeerFor, itself or over others.
  [[nodiscard]] std::vector<LinkPeer> peers(Instant now) const;
  static constexpr Duration kPeerFor = std::chrono::seconds{10};
  [[nodiscard]] LinkCounts counts() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace skein::air
