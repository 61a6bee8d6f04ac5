// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/result.hpp"

/// The part of OMG IDL that idl/ is written in: modules, integer constants, structs, enums, unions
/// over enums; numbers, strings, sequences and arrays.
namespace skein::schemas {

/// What a member is, but for how many.
struct ElementType {
  std::string primitive;  ///< as a .msg file says it ("uint16", "string"); empty for a named type
  std::string name;       ///< of a struct, enum or union, without its modules
  std::optional<std::uint64_t> bound;  ///< of a string
};

struct Member {
  ElementType type;
  std::string name;
  bool is_sequence = false;
  std::optional<std::uint64_t> sequence_bound;
  std::optional<std::uint64_t> array_size;
};

struct Struct {
  std::string name;
  std::string full_name;  ///< with its modules: "skein::wire::Telemetry"
  std::vector<Member> members;
};

struct Enum {
  std::string name;
  std::vector<std::string> values;  ///< from 0
};

struct Union {
  struct Branch {
    std::string label;  ///< the enumerator
    Member member;
  };
  std::string name;
  std::string discriminator;  ///< an enum
  std::vector<Branch> branches;
};

/// All files together. A name stands for one thing only, whatever module it is in.
struct Definitions {
  std::vector<Struct> structs;  ///< in the order of the files
  std::map<std::string, Enum> enums;
  std::map<std::string, Union> unions;
  std::map<std::string, std::uint64_t> constants;

  [[nodiscard]] const Struct* find_struct(std::string_view name) const;
};

/// Adds what the text of one file defines. Lines that begin with # are passed over: give the files
/// in an order in which nothing is used before it is defined. Fails with "file:line: what is
/// wrong".
[[nodiscard]] Result<void> parse(std::string_view text, const std::string& file, Definitions& into);

}  // namespace skein::schemas
