// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/configuration/experiment.hpp"
#include "skein/configuration/ground_config.hpp"
#include "skein/configuration/routes_config.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/configuration/shape_file.hpp"
#include "skein/configuration/tasking.hpp"
#include "skein/configuration/track_file.hpp"

namespace skein::configuration {

inline constexpr bool kRequired = true;

/// One key of a group. An empty key means the value itself: the element of a list.
struct Field {
  std::string_view key;
  std::string_view text;  ///< one phrase for the reference page
  bool required = false;
};

/// What a number may be, both ends included.
struct Range {
  double low = 0.0;
  double high = 0.0;
  std::string_view unit{};
};

class FieldVisitor;
using Fields = std::function<void(FieldVisitor&)>;

struct List {
  std::size_t size = 0;
  std::size_t size_max = 0;
  std::function<void(std::size_t)> resize;
  std::function<void(FieldVisitor&, std::size_t)> element;
  /// Where elements must differ: what they are ("vehicle"), and the id of one.
  std::string_view noun{};
  std::function<std::uint32_t(std::size_t)> id_of;
};

/// Every struct has one function fields(visitor, struct) that names its keys; the loader, the
/// writer and the reference page are visitors of it. Values are handed over in the unit of the key.
class FieldVisitor {
 public:
  FieldVisitor() = default;
  FieldVisitor(const FieldVisitor&) = delete;
  FieldVisitor& operator=(const FieldVisitor&) = delete;
  virtual ~FieldVisitor() = default;

  virtual void number(const Field& field, const Range& range, double& value) = 0;
  /// A key that may be left out, with a meaning of its own.
  virtual void number(const Field& field, const Range& range, std::optional<double>& value) = 0;
  virtual void integer(const Field& field, const Range& range, std::int64_t& value) = 0;
  virtual void integer(const Field& field, const Range& range,
                       std::optional<std::int64_t>& value) = 0;
  virtual void text(const Field& field, std::string& value) = 0;
  virtual void choice(const Field& field, std::span<const std::string_view> names,
                      std::size_t& value) = 0;
  /// [east, north] in metres.
  virtual void point(const Field& field, const Range& range, Vec2& value) = 0;
  virtual void section(const Field& field, const Fields& fields) = 0;
  virtual void list(const Field& field, const List& list) = 0;
  /// The three levels `all`, `types` and `vehicles`.
  virtual void fleet(std::vector<ScenarioVehicle>& vehicles) = 0;
  /// A rule over several keys of this group; `what` says what is wrong and what to do.
  virtual void require(bool holds, std::string_view key, std::string_view what) = 0;
};

/// The tables.
void fields(FieldVisitor& v, VehicleConfig& config);
void fields(FieldVisitor& v, GroundConfig& config);
void fields(FieldVisitor& v, Scenario& scenario);
void fields(FieldVisitor& v, ScenarioVehicle& vehicle);
void fields(FieldVisitor& v, Experiment& experiment);
void fields(FieldVisitor& v, ShapeFile& shape);
void fields(FieldVisitor& v, SitesFile& file);
void fields(FieldVisitor& v, TrackFile& track);
void fields(FieldVisitor& v, RoutePlan& plan);
void fields(FieldVisitor& v, TaskingPlan& plan);

}  // namespace skein::configuration
