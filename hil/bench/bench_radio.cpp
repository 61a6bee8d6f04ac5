// SPDX-License-Identifier: Apache-2.0
#include "bench_radio.hpp"

#include <utility>

namespace skein::hil {

Result<void> BenchRadio::open() {
  auto table = radio::LinkTable::create();
  if (!table) return table.error();
  table_.emplace(std::move(table).value());
  return {};
}

void BenchRadio::move(const Moment& moment, const ExternalHosts& external, LinkListener* links) {
  places_.clear();
  for (const VehicleId id : nodes_) {
    const auto found = moment.positions.find(id);
    places_.push_back(
        {id, found == moment.positions.end() ? std::nullopt : std::optional{found->second},
         !moment.silent.contains(id)});
  }
  if (mesh_) mesh_->move(params_, moment.interference, places_, moment.now);
  const auto hop =
      radio::in_real_time(radio::link_when_up(params_, moment.interference), moment.rate);
  table_->set(hop);
  for (std::size_t to = 0; to < places_.size(); ++to) {
    radio::Hearing hearing{places_[to].id, hop, {}};
    for (std::size_t from = 0; from < places_.size(); ++from) {
      if (from == to) continue;
      const bool direct = is_up(params_, moment.interference, places_[from], places_[to]);
      const int hops = mesh_ ? mesh_->hops(from, to) : int{direct};
      table_->set_hops(places_[from].id, places_[to].id, hops);
      hearing.hops.at(places_[from].id.value) = static_cast<std::uint8_t>(hops);
      if (links != nullptr)
        links->tell(places_[from].id, places_[to].id, radio::over_hops(hop, int{direct}));
    }
    external.tell(hearing);
  }
  if (links != nullptr) links->hand_on();
}

}  // namespace skein::hil
