// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "prompt_words.hpp"
#include "skein/base/angles.hpp"
#include "skein/base/text.hpp"
#include "skein/codec/json_text.hpp"
#include "skein/console/sections.hpp"
#include "skein/groundstation/orders.hpp"

namespace skein::groundstation {
namespace {

using codec::Json;
using codec::ParsedJson;

constexpr double kIdMax = 65535.0;

/// Reads members, and keeps the first that is wrong.
class Reader {
 public:
  explicit Reader(const ParsedJson& json) : json_{json} {}

  [[nodiscard]] bool has(const char* name) const { return json_.contains(name); }
  double number(const char* name, const Limit& limit) {
    const auto found = json_.find(name);
    if (found != json_.end() && found->is_number() && limit.has(found->get<double>())) {
      return found->get<double>();
    }
    fail(fmt::format("{} is to be a number from {} to {}", name, limit.low, limit.high));
    return limit.low;
  }
  std::uint32_t integer(const char* name, double low, double high) {
    const auto found = json_.find(name);
    if (found == json_.end() || !found->is_number_integer()) {
      fail(fmt::format("{} is to be a whole number", name));
      return 0;
    }
    return static_cast<std::uint32_t>(number(name, {low, high}));
  }
  std::vector<double> numbers(const char* name, const Limit& limit, std::size_t most) {
    std::vector<double> values;
    const auto found = json_.find(name);
    const bool list = found != json_.end() && found->is_array() && found->size() <= most;
    for (std::size_t i = 0; list && i < found->size(); ++i) {
      const auto& value = (*found)[i];
      if (value.is_number() && limit.has(value.get<double>()))
        values.push_back(value.get<double>());
    }
    if (!list || values.size() != found->size()) {
      fail(fmt::format("{} is to be a list of {} numbers at most, from {} to {}", name, most,
                       limit.low, limit.high));
    }
    return values;
  }
  /// None twice, in their order.
  std::vector<VehicleId> vehicles(const char* name, std::size_t most) {
    std::vector<VehicleId> all;
    for (const double id : numbers(name, {1.0, kIdMax}, most)) {
      if (id != std::floor(id)) fail(fmt::format("{} is to be a list of whole numbers", name));
      all.push_back({static_cast<std::uint16_t>(id)});
    }
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }
  bool flag(const char* name) {
    const auto found = json_.find(name);
    if (found != json_.end() && found->is_boolean()) return found->get<bool>();
    fail(fmt::format("{} is to be true or false", name));
    return false;
  }
  /// Pairs [east, north].
  std::vector<Vec2> points(const char* name, const Limit& limit, std::size_t most) {
    const auto found = json_.find(name);
    const bool is_list = found != json_.end() && found->is_array() && found->size() <= most;
    std::vector<Vec2> points;
    const auto is_good = [&limit](const ParsedJson& value) {
      return value.is_number() && limit.has(value.get<double>());
    };
    if (is_list) {
      for (const ParsedJson& pair : *found) {
        if (!pair.is_array() || pair.size() != 2 || !is_good(pair[0]) || !is_good(pair[1])) break;
        points.emplace_back(pair[0].get<double>(), pair[1].get<double>());
      }
    }
    if (!is_list || points.size() != found->size()) {
      fail(fmt::format("{} is to be at most {} pairs [east, north], each from {} to {}", name, most,
                       limit.low, limit.high));
    }
    return points;
  }
  std::string text(const char* name) {
    const auto found = json_.find(name);
    if (found != json_.end() && found->is_string()) return found->get<std::string>();
    fail(fmt::format("{} is to be a text", name));
    return "";
  }
  /// One of an enumeration, by its name.
  template <class E>
  E one_of(const char* name) {
    const auto wanted = text(name);
    for (std::size_t i = 0; i < static_cast<std::size_t>(E::count); ++i) {
      if (to_string(static_cast<E>(i)) == wanted) return static_cast<E>(i);
    }
    fail(fmt::format("there is no {} '{}'", name, wanted));
    return E{};
  }
  void fail(std::string why) {
    if (!wrong_) wrong_ = Error{std::move(why)};
  }
  [[nodiscard]] const std::optional<Error>& wrong() const { return wrong_; }

 private:
  const ParsedJson& json_;
  std::optional<Error> wrong_;
};

constexpr std::size_t kAcknowledgedMax = 300;

Input command(Reader& from) {
  Order order;
  order.kind = from.one_of<mission::CommandKind>("command");
  order.vehicle = {static_cast<std::uint16_t>(from.integer("vehicle", 0.0, kIdMax))};
  return order;
}

Input command_to_several(Reader& from) {
  OrderToSeveral order;
  order.kind = from.one_of<mission::CommandKind>("command");
  // Each pilot gives his own.
  if (order.kind == mission::CommandKind::give_back) from.fail("give_back is to one vehicle");
  order.vehicles = from.vehicles("vehicles", kVehiclesPerOrderMax);
  if (order.vehicles.empty()) from.fail("vehicles is to name at least one");
  return order;
}

Input decision(Reader& from) {
  Decision decision;
  decision.site = {static_cast<std::uint16_t>(from.integer("site", 1.0, kIdMax))};
  decision.grant = from.flag("grant");
  const auto coalition = console::coalition_of(from.text("coalition"));
  if (!coalition) from.fail("coalition is to be the key of one");
  decision.plan = coalition::Round{coalition.value_or(coalition::CoalitionId{}),
                                   from.integer("round", 0.0, 4294967295.0)};
  if (from.has("override")) decision.although_silent = from.flag("override");
  return decision;
}

std::vector<Vec2> outline(Reader& from) {
  auto corners = from.points("corners", kCoordinate_m, planning::kAreaCornersMax);
  if (auto why = planning::why_no_area(corners)) from.fail(*std::move(why));
  return corners;
}

Input hazard(Reader& from) {
  NewHazard hazard;
  if (from.has("preview")) hazard.preview = from.flag("preview");
  if (from.has("hazard")) {
    hazard.changes = HazardId{static_cast<std::uint16_t>(from.integer("hazard", 1.0, kIdMax))};
  }
  if (from.has("corners")) {
    hazard.corners = outline(from);
    return hazard;
  }
  hazard.centre_m = {from.number("x", kCoordinate_m), from.number("y", kCoordinate_m)};
  hazard.radius_m = from.number("radius_m", kHazardRadius_m);
  return hazard;
}

Input fence(Reader& from) {
  NewFence order;
  order.preview = from.flag("preview");
  order.fence.corners = from.points("corners", kCoordinate_m, Fence::kCornersMax);
  order.fence.height_max_m = from.number("height_m", kFenceHeight_m);
  return order;
}

template <class T>
void take(Reader& from, const char* name, const Limit& limit, std::optional<T>& value) {
  if (from.has(name)) value = static_cast<T>(from.number(name, limit));
}

Input search(Reader& from) {
  SearchArea order;
  order.preview = from.flag("preview");
  mission::SearchWishes& wishes = order.wishes;
  const bool is_rest = from.has("rest") && from.flag("rest");
  if (!is_rest) wishes.corners = outline(from);
  if (from.has("vehicles")) {
    wishes.vehicles = from.vehicles("vehicles", planning::kAreaSearchersMax);
  }
  take(from, "spacing_m", kLaneSpacing_m, wishes.spacing_m);
  take(from, "in_s", kRoutesIn_s, wishes.in_s);
  return order;
}

Input site_order(Reader& from) {
  NewSite order;
  order.preview = from.flag("preview");
  SiteWishes& wishes = order.wishes;
  if (from.has("site")) {
    order.changes = SiteId{static_cast<std::uint16_t>(from.integer("site", 1.0, kIdMax))};
  }
  if (!order.changes || from.has("x")) {
    wishes.place_m = Vec2{from.number("x", kCoordinate_m), from.number("y", kCoordinate_m)};
  }
  if (from.has("like")) wishes.like = from.text("like");
  if (from.has("bearings_deg")) {
    wishes.bearings_rad = from.numbers("bearings_deg", kHeading_deg, kTasksPerKindMax);
    for (double& bearing : *wishes.bearings_rad) bearing = heading_from_compass_deg(bearing);
  }
  take(from, "interval_s", limit_of(configuration::kDeliveryInterval_s), wishes.interval_s);
  take(from, "assessments", kTasks, wishes.assessments);
  take(from, "wait_s", limit_of(configuration::kAssessmentWait_s), wishes.assessment_wait_s);
  take(from, "dwell_s", limit_of(configuration::kAssessmentDwell_s), wishes.assessment_dwell_s);
  take(from, "survey_s", limit_of(configuration::kSurveyDwell_s), wishes.survey_dwell_s);
  take(from, "reward", limit_of(configuration::kSiteReward), wishes.reward);
  take(from, "decay_per_s", limit_of(configuration::kRewardDecay_per_s), wishes.reward_decay_per_s);
  if (from.has("vehicle")) {
    wishes.surveyor = VehicleId{static_cast<std::uint16_t>(from.integer("vehicle", 1.0, kIdMax))};
  }
  if (from.has("anyway")) wishes.anyway = from.flag("anyway");
  return order;
}

Input withdrawal(Reader& from) {
  if (from.has("routes")) {
    (void)from.flag("routes");
    return CallOffRoutes{};
  }
  if (from.has("hazard")) {
    return WithdrawHazard{{static_cast<std::uint16_t>(from.integer("hazard", 1.0, kIdMax))}};
  }
  if (from.has("decision")) {
    return TakeBack{{static_cast<std::uint16_t>(from.integer("decision", 1.0, kIdMax))}};
  }
  return WithdrawSite{{static_cast<std::uint16_t>(from.integer("site", 1.0, kIdMax))}};
}

Input proposal_answer(Reader& from) {
  return ProposalAnswer{from.integer("number", 1.0, kIdMax), from.flag("accept")};
}

/// By number: what has come since the page was drawn is not meant.
Input acknowledgement(Reader& from) {
  Acknowledge order;
  for (const double number : from.numbers("alarms", {1.0, 4294967295.0}, kAcknowledgedMax)) {
    order.numbers.push_back(static_cast<std::uint32_t>(number));
    if (static_cast<double>(order.numbers.back()) != number)
      from.fail("alarms is to have whole numbers");
  }
  if (order.numbers.empty()) from.fail("alarms is to have the number of one at least");
  return order;
}

Input formation_order(Reader& from) {
  Formation input;
  input.preview = from.flag("preview");
  input.order.kind = from.one_of<mission::OrderKind>("order");
  const bool along = input.order.kind == mission::OrderKind::fly_along;
  if (input.order.kind == mission::OrderKind::reshape) from.fail("a page orders form");
  if (!along && input.order.kind != mission::OrderKind::form) return input;
  if (along) {
    input.track = from.text("track");
    if (from.has("speed_mps")) input.speed_mps = from.number("speed_mps", kTrackSpeed_mps);
    if (from.has("laps")) {
      input.laps = static_cast<int>(from.integer("laps", kLaps.low, kLaps.high));
    }
  }
  formation::ShapeSpec& shape = input.order.shape;
  const std::string name = from.text("shape");
  const auto known = shape_named(name);
  shape.kind = known.value_or(formation::ShapeKind::free);
  if (!known) input.shape = name;
  input.has_spacing = from.has("spacing_m");
  if (input.has_spacing) shape.spacing_m = from.number("spacing_m", kSpacing_m);
  input.has_heading = from.has("heading_deg");
  if (input.has_heading) {
    shape.heading_rad = heading_from_compass_deg(from.number("heading_deg", kHeading_deg));
  }
  input.has_centre = from.has("x");
  if (input.has_centre) {
    shape.centre = {from.number("x", kCoordinate_m), from.number("y", kCoordinate_m),
                    from.number("z", kCoordinate_m)};
  }
  if (from.has("places")) input.order.places = from.integer("places", kPlaces.low, kPlaces.high);
  return input;
}

}  // namespace

Result<Input> read_order(std::string_view text) {
  const ParsedJson json = codec::parse_json(text);
  if (!json.is_object()) return Error{"an order is a JSON object"};
  Reader from{json};
  const std::string kind = from.text("kind");
  const auto of_kind = [&]() -> Input {
    if (kind == "command") return command(from);
    if (kind == "commands") return command_to_several(from);
    if (kind == "decision") return decision(from);
    if (kind == "hazard") return hazard(from);
    if (kind == "fence") return fence(from);
    if (kind == "search") return search(from);
    if (kind == "site") return site_order(from);
    if (kind == "withdraw") return withdrawal(from);
    if (kind == "proposal") return proposal_answer(from);
    if (kind == "formation") return formation_order(from);
    if (kind == "acknowledge") return acknowledgement(from);
    if (kind == "take_command") return TakeCommand{as_text(from.text("reason"), kReasonMax)};
    if (kind == "hand_over") return HandOver{};
    from.fail("there is no order '" + kind + "'");
    return {};
  };
  Result<Input> input = of_kind();
  if (from.wrong()) return *from.wrong();
  return input;
}

std::string limits_json() {
  const auto range = [](const Limit& limit) { return Json::array({limit.low, limit.high}); };
  return codec::json_text({{"coordinate_m", range(kCoordinate_m)},
                           {"hazard_radius_m", range(kHazardRadius_m)},
                           {"fence_height_m", range(kFenceHeight_m)},
                           {"spacing_m", range(kSpacing_m)},
                           {"heading_deg", range(kHeading_deg)},
                           {"places", range(kPlaces)},
                           {"tasks", range(kTasks)},
                           {"interval_s", range(limit_of(configuration::kDeliveryInterval_s))},
                           {"dwell_s", range(limit_of(configuration::kAssessmentDwell_s))},
                           {"reward", range(limit_of(configuration::kSiteReward))}});
}

}  // namespace skein::groundstation
