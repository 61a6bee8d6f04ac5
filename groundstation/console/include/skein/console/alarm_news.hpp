// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "skein/base/time.hpp"
#include "skein/mission/messages.hpp"

namespace skein::console {

/// What events have told of that goes on until another event, or the picture, ends it.
class AlarmNews {
 public:
  static constexpr std::size_t kMax = 1000;  ///< of which the oldest give way
  /// So long what is told once is shown.
  static constexpr Duration kTold = std::chrono::seconds{60};

  enum class Topic : std::uint8_t {
    separation,         ///< vehicle: who says so; other
    traffic,            ///< vehicle; detail: the aircraft's address
    range_spent,        ///< vehicle
    orders_unknown,     ///< vehicle
    id_in_use,          ///< vehicle
    landing_barred,     ///< vehicle
    setup_differs,      ///< vehicle: who says so; other
    task_lost,          ///< site and task in detail; vehicle: whose it was
    task_unknown,       ///< the same
    formation_lost,     ///< vehicle
    change_refused,     ///< vehicle
    change_waits,       ///< vehicle
    order_waits,        ///< of the script
    autopilot,          ///< vehicle
    not_landed,         ///< vehicle
    command_elsewhere,  ///< since it was taken from here
    nobody_commands,
    traffic_unseen,  ///< by the receivers of this ground station
    told             ///< once; detail: a running number
  };
  struct Key {
    Topic topic{};
    VehicleId vehicle{};
    VehicleId other{};
    SiteId site{};
    std::uint64_t detail = 0;
    auto operator<=>(const Key&) const = default;
  };
  struct Item {
    Instant since{};
    std::string what;
    TaskId task = {};
    bool grave = false;                   ///< act now
    std::optional<Instant> closest = {};  ///< when two come closest to each other
  };

  void on_event(const mission::MissionEvent& event, Instant now);
  void on_command(bool nobody, Instant now);
  /// What keeps receivers from telling of aircraft; empty where nothing does.
  void on_receivers(const std::string& trouble, Instant now);
  void drop(const Key& key) { items_.erase(key); }

  /// Until when, by its own clock, what a vehicle says of itself may still have a conflict that it
  /// has told to be over since.
  [[nodiscard]] Instant clear_since(VehicleId vehicle) const;
  [[nodiscard]] const std::map<Key, Item>& items() const { return items_; }
  /// Those of one topic: [first, last).
  [[nodiscard]] auto of(Topic topic) const {
    const auto next = static_cast<Topic>(static_cast<std::uint8_t>(topic) + 1);
    return std::pair{items_.lower_bound(Key{topic}), items_.lower_bound(Key{next})};
  }

 private:
  struct Reader;
  void begin(const Key& key, Item item);
  void end(Topic topic, VehicleId vehicle);
  void tell(VehicleId vehicle, Instant now, std::string what);
  void forget(VehicleId vehicle);

  std::map<Key, Item> items_;
  std::map<VehicleId, Instant> clear_since_;
  std::uint64_t told_ = 0;
  bool commanded_here_ = false;
};

}  // namespace skein::console
