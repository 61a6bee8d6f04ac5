// SPDX-License-Identifier: Apache-2.0
#include "ether.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "skein/base/assert.hpp"
#include "skein/codec/codec.hpp"

namespace skein::hil {
namespace {

constexpr double kAnywhere_m = std::numeric_limits<double>::infinity();

/// As sent alone on the air, with the headers of IP, UDP and seal.
std::size_t bytes_of(const mission::Message& message) {
  constexpr std::size_t kHeaders = 60;
  return codec::encode(message).value_or(codec::Bytes{}).size() + kHeaders;
}

}  // namespace

Ether::Ether(const TeamMission& mission)
    : vehicles_{mission.vehicles.size()},
      clocks_agree_{std::ranges::none_of(
          mission.faults, [](const Fault& f) { return std::holds_alternative<ClockOff>(f.what); })},
      radio_{mission.radio, mission.seed},
      positions_{mission.vehicles.size() + 2},
      mesh_{mission.radio.mesh ? std::optional<radio::Mesh>{*mission.radio.mesh} : std::nullopt} {
  for (const auto& v : mission.vehicles) {
    stations_.push_back({{v.spec.id, Vec2{0.0, 0.0}}, v.number(), false});
  }
  stations_.push_back({{kGroundStation, std::nullopt}, kGroundStation});
  if (has_second_station(mission.faults)) {
    stations_.push_back({{kSecondStation, std::nullopt}, kGroundStation});
  }
  channels_.resize(stations_.size());
}

std::size_t Ether::index_of(VehicleId id) const {
  const auto found = std::ranges::find_if(
      stations_, [id](const Station& station) { return station.node.id == id; });
  SKEIN_ASSERT(found != stations_.end());
  return static_cast<std::size_t>(found - stations_.begin());
}

void Ether::place(std::size_t vehicle, const Vec2& position) {
  stations_[vehicle].node.position = position;
  positions_.set(vehicle, position);
}

void Ether::step(Instant now) {
  for (const radio::Flood& by : radio_.interference().floods) flood(by, now);
}

void Ether::route(Instant now) {
  if (!mesh_) return;
  places_.clear();
  for (const Station& station : stations_) {
    places_.push_back(station.node);
    places_.back().on = station.on;
  }
  mesh_->move(radio_.params(), radio_.interference(), places_, now);
}

void Ether::broadcast(std::size_t from, mission::Message message, Instant now,
                      const Watches& watches) {
  const std::size_t bytes = radio_.params().bytes_per_s ? bytes_of(message) : 0;
  Said said{std::make_shared<const Content>(std::move(message)), bytes};
  const auto* telemetry = std::get_if<mission::Telemetry>(&std::get<mission::Message>(*said.what));
  // Ground stations are the last, and the first to hear.
  for (std::size_t to = ground(); to < stations_.size(); ++to) {
    if (to != from) post(from, to, hops_between(from, to), said, now);
  }
  // Between most vehicles their distance alone decides, and that is looked at here.
  const bool anywhere = mesh_ || healed() || from >= ground();
  const bool near_hears = !anywhere && radio_.interference().cuts.empty();
  positions_.find_near(from, anywhere ? kAnywhere_m : radio_.params().range_m, near_);
  for (const std::size_t to : near_) {
    if (to == from || to >= ground()) continue;
    said.only_wakes = telemetry != nullptr && !watches(to, *telemetry);
    post(from, to, near_hears ? 1 : hops_between(from, to), said, now);
  }
}

int Ether::hops_between(std::size_t from, std::size_t to) const {
  if (mesh_) return mesh_->hops(from, to);
  return radio_.hears(stations_[from].node, stations_[to].node) ? 1 : 0;
}

void Ether::flood(const radio::Flood& by, Instant now) {
  if (!radio_.params().bytes_per_s) return;
  const std::size_t from = index_of(by.vehicle);
  const auto datagrams =
      static_cast<int>(std::lround(radio::Flood::kDatagrams_per_s * to_seconds(InFlight::kStep)));
  for (std::size_t to = 0; to < stations_.size(); ++to) {
    if (to == from || !stations_[from].on || !stations_[to].on) continue;
    for (int i = 0; i < datagrams; ++i) {
      (void)radio_.carry(hops_between(from, to), channels_[to], by.vehicle, radio::Flood::kBytes,
                         now);
    }
  }
}

void Ether::post(std::size_t from, std::size_t to, int hops, const Said& said, Instant now) {
  if (hops == 0 || !stations_[to].on) return;
  const VehicleId sender = stations_[from].number;
  for (const Duration delay : radio_.carry(hops, channels_[to], sender, said.bytes, now)) {
    if (said.only_wakes && clocks_agree_) {
      in_flight_.post_wake(now + delay, to, sender, said.what);
    } else {
      in_flight_.post({now + delay, 0, to, sender, 0, said.what, false, stations_[from].start});
    }
  }
}

}  // namespace skein::hil
