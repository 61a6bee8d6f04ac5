// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/radio/link_feed.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <chrono>
#include <system_error>
#include <utility>

namespace skein::hil::radio {
namespace {

constexpr std::array<std::uint8_t, 4> kMark{'S', 'K', 'R', 2};  // the last is the version
constexpr std::size_t kNumbers = 7;
/// Two nodes share a byte.
constexpr std::size_t kHopsBytes = LinkTable::kNodes / 2;
constexpr std::uint8_t kHopsMax = 15;
constexpr std::size_t kSize = kMark.size() + 3 + 8 * kNumbers + kHopsBytes;
constexpr auto kSilence = std::chrono::seconds{3};
constexpr int kLook_ms = 200;  ///< how often a silent receiver looks whether it is to end

std::uint64_t bits_of(double value) { return std::bit_cast<std::uint64_t>(value); }
std::uint64_t bits_of(Duration value) { return std::bit_cast<std::uint64_t>(value.count()); }
double number_of(std::uint64_t bits) { return std::bit_cast<double>(bits); }
Duration duration_of(std::uint64_t bits) { return Duration{std::bit_cast<std::int64_t>(bits)}; }

sockaddr_in address_of(std::uint32_t host, std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(host);
  return address;
}

Result<int> udp_socket() {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket < 0) {
    return Error{"no UDP socket for the radio: " + std::generic_category().message(errno)};
  }
  return socket;
}

/// A datagram from anywhere must not stop a node's radio for ever, nor fill its memory with what is
/// held back.
bool can_be(const Link& link) {
  constexpr Duration kLongest = std::chrono::seconds{60};
  const auto share = [](double of) { return of >= 0.0 && of <= 1.0; };
  const auto bounded = [=](Duration of) { return of >= Duration{} && of <= kLongest; };
  if (!share(link.loss) || !bounded(link.delay) || !bounded(link.jitter)) return false;
  if (link.bytes_per_s && !(*link.bytes_per_s > 0.0)) return false;
  return !link.disorder || (share(link.disorder->duplicates) && share(link.disorder->held_back) &&
                            bounded(link.disorder->held_back_max));
}

/// Into the node's row.
void put(LinkTable& table, const Hearing& hearing) {
  table.set(hearing.hop);
  for (std::size_t id = 0; id < LinkTable::kNodes; ++id) {
    table.set_hops(VehicleId{static_cast<std::uint16_t>(id)}, hearing.self, hearing.hops.at(id));
  }
}

Hearing perfect(VehicleId self) {
  Hearing hearing{self, {}, {}};
  hearing.hops.fill(1);
  return hearing;
}

}  // namespace

std::vector<std::uint8_t> encode(const Hearing& hearing) {
  std::vector<std::uint8_t> bytes{kMark.begin(), kMark.end()};
  bytes.reserve(kSize);
  bytes.push_back(static_cast<std::uint8_t>(hearing.self.value >> 8U));
  bytes.push_back(static_cast<std::uint8_t>(hearing.self.value & 0xFFU));
  bytes.push_back(hearing.hop.disorder ? 1 : 0);
  const Disorder disorder = hearing.hop.disorder.value_or(Disorder{});
  for (const std::uint64_t number :
       {bits_of(hearing.hop.loss), bits_of(hearing.hop.delay), bits_of(hearing.hop.jitter),
        bits_of(disorder.duplicates), bits_of(disorder.held_back), bits_of(disorder.held_back_max),
        bits_of(hearing.hop.bytes_per_s.value_or(0.0))}) {
    for (unsigned i = 0; i < 8; ++i) {
      bytes.push_back(static_cast<std::uint8_t>((number >> (8U * i)) & 0xFFU));
    }
  }
  for (std::size_t id = 0; id < LinkTable::kNodes; id += 2) {
    const unsigned high = std::min(hearing.hops.at(id), kHopsMax);
    const unsigned low = std::min(hearing.hops.at(id + 1), kHopsMax);
    bytes.push_back(static_cast<std::uint8_t>(high << 4U | low));
  }
  return bytes;
}

std::optional<Hearing> decode(std::span<const std::uint8_t> bytes) {
  if (bytes.size() != kSize || !std::equal(kMark.begin(), kMark.end(), bytes.begin())) {
    return std::nullopt;
  }
  bytes = bytes.subspan(kMark.size());
  Hearing hearing;
  hearing.self.value = static_cast<std::uint16_t>((bytes[0] << 8U) | bytes[1]);
  const bool disordered = bytes[2] != 0;
  bytes = bytes.subspan(3);
  std::array<std::uint64_t, kNumbers> numbers{};
  for (std::uint64_t& number : numbers) {
    for (unsigned i = 0; i < 8; ++i) number |= std::uint64_t{bytes[i]} << (8U * i);
    bytes = bytes.subspan(8);
  }
  hearing.hop = {true, number_of(numbers[0]), duration_of(numbers[1]), duration_of(numbers[2])};
  if (disordered) {
    hearing.hop.disorder = {number_of(numbers[3]), number_of(numbers[4]), duration_of(numbers[5])};
  }
  if (numbers[6] != 0) hearing.hop.bytes_per_s = number_of(numbers[6]);
  if (!can_be(hearing.hop)) return std::nullopt;
  for (std::size_t id = 0; id < LinkTable::kNodes; id += 2) {
    hearing.hops.at(id) = static_cast<std::uint8_t>(bytes[id / 2] >> 4U);
    hearing.hops.at(id + 1) = static_cast<std::uint8_t>(bytes[id / 2] & 0xFU);
  }
  return hearing;
}

Result<FeedSender> FeedSender::open() {
  const auto socket = udp_socket();
  if (!socket) return socket.error();
  return FeedSender{*socket};
}

FeedSender::~FeedSender() {
  if (socket_ >= 0) ::close(socket_);
}

FeedSender::FeedSender(FeedSender&& other) noexcept : socket_{std::exchange(other.socket_, -1)} {}

void FeedSender::send(const Hearing& hearing, const std::string& address) const {
  sockaddr_in to = address_of(0, feed_port(hearing.self));
  if (::inet_pton(AF_INET, address.c_str(), &to.sin_addr) != 1) return;
  const auto bytes = encode(hearing);
  (void)::sendto(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL,
                 reinterpret_cast<const sockaddr*>(&to), sizeof to);
}

Result<std::shared_ptr<FeedReceiver>> FeedReceiver::open(VehicleId self) {
  const auto socket = udp_socket();
  if (!socket) return socket.error();
  const sockaddr_in here = address_of(INADDR_ANY, feed_port(self));
  if (::bind(*socket, reinterpret_cast<const sockaddr*>(&here), sizeof here) != 0) {
    const Error error{"the radio cannot listen on UDP port " + std::to_string(feed_port(self)) +
                      ": " + std::generic_category().message(errno)};
    ::close(*socket);
    return error;
  }
  auto table = LinkTable::create_private();
  if (!table) {
    ::close(*socket);
    return table.error();
  }
  return std::shared_ptr<FeedReceiver>{new FeedReceiver{self, *socket, std::move(table).value()}};
}

FeedReceiver::FeedReceiver(VehicleId self, int socket, LinkTable table)
    : self_{self}, socket_{socket}, table_{std::move(table)}, thread_{[this] { listen(); }} {}

FeedReceiver::~FeedReceiver() {
  stopping_ = true;
  thread_.join();
  ::close(socket_);
}

void FeedReceiver::listen() {
  using std::chrono::steady_clock;
  auto last = steady_clock::now();
  bool told = false;
  while (!stopping_) {
    pollfd item{socket_, POLLIN, 0};
    (void)::poll(&item, 1, kLook_ms);
    std::array<std::uint8_t, kSize + 1> bytes{};
    const auto size = ::recv(socket_, bytes.data(), bytes.size(), 0);
    const auto hearing =
        size > 0 ? decode(std::span{bytes}.first(static_cast<std::size_t>(size))) : std::nullopt;
    if (hearing && hearing->self == self_) {
      put(table_, *hearing);
      last = steady_clock::now();
      told = true;
    } else if (told && steady_clock::now() - last > kSilence) {
      put(table_, perfect(self_));
      told = false;
    }
  }
}

}  // namespace skein::hil::radio
