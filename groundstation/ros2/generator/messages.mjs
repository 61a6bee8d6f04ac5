// SPDX-License-Identifier: Apache-2.0
//
// ROS 2's messages as their .msg files define them, with the DDS names and the type hashes that ROS 2
// gives them (REP-2011; the hash is SHA-256 of the TypeDescription's JSON, as rosidl writes it).
import { createHash } from 'node:crypto'
import { readdirSync, readFileSync } from 'node:fs'
import { basename, dirname, join } from 'node:path'

/** By their names in .msg files: type ids of type_description_interfaces/msg/FieldType. */
export const basic_types = {
  int8: 2, uint8: 3, int16: 4, uint16: 5, int32: 6, uint32: 7, int64: 8, uint64: 9,
  float32: 10, float64: 11, bool: 15, byte: 16, string: 17,
  char: 3 // in .msg files an unsigned number
}
const bounded_string = 21
const nested = 1
const of_array = 48
const of_bounded_sequence = 96
const of_unbounded_sequence = 144

function parse_type(text, packages) {
  const found = /^([A-Za-z0-9_/]+)(?:<=(\d+))?(?:\[(<=)?(\d*)\])?$/.exec(text)
  if (!found) throw new Error(`'${text}' is no type`)
  const [whole, base, string_max, bounded, count] = found
  const type = { base, string_max: Number(string_max ?? 0), count: Number(count || 0), many: null }
  if (whole.endsWith(']')) type.many = bounded ? 'bounded' : count ? 'array' : 'unbounded'
  if (string_max && base !== 'string') throw new Error(`only strings are bounded so: '${text}'`)
  if (!(base in basic_types)) {
    const [of, name] = base.includes('/') ? base.split('/') : [packages, base]
    type.nested = `${of}/msg/${name}`
  }
  return type
}

/** One .msg file: PACKAGE/msg/NAME.msg. */
function parse_message(file) {
  const package_name = basename(dirname(dirname(file)))
  const name = basename(file, '.msg')
  const message = { package_name, name, type_name: `${package_name}/msg/${name}`,
    dds_name: `${package_name}::msg::dds_::${name}_`, fields: [], constants: [] }
  for (const [index, line] of readFileSync(file, 'utf8').split('\n').entries()) {
    const text = line.replace(/#.*/, '').trim()
    if (!text) continue
    const constant = /^(\w+)\s+([A-Z][A-Z0-9_]*)\s*=\s*(-?\d+)$/.exec(text)
    const field = /^(\S+)\s+([a-z][a-z0-9_]*)(?:\s+(\S+))?$/.exec(text)
    if (constant) message.constants.push({ type: constant[1], name: constant[2], value: constant[3] })
    else if (field) {
      message.fields.push({ type: parse_type(field[1], package_name), name: field[2], initial: field[3] })
    } else throw new Error(`${file}:${index + 1}: '${text}' is neither a field nor a constant`)
  }
  if (message.fields.length === 0) throw new Error(`${file}: has no fields`)
  return message
}

/** All of those folders, each after what it has in it. */
export function load(folders) {
  const all = new Map()
  for (const folder of folders) {
    for (const file of readdirSync(join(folder, 'msg')).filter(name => name.endsWith('.msg')).sort()) {
      const message = parse_message(join(folder, 'msg', file))
      all.set(message.type_name, message)
    }
  }
  const sorted = new Map()
  const add = (message, within) => {
    if (sorted.has(message.type_name)) return
    if (within.includes(message)) throw new Error(`${message.type_name} has itself in it`)
    for (const { type } of message.fields) {
      if (!type.nested) continue
      if (!all.has(type.nested)) throw new Error(`${message.type_name}: there is no ${type.nested}`)
      add(all.get(type.nested), [...within, message])
    }
    sorted.set(message.type_name, message)
  }
  for (const message of all.values()) add(message, [])
  return sorted
}

function type_id(type) {
  const one = type.nested ? nested : type.string_max ? bounded_string : basic_types[type.base]
  const more = { array: of_array, bounded: of_bounded_sequence, unbounded: of_unbounded_sequence }
  return one + (more[type.many] ?? 0)
}

// Python's json.dumps with the separators ', ' and ': ', which is what is hashed.
function field_json({ name, type }) {
  return `{"name": "${name}", "type": {"type_id": ${type_id(type)}, "capacity": ${type.count}, ` +
    `"string_capacity": ${type.string_max}, "nested_type_name": "${type.nested ?? ''}"}}`
}
const individual_json = message =>
  `{"type_name": "${message.type_name}", "fields": [${message.fields.map(field_json).join(', ')}]}`

function referenced(message, messages, names = new Set()) {
  for (const { type } of message.fields) {
    if (!type.nested || names.has(type.nested)) continue
    names.add(type.nested)
    referenced(messages.get(type.nested), messages, names)
  }
  return names
}

/** "RIHS01_" and 64 hex digits. */
export function type_hash(message, messages) {
  const others = [...referenced(message, messages)].sort().map(name => individual_json(messages.get(name)))
  const json = `{"type_description": ${individual_json(message)}, "referenced_type_descriptions": [${others.join(', ')}]}`
  return `RIHS01_${createHash('sha256').update(json).digest('hex')}`
}
