// SPDX-License-Identifier: Apache-2.0
#include "ros2msg.hpp"

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

namespace skein::schemas {
namespace {

constexpr const char* kPackage = "skein";
constexpr std::size_t kSeparatorWidth = 80;

/// "lease_renewal" to "LeaseRenewal".
std::string camel_case(const std::string& name) {
  std::string camel;
  bool upper = true;
  for (const char c : name) {
    if (c != '_') {
      const auto letter = static_cast<unsigned char>(c);
      camel += static_cast<char>(upper ? std::toupper(letter) : letter);
    }
    upper = c == '_';
  }
  return camel;
}

/// Writes one schema: a struct, then what it is made of, each once.
class Text {
 public:
  explicit Text(const Definitions& definitions) : definitions_{definitions} {}

  /// The first lines; `branch` stands for the union, where there is one.
  void begin(const Struct& made, const Union* over, const Union::Branch* branch) {
    for (const Member& member : made.members) {
      if (over != nullptr && member.type.name == over->name) {
        enumeration(over->discriminator, "kind");
        Member body = branch->member;
        body.name = member.name;
        line(body);
      } else {
        line(member);
      }
    }
  }

  std::string finish() {
    std::size_t next = 0;
    while (next < used_.size()) {  // which grows meanwhile
      const std::string name = used_[next++];
      const Struct* part = definitions_.find_struct(name);
      text_ += std::string(kSeparatorWidth, '=') + "\nMSG: " + kPackage + "/" + name + "\n";
      constants_.clear();
      for (const Member& member : part->members) line(member);
    }
    return std::move(text_);
  }

 private:
  void enumeration(const std::string& name, const std::string& field) {
    const Enum& values = definitions_.enums.at(name);
    if (constants_.insert(name).second) {
      for (std::size_t i = 0; i < values.values.size(); ++i) {
        text_ += "uint32 " + values.values[i] + "=" + std::to_string(i) + "\n";
      }
    }
    text_ += "uint32 " + field + "\n";
  }

  void line(const Member& member) {
    const bool is_enum = definitions_.enums.contains(member.type.name);
    if (is_enum && !member.is_sequence && !member.array_size) {
      return enumeration(member.type.name, member.name);
    }
    std::string type = is_enum ? "uint32" : member.type.primitive + member.type.name;
    if (member.type.bound) type += "<=" + std::to_string(*member.type.bound);
    if (member.is_sequence) {
      type += member.sequence_bound ? "[<=" + std::to_string(*member.sequence_bound) + "]" : "[]";
    }
    if (member.array_size) type += "[" + std::to_string(*member.array_size) + "]";
    text_ += type + " " + member.name + "\n";
    if (!is_enum && !member.type.name.empty() &&
        std::find(used_.begin(), used_.end(), member.type.name) == used_.end()) {
      used_.push_back(member.type.name);
    }
  }

  const Definitions& definitions_;
  std::string text_;
  std::vector<std::string> used_;    ///< structs
  std::set<std::string> constants_;  ///< enums whose constants this definition has
};

}  // namespace

Result<std::vector<MadeSchema>> ros2msg_schemas(const Definitions& definitions) {
  std::vector<MadeSchema> schemas;
  std::set<std::string> with_union;
  for (const Struct& made : definitions.structs) {
    const Union* over = nullptr;
    for (const Member& member : made.members) {
      if (with_union.contains(member.type.name) || over != nullptr) {
        return Error{made.full_name + ": a union can only be the last member of a whole message"};
      }
      const auto found = definitions.unions.find(member.type.name);
      if (found == definitions.unions.end()) continue;
      if (member.is_sequence || member.array_size) {
        return Error{made.full_name + ": no schema for several unions in one member"};
      }
      over = &found->second;
      with_union.insert(made.name);
    }
    MadeSchema schema;
    schema.type = made.full_name;
    if (over == nullptr) {
      schema.name = std::string{kPackage} + "/msg/" + made.name;
      Text text{definitions};
      text.begin(made, nullptr, nullptr);
      schema.text = text.finish();
      schemas.push_back(std::move(schema));
      continue;
    }
    const auto& values = definitions.enums.at(over->discriminator).values;
    for (const Union::Branch& branch : over->branches) {
      const auto value = std::find(values.begin(), values.end(), branch.label);
      if (value == values.end()) {
        return Error{over->name + ": " + branch.label + " is not of " + over->discriminator};
      }
      schema.kind = static_cast<std::uint32_t>(value - values.begin());
      schema.branch = branch.member.name;
      schema.name = std::string{kPackage} + "/msg/" + made.name + camel_case(branch.member.name);
      Text text{definitions};
      text.begin(made, over, &branch);
      schema.text = text.finish();
      schemas.push_back(schema);
    }
  }
  return schemas;
}

std::string cpp_source(const std::vector<MadeSchema>& schemas) {
  std::string text =
      "// Made from idl/ by skein_schema_generator.\n"
      "#include \"skein/schemas/schemas.hpp\"\n\n"
      "#include <array>\n\n"
      "namespace skein::schemas {\nnamespace {\n\n"
      "constexpr std::array<Schema, " +
      std::to_string(schemas.size()) + "> kSchemas{{\n";
  for (const MadeSchema& schema : schemas) {
    text += "{\"" + schema.type + "\", " +
            (schema.kind ? std::to_string(*schema.kind) + "U" : "{}") + ", \"" + schema.branch +
            "\", \"" + schema.name + "\",\n R\"MSG(" + schema.text + ")MSG\"},\n";
  }
  text +=
      "}};\n\n}  // namespace\n\n"
      "std::span<const Schema> all() { return kSchemas; }\n\n"
      "const Schema* find(std::string_view type, std::optional<std::uint32_t> kind) {\n"
      "  for (const Schema& schema : kSchemas) {\n"
      "    if (schema.type == type && schema.kind == kind) return &schema;\n"
      "  }\n"
      "  return nullptr;\n"
      "}\n\n}  // namespace skein::schemas\n";
  return text;
}

}  // namespace skein::schemas
