// SPDX-License-Identifier: Apache-2.0
#include "skein/configuration/reference.hpp"

#include "field_types.hpp"
#include "number_text.hpp"

namespace skein::configuration {
namespace {

std::string code(std::string_view word) { return std::string(1, '`').append(word).append("`"); }

std::string joined_path(std::string path, std::string_view key) {
  if (!path.empty() && !key.empty()) path += '.';
  return path.append(key);
}

/// Prints the tables as Markdown: one table a group of keys, defaults from a default struct.
class ReferencePage final : public FieldVisitor {
 public:
  std::string print(const Fields& fields) {
    groups_.push_back({"", "The file", ""});
    fields(*this);
    std::string page;
    for (const Group& group : groups_) {
      page += "\n## " + (group.path.empty() ? "" : code(group.path) + ": ") + group.title +
              "\n\n| key | value | default | meaning |\n|---|---|---|---|\n" + group.rows;
    }
    return page;
  }

  void number(const Field& field, const Range& range, double& value) override {
    row(field, "number, " + range_text(range), number_text(value));
  }
  void number(const Field& field, const Range& range, std::optional<double>&) override {
    row(field, "number, " + range_text(range), "none");
  }
  void integer(const Field& field, const Range& range, std::int64_t& value) override {
    row(field, "whole number, " + range_text(range), std::to_string(value));
  }
  void integer(const Field& field, const Range& range, std::optional<std::int64_t>&) override {
    row(field, "whole number, " + range_text(range), "none");
  }
  void text(const Field& field, std::string& value) override {
    row(field, "text", value.empty() ? "empty" : value);
  }
  void choice(const Field& field, std::span<const std::string_view> names,
              std::size_t& value) override {
    std::string words;
    for (const std::string_view name : names) {
      if (!words.empty()) words += ", ";
      words += code(name);
    }
    row(field, (names.size() > 1 ? "one of " : "") + words, std::string{names[value]});
  }
  void point(const Field& field, const Range& range, Vec2&) override {
    row(field, "[east, north], each " + range_text(range), "");
  }
  void section(const Field& field, const Fields& fields) override {
    row(field, field.key.empty() ? "group" : "group, see below", "as below");
    group(joined_path(path_, field.key), field.key.empty() ? title_ : std::string{field.text},
          fields);
  }
  void list(const Field& field, const List& list) override {
    const std::string outer_path = path_;
    const std::string outer_title = title_;
    if (!field.key.empty()) title_ = field.text;
    path_ = joined_path(path_, field.key) + "[]";
    const std::size_t group = group_;
    list.resize(1);
    list.element(*this, 0);
    list.resize(0);
    group_ = group;
    path_ = outer_path;
    title_ = outer_title;
    const std::string of = element_ == "group" ? "groups, see below" : element_;
    row(field, "list of " + std::to_string(list.size_max) + " at most: " + of, "[]");
  }
  void fleet(std::vector<ScenarioVehicle>& vehicles) override {
    row({"all", "keys of `vehicles[]` that every vehicle starts from"}, "group", "none");
    row({"types", "by name: keys of `vehicles[]` for the vehicles of that type, over `all`"},
        "groups", "none");
    List fleet = groups_of(vehicles, 1000,
                           [](FieldVisitor& v, ScenarioVehicle& vehicle) { fields(v, vehicle); });
    list({"vehicles", "the fleet; own keys over those of the type", kRequired}, fleet);
  }
  void require(bool, std::string_view, std::string_view) override {}

 private:
  struct Group {
    std::string path;
    std::string title;
    std::string rows;
  };

  void row(const Field& field, const std::string& value, const std::string& standard) {
    if (field.key.empty()) {
      element_ = value;
      return;
    }
    std::string& rows = groups_[group_].rows;
    rows.append("| ").append(code(field.key)).append(" | ").append(value).append(" | ");
    rows.append(field.required ? "**required**" : standard).append(" | ");
    rows.append(field.text).append(" |\n");
  }
  void group(const std::string& path, const std::string& title, const Fields& fields) {
    const std::size_t outer = group_;
    const std::string outer_path = path_;
    const std::string element = element_;
    groups_.push_back({path, title, ""});
    group_ = groups_.size() - 1;
    path_ = path;
    fields(*this);
    path_ = outer_path;
    group_ = outer;
    element_ = element;
  }

  std::vector<Group> groups_;
  std::size_t group_ = 0;
  std::string path_;
  std::string title_;
  std::string element_;
};

template <class T>
std::string page_of() {
  T value;
  return ReferencePage{}.print([&value](FieldVisitor& v) { fields(v, value); });
}

constexpr std::string_view kRules =
    "Directions are compass degrees: from north, clockwise. Positions are metres east and north of "
    "`origin`. The unit is in the key. An unknown key is an error, as is a missing required one; "
    "a message about a key says the file, the line, the key, what is wrong and what to do; one "
    "about "
    "what keys say together (a site inside a hazard) names what it is about.\n";

}  // namespace

std::string scenario_reference() {
  return "<!-- Printed from runtime/configuration/*_fields.cpp by configuration_test; do not edit. "
         "-->\n"
         "# Scenario files\n\n"
         "A scenario is one mission: the fleet, the sites, the world, and what must come out. "
         "`skein-hil run FILE` flies it. The shipped ones are in `scenarios/`.\n\n" +
         std::string{kRules} +
         "\nThe fleet has three levels: `all`, then `types`, then `vehicles`; a lower one "
         "overrides "
         "a higher one key by key, so a required key may stand in any of them.\n\n"
         "Bearings and angles of a site: a delivery's bearing is the direction of travel on "
         "arrival "
         "(0: flying north, coming from the south). An arc's start angle is where the vehicle is "
         "as "
         "seen from the site (0: north of it).\n" +
         page_of<Scenario>();
}

std::string configuration_reference() {
  return "<!-- Printed from runtime/configuration/*_fields.cpp by configuration_test; do not edit. "
         "-->\n"
         "# Configuration of the processes\n\n" +
         std::string{kRules} + "\n# `skein-onboard --config FILE`\n" + page_of<VehicleConfig>() +
         "\n# `skein-ground --config FILE`\n" + page_of<GroundConfig>() +
         "\n# Shapes: `scenarios/shapes/*.yaml`\n\nWhat formations make of them stands in "
         "[formation.md](formation.md).\n" +
         page_of<ShapeFile>() + "\n# Tracks: `scenarios/tracks/*.yaml`\n" + page_of<TrackFile>() +
         "\n# Plans of routes: `plan.yaml` of `skein-ground plan`\n" + page_of<RoutePlan>() +
         "\n# Plans of tasks: `plan.yaml` of `skein-ground plan`, of a mission with known sites\n" +
         page_of<TaskingPlan>();
}

}  // namespace skein::configuration
