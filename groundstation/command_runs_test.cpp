// SPDX-License-Identifier: Apache-2.0
//
// Two ground stations and six vehicles in virtual time, over links that are cut and mended, with
// ground stations that are killed and start anew, and operators who take the command whenever they
// like.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "skein/base/random.hpp"
#include "skein/groundstation/command_desk.hpp"
#include "skein/mission/ground_node.hpp"
#include "skein/mission/may_say.hpp"
#include "skein/mission/newest_station.hpp"
#include "skein/mission/order_book.hpp"

namespace skein::groundstation {
namespace {

using mission::Command;
using mission::CommandKind;
using mission::Message;

constexpr std::size_t kStations = 2;
constexpr std::size_t kVehicles = 6;
constexpr std::size_t kNodes = kStations + kVehicles;
constexpr Duration kStep = std::chrono::milliseconds{50};
constexpr double kTroubleUntil_s = 100.0;
constexpr double kEnd_s = 180.0;

std::vector<VehicleId> fleet() {
  std::vector<VehicleId> all;
  for (std::uint16_t id = 1; id <= kVehicles; ++id) all.push_back(VehicleId{id});
  return all;
}

/// What of a vehicle has to do with who commands it.
struct Vehicle {
  VehicleId id;
  mission::NewestStation station;
  std::uint64_t newest = 0;
  CommandKind obeys = CommandKind::resume;
  std::optional<InstanceId> heard;  ///< the newest ground station, as the test sees it
  Instant heard_at;
  bool obeyed_an_older = false;

  void hear(const Message& message, InstanceId from, Instant now) {
    if (!station.heeds(from)) return;
    heard_at = now;
    const bool older = heard && from < *heard;
    const auto* command = std::get_if<Command>(&message);
    const bool ours = command != nullptr &&
                      (command->vehicle == id || command->vehicle == kGroundStation) &&
                      number_of(*command) > newest;
    obeyed_an_older = obeyed_an_older || older;
    heard = std::max(heard.value_or(from), from);
    if (!ours) return;
    newest = number_of(*command);
    obeys = command->kind;
  }
  [[nodiscard]] Message setup(Instant now) const {
    mission::Setup said;
    said.node = id;
    said.instance = {id.value};
    said.time = now;
    said.clock_guard = std::chrono::milliseconds{500};
    said.knows_orders = true;
    said.newest_order = newest;
    return said;
  }
  [[nodiscard]] Message health(Instant now) const {
    mission::Health said;
    said.vehicle = id;
    if (heard) said.heard.push_back({kGroundStation, now - heard_at});
    return said;
  }
  [[nodiscard]] Message telemetry(Instant now) const {
    mission::Telemetry said;
    said.vehicle = id;
    said.instance = {id.value};
    said.state.time = now;
    return said;
  }
};

/// As Commanding has them, on a network that is a list.
class Station {
 public:
  Station(std::uint16_t number, bool watches, Instant now)
      : desk_{{number, "ridge-" + std::to_string(number), watches}, {}, now}, node_{config(), now} {
    node_.watch(now);
  }

  void hear(const Message& message, VehicleId sender, InstanceId instance, Instant now) {
    switch (desk_.on_message(message, sender, instance, now)) {
      case CommandDesk::Heard::own:
      case CommandDesk::Heard::word:
        return;
      case CommandDesk::Heard::superseded:
        speaks_as_.reset();
        node_.watch(now);
        break;
      case CommandDesk::Heard::others:
        break;
    }
    node_.on_message(message, sender, now);
  }
  /// As process::start_voice() has it.
  void take(InstanceId start, Instant now) {
    speaks_as_ = start;
    node_.take_command(start, now);
    node_.say(desk_.take(start, "", "", now));
  }
  std::vector<Message> said(Instant now) {
    std::vector<Message> all;
    node_.on_timeout(now);
    while (auto message = node_.poll_message()) all.push_back(*std::move(message));
    if (auto word = desk_.poll_word(now)) all.push_back(*std::move(word));
    while (node_.poll_event()) continue;
    return all;
  }
  bool order(VehicleId vehicle, CommandKind kind, Instant now) {
    return desk_.is_commanding() && node_.command(vehicle, kind, now).ok();
  }

  [[nodiscard]] const CommandDesk& desk() const { return desk_; }
  [[nodiscard]] const std::optional<InstanceId>& speaks_as() const { return speaks_as_; }

 private:
  static mission::GroundNodeConfig config() {
    mission::GroundNodeConfig node;
    node.agent.expected = fleet();
    node.setup.clock_guard = std::chrono::milliseconds{500};
    return node;
  }

  CommandDesk desk_;
  mission::GroundNode node_;
  std::optional<InstanceId> speaks_as_;
};

class World {
 public:
  explicit World(std::uint64_t seed) : random_{seed} {
    for (const VehicleId id : fleet())
      vehicles_.push_back({id, {}, 0, CommandKind::resume, {}, {}, false});
    stations_[0].emplace(1, false, now_);
    stations_[1].emplace(2, true, now_);
    for (auto& row : up_) row.fill(true);
  }

  void run() {
    for (; now_ < at_seconds(kEnd_s); now_ += kStep) {
      if (now_ < at_seconds(kTroubleUntil_s)) {
        trouble();
      } else {
        heal();
      }
      deliver();
      for (std::size_t i = 0; i < kStations; ++i) speak(i);
      for (Vehicle& vehicle : vehicles_) speak(vehicle);
    }
  }

  void judge() const {
    std::vector<const Station*> commanding;
    for (const auto& station : stations_) {
      if (station && station->desk().is_commanding()) commanding.push_back(&*station);
    }
    ASSERT_EQ(commanding.size(), 1U) << "one is in command";
    const InstanceId start = *commanding.front()->speaks_as();
    for (const Vehicle& vehicle : vehicles_) {
      EXPECT_FALSE(vehicle.obeyed_an_older) << vehicle.id.value;
      EXPECT_EQ(vehicle.heard, start) << vehicle.id.value;
      // What the one in command has ordered since it has it.
      std::optional<CommandKind> last;
      for (const Ordered& order : ordered_) {
        const bool concerned = order.vehicle == vehicle.id || order.vehicle == kGroundStation;
        if (order.by == start && concerned) last = order.kind;
      }
      if (!last) continue;
      EXPECT_EQ(vehicle.obeys, *last) << "vehicle " << vehicle.id.value;
      ++orders_judged_;
    }
    for (const auto& station : stations_) {
      EXPECT_FALSE(station && station->desk().nobody_commands(now_));
    }
  }
  [[nodiscard]] std::size_t handed_over() const { return starts_.size(); }
  [[nodiscard]] std::size_t both_at_once() const { return both_; }
  [[nodiscard]] std::size_t orders_judged() const { return orders_judged_; }

 private:
  struct Ordered {
    InstanceId by;
    VehicleId vehicle;
    CommandKind kind;
  };
  struct OnItsWay {
    std::size_t to;
    Message message;
    VehicleId sender;
    InstanceId instance;
  };

  bool chance(double per_s) { return random_.uniform(0.0, 1.0) < per_s * to_seconds(kStep); }

  void trouble() {
    for (std::size_t i = 0; i < kStations; ++i) {
      if (!stations_[i] && chance(0.1))
        stations_[i].emplace(static_cast<std::uint16_t>(i + 1), i == 1, now_);
      if (stations_[i] && chance(0.008)) stations_[i].reset();
      if (stations_[i] && !stations_[i]->desk().why_not_take(now_) && chance(0.03)) take(i);
      if (stations_[i] && chance(0.15)) {
        const bool all = random_.uniform(0.0, 1.0) < 0.3;
        const VehicleId to = all ? kGroundStation : vehicles_[random_.index(kVehicles)].id;
        const CommandKind kind =
            random_.uniform(0.0, 1.0) < 0.5 ? CommandKind::hold : CommandKind::resume;
        const auto by = stations_[i]->speaks_as();
        if (stations_[i]->order(to, kind, now_)) ordered_.push_back({*by, to, kind});
      }
    }
    if (!chance(0.1)) return;
    // Two parts that do not hear each other, or all do again.
    const bool cuts = random_.uniform(0.0, 1.0) < 0.6;
    std::array<bool, kNodes> side{};
    for (bool& one : side) one = cuts && random_.uniform(0.0, 1.0) < 0.5;
    for (std::size_t a = 0; a < kNodes; ++a) {
      for (std::size_t b = 0; b < kNodes; ++b) up_[a][b] = side[a] == side[b];
    }
  }

  void heal() {
    for (auto& row : up_) row.fill(true);
    // An operator who is told that nobody is in command takes it.
    if (now_ < at_seconds(kTroubleUntil_s + 15.0)) return;
    const bool any = std::ranges::any_of(
        stations_, [](const auto& one) { return one && one->desk().is_commanding(); });
    for (std::size_t i = 0; !any && i < kStations; ++i) {
      if (!stations_[i]) stations_[i].emplace(static_cast<std::uint16_t>(i + 1), true, now_);
      if (stations_[i]->desk().nobody_commands(now_)) return take(i);
    }
    // And who is told that some do not heed it takes it again.
    for (std::size_t i = 0; i < kStations; ++i) {
      if (stations_[i] && !stations_[i]->desk().unheeding(now_).empty()) take(i);
    }
  }

  void take(std::size_t i) {
    // Its own starts are on its disk, with those that it has heard of others.
    if (const auto heard = stations_[i]->desk().newest()) {
      counted_[i] = std::max(counted_[i], heard->value >> 24U);
    }
    const bool knows =
        stations_[i]->desk().newest() && stations_[i]->desk().unheeding(now_).empty();
    counted_[i] += knows ? 1 : 200;
    const InstanceId start{counted_[i] << 24U | random_.index(1U << 24U)};
    starts_.insert(start);
    stations_[i]->take(start, now_);
  }

  void speak(std::size_t i) {
    if (!stations_[i]) return;
    if (stations_[i]->desk().takes_by_itself(now_)) take(i);
    const auto as = stations_[i]->speaks_as();
    for (Message& message : stations_[i]->said(now_)) {
      ASSERT_TRUE(as) << "who watches says nothing";
      say(i, message, kGroundStation, *as);
    }
    const bool both = std::ranges::all_of(
        stations_, [](const auto& one) { return one && one->desk().is_commanding(); });
    both_ += both ? 1 : 0;
  }

  void speak(Vehicle& vehicle) {
    const std::size_t self = kStations + vehicle.id.value - 1U;
    const auto step = now_.time_since_epoch() / kStep;
    if ((step + vehicle.id.value) % 20 == 0) say(self, vehicle.telemetry(now_), vehicle.id, {});
    if ((step + vehicle.id.value) % 20 == 10) say(self, vehicle.health(now_), vehicle.id, {});
    if ((step + vehicle.id.value) % 100 == 0) say(self, vehicle.setup(now_), vehicle.id, {});
  }

  /// What is said best effort may be lost; what is not is said again until it is there.
  void say(std::size_t from, const Message& message, VehicleId sender, InstanceId instance) {
    const bool best_effort = std::holds_alternative<mission::Setup>(message) ||
                             std::holds_alternative<mission::Health>(message) ||
                             std::holds_alternative<mission::Telemetry>(message);
    for (std::size_t to = 0; to < kNodes; ++to) {
      if (to == from || !up_[from][to]) continue;
      if (best_effort && random_.uniform(0.0, 1.0) < 0.1) continue;
      const Instant at = now_ + from_seconds(random_.uniform(0.02, 0.15));
      Instant& last = arrived_[{from, to}];
      last = std::max(last, at);
      on_their_way_.emplace(last, OnItsWay{to, message, sender, instance});
    }
  }

  void deliver() {
    while (!on_their_way_.empty() && on_their_way_.begin()->first <= now_) {
      const OnItsWay one = on_their_way_.begin()->second;
      on_their_way_.erase(on_their_way_.begin());
      if (one.to < kStations) {
        if (stations_[one.to]) {
          stations_[one.to]->hear(one.message, one.sender, one.instance, now_);
        }
      } else if (one.sender == kGroundStation) {
        vehicles_[one.to - kStations].hear(one.message, one.instance, now_);
      }
    }
  }

  Random random_;
  Instant now_ = at_seconds(-5.0);
  std::array<std::optional<Station>, kStations> stations_;
  std::array<std::uint64_t, kStations> counted_{3, 1};  ///< starts, as on their disks
  std::vector<Vehicle> vehicles_;
  std::array<std::array<bool, kNodes>, kNodes> up_{};
  std::multimap<Instant, OnItsWay> on_their_way_;
  std::map<std::pair<std::size_t, std::size_t>, Instant> arrived_;
  std::vector<Ordered> ordered_;
  std::set<InstanceId> starts_;
  std::size_t both_ = 0;
  mutable std::size_t orders_judged_ = 0;
};

TEST(CommandRuns, OneIsInCommandAndObeyedInTheEndWhateverHappened) {
  std::size_t handed_over = 0;
  std::size_t both = 0;
  std::size_t orders = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    World world{seed};
    world.run();
    world.judge();
    if (HasFatalFailure() || HasNonfatalFailure()) return;
    handed_over += world.handed_over();
    both += world.both_at_once();
    orders += world.orders_judged();
  }
  // The runs are of what they are meant to be of.
  EXPECT_GT(handed_over, 800U);
  EXPECT_GT(both, 100U) << "parts that are cut off have one each, for a while";
  EXPECT_GT(orders, 200U);
}

}  // namespace
}  // namespace skein::groundstation
