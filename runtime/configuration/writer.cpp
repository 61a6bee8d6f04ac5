// SPDX-License-Identifier: Apache-2.0
#include "writer.hpp"

#include <set>

#include "field_types.hpp"
#include "number_text.hpp"

namespace skein::configuration {

std::string Writer::write(const Fields& fields) {
  out_ << YAML::BeginMap;
  fields(*this);
  out_ << YAML::EndMap;
  return std::string{out_.c_str(), out_.size()} + "\n";
}

void Writer::key(const Field& field) {
  if (!field.key.empty()) out_ << YAML::Key << std::string{field.key} << YAML::Value;
}

void Writer::number(const Field& field, const Range&, double& value) {
  key(field);
  out_ << number_text(value);
}

void Writer::number(const Field& field, const Range& range, std::optional<double>& value) {
  if (value) number(field, range, *value);
}

void Writer::integer(const Field& field, const Range&, std::int64_t& value) {
  key(field);
  out_ << std::to_string(value);
}

void Writer::integer(const Field& field, const Range& range, std::optional<std::int64_t>& value) {
  if (value) integer(field, range, *value);
}

void Writer::text(const Field& field, std::string& value) {
  key(field);
  out_ << YAML::DoubleQuoted << value;
}

void Writer::choice(const Field& field, std::span<const std::string_view> names,
                    std::size_t& value) {
  key(field);
  out_ << std::string{names[value]};
}

void Writer::point(const Field& field, const Range&, Vec2& value) {
  key(field);
  out_ << YAML::Flow << YAML::BeginSeq << number_text(value.x()) << number_text(value.y())
       << YAML::EndSeq;
}

void Writer::section(const Field& field, const Fields& fields) {
  key(field);
  out_ << YAML::BeginMap;
  fields(*this);
  out_ << YAML::EndMap;
}

void Writer::list(const Field& field, const List& list) {
  key(field);
  if (list.size == 0) out_ << YAML::Flow;
  out_ << YAML::BeginSeq;
  for (std::size_t i = 0; i < list.size; ++i) list.element(*this, i);
  out_ << YAML::EndSeq;
}

void Writer::fleet(std::vector<ScenarioVehicle>& vehicles) {
  // The levels are merged, so every vehicle carries its own keys; types keep their names only.
  std::set<std::string> types;
  for (const ScenarioVehicle& vehicle : vehicles) {
    if (!vehicle.type.empty()) types.insert(vehicle.type);
  }
  out_ << YAML::Key << "types" << YAML::Value << YAML::BeginMap;
  for (const std::string& type : types) {
    out_ << YAML::Key << YAML::DoubleQuoted << type << YAML::Value << YAML::Flow << YAML::BeginMap
         << YAML::EndMap;
  }
  out_ << YAML::EndMap;
  List list = groups_of(vehicles, vehicles.size(),
                        [](FieldVisitor& v, ScenarioVehicle& vehicle) { fields(v, vehicle); });
  this->list({"vehicles", ""}, list);
}

}  // namespace skein::configuration
