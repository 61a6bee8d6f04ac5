// SPDX-License-Identifier: Apache-2.0
#include "search_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "skein/planning/area_search.hpp"
#include "skein/wording/wording.hpp"

namespace skein::groundstation {
namespace {

using mission::AreaSearch;
using mission::SearchShare;

constexpr double kHectare_m2 = 1e4;
/// A search that is called off counts as worse than any number of vehicles that leave one.
constexpr std::uint32_t kCalledOffEdition = 1000;

std::string vehicles_text(const std::vector<VehicleId>& vehicles) {
  return (vehicles.size() == 1 ? "vehicle " : "vehicles ") + typed_ids(vehicles);
}

std::string lanes_text(const mission::ShareProgress& progress) {
  return fmt::format("{} {} with {:.1f} km", progress.lanes_left,
                     progress.lanes_left == 1 ? "lane" : "lanes", progress.left_m / 1000.0);
}

std::string share_text(const AreaSearch& area, const SearchShare& share, std::int64_t epoch_unix_ns,
                       Instant now) {
  const auto progress = mission::progress_of(area, share, now);
  const std::string until =
      progress.ends
          ? fmt::format(", done in {}, at {}", duration_text(to_seconds(*progress.ends - now)),
                        wording::moment_text(*progress.ends, epoch_unix_ns))
          : "";
  switch (share.state) {
    case SearchShare::State::waits:
      return fmt::format("waits for its next route: {} of {} left{}", lanes_text(progress),
                         share.all, until);
    case SearchShare::State::flies:
      return fmt::format("flies: {} of {} left{}", lanes_text(progress), share.all, until);
    case SearchShare::State::done:
      return fmt::format("has flown its share of {} lanes", share.all);
    case SearchShare::State::left:
      return fmt::format("flies it no more: {}; {} of {} are not flown", share.why,
                         lanes_text(progress), share.all);
    case SearchShare::State::count:
      break;
  }
  return "";
}

std::string state_text(const AreaSearch& area) {
  switch (area.state) {
    case AreaSearch::State::flown:
      return "is being searched";
    case AreaSearch::State::over:
      return "is flown to its end";
    default:
      return "is called off: " + area.why;
  }
}

/// "; vehicle 3: it holds"
std::string who_left(const AreaSearch& area) {
  std::string text;
  for (const auto& [id, share] : area.shares) {
    if (share.state != SearchShare::State::left) continue;
    fmt::format_to(std::back_inserter(text), "; {}: {}", wording::text_of(id), share.why);
  }
  return text;
}

struct Whom {
  const std::vector<VehicleId>& searching;

  [[nodiscard]] static bool ends(mission::CommandKind kind) {
    using enum mission::CommandKind;
    return kind == hold || kind == return_home || kind == land;
  }
  std::vector<VehicleId> operator()(const Order& order) const {
    if (!ends(order.kind)) return {};
    return order.vehicle == kGroundStation ? searching : std::vector<VehicleId>{order.vehicle};
  }
  std::vector<VehicleId> operator()(const OrderToSeveral& order) const {
    return ends(order.kind) ? order.vehicles : std::vector<VehicleId>{};
  }
  std::vector<VehicleId> operator()(const ReturnPreview& preview) const {
    return preview.vehicles.empty() ? searching : preview.vehicles;
  }
  template <class Other>
  std::vector<VehicleId> operator()(const Other& /*asks nothing of them*/) const {
    return {};
  }
};

}  // namespace

std::string duration_text(double seconds) {
  const auto whole = std::max(0L, std::lround(seconds));
  if (whole < 120) return fmt::format("{} s", whole);
  if (whole < 7200) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

std::string searched_text(const mission::GroundSearch& search) {
  const double area_ha = planning::area_m2(search.area()->corners) / kHectare_m2;
  return fmt::format("{:.1f} of {:.1f} ha searched ({:.0f} %)", search.seen() * area_ha, area_ha,
                     std::floor(100.0 * search.seen()));
}

std::string progress_text(const mission::GroundSearch& search, std::int64_t epoch_unix_ns,
                          Instant now) {
  const auto& area = search.area();
  if (!area) return "";
  std::string text = fmt::format("the area {}: {}, {:.0f} % when all is flown\n", state_text(*area),
                                 searched_text(search), std::floor(100.0 * area->planned));
  if (const auto ends = mission::expected_end(*area, now)) {
    const double late_s = to_seconds(*ends - area->ends);
    fmt::format_to(std::back_inserter(text), "expected to be done in {}, at {}{}\n",
                   duration_text(to_seconds(*ends - now)),
                   wording::moment_text(*ends, epoch_unix_ns),
                   late_s < 5.0 ? "" : ", " + duration_text(late_s) + " later than planned");
  }
  for (const auto& [id, share] : area->shares) {
    fmt::format_to(std::back_inserter(text), "{:>7}  {}\n", id.value,
                   share_text(*area, share, epoch_unix_ns, now));
  }
  if (search.leaves_rest()) text += "'search rest' shares out what was not seen\n";
  return text;
}

std::string ends_search_text(const mission::GroundSearch& search,
                             const std::vector<VehicleId>& vehicles) {
  std::vector<VehicleId> of = search.searching();
  std::erase_if(of,
                [&](VehicleId id) { return std::ranges::find(vehicles, id) == vehicles.end(); });
  if (of.empty()) return "";
  return fmt::format("it ends the search of {}: {}; 'search rest' shares out what is left\n",
                     vehicles_text(of), searched_text(search));
}

std::string ends_search_text(const mission::GroundSearch& search, const Input& order) {
  return ends_search_text(search, std::visit(Whom{search.searching()}, order));
}

std::optional<console::EndedSearch> ended_search(const mission::GroundSearch& search) {
  const auto& area = search.area();
  if (!area) return std::nullopt;
  console::EndedSearch ended;
  ended.begun = area->begins;
  std::uint32_t left = 0;
  bool only_found = true;
  for (const auto& [id, share] : area->shares) {
    if (share.state != SearchShare::State::left) continue;
    ++left;
    only_found = only_found && share.has_found;
    ended.since = std::max(ended.since, share.left_at);
  }
  if (area->state == AreaSearch::State::called_off) {
    ended.what = fmt::format("search called off: {}; {}", searched_text(search), area->why);
    ended.since = area->called_off_at;
    ended.edition = kCalledOffEdition;
    ended.is_wanted = area->by_operator;
    return ended;
  }
  if (left == 0) return std::nullopt;
  const bool is_flown = area->state == AreaSearch::State::flown;
  if (!is_flown && !search.leaves_rest()) return std::nullopt;
  ended.what = fmt::format("{}: {}{}", is_flown ? "some search no more" : "search ended unfinished",
                           searched_text(search), who_left(*area));
  ended.edition = is_flown ? left : kCalledOffEdition;
  // It goes on as it is meant to, until what is left is known.
  ended.is_wanted = is_flown && only_found;
  return ended;
}

}  // namespace skein::groundstation
