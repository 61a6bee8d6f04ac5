// SPDX-License-Identifier: Apache-2.0
#include "skein/ros2/bridge.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "skein/agencies/outlet.hpp"
#include "skein/process/log.hpp"
#include "skein/process/mission_clock.hpp"
#include "skein/process/service.hpp"
#include "skein/process/shutdown.hpp"
#include "skein/process/token.hpp"
#include "skein/ros2/console_feed.hpp"
#include "skein/ros2/proposals.hpp"

namespace skein::ros2 {
namespace {

constexpr std::chrono::milliseconds kStep{20};
constexpr int kStepsOfRound = 10;       // between two looks at whether it is to end
constexpr int kProposalsPerStep = 100;  // so that a flood cannot keep the loop from its picture
constexpr Duration kComplaintPeriod = std::chrono::seconds{10};
constexpr std::uint32_t kDomainMax = 232;  // of more the ports would not fit

std::int64_t unix_ns_now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

bool is_name(const std::string& text) {
  const auto is_part = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !text.empty() && text.front() >= 'a' && text.front() <= 'z' &&
         std::ranges::all_of(text, is_part);
}

class Bridge {
 public:
  Bridge(const BridgeConfig& config, RosNode& node, agencies::Outlet* markers,
         const process::MissionClock& clock)
      : node_{node},
        markers_{markers},
        clock_{clock},
        intake_{process::make_token().substr(0, 8)},
        console_{config.console,
                 {[this](const std::string& text) { return on_text(text); },
                  [](const std::string& news) { spdlog::info("{}", news); }}} {}

  void step() {
    console_.run_for(kStep);
    node_.tell_of_topics();
    take_proposals();
  }

 private:
  Result<std::string> on_text(const std::string& text) {
    auto heard = feed_.on_text(text);
    if (!heard) return heard.error();
    for (const Publication& one : heard->publications) {
      if (!node_.publish(one) && lost_++ == 0) {
        spdlog::warn("{} could not be published; later ones are counted only", one.topic);
      }
    }
    return std::move(heard->answer);
  }

  void take_proposals() {
    const Instant now = clock_.now();
    for (int i = 0; i < kProposalsPerStep; ++i) {
      const auto sample = node_.next_proposal();
      if (!sample) break;
      const auto marker = intake_.take(*sample, now, unix_ns_now());
      if (!marker) continue;
      if (markers_ == nullptr) {
        complain(now, "a proposal is dropped: --markers says where the ground station takes them");
      } else {
        markers_->send(*marker);
      }
    }
    if (markers_ != nullptr) {
      markers_->poll(std::chrono::steady_clock::now());
      if (const auto news = markers_->poll_news()) spdlog::warn("markers: {}", *news);
    }
    if (const auto trouble = intake_.poll_trouble()) {
      complain(now, "a proposal is dropped: " + *trouble);
    }
  }

  void complain(Instant now, const std::string& what) {
    if (now < next_complaint_) return;
    next_complaint_ = now + kComplaintPeriod;
    spdlog::warn("{} (unreadable: {}, too many: {})", what, intake_.unreadable(),
                 intake_.too_many());
  }

  RosNode& node_;
  agencies::Outlet* markers_;
  const process::MissionClock& clock_;
  ConsoleFeed feed_;
  ProposalIntake intake_;
  std::uint64_t lost_ = 0;
  Instant next_complaint_{Instant::min()};
  ConsoleClient console_;  // last: it calls the rest
};

}  // namespace

Result<void> check(const BridgeConfig& config) {
  if (config.node.domain > kDomainMax) {
    return Error{"a domain is a number from 0 to " + std::to_string(kDomainMax)};
  }
  if (!is_name(config.node.name_space)) {
    return Error{"'" + config.node.name_space +
                 "' is no namespace: small letters, digits and _, a letter first"};
  }
  for (const std::string& address : config.node.peers) {
    if (const auto peer = parse_place(address); !peer || peer->port != 0) {
      return Error{"'" + address + "' is no IPv4 address of a peer"};
    }
  }
  return {};
}

int run(const BridgeConfig& config) {
  const process::Shutdown shutdown;
  const process::MissionClock clock{unix_ns_now(), 1.0};
  process::start_log(clock);
  std::unique_ptr<agencies::Outlet> markers;
  if (config.markers) {
    auto opened = agencies::open_udp(config.markers->host, config.markers->port, "");
    if (!opened) {
      spdlog::error("markers: {}", opened.error().message);
      return process::kExitCannotStart;
    }
    markers = std::move(opened).value();
  }
  // Fast DDS would start all the same, and speak with nobody.
  if (const auto own = agencies::Inlet::open(config.node.address, 0, ""); !own) {
    spdlog::error("--address is to be one of this machine's: {}", own.error().message);
    return process::kExitCannotStart;
  }
  auto node = RosNode::open(config.node);
  if (!node) {
    spdlog::error("{}", node.error().message);
    return process::kExitCannotStart;
  }
  Bridge bridge{config, **node, markers.get(), clock};
  const process::Service service;
  service.ready();
  spdlog::info("speaks as ROS 2 in domain {} on {}, topics /{}/...", config.node.domain,
               config.node.address, config.node.name_space);
  while (shutdown.wait_for(std::chrono::nanoseconds{0}) == nullptr) {
    for (int i = 0; i < kStepsOfRound; ++i) bridge.step();
    service.feed_watchdog();
  }
  service.stopping();
  return 0;
}

}  // namespace skein::ros2
