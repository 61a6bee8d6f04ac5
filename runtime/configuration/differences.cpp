// SPDX-License-Identifier: Apache-2.0
#include "skein/configuration/differences.hpp"

#include <map>

#include "field_visitor.hpp"
#include "number_text.hpp"

namespace skein::configuration {
namespace {

/// Lists every key of a struct with its value as text.
class Listing final : public FieldVisitor {
 public:
  struct Entry {
    std::string key;
    std::string value;
  };

  template <class T>
  static std::vector<Entry> of(T config) {
    Listing listing;
    fields(listing, config);
    return std::move(listing.entries_);
  }

  void number(const Field& field, const Range&, double& value) override {
    add(field, number_text(value));
  }
  void number(const Field& field, const Range&, std::optional<double>& value) override {
    if (value) add(field, number_text(*value));
  }
  void integer(const Field& field, const Range&, std::int64_t& value) override {
    add(field, std::to_string(value));
  }
  void integer(const Field& field, const Range&, std::optional<std::int64_t>& value) override {
    if (value) add(field, std::to_string(*value));
  }
  void text(const Field& field, std::string& value) override { add(field, value); }
  void choice(const Field& field, std::span<const std::string_view> names,
              std::size_t& value) override {
    add(field, std::string{names[value]});
  }
  void point(const Field& field, const Range&, Vec2& value) override {
    add(field, "[" + number_text(value.x()) + ", " + number_text(value.y()) + "]");
  }
  void section(const Field& field, const Fields& fields) override {
    const std::string outer = path_;
    path_ = path_of(field.key);
    fields(*this);
    path_ = outer;
  }
  void list(const Field& field, const List& list) override {
    const std::string outer = path_;
    for (std::size_t i = 0; i < list.size; ++i) {
      path_ = outer;
      const std::size_t number = list.id_of ? list.id_of(i) : i + 1;
      path_ = path_of(field.key).append("[").append(std::to_string(number)).append("]");
      list.element(*this, i);
    }
    path_ = outer;
  }
  void fleet(std::vector<ScenarioVehicle>&) override {}
  void require(bool, std::string_view, std::string_view) override {}

 private:
  [[nodiscard]] std::string path_of(std::string_view key) const {
    std::string path = path_;
    if (!path.empty() && !key.empty()) path += '.';
    return path.append(key);
  }
  void add(const Field& field, std::string value) {
    entries_.push_back({path_of(field.key), std::move(value)});
  }

  std::string path_;
  std::vector<Entry> entries_;
};

template <class T>
std::vector<Difference> difference_of(const T& first, const T& second) {
  const auto mine = Listing::of(first);
  std::map<std::string, std::string> others;
  for (auto& entry : Listing::of(second)) others.emplace(entry.key, std::move(entry.value));
  std::vector<Difference> all;
  for (const auto& [key, value] : mine) {
    const auto other = others.find(key);
    if (other == others.end()) {
      all.push_back({key, value, ""});
      continue;
    }
    if (other->second != value) all.push_back({key, value, other->second});
    others.erase(other);
  }
  for (const auto& [key, value] : others) all.push_back({key, "", value});
  return all;
}

}  // namespace

std::vector<Difference> differences(const VehicleConfig& first, const VehicleConfig& second) {
  return difference_of(first, second);
}
std::vector<Difference> differences(const GroundConfig& first, const GroundConfig& second) {
  return difference_of(first, second);
}

}  // namespace skein::configuration
