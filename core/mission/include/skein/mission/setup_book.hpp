// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/bounded_queue.hpp"
#include "skein/base/time.hpp"
#include "skein/mission/messages.hpp"

namespace skein::mission {

/// FNV-1a, 32 bits, over the bytes: the same on every machine and in every release.
[[nodiscard]] std::uint32_t setup_hash(std::string_view text);

/// What nodes must have in common, as its place in the configuration ("origin.latitude_deg"), and
/// what it is set to here.
struct CommonKey {
  std::string name;
  std::uint32_t value = 0;  ///< setup_hash() of the value as text
  friend bool operator==(const CommonKey&, const CommonKey&) = default;
};

/// Has the mission begun before this program did? Then orders may stand that it does not know.
[[nodiscard]] constexpr bool starts_anew(Instant now) {
  return now >= Instant{} + std::chrono::seconds{2};
}

struct SetupParams {
  std::vector<CommonKey> common;  ///< kSetupItemsMax at most
  /// Clocks that differ by more do not work together. It is noticed where the other's is ahead by
  /// more than this and the message's delay; no message arrives before it is sent, so it is never
  /// noticed where it is not so.
  Duration clock_guard = std::chrono::milliseconds{500};
};

/// As a Setup tells them.
[[nodiscard]] std::vector<SetupItem> items_of(const SetupParams& params);

/// In what another node differs from this one; or that two programs speak under its number, which
/// may be this node's own.
struct SetupDifference {
  std::string keys;          ///< with commas; empty: the clock alone
  double clock_ahead_s = 0;  ///< of the other; 0: within the guard
  friend bool operator==(const SetupDifference&, const SetupDifference&) = default;
};
/// "another origin.latitude_deg", "a clock that is 3.0 s ahead": what a sentence goes on with.
[[nodiscard]] std::string text_of(const SetupDifference& difference);

/// What this node runs with, told to all every kPeriod, and at once where somebody new is heard:
/// the more rarely the more are new, and the more nodes there are beyond kTeam, so that each has no
/// more to judge; and what of that others run with too. `now` is of this node's clock and never
/// decreases.
class SetupBook {
 public:
  static constexpr Duration kPeriod = std::chrono::seconds{5};
  static constexpr Duration kPeriodWhileNew = std::chrono::seconds{1};
  static constexpr std::size_t kTeam = 32;
  static constexpr std::size_t kNodesMax = 1024;

  SetupBook(const SetupParams& params, VehicleId self, InstanceId instance, Instant now);

  /// Of who may say it (may_say()).
  void on_setup(const Setup& setup, Instant now);
  /// That node has said, by its clock, that it was `then`: its telemetry, many times a second.
  void on_time(VehicleId node, Instant then, Instant now) {
    if (then > now + params_.clock_guard) on_ahead(node, then - now, now);
  }

  /// Told in it: the orders that this node knows of.
  struct Orders {
    bool known = true;
    std::uint64_t newest = 0;
  };
  [[nodiscard]] std::optional<Setup> poll_setup(const Orders& orders, Instant now);
  /// Says it at the next poll_setup(), whenever it was said before.
  void say_at_once() { next_ = Instant::min(); }
  /// What has changed in what others have in common with this one.
  [[nodiscard]] std::optional<EventBody> poll_news() { return news_.pop(); }
  [[nodiscard]] Instant next_timeout() const { return next_; }

  /// Has that node told anything of its setup or its clock?
  [[nodiscard]] bool knows(VehicleId node) const { return nodes_.contains(node); }
  /// Null for a node that runs with the same, or has told nothing yet.
  [[nodiscard]] const SetupDifference* difference(VehicleId node) const;

 private:
  /// A clock counts as within the guard again after so many setups in which it was, so far apart:
  /// those that waited for this program while it stood still are late, which looks like it.
  static constexpr int kClean = 3;
  static constexpr Duration kCleanApart = kPeriodWhileNew / 2;
  struct Node {
    InstanceId instance = {};
    std::string keys = {};
    double ahead_s = 0;
    int clean = 0;
    Instant clean_at = {};                 ///< the last of them came
    std::vector<InstanceId> earlier = {};  ///< that were heard before, the newest last
    std::optional<Instant> twin_at = {};   ///< an earlier one was heard again
    std::optional<SetupDifference> difference = {};
  };

  [[nodiscard]] std::string differing_keys(const Setup& setup) const;
  void watch_clock(Node& node, const Setup& setup, Instant now) const;
  void on_ahead(VehicleId id, Duration ahead, Instant now);
  void compare(VehicleId id, Node& node, Instant now);
  void say_soon(Instant now);
  [[nodiscard]] Duration in_this_team(Duration period) const;
  void forget_twins(Instant now);

  SetupParams params_;
  Setup own_;
  std::map<std::uint32_t, const CommonKey*> by_key_;
  std::map<VehicleId, Node> nodes_;
  std::size_t told_ = 0;   ///< nodes that have told their setup, which is proven
  bool suspects_ = false;  ///< some node has had a twin, or another clock
  Instant said_at_ = Instant::min();
  /// After the last: doubled while somebody new comes again and again, as where all start at once.
  Duration soon_ = kPeriod;
  bool hurried_ = false;  ///< the next is said sooner than its period asks for
  Instant next_;
  BoundedQueue<EventBody> news_{64};
};

}  // namespace skein::mission
