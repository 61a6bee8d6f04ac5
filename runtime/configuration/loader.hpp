// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "field_visitor.hpp"

namespace skein::configuration {

/// Reads YAML into structs and collects one sentence for every mistake. A value that is wrong or
/// missing leaves the struct's own default.
class Loader final : public FieldVisitor {
 public:
  explicit Loader(std::string file) : file_{std::move(file)} {}

  void read(const std::string& yaml, const Fields& fields);
  [[nodiscard]] bool ok() const { return errors_.empty(); }
  /// One line a mistake.
  [[nodiscard]] std::string message() const;

  void number(const Field& field, const Range& range, double& value) override;
  void number(const Field& field, const Range& range, std::optional<double>& value) override;
  void integer(const Field& field, const Range& range, std::int64_t& value) override;
  void integer(const Field& field, const Range& range, std::optional<std::int64_t>& value) override;
  void text(const Field& field, std::string& value) override;
  void choice(const Field& field, std::span<const std::string_view> names,
              std::size_t& value) override;
  void point(const Field& field, const Range& range, Vec2& value) override;
  void section(const Field& field, const Fields& fields) override;
  void list(const Field& field, const List& list) override;
  void fleet(std::vector<ScenarioVehicle>& vehicles) override;
  void require(bool holds, std::string_view key, std::string_view what) override;

 private:
  struct Entry {
    std::string key;
    YAML::Node value;
    int line = 0;
  };
  /// Where a level of the fleet gives a key to the vehicles below it.
  struct Given {
    std::string path;
    int line = 0;
  };
  /// What is being read: a group of keys, or one element of a list.
  struct Place {
    std::string path;
    YAML::Node node;
    std::vector<Entry> entries;
    std::vector<std::string> known;
    bool partial = false;                ///< a level of the fleet: nothing is required
    std::map<std::string, Given> given;  ///< by a level above
    [[nodiscard]] bool has(std::string_view key) const {
      return std::any_of(entries.begin(), entries.end(),
                         [key](const Entry& entry) { return entry.key == key; });
    }
  };
  /// Keys that one level of the fleet gives to those below it.
  struct Level {
    ScenarioVehicle vehicle;
    std::map<std::string, Given> given;
  };

  [[nodiscard]] const YAML::Node* find(const Field& field, const std::string& remedy);
  [[nodiscard]] std::string path_of(std::string_view key) const;
  void fail(int line, const std::string& path, const std::string& what);
  void fail(const YAML::Node& node, std::string_view key, const std::string& what);
  bool read_number(const YAML::Node& node, std::string_view key, const Range& range, double& value);
  bool read_integer(const YAML::Node& node, std::string_view key, const Range& range,
                    std::int64_t& value);
  void read_group(Place place, const Fields& fields);
  [[nodiscard]] std::vector<Entry> entries_of(const YAML::Node& node, const std::string& path);
  void report_unknown(const Place& place);
  void read_vehicle(const YAML::Node& node, const std::string& path, ScenarioVehicle& vehicle,
                    const Level& all, const std::vector<std::pair<std::string, Level>>& types);
  void read_level(const YAML::Node& node, const std::string& path, Level& level);

  std::string file_;
  Place* place_ = nullptr;
  std::vector<std::string> errors_;
};

}  // namespace skein::configuration
