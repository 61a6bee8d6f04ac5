// SPDX-License-Identifier: Apache-2.0
#include "connections.hpp"

#include <algorithm>
#include <utility>

namespace skein::console {

void Connections::Place::has_session() {
  const auto own = all_->places_.find(number_);
  if (own != all_->places_.end()) own->second.drop = nullptr;
}

Connections::Entries::iterator Connections::who_gives_way(const std::string& address) {
  const auto is_stranger = [](const auto& place) { return place.second.drop != nullptr; };
  const auto is_like_this = [&](const auto& place) {
    return is_stranger(place) && place.second.address == address;
  };
  const auto like_this = std::ranges::count_if(places_, is_like_this);
  if (static_cast<std::size_t>(like_this) >= kStrangersOfOneAddress) {
    return std::ranges::find_if(places_, is_like_this);
  }
  if (places_.size() < kMax) return places_.end();
  return std::ranges::find_if(places_, is_stranger);
}

std::shared_ptr<Connections::Place> Connections::enter(std::string address,
                                                       std::function<void()> drop) {
  if (const auto other = who_gives_way(address); other != places_.end()) {
    const auto drop_other = std::move(other->second.drop);
    places_.erase(other);
    drop_other();
  }
  if (places_.size() >= kMax) return nullptr;
  const std::uint64_t number = next_++;
  places_.emplace(number, Entry{std::move(address), std::move(drop)});
  return std::shared_ptr<Place>{new Place{*this, number}};
}

}  // namespace skein::console
