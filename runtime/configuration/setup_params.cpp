// SPDX-License-Identifier: Apache-2.0
#include "skein/configuration/setup_params.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "field_visitor.hpp"
#include "number_text.hpp"
#include "skein/base/contains.hpp"

namespace skein::configuration {
namespace {

/// Groups of a process's file that all of a team have in common; what else it says is its own.
constexpr std::array<std::string_view, 6> kCommonGroups{"origin",   "time",    "protocol",
                                                        "planning", "traffic", "formation"};

/// Of formations what vehicles fly by themselves. Where they fly, how far apart and how high,
/// reaches them with every change or flight: for that the ground station's file alone counts, and
/// may be another one from one of its starts to the next.
constexpr std::array<std::string_view, 7> kFormationKeys{
    "airframe",   "speed_mps", "acceleration_mps2", "jerk_mps3",
    "tracking_m", "avoidance", "place_tolerance_m"};

/// Lists the keys of those groups with what they are set to. Lists are left out: shapes, tracks and
/// the script of formations are the ground station's, and reach vehicles as changes.
class CommonKeys final : public FieldVisitor {
 public:
  std::vector<mission::CommonKey> list(const Fields& fields) {
    fields(*this);
    return std::move(keys_);
  }

  void number(const Field& field, const Range&, double& value) override {
    add(field, number_text(value));
  }
  void number(const Field& field, const Range&, std::optional<double>& value) override {
    add(field, value ? number_text(*value) : "");
  }
  void integer(const Field& field, const Range&, std::int64_t& value) override {
    add(field, std::to_string(value));
  }
  void integer(const Field& field, const Range&, std::optional<std::int64_t>& value) override {
    add(field, value ? std::to_string(*value) : "");
  }
  void text(const Field& field, std::string& value) override { add(field, value); }
  void choice(const Field& field, std::span<const std::string_view> names,
              std::size_t& value) override {
    add(field, names[value]);
  }
  void point(const Field& field, const Range&, Vec2& value) override {
    add(field, number_text(value.x()) + " " + number_text(value.y()));
  }
  void section(const Field& field, const Fields& fields) override {
    if (path_.empty() && !contains(kCommonGroups, field.key)) return;
    const std::string outer = path_;
    path_.append(field.key).append(".");
    fields(*this);
    path_ = outer;
  }
  void list(const Field&, const List&) override {}
  void fleet(std::vector<ScenarioVehicle>&) override {}
  void require(bool, std::string_view, std::string_view) override {}

 private:
  void add(const Field& field, std::string_view value) {
    if (path_.empty()) return;
    const bool of_formation = path_.starts_with("formation.");
    if (of_formation && (path_ != "formation." || !contains(kFormationKeys, field.key))) return;
    keys_.push_back({path_ + std::string{field.key}, mission::setup_hash(value)});
  }

  std::string path_;
  std::vector<mission::CommonKey> keys_;
};

/// Formations fly by the clock: a clock that is out leads a vehicle past its tracking.
Duration clock_guard(const coalition::ProtocolParams& protocol, const FormationConfig& formation,
                     bool in_formation) {
  if (!in_formation) return protocol.clock_guard;
  const double tracked_s = formation.tracking_m / formation.limits.speed_mps;
  return std::min(protocol.clock_guard, from_seconds(tracked_s));
}

/// Without the commit: builds of one release work together.
std::string_view number_of(std::string_view version) {
  return version.substr(0, version.find('+'));
}

template <class Config>
mission::SetupParams params_of(Config config, const Release& release, bool in_formation) {
  mission::SetupParams params;
  params.common = CommonKeys{}.list([&config](FieldVisitor& v) { fields(v, config); });
  params.common.push_back({"program.version", mission::setup_hash(number_of(release.version))});
  params.common.push_back({"program.wire", mission::setup_hash(release.wire)});
  params.clock_guard = clock_guard(config.protocol, config.formation, in_formation);
  return params;
}

}  // namespace

mission::SetupParams setup_params(const VehicleConfig& config, const Release& release) {
  return params_of(config, release, flies_formation(config.vehicle));
}
mission::SetupParams setup_params(const GroundConfig& config, const Release& release) {
  return params_of(config, release, false);
}

}  // namespace skein::configuration
