// SPDX-License-Identifier: Apache-2.0
#include "skein/console/team_fence.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "skein/codec/json.hpp"
#include "skein/wording/wording.hpp"

namespace skein::console {
namespace {

using codec::Json;

double to_tenths(double metres) { return std::round(metres * 10.0) / 10.0; }

double area_m2(const std::vector<Vec2>& corners) {
  double twice = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    twice += cross(corners[i], corners[(i + 1) % corners.size()]);
  }
  return std::abs(twice) / 2.0;
}

}  // namespace

std::string_view to_string(Keeps keeps) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(Keeps::count)> kNames{
      "this", "another", "none", "not_known"};
  return kNames.at(static_cast<std::size_t>(keeps));
}

std::string_view words_of(Keeps keeps) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(Keeps::count)> kWords{
      "keeps it", "keeps another one", "keeps none", "has not told"};
  return kWords.at(static_cast<std::size_t>(keeps));
}

std::map<VehicleId, Keeps> fence_keepers(const Fence& fence, const mission::Fleet& fleet) {
  std::map<VehicleId, Keeps> keepers;
  const std::uint32_t ours = digest_of(fence);
  for (const auto& [id, known] : fleet.vehicles()) {
    Keeps keeps = Keeps::not_known;
    if (known.health && !known.silent) {
      const std::uint32_t theirs = known.health->fence;
      keeps = theirs == 0 ? Keeps::none : theirs == ours ? Keeps::this_one : Keeps::another;
    }
    keepers[id] = keeps;
  }
  return keepers;
}

std::string fence_size(const Fence& fence) {
  return fmt::format("{} corners, {:.2f} km2, up to {:g} m", fence.corners.size(),
                     area_m2(fence.corners) / 1e6, fence.height_max_m);
}

std::string fence_text(const Picture& picture, const mission::Fleet& fleet) {
  const Fence& fence = picture.fence();
  if (!fence.exists()) return "no fence is ordered or configured\n";
  const auto order = picture.fence_order();
  std::string text = fmt::format(
      "fence {}: {}\n", order == 0 ? "of the configuration" : fmt::format("of order {}", order),
      fence_size(fence));
  for (const Vec2& corner : fence.corners) {
    fmt::format_to(std::back_inserter(text), "  {:.0f} east {:.0f} north\n", corner.x(),
                   corner.y());
  }
  fmt::format_to(std::back_inserter(text), "at its edge: {}\n", kFenceAction);
  for (const auto& [id, keeps] : fence_keepers(fence, fleet)) {
    fmt::format_to(std::back_inserter(text), "{}: {}\n", wording::text_of(id), words_of(keeps));
  }
  return text;
}

std::string fence_json(const Picture& picture, const mission::Fleet& fleet) {
  const Fence& fence = picture.fence();
  if (!fence.exists()) return codec::json_text(nullptr);
  Json corners = Json::array();
  for (const Vec2& corner : fence.corners) {
    corners.push_back(Json::array({to_tenths(corner.x()), to_tenths(corner.y())}));
  }
  Json keepers = Json::array();
  for (const auto& [id, keeps] : fence_keepers(fence, fleet)) {
    keepers.push_back({{"id", id.value}, {"keeps", to_string(keeps)}});
  }
  const auto order = picture.fence_order();
  return codec::json_text({{"order", order == 0 ? Json(nullptr) : Json(order)},
                           {"corners", std::move(corners)},
                           {"height_m", to_tenths(fence.height_max_m)},
                           {"action", kFenceAction},
                           {"keepers", std::move(keepers)}});
}

}  // namespace skein::console
