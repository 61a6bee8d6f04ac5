// SPDX-License-Identifier: Apache-2.0
#include "area_words.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "prompt_words.hpp"

namespace skein::groundstation {
namespace {

/// From that word on as long as they are places.
Result<std::vector<Vec2>> corners_of(const Words& words, std::size_t& next) {
  std::vector<Vec2> corners;
  while (next < words.size() && words[next].find(',') != std::string_view::npos) {
    const auto place = place_of(words[next]);
    if (!place) return place.error();
    corners.push_back(*place);
    ++next;
  }
  if (auto why = planning::why_no_area(corners)) return Error{*std::move(why)};
  return corners;
}

std::string corners_line(const std::vector<Vec2>& corners) {
  std::string line;
  for (const Vec2& corner : corners) line += fmt::format(" {},{}", corner.x(), corner.y());
  return line;
}

}  // namespace

Result<Input> hazard_order(const Words& words, bool preview) {
  NewHazard hazard;
  hazard.preview = preview;
  std::size_t next = 1;
  if (words[0] == "change") {
    const auto id = words.size() > 2 ? id_of(words[2]) : std::nullopt;
    if (!id) {
      return Error{
          "'change hazard' needs its number, and its new shape, as in "
          "'change hazard 10012 1200 -300 250'"};
    }
    hazard.changes = HazardId{*id};
    next = 3;
  }
  if (next < words.size() && words[next] == "polygon") {
    auto corners = corners_of(words, ++next);
    if (!corners) return corners.error();
    hazard.corners = *std::move(corners);
    if (next < words.size()) {
      return Error{fmt::format("'{}' is no corner EAST,NORTH of a polygon", words[next])};
    }
    return Input{hazard};
  }
  if (words.size() != next + 3) {
    return Error{
        "'hazard' needs three numbers, EAST NORTH RADIUS in metres, as in "
        "'hazard 1200 -300 250', or 'polygon' and its corners EAST,NORTH; 'hazards' lists those "
        "that are known"};
  }
  const auto east = number_after("hazard EAST", words[next], kCoordinate_m);
  const auto north = number_after("hazard EAST NORTH", words[next + 1], kCoordinate_m);
  const auto radius = number_after("hazard EAST NORTH RADIUS", words[next + 2], kHazardRadius_m);
  for (const auto* number : {&east, &north, &radius}) {
    if (!*number) return number->error();
  }
  hazard.centre_m = {*east, *north};
  hazard.radius_m = *radius;
  return Input{hazard};
}

Result<Input> search_order(const Words& words, bool preview) {
  if (words.size() == 1 && !preview) return Input{View::search};
  SearchArea order;
  order.preview = preview;
  std::size_t next = 1;
  if (next < words.size() && words[next] == "rest") {
    ++next;
  } else {
    auto corners = corners_of(words, next);
    if (!corners) return corners.error();
    order.wishes.corners = *std::move(corners);
  }
  while (next < words.size()) {
    const auto keyword = words[next++];
    if (keyword != "by" && keyword != "spacing" && keyword != "in") {
      return Error{fmt::format("'{}' is none of by IDS, spacing M, in S", keyword)};
    }
    if (next == words.size()) return Error{fmt::format("'{}' needs a number after it", keyword)};
    const auto word = words[next++];
    if (keyword == "by") {
      auto vehicles = ids_of(word);
      if (!vehicles) {
        return Error{
            fmt::format("'by' needs numbers of vehicles, such as 1,2,5-9, not '{}'", word)};
      }
      order.wishes.vehicles = *std::move(vehicles);
      continue;
    }
    const bool is_time = keyword == "in";
    const auto value = number_after(keyword, word, is_time ? kRoutesIn_s : kLaneSpacing_m);
    if (!value) return value.error();
    (is_time ? order.wishes.in_s : order.wishes.spacing_m) = *value;
  }
  return Input{order};
}

std::string hazard_line(const NewHazard& hazard) {
  std::string line = hazard.preview ? "preview " : "";
  line += hazard.changes ? fmt::format("change hazard {}", hazard.changes->value) : "hazard";
  if (!hazard.corners.empty()) return line + " polygon" + corners_line(hazard.corners);
  return line + fmt::format(" {} {} {}", hazard.centre_m.x(), hazard.centre_m.y(), hazard.radius_m);
}

std::string search_line(const SearchArea& search) {
  const mission::SearchWishes& wishes = search.wishes;
  std::string line = search.preview ? "preview search" : "search";
  line += wishes.corners.empty() ? " rest" : corners_line(wishes.corners);
  for (std::size_t i = 0; i < wishes.vehicles.size(); ++i) {
    line += fmt::format("{}{}", i == 0 ? " by " : ",", wishes.vehicles[i].value);
  }
  if (wishes.spacing_m) line += fmt::format(" spacing {}", *wishes.spacing_m);
  if (wishes.in_s) line += fmt::format(" in {}", *wishes.in_s);
  return line;
}

}  // namespace skein::groundstation
