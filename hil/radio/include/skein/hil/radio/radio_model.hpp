// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/base/ids.hpp"
#include "skein/base/random.hpp"
#include "skein/base/static_vector.hpp"
#include "skein/base/time.hpp"

/// The one radio of simulator and bench: who hears whom, and what becomes of each message. Pure;
/// what is random is drawn from the generator that is handed in.
namespace skein::hil::radio {

/// That nodes pass on what others say, hop by hop.
struct MeshParams {
  int hops_max = 8;
  /// How old routes may be. None: everything is said to all, and who hears it first passes it on,
  /// so that it takes whatever ways there are (measured: docs/mesh.md). Where routes are looked up,
  /// batman-adv takes 5 s to find another.
  Duration mend{};
  bool ground_relays = true;  ///< the ground station passes on, too
};

/// What a radio is when nothing goes wrong.
struct RadioParams {
  double range_m = 1500.0;          ///< vehicle to vehicle (Wang 2022: r_n)
  double ground_range_m = 20000.0;  ///< vehicle to ground station, which is at the mission origin
  Duration delay = std::chrono::milliseconds{60};
  Duration jitter = std::chrono::milliseconds{30};  ///< the delay varies by up to this, either way
  double loss = 0.0;                                ///< probability, of each message by itself
  std::optional<MeshParams> mesh{};                 ///< none: only who is in range is heard
  std::optional<double> bytes_per_s{};              ///< Link's
};

/// Messages that arrive twice, or after those that were sent later.
struct Disorder {
  double duplicates = 0.0;  ///< probability
  double held_back = 0.0;   ///< probability, of arriving up to held_back_max later
  Duration held_back_max{};
};

/// A radio that is worse than RadioParams for a time.
struct Disturbance {
  double loss = 0.0;  ///< where it is more than the radio's own
  Duration delay{};   ///< besides the radio's own
  Duration jitter{};
  std::optional<Disorder> disorder = std::nullopt;

  /// The larger of each.
  void add(const Disturbance& other);
};

/// The network is cut for a time: each group hears itself only, and so do those in no group.
struct Cut {
  enum class Kind : std::uint8_t {
    both_ways,
    one_way,  ///< a group is not heard by the others, and hears those in no group
    bridge    ///< but one node hears all, and all hear it
  };
  Kind kind = Kind::both_ways;
  std::vector<std::vector<VehicleId>> groups;  ///< 0 is the ground station
  VehicleId bridge;                            ///< where the kind is bridge

  [[nodiscard]] bool lets_through(VehicleId sender, VehicleId receiver) const;
};
/// One group apart from all others.
[[nodiscard]] Cut cut_off(std::vector<VehicleId> group, Cut::Kind kind = Cut::Kind::both_ways);
/// Each of the nodes by itself: they are silent, and deaf unless it is one way.
[[nodiscard]] Cut silence(const std::vector<VehicleId>& nodes,
                          Cut::Kind kind = Cut::Kind::both_ways);

/// A vehicle that says noise without end.
struct Flood {
  VehicleId vehicle;
  static constexpr double kDatagrams_per_s = 500.0;
  static constexpr std::size_t kBytes = 1000;  ///< each
};

/// All that is wrong with the radio at a moment.
struct Interference {
  Disturbance disturbance;
  std::vector<Cut> cuts;
  std::vector<Flood> floods;
  bool healed = false;  ///< nobody is out of range, and the radio itself loses nothing
};

struct Node {
  VehicleId id;
  std::optional<Vec2> position;  ///< mission frame; nothing: not known yet. Not of the ground.
  bool on = true;                ///< it hears, and is heard
};

/// How one node hears another at this moment.
struct Link {
  bool up = true;
  double loss = 0.0;  ///< probability, of each message by itself
  Duration delay{};
  Duration jitter{};  ///< the delay varies by up to this, either way
  std::optional<Disorder> disorder = std::nullopt;
  /// Of the channel that all share whom a node hears; none: there is always room.
  std::optional<double> bytes_per_s = std::nullopt;
};

/// Whether one node hears another at all. A vehicle whose position is not known is out of range of
/// other vehicles, and in that of the ground station.
[[nodiscard]] bool is_up(const RadioParams& params, const Interference& interference,
                         const Node& from, const Node& to);
/// How every link is that is up.
[[nodiscard]] Link link_when_up(const RadioParams& params, const Interference& interference);
/// What is as good as that many such links, one after the other; 0: none. Each takes its time of
/// the channel.
[[nodiscard]] Link over_hops(const Link& link, int hops);

/// The link where `rate` mission seconds pass in a real one.
[[nodiscard]] Link in_real_time(const Link& link, double rate);

/// How long a message is on its way: nothing where it is lost, twice where it is doubled. What is
/// drawn depends on the link alone: from one that is down, nothing.
using Arrivals = StaticVector<Duration, 2>;
[[nodiscard]] Arrivals carry(const Link& link, Random& random);

/// What a node hears, one after the other, as far as its channel has room.
class Channel {
 public:
  /// As above, of a message of that many bytes, headers included. It is lost where it would wait
  /// for longer than kWaitMax, or where its sender has more than half of the channel, as radios
  /// that listen before they speak share it.
  [[nodiscard]] Arrivals carry(const Link& link, VehicleId from, std::size_t bytes, Instant now,
                               Random& random);
  static constexpr Duration kWaitMax = std::chrono::seconds{1};
  /// So much of the channel's time a sender may have at once.
  static constexpr Duration kBurst = std::chrono::milliseconds{100};

 private:
  Instant free_at_{};
  std::map<VehicleId, Instant> half_free_at_;  ///< by sender, had it half of the channel
};

/// The radio as a simulator has it; the bench has a LinkTable and, in every process, the plugin.
class SimulatedRadio {
 public:
  SimulatedRadio(const RadioParams& params, std::uint64_t seed)
      : params_{params}, link_{link_when_up(params, {})}, random_{seed} {}

  /// From now on.
  void interfere(const Interference& interference) {
    interference_ = interference;
    link_ = link_when_up(params_, interference_);
  }
  [[nodiscard]] Arrivals carry(const Node& from, const Node& to) {
    return carry(hears(from, to) ? 1 : 0);
  }
  /// Over so many hops; 0: there is no way.
  [[nodiscard]] Arrivals carry(int hops) {
    if (hops == 0) return {};
    return radio::carry(hops == 1 ? link_ : over_hops(link_, hops), random_);
  }
  /// The same, where the receiver's channel has to have room.
  [[nodiscard]] Arrivals carry(int hops, Channel& channel, VehicleId from, std::size_t bytes,
                               Instant now) {
    if (hops == 0 || !link_.bytes_per_s) return carry(hops);
    return channel.carry(over_hops(link_, hops), from, bytes, now, random_);
  }
  [[nodiscard]] bool hears(const Node& from, const Node& to) const {
    return is_up(params_, interference_, from, to);
  }
  [[nodiscard]] const RadioParams& params() const { return params_; }
  [[nodiscard]] const Interference& interference() const { return interference_; }

 private:
  RadioParams params_;
  Interference interference_;
  Link link_;  ///< of all that are up; which are, changes with every movement
  Random random_;
};

}  // namespace skein::hil::radio
