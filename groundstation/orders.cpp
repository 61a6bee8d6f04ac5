// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/orders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "area_words.hpp"
#include "fence_words.hpp"
#include "site_words.hpp"
#include "skein/base/angles.hpp"
#include "skein/wording/wording.hpp"

namespace skein::groundstation {
namespace {

std::string_view word_of(View view) {
  static constexpr std::array<std::string_view, 19> kWords{
      "help",  "status",    "sites",  "pending", "places",    "coalitions", "hazards",
      "audit", "proposals", "routes", "search",  "preflight", "fence",      "links",
      "wind",  "traffic",   "alarms", "command", "console"};
  return kWords.at(static_cast<std::size_t>(view));
}

std::string_view verb_of(mission::CommandKind kind) {
  static constexpr std::array<std::string_view, 5> kVerbs{"hold", "resume", "return", "give-back",
                                                          "land"};
  static_assert(kVerbs.size() == static_cast<std::size_t>(mission::CommandKind::count));
  return kVerbs.at(static_cast<std::size_t>(kind));
}

struct Line {
  std::string operator()(std::monostate /*empty*/) const { return ""; }
  std::string operator()(View view) const { return std::string{word_of(view)}; }
  std::string operator()(const Decision& decision) const {
    return fmt::format("{} {}{}", decision.grant ? "authorise" : "refuse", decision.site.value,
                       decision.although_silent ? " override" : "");
  }
  std::string operator()(const TakeBack& back) const {
    return fmt::format("withdraw decision {}", back.site.value);
  }
  std::string operator()(const Order& order) const {
    const std::string_view verb = verb_of(order.kind);
    return order.vehicle == kGroundStation ? fmt::format("{} all", verb)
                                           : fmt::format("{} {}", verb, order.vehicle.value);
  }
  std::string operator()(const Acknowledge& order) const {
    std::string line = "acknowledge";
    for (const std::uint32_t number : order.numbers) line += fmt::format(" {}", number);
    return order.numbers.empty() ? line + " all" : line;
  }
  std::string operator()(const OrderToSeveral& order) const {
    return fmt::format("{} {}", verb_of(order.kind), typed_ids(order.vehicles));
  }
  std::string operator()(const NewHazard& hazard) const { return hazard_line(hazard); }
  std::string operator()(const SearchArea& search) const { return search_line(search); }
  std::string operator()(const WithdrawHazard& hazard) const {
    return fmt::format("withdraw hazard {}", hazard.hazard.value);
  }
  std::string operator()(const NewFence& fence) const { return fence_line(fence); }
  std::string operator()(const NewSite& site) const { return site_line(site); }
  std::string operator()(const SitesFromFile& from) const { return "sites " + from.file; }
  std::string operator()(const WithdrawSite& site) const {
    return fmt::format("withdraw site {}", site.site.value);
  }
  std::string operator()(const RoutesFromFile& from) const {
    return fmt::format("{}routes {}{}", from.preview ? "preview " : "", from.file,
                       from.in_s ? fmt::format(" in {}", *from.in_s) : "");
  }
  std::string operator()(const PreflightOf& of) const {
    return fmt::format("preflight {}", of.vehicle.value);
  }
  std::string operator()(const StatusOf& of) const {
    return fmt::format("status {}", of.vehicle.value);
  }
  std::string operator()(const ReturnPreview& preview) const {
    std::string ids;
    for (const VehicleId id : preview.vehicles) {
      ids += fmt::format("{}{}", ids.empty() ? "" : ",", id.value);
    }
    return "preview return " + (ids.empty() ? "all" : ids);
  }
  std::string operator()(const CallOffRoutes& /*off*/) const { return "withdraw routes"; }
  std::string operator()(const ProposalAnswer& answer) const {
    return fmt::format("{} {}", answer.accept ? "accept" : "dismiss", answer.number);
  }
  std::string operator()(const Formation& formation) const {
    const formation::ShapeSpec& shape = formation.order.shape;
    std::string line = formation.preview ? "preview " : "";
    line += hyphened(to_string(formation.order.kind));
    const bool along = formation.order.kind == mission::OrderKind::fly_along;
    if (!along && formation.order.kind != mission::OrderKind::form) return line;
    if (along) line += " " + formation.track + " in";
    line += " " + (formation.shape.empty() ? hyphened(formation::to_string(shape.kind))
                                           : formation.shape);
    if (formation.has_spacing) line += fmt::format(" spacing {}", shape.spacing_m);
    if (formation.has_heading) {
      line += " heading " + wording::bearing_digits(shape.heading_rad);
    }
    if (formation.has_centre) {
      line += fmt::format(" at {} {} {}", shape.centre.x(), shape.centre.y(), shape.centre.z());
    }
    if (formation.speed_mps) line += fmt::format(" speed {}", *formation.speed_mps);
    if (formation.laps != 1) line += fmt::format(" laps {}", formation.laps);
    if (formation.order.places) line += fmt::format(" places {}", *formation.order.places);
    return line;
  }
  std::string operator()(const Wait& wait) const {
    return fmt::format("wait {}", to_seconds(wait.duration));
  }
  std::string operator()(const Record& record) const {
    return "record " + (record.folder.empty() ? "stop" : record.folder);
  }
  std::string operator()(const Quit& /*quit*/) const { return "quit"; }
  std::string operator()(const TakeCommand& take) const {
    return take.reason.empty() ? "take command" : "take command " + take.reason;
  }
  std::string operator()(const HandOver& /*over*/) const { return "hand over"; }
};

}  // namespace

std::string hyphened(std::string_view name) {
  std::string word{name};
  std::replace(word.begin(), word.end(), '_', '-');
  return word;
}

std::vector<std::string> shape_names() {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < static_cast<std::size_t>(formation::ShapeKind::free); ++i) {
    names.push_back(hyphened(formation::to_string(static_cast<formation::ShapeKind>(i))));
  }
  return names;
}

std::optional<formation::ShapeKind> shape_named(std::string_view name) {
  const auto names = shape_names();
  const auto found = std::find(names.begin(), names.end(), hyphened(name));
  if (found == names.end()) return std::nullopt;
  return static_cast<formation::ShapeKind>(found - names.begin());
}

std::string typed_ids(const std::vector<VehicleId>& vehicles) {
  std::string text;
  for (std::size_t i = 0; i < vehicles.size();) {
    std::size_t end = i;
    while (end + 1 < vehicles.size() && vehicles[end + 1].value == vehicles[end].value + 1) ++end;
    if (!text.empty()) text += ',';
    text += std::to_string(vehicles[i].value);
    if (end > i) text += (end > i + 1 ? "-" : ",") + std::to_string(vehicles[end].value);
    i = end + 1;
  }
  return text;
}

std::string line_of(const Input& input) { return std::visit(Line{}, input); }

}  // namespace skein::groundstation
