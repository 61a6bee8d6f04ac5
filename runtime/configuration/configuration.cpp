// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>

#include "loader.hpp"
#include "skein/configuration/experiment.hpp"
#include "skein/configuration/ground_config.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/configuration/shape_file.hpp"
#include "skein/configuration/site_config.hpp"
#include "skein/configuration/track_file.hpp"
#include "skein/configuration/vehicle_config.hpp"
#include "writer.hpp"

namespace skein::configuration {
namespace {

constexpr std::size_t kFileSizeMax = 1U << 20U;

Result<std::string> read_file(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) {
    return Error{name + ": is a folder; name a YAML file"};
  }
  errno = 0;
  std::ifstream in{file, std::ios::binary};
  if (!in) {
    return Error{name + ": cannot be opened: " + std::generic_category().message(errno) +
                 "; check the path"};
  }
  std::string text(kFileSizeMax + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > kFileSizeMax) {
    return Error{name + ": is larger than " + std::to_string(kFileSizeMax) +
                 " bytes; name a configuration file"};
  }
  return text;
}

template <class T>
Result<T> parse(std::string_view yaml, const std::string& name) {
  T value;
  Loader loader{name};
  loader.read(std::string{yaml}, [&value](FieldVisitor& v) { fields(v, value); });
  if (!loader.ok()) return Error{loader.message()};
  return value;
}

template <class T>
Result<T> load(const std::filesystem::path& file) {
  const Result<std::string> text = read_file(file);
  if (!text) return text.error();
  return parse<T>(*text, file.string());
}

template <class T>
std::string written(T value) {
  return Writer{}.write([&value](FieldVisitor& v) { fields(v, value); });
}

}  // namespace

Result<VehicleConfig> load_vehicle_config(const std::filesystem::path& file) {
  return load<VehicleConfig>(file);
}
Result<VehicleConfig> parse_vehicle_config(std::string_view yaml, const std::string& name) {
  return parse<VehicleConfig>(yaml, name);
}
std::string to_yaml(const VehicleConfig& config) { return written(config); }

Result<GroundConfig> load_ground_config(const std::filesystem::path& file) {
  return load<GroundConfig>(file);
}
Result<GroundConfig> parse_ground_config(std::string_view yaml, const std::string& name) {
  return parse<GroundConfig>(yaml, name);
}
std::string to_yaml(const GroundConfig& config) { return written(config); }

Result<Scenario> load_scenario(const std::filesystem::path& file) {
  auto scenario = load<Scenario>(file);
  if (!scenario) return scenario;
  const auto beside = [&file](const std::string& name) {
    return std::filesystem::absolute(file.parent_path() / name).lexically_normal();
  };
  for (NamedShape& shape : scenario->formation.shapes) shape.file = beside(shape.file);
  for (NamedTrack& track : scenario->formation.tracks) track.file = beside(track.file);
  return scenario;
}
Result<Scenario> load_flyable_scenario(const std::filesystem::path& file) {
  auto scenario = load_scenario(file);
  if (!scenario) return scenario;
  const auto flyable = check(*scenario);
  if (flyable) return scenario;
  const std::string name = file.string() + ": ";
  std::string message = name;
  for (const char c : flyable.error().message) {
    message += c;
    if (c == '\n') message += name;
  }
  return Error{message};
}
Result<Scenario> parse_scenario(std::string_view yaml, const std::string& name) {
  return parse<Scenario>(yaml, name);
}
std::string to_yaml(const Scenario& scenario) { return written(scenario); }

Result<Experiment> load_experiment(const std::filesystem::path& file) {
  return load<Experiment>(file);
}
Result<Experiment> parse_experiment(std::string_view yaml, const std::string& name) {
  return parse<Experiment>(yaml, name);
}
std::string to_yaml(const Experiment& experiment) { return written(experiment); }

Result<RoutePlan> load_route_plan(const std::filesystem::path& file) {
  return load<RoutePlan>(file);
}
Result<RoutePlan> parse_route_plan(std::string_view yaml, const std::string& name) {
  return parse<RoutePlan>(yaml, name);
}
std::string to_yaml(const RoutePlan& plan) { return written(plan); }

Result<TaskingPlan> load_tasking_plan(const std::filesystem::path& file) {
  return load<TaskingPlan>(file);
}
Result<TaskingPlan> parse_tasking_plan(std::string_view yaml, const std::string& name) {
  return parse<TaskingPlan>(yaml, name);
}
std::string to_yaml(const TaskingPlan& plan) { return written(plan); }

Result<ShapeFile> load_shape(const std::filesystem::path& file) { return load<ShapeFile>(file); }
Result<ShapeFile> parse_shape(std::string_view yaml, const std::string& name) {
  return parse<ShapeFile>(yaml, name);
}
std::string to_yaml(const ShapeFile& shape) { return written(shape); }

Result<SitesFile> load_sites(const std::filesystem::path& file) { return load<SitesFile>(file); }
Result<SitesFile> parse_sites(std::string_view yaml, const std::string& name) {
  return parse<SitesFile>(yaml, name);
}
std::string to_yaml(const SitesFile& file) { return written(file); }

Result<TrackFile> load_track(const std::filesystem::path& file) { return load<TrackFile>(file); }
Result<TrackFile> parse_track(std::string_view yaml, const std::string& name) {
  return parse<TrackFile>(yaml, name);
}
std::string to_yaml(const TrackFile& track) { return written(track); }

}  // namespace skein::configuration
