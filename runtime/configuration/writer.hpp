// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "field_visitor.hpp"

namespace skein::configuration {

/// Writes a struct as the YAML that the loader reads back as the same struct. Every key is written.
class Writer final : public FieldVisitor {
 public:
  [[nodiscard]] std::string write(const Fields& fields);

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
  void require(bool, std::string_view, std::string_view) override {}

 private:
  void key(const Field& field);

  YAML::Emitter out_;
};

}  // namespace skein::configuration
