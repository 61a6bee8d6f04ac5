// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <ranges>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "frames.hpp"
#include "skein/air/link.hpp"
#include "skein/base/random.hpp"

namespace skein::air {

using namespace std::chrono_literals;

inline constexpr std::uint8_t kOrders = 0;
inline constexpr std::uint8_t kMotion = 1;
inline constexpr std::uint8_t kEvents = 2;
inline const std::vector<Channel> kChannels{
    {.reliable = true, .urgency = Urgency::decision, .kept = 64},
    {.reliable = false, .urgency = Urgency::motion, .kept = 1},
    {.reliable = true, .urgency = Urgency::report, .kept = 200}};

struct Heard {
  std::uint8_t channel;
  Author author;
  std::string text;
  Instant at;
};

/// As it is on the air: who says it (10 bytes), which of its datagrams (4), content.
inline std::vector<std::uint8_t> sealed(const Author& author, std::uint32_t counter,
                                        const std::vector<std::uint8_t>& content) {
  std::vector<std::uint8_t> bytes;
  const auto put = [&bytes](std::uint64_t number, int count) {
    while (count-- > 0) bytes.push_back(static_cast<std::uint8_t>(number >> (8 * count)));
  };
  put(author.node.value, 2);
  put(author.instance.value, 8);
  put(counter, 4);
  bytes.insert(bytes.end(), content.begin(), content.end());
  return bytes;
}

/// Links in virtual time, which hear each other but for what gets lost.
class Air {
 public:
  explicit Air(std::uint64_t seed = 1) : random_{seed} {}

  double loss = 0.0;
  Duration delay_max = 2ms;
  std::uint8_t hops_max = 1;
  bool somebody_lies = false;
  std::function<bool(std::size_t, std::size_t)> apart = [](auto, auto) { return false; };
  Instant now{};

  std::size_t add(std::uint16_t id, std::uint64_t instance = 7,
                  std::optional<double> bytes_per_s = {}) {
    auto node = std::make_unique<Node>(*this);
    LinkConfig config;
    config.self = {VehicleId{id}, InstanceId{instance}};
    config.role = static_cast<std::uint8_t>(id % 3);
    config.channels = kChannels;
    config.certificate = std::vector<std::uint8_t>(200, static_cast<std::uint8_t>(id));
    config.bytes_per_s = bytes_per_s;
    config.hops_max = hops_max;
    config.seed = random_.next();
    node->self = config.self;
    node->link = std::make_unique<Link>(config, *node, now);
    nodes_.push_back(std::move(node));
    return nodes_.size() - 1;
  }
  void remove(std::size_t node) { nodes_[node]->link.reset(); }
  void say(std::size_t node, std::uint8_t channel, const std::string& text) {
    EXPECT_TRUE(nodes_[node]->link->send(channel, {text.begin(), text.end()}, now));
  }
  Link& link(std::size_t node) { return *nodes_[node]->link; }
  /// How often somebody has passed on a datagram of that node's.
  [[nodiscard]] std::uint64_t passed_on(std::size_t of) const { return nodes_[of]->passed_on; }
  /// Of all nodes together.
  [[nodiscard]] std::uint64_t sum(std::uint64_t LinkCounts::*count) const {
    std::uint64_t sum = 0;
    for (const auto& node : nodes_) sum += node->link ? node->link->counts().*count : 0;
    return sum;
  }
  /// To `node`, as if it were that author's.
  void forge(std::size_t node, const Author& author, const std::vector<std::uint8_t>& content) {
    flying_.emplace(now, Flying{node, sealed(author, ++forged_, content)});
  }
  [[nodiscard]] std::uint64_t refused(std::size_t node) const { return nodes_[node]->refused; }
  std::vector<Heard>& heard(std::size_t node) { return nodes_[node]->heard; }
  std::set<Author>& certified(std::size_t node) { return nodes_[node]->certified; }
  std::vector<std::string> texts(std::size_t node, std::uint8_t channel, std::uint16_t of) {
    std::vector<std::string> all;
    for (const Heard& h : heard(node)) {
      if (h.channel == channel && h.author.node.value == of) all.push_back(h.text);
    }
    return all;
  }

  void run(Duration time) {
    run_until(now + time, [] { return false; });
  }
  bool run_until(Instant end, const std::function<bool()>& done) {
    while (!done()) {
      Instant next = flying_.empty() ? Instant::max() : flying_.begin()->first;
      for (const auto& node : nodes_) {
        if (node->link) next = std::min(next, node->link->due());
      }
      if (next > end) {
        now = end;
        return done();
      }
      now = std::max(now, next);
      step();
    }
    return true;
  }

 private:
  struct Node final : LinkSink {
    explicit Node(Air& in) : air{in} {}
    Air& air;
    Author self;
    std::unique_ptr<Link> link;
    std::uint32_t counter = 0;
    std::vector<Heard> heard;
    std::set<Author> certified;
    std::map<Author, std::set<std::uint64_t>> opened;
    std::uint64_t refused = 0;
    std::uint64_t passed_on = 0;
    std::optional<Opened> open(std::span<const std::uint8_t> datagram) override {
      const auto number = [&](std::size_t from, std::size_t count) {
        std::uint64_t value = 0;
        for (const std::uint8_t byte : datagram.subspan(from, count)) value = value << 8U | byte;
        return value;
      };
      // Authors are believed below 1000; who seals knows better.
      if (datagram.size() < 14 || number(0, 2) >= 1000) {
        ++refused;
        return std::nullopt;
      }
      const Author author{VehicleId{static_cast<std::uint16_t>(number(0, 2))},
                          InstanceId{number(2, 8)}};
      const std::uint64_t count = number(10, 4);
      if (!opened[author].insert(count).second) return Opened{author, count, std::nullopt};
      return Opened{author, count, datagram.subspan(14)};
    }
    void hear(std::span<const std::uint8_t> datagram) {
      const auto got = open(datagram);
      if (got && got->content) link->hear(*got, datagram, air.now);
    }
    void on_sample(std::uint8_t channel, const Author& author,
                   std::span<const std::uint8_t> bytes) override {
      heard.push_back({channel, author, {bytes.begin(), bytes.end()}, air.now});
    }
    void on_certificate(const Author& author, std::span<const std::uint8_t> bytes) override {
      EXPECT_TRUE(bytes.size() == 200U || air.somebody_lies);
      certified.insert(author);
    }
  };
  struct Flying {
    std::size_t to;
    std::vector<std::uint8_t> bytes;
  };

  void step() {
    while (!flying_.empty() && flying_.begin()->first <= now) {
      const Flying flying = std::move(flying_.begin()->second);
      flying_.erase(flying_.begin());
      Node& to = *nodes_[flying.to];
      if (to.link) to.hear(flying.bytes);
    }
    for (std::size_t from = 0; from < nodes_.size(); ++from) {
      if (!nodes_[from]->link) continue;
      int said = 0;
      while (const auto content = nodes_[from]->link->poll(now)) {
        ASSERT_LE(content->size(), hops_max > 1 ? 1442U : 1200U);
        ASSERT_LT(++said, 1000);
        count_passed_on(*content);
        spread(from, sealed(nodes_[from]->self, ++nodes_[from]->counter, *content));
      }
      ASSERT_GT(nodes_[from]->link->due(), now);
    }
  }
  void count_passed_on(std::span<const std::uint8_t> content) {
    ASSERT_TRUE(read_head(content));
    while (!content.empty()) {
      const auto frame = read_frame(content);
      ASSERT_TRUE(frame);
      const auto* passed_on = std::get_if<PassedOnFrame>(&*frame);
      if (passed_on == nullptr) continue;
      const auto of = std::ranges::find_if(nodes_, [&](const auto& node) {
        return std::ranges::equal(sealed(node->self, 0, {}) | std::views::take(10),
                                  passed_on->bytes.first(10));
      });
      if (of != nodes_.end()) ++(*of)->passed_on;
    }
  }
  void spread(std::size_t from, const std::vector<std::uint8_t>& datagram) {
    for (std::size_t to = 0; to < nodes_.size(); ++to) {
      if (to == from || apart(from, to) || random_.chance(loss)) continue;
      const Duration delay{static_cast<std::int64_t>(random_.uniform(0.1, 1.0) *
                                                     static_cast<double>(delay_max.count()))};
      flying_.emplace(now + delay, Flying{to, datagram});
    }
  }

  Random random_;
  std::vector<std::unique_ptr<Node>> nodes_;
  std::multimap<Instant, Flying> flying_;
  std::uint32_t forged_ = 1'000'000;
};

inline bool all_found(Air& air, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    if (air.link(i).peers(air.now).size() != count - 1) return false;
  }
  return true;
}

inline std::vector<std::string> numbered(int first, int end) {
  std::vector<std::string> all;
  for (int i = first; i < end; ++i) all.push_back("m" + std::to_string(i));
  return all;
}

}  // namespace skein::air
