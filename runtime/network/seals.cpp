// SPDX-License-Identifier: Apache-2.0
#include "seals.hpp"

#include <chrono>
#include <utility>

namespace skein::network {

Instant steady_now() {
  return Instant{
      std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch())};
}

Seals::Seals(const seal::SenderStart& start, const seal::EpochKey& key, seal::CounterRange counters,
             std::map<Place, VehicleId> nodes)
    : sealer{start, key, counters}, news{start.sender}, peers{std::move(nodes)}, key_{key} {
  opener.accept(key);
}

std::uint8_t Seals::epoch() const {
  const std::lock_guard lock{mutex_};
  return key_.epoch;
}

void Seals::change_key(const seal::EpochKey& key, Duration old_for) {
  const std::lock_guard lock{mutex_};
  opener.accept(key_, steady_now() + old_for);
  opener.accept(key);
  sealer.change(key);
  key_ = key;
}

}  // namespace skein::network
