// SPDX-License-Identifier: Apache-2.0
//
// node generate.mjs OUTPUT.hpp PACKAGE_FOLDER...: C++ of the .msg files in PACKAGE_FOLDER/msg. A file that
// would not change is left alone, so that nothing is built anew for it.
import { existsSync, readFileSync, writeFileSync } from 'node:fs'
import { basic_types, load, type_hash } from './messages.mjs'

const cpp_basic = { bool: 'bool', byte: 'std::uint8_t', char: 'std::uint8_t', float32: 'float', float64: 'double', string: 'std::string' }
const cpp_of = base => cpp_basic[base] ?? `std::${base}_t`
const cpp_name = type_name => type_name.replace('/msg/', '::')

function cpp_type(type) {
  const one = type.nested ? cpp_name(type.nested) : cpp_of(type.base)
  if (type.many === 'array') return `std::array<${one}, ${type.count}>`
  return type.many ? `std::vector<${one}>` : one
}

function cpp_struct(message, messages) {
  const constants = message.constants.map(({ type, name, value }) =>
    `  static constexpr ${cpp_of(type)} ${name} = ${value};\n`)
  const fields = message.fields.map(({ type, name, initial }) => {
    const is_number = !type.nested && !type.many && type.base in basic_types && type.base !== 'string'
    return `  ${cpp_type(type)} ${name}${is_number ? `{${initial ?? ''}}` : '{}'};\n`
  })
  const visits = message.fields.map(({ name }) => `    visit(self.${name});\n`)
  return `namespace ${message.package_name} {
struct ${message.name} {
  static constexpr TypeInfo kType{"${message.type_name}", "${message.dds_name}", "${type_hash(message, messages)}"};
${constants.join('')}${fields.join('')}
  /// All fields in their order, with \`self\` this struct, or a constant one.
  template <class Self, class Visitor>
  static void for_each_field(Self& self, Visitor&& visit) {
${visits.join('')}  }
};
}  // namespace ${message.package_name}
`
}

try {
  const [out, ...folders] = process.argv.slice(2)
  const messages = load(folders)
  const text = `// SPDX-License-Identifier: Apache-2.0
// Made by groundstation/ros2/generator of .msg files.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "skein/ros2/type_info.hpp"

// NOLINTBEGIN(readability-identifier-naming): names are those of ROS 2
namespace skein::ros2 {

${[...messages.values()].map(message => cpp_struct(message, messages)).join('\n')}
}  // namespace skein::ros2
// NOLINTEND(readability-identifier-naming)
`
  if (!existsSync(out) || readFileSync(out, 'utf8') !== text) writeFileSync(out, text)
} catch (error) {
  console.error(`groundstation/ros2/generator: ${error.message}`)
  process.exit(1)
}
