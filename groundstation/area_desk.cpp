// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/area_desk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "search_words.hpp"
#include "skein/codec/json_text.hpp"
#include "skein/groundstation/views.hpp"
#include "skein/planning/circle_cover.hpp"
#include "skein/wording/wording.hpp"

namespace skein::groundstation {
namespace {

using codec::Json;
using mission::AreaSearch;

constexpr double kRouteStep_m = 25.0;  ///< of a polyline, on arcs
constexpr std::size_t kRoutePointsMax = 500;

Answer refusal(const Error& error) { return {false, error.message + "\n"}; }

Json number(double value, int decimals) {
  const double unit = std::pow(10.0, decimals);
  return std::round(value * unit) / unit;
}

Json place(const Vec2& at) { return Json::array({number(at.x(), 1), number(at.y(), 1)}); }

Json places(const std::vector<Vec2>& corners) {
  Json all = Json::array();
  for (const Vec2& corner : corners) all.push_back(place(corner));
  return all;
}

Json points_of(const Path& path) {
  Json points = Json::array();
  double begun_m = 0.0;
  for (const Segment& segment : path.segments) {
    const double steps =
        segment.curvature_per_m == 0.0 ? 1.0 : std::ceil(segment.length_m / kRouteStep_m);
    for (double k = 0.0; k < steps && points.size() < kRoutePointsMax; ++k) {
      points.push_back(place(path.pose_at(begun_m + segment.length_m * k / steps).position()));
    }
    begun_m += segment.length_m;
  }
  points.push_back(place(path.end().position()));
  return points;
}

Json area_json(const AreaSearch& area, Instant now) {
  Json shares = Json::array();
  for (const auto& [id, share] : area.shares) {
    const auto progress = mission::progress_of(area, share, now);
    Json lanes = Json::array();
    for (const auto& lane : share.lanes) {
      const Vec2 from = lane.start.position();
      const Vec2 to = lane.end().position();
      lanes.push_back(Json::array(
          {number(from.x(), 1), number(from.y(), 1), number(to.x(), 1), number(to.y(), 1)}));
    }
    shares.push_back({{"id", id.value},
                      {"state", to_string(share.state)},
                      {"why", share.why},
                      {"lanes", share.all},
                      {"lanes_left", progress.lanes_left},
                      {"left_m", number(progress.left_m, 0)},
                      {"done_s", progress.ends ? number(to_seconds(*progress.ends), 0) : nullptr},
                      {"length_m", number(share.length_m, 0)},
                      {"time_s", number(share.time_s, 0)},
                      {"ways", std::move(lanes)},
                      {"points", points_of(share.route.path)}});
  }
  Json without = Json::array();
  for (const auto& [id, why] : area.without) without.push_back({{"id", id.value}, {"why", why}});
  const auto expected = mission::expected_end(area, now);
  return {{"state", to_string(area.state)},
          {"why", area.why},
          {"area_m2", number(planning::area_m2(area.corners), 0)},
          {"expected_s", expected ? number(to_seconds(*expected), 0) : nullptr},
          {"corners", places(area.corners)},
          {"sensor_radius_m", number(area.sensor_radius_m, 1)},
          {"spacing_m", number(area.spacing_m, 1)},
          {"planned", number(area.planned, 4)},
          {"least_s", number(area.bound_s, 0)},
          {"begins_s", number(to_seconds(area.begins), 1)},
          {"ends_s", number(to_seconds(area.ends), 1)},
          {"parts", area.parts},
          {"shares", std::move(shares)},
          {"without", std::move(without)}};
}

/// What will be, or is.
std::string plan_text(const AreaSearch& area, Instant now) {
  std::string text = fmt::format(
      "{:.1f} ha in lanes {:.0f} m apart, by {} vehicles: begins in {:.0f} s, covered in {} ({} "
      "without turns); {:.1f} % of it\n",
      planning::area_m2(area.corners) / 1e4, area.spacing_m, area.shares.size(),
      to_seconds(area.begins - now), duration_text(to_seconds(area.ends - now)),
      duration_text(area.bound_s), 100.0 * area.planned);
  if (area.planned < 0.9995) {
    text += "the rest is out of range, or there is no room for turns\n";
  }
  if (area.parts > 1) {
    text += fmt::format(
        "each flies {} routes one after another: the next is told when all have flown theirs\n",
        area.parts);
  }
  for (const auto& [id, share] : area.shares) {
    fmt::format_to(std::back_inserter(text), "{}: {} {}, {:.1f} km, {}\n", wording::text_of(id),
                   share.all, share.all == 1 ? "lane" : "lanes", share.length_m / 1000.0,
                   duration_text(share.time_s));
  }
  for (const auto& [id, why] : area.without) {
    fmt::format_to(std::back_inserter(text), "without {}: {}\n", wording::text_of(id), why);
  }
  return text;
}

std::string shape_text(const mission::HazardGroup& group) {
  if (group.shape.corners.empty()) return "a circle that was changed";
  return fmt::format("{} circles hold the polygon, and shut out {:.0f} % more",
                     group.circles.size(), 100.0 * group.more);
}

}  // namespace

Answer AreaDesk::answer(const SearchArea& order, Instant now) {
  json_until_ = Instant::min();
  const auto area = order.preview ? node_->preview_search(order.wishes, now)
                                  : node_->give_search(order.wishes, now);
  if (!area) return refusal(area.error());
  Json data = area_json(*area, now);
  data["kind"] = "search";
  return {true,
          (order.preview ? "" : fmt::format("plan {} is offered; ", area->plan)) +
              plan_text(*area, now),
          codec::json_text(data)};
}

Answer AreaDesk::answer(const NewHazard& order, Instant now) {
  const mission::HazardShape shape{order.corners, order.centre_m, order.radius_m};
  if (order.preview) {
    if (order.corners.empty()) return {true, "a circle\n" + bars_text(order, now)};
    const auto cover = planning::cover_with_circles(order.corners);
    if (!cover) return refusal(cover.error());
    Json data{{"kind", "hazard"}, {"circles", Json::array()}};
    for (const auto& circle : cover->circles) {
      data["circles"].push_back(
          Json::array({number(circle.centre.x(), 1), number(circle.centre.y(), 1),
                       number(circle.radius_m, 1)}));
    }
    return {true,
            fmt::format("{} circles hold the polygon, and shut out {:.0f} % more\n",
                        cover->circles.size(), 100.0 * cover->more()) +
                bars_text(order, now),
            codec::json_text(data)};
  }
  const std::string bars = bars_text(order, now);
  HazardId id = order.changes.value_or(HazardId{});
  if (order.changes) {
    const auto changed = node_->hazards().change(id, shape, now);
    if (!changed) return refusal(changed.error());
  } else {
    const auto added = node_->hazards().add(shape, now);
    if (!added) return refusal(added.error());
    id = *added;
  }
  const auto group = node_->hazards().groups().find(id);
  const bool is_polygon = group != node_->hazards().groups().end() && !order.corners.empty();
  const std::string what = is_polygon ? "; " + shape_text(group->second) : "";
  if (!order.changes) {
    return {true, fmt::format("hazard {} is told to all{}\n{}", id.value, what, bars)};
  }
  return {true, fmt::format("hazard {} is changed; the old one stands until all know the new "
                            "one{}\n{}",
                            id.value, what, bars)};
}

/// Whose search it ends.
std::string AreaDesk::bars_text(const NewHazard& order, Instant now) const {
  std::vector<Hazard> hazards;
  if (order.corners.empty()) {
    hazards.push_back({{}, order.centre_m, order.radius_m});
  } else if (const auto cover = planning::cover_with_circles(order.corners)) {
    for (const auto& circle : cover->circles)
      hazards.push_back({{}, circle.centre, circle.radius_m});
  }
  return ends_search_text(node_->searches(), node_->searches().barred_by(hazards, now));
}

Answer AreaDesk::answer(const WithdrawHazard& order, Instant now) {
  const HazardId number = node_->hazards().number_of(order.hazard);
  const auto group = node_->hazards().groups().find(number);
  std::string of_several;
  if (group != node_->hazards().groups().end() && group->second.circles.size() > 1) {
    of_several = fmt::format(" with all of its {} circles", group->second.circles.size());
  }
  const auto withdrawn = node_->hazards().withdraw(order.hazard, now);
  if (!withdrawn) return refusal(withdrawn.error());
  return {true, fmt::format("hazard {} is withdrawn{}\n", number.value, of_several)};
}

std::string AreaDesk::hazards_text() const {
  const auto& groups = node_->hazards().groups();
  std::string text;
  for (const Hazard& hazard : node_->hazards().known()) {
    const HazardId number = node_->hazards().number_of(hazard.id);
    const auto group = groups.find(number);
    const bool of_polygon = group != groups.end() && !group->second.shape.corners.empty();
    if (of_polygon && group->second.circles.front() != hazard.id) continue;
    fmt::format_to(std::back_inserter(text), "hazard {}: ", number.value);
    if (of_polygon) {
      fmt::format_to(std::back_inserter(text), "polygon of {} corners, the first {} of the origin",
                     group->second.shape.corners.size(),
                     wording::place_text(group->second.shape.corners.front()));
      fmt::format_to(std::back_inserter(text), "; {}\n", shape_text(group->second));
    } else {
      text += circle_text(hazard) + "\n";
    }
  }
  return text.empty() ? "no hazard is known\n" : text;
}

std::string AreaDesk::text(Instant now) const {
  std::string text;
  for (const auto& [id, group] : node_->hazards().groups()) {
    fmt::format_to(std::back_inserter(text), "hazard {}: {}\n", id.value, shape_text(group));
  }
  if (!node_->searches().area()) return text + "no area is searched\n";
  return text + progress_text(node_->searches(), epoch_unix_ns_, now);
}

const std::string& AreaDesk::json(Instant now) {
  if (now >= json_until_) {
    json_ = made_json(now);
    ended_ = ended_search(node_->searches());
    json_until_ = now + kJsonPeriod;
  }
  return json_;
}

std::string AreaDesk::made_json(Instant now) const {
  Json hazards = Json::array();
  for (const auto& [id, group] : node_->hazards().groups()) {
    Json circles = Json::array();
    for (const HazardId circle : group.circles) circles.push_back(circle.value);
    hazards.push_back({{"hazard", id.value},
                       {"corners", places(group.shape.corners)},
                       {"x", number(group.shape.centre_m.x(), 1)},
                       {"y", number(group.shape.centre_m.y(), 1)},
                       {"radius_m", number(group.shape.radius_m, 1)},
                       {"more", number(group.more, 3)},
                       {"circles", std::move(circles)}});
  }
  Json search = nullptr;
  if (const auto& area = node_->searches().area()) {
    search = area_json(*area, now);
    search["seen"] = number(node_->searches().seen(), 3);
    search["rest"] = node_->searches().leaves_rest();
  }
  return codec::json_text({{"search", std::move(search)}, {"hazards", std::move(hazards)}});
}

}  // namespace skein::groundstation
