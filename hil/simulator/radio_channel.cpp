// SPDX-License-Identifier: Apache-2.0
#include "radio_channel.hpp"

#include <algorithm>
#include <utility>

namespace skein::hil {
namespace {
constexpr double kHeldBackMax_s = 2.0;
}  // namespace

RadioChannel::RadioChannel(const TeamMission& mission, InFlight& air)
    : mission_{mission}, air_{air}, random_{mission.seed} {}

void RadioChannel::broadcast(const std::vector<RadioNode>& nodes, std::size_t from,
                             const mission::Message& message, Instant now) {
  const auto what = std::make_shared<const Content>(message);
  const RadioNode& sender = nodes[from];
  const std::size_t ground = nodes.size() - 1;
  if (from != ground) post(sender, nodes[ground], ground, what, now);
  const bool healed = mission_.faults.any() && now >= mission_.faults.healed_at;
  const double range2 = mission_.radio.range_m * mission_.radio.range_m;
  for (std::size_t to = 0; to < ground; ++to) {
    const RadioNode& receiver = nodes[to];
    if (to == from || !receiver.on) continue;
    if (from != ground && !healed && (receiver.position - sender.position).squaredNorm() > range2) {
      continue;
    }
    post(sender, receiver, to, what, now);
  }
}

void RadioChannel::post(const RadioNode& sender, const RadioNode& receiver, std::size_t to,
                        const std::shared_ptr<const Content>& what, Instant now) {
  const SimulatedRadio& radio = mission_.radio;
  const FaultSchedule& faults = mission_.faults;
  const bool healed = faults.any() && now >= faults.healed_at;
  const bool troubled = faults.any() && !healed;
  if (troubled && !faults.lets_through(sender.id, receiver.id, now)) return;
  const double loss = troubled ? std::max(radio.loss, faults.radio.loss) : radio.loss;
  if (random_.chance(healed ? 0.0 : loss)) return;
  const Duration jitter = radio.jitter + (troubled ? faults.radio.jitter : Duration{});
  const Duration delay = radio.delay + (troubled ? faults.radio.delay : Duration{});
  const auto arrival = [&] {
    return now + std::max(Duration{},
                          delay + from_seconds(random_.uniform(-1.0, 1.0) * to_seconds(jitter)));
  };
  Parcel parcel{arrival(), 0, to, sender.id, 0, what};
  if (!troubled) {
    air_.post(std::move(parcel));
    return;
  }
  if (random_.chance(faults.radio.held_back))
    parcel.at += from_seconds(random_.uniform(0.0, kHeldBackMax_s));
  air_.post(parcel);
  if (random_.chance(faults.radio.duplicates)) {
    parcel.at = arrival();
    air_.post(std::move(parcel));
  }
}

}  // namespace skein::hil
