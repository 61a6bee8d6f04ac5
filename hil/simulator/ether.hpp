// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "in_flight.hpp"
#include "skein/hil/radio/mesh.hpp"
#include "skein/hil/radio/positions.hpp"
#include "skein/hil/radio/radio_model.hpp"
#include "skein/hil/team_simulator.hpp"

namespace skein::hil {

/// A node of the simulated network.
struct Station {
  radio::Node node;
  VehicleId number;       ///< that it speaks under
  bool on = true;         ///< its program runs
  InstanceId start = {};  ///< of a ground station
};

/// The network between the simulated programs: who hears what is said, and when.
class Ether {
 public:
  explicit Ether(const TeamMission& mission);

  /// The vehicles in the mission's order, off; then the ground station, or both.
  [[nodiscard]] const std::vector<Station>& stations() const { return stations_; }
  /// The first, or only, ground station.
  [[nodiscard]] std::size_t ground() const { return vehicles_; }
  /// Precondition: there is one.
  [[nodiscard]] std::size_t index_of(VehicleId id) const;
  void turn(std::size_t station, bool on) { stations_[station].on = on; }
  void place(std::size_t vehicle, const Vec2& position);
  /// That ground station speaks so from now on.
  void start(std::size_t ground, InstanceId start) { stations_[ground].start = start; }

  void interfere(const radio::Interference& interference) { radio_.interfere(interference); }
  [[nodiscard]] bool healed() const { return radio_.interference().healed; }
  /// Call once a step: what floods takes its part of every channel in reach.
  void step(Instant now);
  /// A mesh finds its ways.
  void route(Instant now);

  /// To all who hear it. Telemetry goes, as what no more than wakes, to vehicles that do not watch
  /// its sender.
  using Watches = std::function<bool(std::size_t vehicle, const mission::Telemetry& told)>;
  void broadcast(std::size_t from, mission::Message message, Instant now, const Watches& watches);
  /// What is on its way.
  [[nodiscard]] InFlight& in_flight() { return in_flight_; }
  /// Waking says nothing: where the air has its price, vehicles pace their telemetry by that of
  /// others.
  [[nodiscard]] bool wakes_say_nothing() const { return !radio_.params().bytes_per_s; }

 private:
  [[nodiscard]] int hops_between(std::size_t from, std::size_t to) const;
  void flood(const radio::Flood& by, Instant now);
  struct Said {
    std::shared_ptr<const Content> what;
    std::size_t bytes = 0;
    bool only_wakes = false;
  };
  void post(std::size_t from, std::size_t to, int hops, const Said& said, Instant now);

  std::size_t vehicles_;
  /// Then the telemetry of others does no more than wake a vehicle. Else the time in it counts.
  bool clocks_agree_;
  InFlight in_flight_;
  radio::SimulatedRadio radio_;
  std::vector<Station> stations_;
  std::vector<radio::Channel> channels_;  ///< around each of them
  radio::Positions positions_;            ///< of them; ground stations have none
  std::vector<std::uint32_t> near_;       ///< to who sends
  std::optional<radio::Mesh> mesh_;       ///< none: only who is in range is heard
  std::vector<radio::Node> places_;       ///< for it
};

}  // namespace skein::hil
