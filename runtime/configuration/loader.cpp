// SPDX-License-Identifier: Apache-2.0
#include "loader.hpp"

#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>

#include "field_types.hpp"
#include "number_text.hpp"
#include "skein/base/contains.hpp"
#include "skein/base/text.hpp"

namespace skein::configuration {
namespace {

constexpr std::size_t kErrorsMax = 20;
constexpr std::size_t kTextMax = 8000;
constexpr std::string_view kGroupWanted =
    "is not a group of keys; write \"key: value\" lines below it";
constexpr std::string_view kListWanted =
    "is not a list; write [a, b], or a line with \"- \" for each element";

int line_of(const YAML::Node& node) { return node.Mark().line + 1; }

std::string quoted(const YAML::Node& node) {
  constexpr std::size_t kShownMax = 40;
  const std::string& text = node.Scalar();
  std::string shown = "\"";
  for (const char c : text.substr(0, kShownMax)) {
    shown.push_back(static_cast<unsigned char>(c) < 0x20 ? ' ' : c);
  }
  return shown + (text.size() > kShownMax ? "...\"" : "\"");
}

template <class T>
bool parse(const std::string& text, T& value) {
  const std::string_view digits = std::string_view{text}.substr(text.starts_with('+') ? 1 : 0);
  const auto end = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return end.ec == std::errc{} && end.ptr == digits.data() + digits.size();
}

bool is_lines_of_text(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return is_text(text);
}

/// What a value of the wrong kind is called in a message.
std::string found(const YAML::Node& node) {
  if (node.IsSequence()) return "a list";
  if (node.IsMap()) return "a group of keys";
  if (node.IsNull()) return "empty";
  return quoted(node);
}

template <class Names>
std::string joined(const Names& names) {
  std::string text;
  for (const auto& name : names) {
    if (!text.empty()) text += ", ";
    text += name;
  }
  return text;
}

/// Counts documents and passes over what is in them.
class DocumentCounter final : public YAML::EventHandler {
 public:
  [[nodiscard]] int count() const { return count_; }
  void OnDocumentStart(const YAML::Mark& /*at*/) override { ++count_; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& /*at*/, YAML::anchor_t /*anchor*/) override {}
  void OnAlias(const YAML::Mark& /*at*/, YAML::anchor_t /*anchor*/) override {}
  void OnScalar(const YAML::Mark& /*at*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                const std::string& /*value*/) override {}
  void OnSequenceStart(const YAML::Mark& /*at*/, const std::string& /*tag*/,
                       YAML::anchor_t /*anchor*/, YAML::EmitterStyle::value /*style*/) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& /*at*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                  YAML::EmitterStyle::value /*style*/) override {}
  void OnMapEnd() override {}

 private:
  int count_ = 0;
};

/// Looks no further than a second document begins: of ", a: 1" yaml-cpp 0.7 finds documents without
/// end, and YAML::LoadAll() keeps them all.
bool is_one_document(const std::string& yaml) {
  std::istringstream stream{yaml};
  YAML::Parser parser{stream};
  DocumentCounter counter;
  while (counter.count() < 2 && parser.HandleNextDocument(counter)) continue;
  return counter.count() == 1;
}

/// The first, from 1; 0: none is.
int line_indented_by_tab(const std::string& yaml) {
  std::istringstream stream{yaml};
  std::string text;
  for (int line = 1; std::getline(stream, text); ++line) {
    if (text.substr(0, text.find_first_not_of(" \t")).find('\t') != std::string::npos) return line;
  }
  return 0;
}

std::string did_you_mean(const std::string& word) {
  return word.empty() ? "" : "; did you mean " + word + "?";
}

}  // namespace

std::string Loader::message() const {
  std::string text;
  for (std::size_t i = 0; i < std::min(errors_.size(), kErrorsMax); ++i) {
    if (i > 0) text += '\n';
    text += errors_[i];
  }
  if (errors_.size() > kErrorsMax) {
    text +=
        "\n" + file_ + ": and " + std::to_string(errors_.size() - kErrorsMax) + " more mistakes";
  }
  return text;
}

void Loader::fail(int line, const std::string& path, const std::string& what) {
  std::string text = file_;
  if (line > 0) text.append(":").append(std::to_string(line));
  text += ": ";
  if (!path.empty()) text.append(path).append(": ");
  text += what;
  if (!contains(errors_, text)) errors_.push_back(std::move(text));
}

void Loader::fail(const YAML::Node& node, std::string_view key, const std::string& what) {
  int line = line_of(node);
  for (const Entry& entry : place_->entries) {
    if (entry.key == key) line = entry.line;  // an empty value would be on the line after it
  }
  fail(line, path_of(key), what);
}

std::string Loader::path_of(std::string_view key) const {
  if (key.empty()) return place_->path;
  return (place_->path.empty() ? "" : place_->path + ".") + std::string{key};
}

void Loader::read(const std::string& yaml, const Fields& fields) {
  try {
    const bool one = is_one_document(yaml);
    const YAML::Node document = one ? YAML::Load(yaml) : YAML::Node{};
    if (!document.IsMap()) {
      fail(0, "",
           "holds no single group of keys; write \"key: value\" lines, the first \"version: 1\"");
      return;
    }
    Place root;
    root.node = document;
    read_group(std::move(root), fields);
  } catch (const YAML::Exception& e) {
    const int tab = line_indented_by_tab(yaml);
    if (tab > 0) return fail(tab, "", "is indented with a tab; YAML takes spaces only");
    fail(e.mark.is_null() ? 0 : e.mark.line + 1, "", "is not YAML: " + e.msg + "; mend the text");
  } catch (const std::exception& e) {
    fail(0, "", std::string{"cannot be read as YAML: "} + e.what() + "; mend the text");
  }
}

std::vector<Loader::Entry> Loader::entries_of(const YAML::Node& node, const std::string& path) {
  std::vector<Entry> entries;
  std::map<std::string, int> line_of_key;
  for (const auto& pair : node) {
    const std::string key = pair.first.IsScalar() ? pair.first.Scalar() : "";
    const int line = line_of(pair.first);
    std::string full = path;
    if (!full.empty()) full += '.';
    full += key;
    if (key.empty()) {
      fail(line, path, "has a key that is no word; write \"key: value\" lines");
    } else if (const auto first = line_of_key.find(key); first != line_of_key.end()) {
      fail(line, full,
           "stands here a second time; the first is on line " + std::to_string(first->second) +
               ", remove one of them");
    } else {
      line_of_key[key] = line;
      entries.push_back({key, pair.second, line});
    }
  }
  return entries;
}

void Loader::read_group(Place place, const Fields& fields) {
  if (!place.node.IsMap()) {
    fail(line_of(place.node), place.path, std::string{kGroupWanted});
    return;
  }
  place.entries = entries_of(place.node, place.path);
  Place* const outer = place_;
  place_ = &place;
  fields(*this);
  report_unknown(place);
  place_ = outer;
}

void Loader::report_unknown(const Place& place) {
  for (const Entry& entry : place.entries) {
    if (std::find(place.known.begin(), place.known.end(), entry.key) != place.known.end()) continue;
    const std::string meant = nearest_word(entry.key, place.known);
    fail(entry.line, path_of(entry.key),
         meant.empty() ? "is no key of this group, which knows " + joined(place.known)
                       : "is no key of this group" + did_you_mean(meant));
  }
}

const YAML::Node* Loader::find(const Field& field, const std::string& remedy) {
  if (field.key.empty()) return &place_->node;
  place_->known.emplace_back(field.key);
  for (const Entry& entry : place_->entries) {
    if (entry.key == field.key) return &entry.value;
  }
  if (field.required && !place_->partial && !place_->given.contains(std::string{field.key})) {
    fail(place_->node, field.key, "is missing; add it: " + remedy);
  }
  return nullptr;
}

bool Loader::read_number(const YAML::Node& node, std::string_view key, const Range& range,
                         double& value) {
  double read = 0.0;
  if (!node.IsScalar() || !parse(node.Scalar(), read) || !std::isfinite(read)) {
    fail(node, key, "is " + found(node) + ", not a number; write one from " + range_text(range));
    return false;
  }
  if (read < range.low || read > range.high) {
    fail(node, key,
         "is " + number_text(read) + ", outside " + range_text(range) + "; choose a number inside");
    return false;
  }
  value = read;
  return true;
}

bool Loader::read_integer(const YAML::Node& node, std::string_view key, const Range& range,
                          std::int64_t& value) {
  std::int64_t read = 0;
  if (!node.IsScalar() || !parse(node.Scalar(), read)) {
    fail(node, key,
         "is " + found(node) + ", not a whole number; write one from " + range_text(range));
    return false;
  }
  if (static_cast<double>(read) < range.low || static_cast<double>(read) > range.high) {
    fail(node, key,
         "is " + std::to_string(read) + ", outside " + range_text(range) +
             "; choose a number inside");
    return false;
  }
  value = read;
  return true;
}

void Loader::number(const Field& field, const Range& range, double& value) {
  const YAML::Node* node = find(field, "a number from " + range_text(range));
  if (node != nullptr) read_number(*node, field.key, range, value);
}

void Loader::number(const Field& field, const Range& range, std::optional<double>& value) {
  const YAML::Node* node = find(field, "a number from " + range_text(range));
  double read = 0.0;
  if (node != nullptr && read_number(*node, field.key, range, read)) value = read;
}

void Loader::integer(const Field& field, const Range& range, std::int64_t& value) {
  const YAML::Node* node = find(field, "a whole number from " + range_text(range));
  if (node != nullptr) read_integer(*node, field.key, range, value);
}

void Loader::integer(const Field& field, const Range& range, std::optional<std::int64_t>& value) {
  const YAML::Node* node = find(field, "a whole number from " + range_text(range));
  std::int64_t read = 0;
  if (node != nullptr && read_integer(*node, field.key, range, read)) value = read;
}

void Loader::text(const Field& field, std::string& value) {
  const YAML::Node* node = find(field, "some text");
  if (node == nullptr) return;
  if (!node->IsScalar()) {
    fail(*node, field.key, "is " + found(*node) + ", not text; write it in \"quotes\"");
  } else if (node->Scalar().size() > kTextMax) {
    fail(*node, field.key, "is longer than " + std::to_string(kTextMax) + " bytes; shorten it");
  } else if (!is_lines_of_text(node->Scalar())) {
    fail(*node, field.key, "has control characters or is no UTF-8; save the file as UTF-8");
  } else {
    value = node->Scalar();
  }
}

void Loader::choice(const Field& field, std::span<const std::string_view> names,
                    std::size_t& value) {
  const YAML::Node* node = find(field, "one of " + joined(names));
  if (node == nullptr) return;
  const auto name =
      node->IsScalar() ? std::find(names.begin(), names.end(), node->Scalar()) : names.end();
  if (name == names.end()) {
    const std::string meant = node->IsScalar() ? nearest_word(node->Scalar(), names) : "";
    fail(*node, field.key,
         "is " + found(*node) + ", not one of " + joined(names) +
             (meant.empty() ? "; choose one of these" : did_you_mean(meant)));
  } else {
    value = static_cast<std::size_t>(name - names.begin());
  }
}

void Loader::point(const Field& field, const Range& range, Vec2& value) {
  const YAML::Node* node = find(field, "[east, north] in metres");
  if (node == nullptr) return;
  if (!node->IsSequence() || node->size() != 2) {
    fail(*node, field.key, "is not [east, north]; write two numbers from " + range_text(range));
    return;
  }
  Vec2 read{0.0, 0.0};
  if (read_number((*node)[0], field.key, range, read.x()) &&
      read_number((*node)[1], field.key, range, read.y())) {
    value = read;
  }
}

void Loader::section(const Field& field, const Fields& fields) {
  const YAML::Node* node = find(field, "a group of keys");
  if (node == nullptr) return;
  Place inner;
  inner.path = path_of(field.key);
  inner.node = *node;
  read_group(std::move(inner), fields);
}

void Loader::list(const Field& field, const List& list) {
  const YAML::Node* node = find(field, "a list");
  if (node == nullptr) return;
  const std::string path = path_of(field.key);
  if (!node->IsSequence()) {
    fail(*node, field.key, std::string{kListWanted});
    return;
  }
  if (node->size() > list.size_max) {
    fail(*node, field.key,
         "has " + std::to_string(node->size()) + " elements, the most is " +
             std::to_string(list.size_max) + "; remove some");
    return;
  }
  // Elements start from the defaults, also where a level above has given a list of its own.
  list.resize(0);
  list.resize(node->size());
  Place* const outer = place_;
  std::map<std::uint32_t, int> line_of_id;
  for (std::size_t i = 0; i < node->size(); ++i) {
    Place element;
    element.path = path + "[" + std::to_string(i + 1) + "]";
    element.node = (*node)[i];
    place_ = &element;
    const std::size_t errors_before = errors_.size();
    list.element(*this, i);
    if (list.id_of && errors_.size() == errors_before) {
      const std::uint32_t id = list.id_of(i);
      const auto [first, is_new] = line_of_id.emplace(id, line_of(element.node));
      if (!is_new) {
        fail(element.node, "",
             "is " + std::string{list.noun} + " " + std::to_string(id) +
                 " again; the first is on line " + std::to_string(first->second) +
                 ", give each its own id");
      }
    }
  }
  place_ = outer;
}

void Loader::read_level(const YAML::Node& node, const std::string& path, Level& level) {
  Place place;
  place.path = path;
  place.node = node;
  place.partial = true;
  if (node.IsMap()) {
    for (const auto& pair : node) {
      if (!pair.first.IsScalar()) continue;
      const std::string key = pair.first.Scalar();
      std::string full = path;
      full.append(".").append(key);
      level.given.insert_or_assign(key, Given{std::move(full), line_of(pair.first)});
    }
  }
  read_group(std::move(place), [&level](FieldVisitor& v) { fields(v, level.vehicle); });
}

void Loader::read_vehicle(const YAML::Node& node, const std::string& path, ScenarioVehicle& vehicle,
                          const Level& all,
                          const std::vector<std::pair<std::string, Level>>& types) {
  const Level* level = &all;
  const YAML::Node type = node.IsMap() ? node["type"] : YAML::Node{};
  if (type.IsDefined() && type.IsScalar() && !type.Scalar().empty()) {
    std::vector<std::string> names;
    for (const auto& [name, of_type] : types) {
      names.push_back(name);
      if (name == type.Scalar()) level = &of_type;
    }
    if (level == &all) {
      const std::string meant = nearest_word(type.Scalar(), names);
      fail(line_of(type), path + ".type",
           "is " + quoted(type) + ", which is not among types" +
               (meant.empty() ? "; add it there, or choose one of: " + joined(names)
                              : did_you_mean(meant)));
    }
  }
  vehicle = level->vehicle;
  Place place;
  place.path = path;
  place.node = node;
  place.given = level->given;
  read_group(std::move(place), [&vehicle](FieldVisitor& v) { fields(v, vehicle); });
}

void Loader::fleet(std::vector<ScenarioVehicle>& vehicles) {
  Level all;
  if (const YAML::Node* node = find({"all", ""}, "")) read_level(*node, path_of("all"), all);
  std::vector<std::pair<std::string, Level>> types;
  section({"types", ""}, [this, &all, &types](FieldVisitor&) {
    for (const Entry& entry : place_->entries) {
      place_->known.push_back(entry.key);
      types.emplace_back(entry.key, all);
      read_level(entry.value, path_of(entry.key), types.back().second);
    }
  });
  List list;
  list.size_max = kVehiclesMax;
  list.noun = "vehicle";
  list.resize = [&vehicles](std::size_t n) { vehicles.resize(n); };
  list.id_of = [&vehicles](std::size_t i) { return std::uint32_t{vehicles[i].spec.id.value}; };
  list.element = [this, &vehicles, &all, &types](FieldVisitor&, std::size_t i) {
    read_vehicle(place_->node, place_->path, vehicles[i], all, types);
  };
  this->list({"vehicles", "", kRequired}, list);
}

void Loader::require(bool holds, std::string_view key, std::string_view what) {
  if (holds || place_->partial) return;
  const std::string_view outermost = key.substr(0, key.find('.'));
  const auto given = place_->given.find(std::string{outermost});
  if (given != place_->given.end() && !place_->has(outermost)) {
    // Of a level above: the same mistake for all below it.
    const std::string rest{key.substr(outermost.size())};
    fail(given->second.line, given->second.path + rest, std::string{what});
    return;
  }
  // "start.heading_deg" is a key of a group of this group.
  int line = line_of(place_->node);
  YAML::Node group = place_->node;
  for (std::size_t begin = 0; begin <= key.size() && group.IsMap();) {
    const std::size_t end = std::min(key.find('.', begin), key.size());
    const std::string_view part = key.substr(begin, end - begin);
    begin = end + 1;
    YAML::Node inner;
    for (const auto& pair : group) {
      if (!pair.first.IsScalar() || pair.first.Scalar() != part) continue;
      line = line_of(pair.first);
      inner.reset(pair.second);
    }
    group.reset(inner);
  }
  fail(line, path_of(key), std::string{what});
}

}  // namespace skein::configuration
