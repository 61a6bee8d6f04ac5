// SPDX-License-Identifier: Apache-2.0
//
// mesh_probe NODES GROUP TOLERANCE
//   Measures the mesh of network.sh, and compares it with the modelled radio (hil/radio). Nodes 0
//   to NODES - 1, which are to be cut off from each other at first, are made a chain; each sends
//   datagrams to GROUP, a multicast or a broadcast address, and hears what the others send. Links
//   are told on the standard output, as links.sh takes them; the table is on the standard error.
//   The exit status is 1 where something differs from the model by more than TOLERANCE times it, or
//   is not heard at all. On a machine that is itself late only the latter is judged.
#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/hil/radio/radio_model.hpp"

namespace skein::hil {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr std::uint16_t kPort = 7500;
constexpr auto kPeriod = milliseconds{50};
constexpr int kCuts = 6;
constexpr double kLate_ms = 2.0;  ///< of a machine that is too busy to measure anything
const radio::Link kLink{true, 0.05, milliseconds{20}, milliseconds{5}, std::nullopt};

/// As large as most of the air's.
struct Datagram {
  std::size_t from = 0;
  steady_clock::time_point sent{};
  std::array<std::uint8_t, 200> rest{};
};

struct Heard {
  std::size_t from;
  std::size_t to;
  steady_clock::time_point sent;
  steady_clock::time_point at;
};

[[noreturn]] void fail(const std::string& what) {
  std::perror(what.c_str());
  std::exit(1);  // NOLINT(concurrency-mt-unsafe): one thread
}

/// A socket that stays in the namespace of that machine.
int socket_of(std::size_t node, const sockaddr_in& group) {
  const std::string name = fmt::format("/run/netns/skein{}", node);
  const int there = ::open(name.c_str(), O_RDONLY | O_CLOEXEC);
  if (there < 0 || ::setns(there, CLONE_NEWNET) != 0) fail(name);
  ::close(there);
  const int s = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const int yes = 1;
  ::setsockopt(s, SOL_SOCKET, SO_BROADCAST, &yes, sizeof yes);
  if (::bind(s, reinterpret_cast<const sockaddr*>(&group), sizeof group) != 0) fail("bind");
  if (!IN_MULTICAST(ntohl(group.sin_addr.s_addr))) return s;
  ip_mreqn membership{group.sin_addr, {}, 0};
  const std::string own = fmt::format("10.54.0.{}", node == 0 ? 100 : node);
  ::inet_pton(AF_INET, own.c_str(), &membership.imr_address);
  if (::setsockopt(s, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) != 0 ||
      ::setsockopt(s, IPPROTO_IP, IP_MULTICAST_IF, &membership, sizeof membership) != 0) {
    fail("multicast");
  }
  return s;
}

class Probe {
 public:
  Probe(std::size_t nodes, const sockaddr_in& group) : group_{group} {
    for (std::size_t node = 0; node < nodes; ++node) sockets_.push_back(socket_of(node, group));
  }

  void set_link(std::size_t a, std::size_t b, bool up) {
    const std::string how =
        up ? fmt::format("up {:.3f} {:.3f} {:.6f}", 1e3 * to_seconds(kLink.delay),
                         1e3 * to_seconds(kLink.jitter), kLink.loss)
           : "down";
    fmt::print("{} {} {}\n{} {} {}\n", a, b, how, b, a, how);
    std::fflush(stdout);
  }

  /// All send once a period, until it is done or the time is over; gives how often each has sent.
  std::size_t exchange(
      steady_clock::duration at_most, const std::function<void(const Heard&)>& hear,
      const std::function<bool()>& done = [] { return false; }) {
    const auto end = steady_clock::now() + at_most;
    std::size_t rounds = 0;
    for (auto next = steady_clock::now(); next < end && !done(); next += kPeriod, ++rounds) {
      for (std::size_t node = 0; node < sockets_.size(); ++node) {
        const auto due = next + kPeriod * node / sockets_.size();
        listen(due, hear);
        late_ += steady_clock::now() - due;
        send(node);
      }
      listen(next + kPeriod, hear);
    }
    return rounds;
  }

  /// Nobody sends.
  void listen(steady_clock::time_point until, const std::function<void(const Heard&)>& hear) {
    std::vector<pollfd> ready;
    for (const int s : sockets_) ready.push_back({s, POLLIN, 0});
    for (auto now = steady_clock::now(); now < until; now = steady_clock::now()) {
      const timespec wait{0,
                          std::min<long>(999'999'999, (until - now) / std::chrono::nanoseconds{1})};
      (void)::ppoll(ready.data(), ready.size(), &wait, nullptr);
      for (std::size_t to = 0; to < ready.size(); ++to) {
        Datagram datagram{};
        while (ready[to].revents != 0 &&
               ::recv(ready[to].fd, &datagram, sizeof datagram, 0) == sizeof datagram) {
          if (datagram.from == to) continue;
          hear({datagram.from, to, datagram.sent, steady_clock::now()});
        }
      }
    }
  }

  /// Of what was sent so far.
  [[nodiscard]] double late_ms() const {
    return 1e3 * to_seconds(late_) / static_cast<double>(std::max<std::size_t>(sent_, 1));
  }

 private:
  void send(std::size_t node) {
    ++sent_;
    const Datagram datagram{node, steady_clock::now(), {}};
    (void)::sendto(sockets_[node], &datagram, sizeof datagram, MSG_NOSIGNAL,
                   reinterpret_cast<const sockaddr*>(&group_), sizeof group_);
  }

  sockaddr_in group_;
  std::vector<int> sockets_;
  std::size_t sent_ = 0;
  Duration late_{};
};

/// What was measured beside what the model says.
class Table {
 public:
  explicit Table(double tolerance) : tolerance_{tolerance} {
    fmt::print(stderr, "{:44} {:>9} {:>9} {:>6}\n", "", "measured", "model", "ratio");
  }
  void row(const std::string& what, const std::string& unit, double measured, double model) {
    const bool near = std::abs(measured - model) <= tolerance_ * model;
    held_ = held_ && near;
    fmt::print(stderr, "{:44} {:9.3f} {:9.3f} {:6.2f}{}\n", what + ", " + unit, measured, model,
               measured / model, near ? "" : "  FAIL");
  }
  static void note(const std::string& what, double measured) {
    fmt::print(stderr, "{:44} {:9.3f}\n", what, measured);
  }
  /// Did all rows hold, as far as a machine that is so late can tell?
  [[nodiscard]] bool held(double late_ms) const {
    if (late_ms <= kLate_ms) return held_;
    fmt::print(stderr, "NOT JUDGED: the machine is {:.1f} ms late itself\n", late_ms);
    return true;
  }

 private:
  double tolerance_;
  bool held_ = true;
};

std::size_t hops_of(const Heard& heard) {
  return heard.from < heard.to ? heard.to - heard.from : heard.from - heard.to;
}

/// From the moment that there are links until every node has heard every other.
void measure_meeting(Probe& probe, std::size_t nodes) {
  std::vector<std::vector<bool>> has_heard(nodes, std::vector<bool>(nodes, false));
  std::size_t pairs = 0;
  probe.exchange(seconds{2}, [](const Heard&) { fail("heard without a link"); });
  const auto start = steady_clock::now();
  for (std::size_t node = 1; node < nodes; ++node) probe.set_link(node - 1, node, true);
  probe.exchange(
      seconds{60},
      [&](const Heard& heard) {
        if (has_heard[heard.to][heard.from]) return;
        has_heard[heard.to][heard.from] = true;
        ++pairs;
      },
      [&] { return pairs == nodes * (nodes - 1); });
  if (pairs < nodes * (nodes - 1)) fail("not all have found each other");
  Table::note("all have found each other, s", to_seconds(steady_clock::now() - start));
}

void measure_ways(Probe& probe, std::size_t nodes, Table& table) {
  struct Way {
    std::size_t received = 0;
    Duration delay{};
  };
  std::vector<Way> ways(nodes);
  const auto hear = [&](const Heard& heard) {
    Way& way = ways[hops_of(heard)];
    ++way.received;
    way.delay += heard.at - heard.sent;
  };
  probe.exchange(seconds{1}, [](const Heard&) {});
  const std::size_t sent = probe.exchange(seconds{20}, hear);
  probe.listen(steady_clock::now() + seconds{1}, hear);
  for (std::size_t hops = 1; hops < nodes; ++hops) {
    const Way& way = ways[hops];
    const radio::Link model = radio::over_hops(kLink, static_cast<int>(hops));
    const auto received = static_cast<double>(std::max<std::size_t>(way.received, 1));
    const auto expected = static_cast<double>(2 * (nodes - hops) * sent);
    table.row(fmt::format("delay over {} hops", hops), "ms", 1e3 * to_seconds(way.delay) / received,
              1e3 * to_seconds(model.delay));
    table.row(fmt::format("loss over {} hops", hops), "share",
              1.0 - static_cast<double>(way.received) / expected, model.loss);
  }
}

/// The chain is made a ring, and cut in the middle: neighbours hear each other the long way.
void measure_mending(Probe& probe, std::size_t nodes, Table& table) {
  const std::size_t a = nodes / 2 - 1;
  const std::size_t b = a + 1;
  Duration gap{};
  for (int cut = 0; cut < kCuts; ++cut) {
    probe.set_link(0, nodes - 1, true);
    probe.exchange(seconds{8}, [](const Heard&) {});  // the ring is found, and all of it is known
    const auto start = steady_clock::now();
    std::array<std::optional<Duration>, 2> until;
    probe.set_link(a, b, false);
    probe.exchange(
        seconds{30},
        [&](const Heard& heard) {
          if (heard.sent < start + milliseconds{10}) return;  // the link's end takes a moment
          const bool forth = heard.from == a && heard.to == b;
          const bool back = heard.from == b && heard.to == a;
          if (forth || back) until[forth ? 0 : 1] = until[forth ? 0 : 1].value_or(heard.at - start);
        },
        [&] { return until[0] && until[1]; });
    if (!until[0] || !until[1]) fail("not heard the long way");
    gap += *until[0] + *until[1];
    probe.set_link(0, nodes - 1, false);
    probe.set_link(a, b, true);
    probe.exchange(seconds{2}, [](const Heard&) {});
  }
  // The next datagram that is not lost, along the long way, once there is one.
  const radio::Link way = radio::over_hops(kLink, static_cast<int>(nodes - 1));
  const Duration mend = radio::MeshParams{}.mend / 2;
  const Duration wait = from_seconds(to_seconds(kPeriod) * (0.5 + way.loss / (1.0 - way.loss)));
  table.row("heard again after a link's end", "s", to_seconds(gap) / (2.0 * kCuts),
            to_seconds(way.delay + mend + wait));
}

}  // namespace
}  // namespace skein::hil

int main(int argc, char** argv) {
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_port = htons(skein::hil::kPort);
  const std::size_t nodes = argc == 4 ? std::strtoul(argv[1], nullptr, 10) : 0;
  if (nodes < 3 || ::inet_pton(AF_INET, argv[2], &group.sin_addr) != 1) {
    fmt::print(stderr, "mesh_probe NODES GROUP TOLERANCE, three nodes at least\n");
    return 2;
  }
  skein::hil::Probe probe{nodes, group};
  skein::hil::Table table{std::strtod(argv[3], nullptr)};
  skein::hil::measure_meeting(probe, nodes);
  skein::hil::measure_ways(probe, nodes, table);
  skein::hil::measure_mending(probe, nodes, table);
  return table.held(probe.late_ms()) ? 0 : 1;
}
