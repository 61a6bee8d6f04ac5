// SPDX-License-Identifier: Apache-2.0
//
// C++ of the model: the types that core uses, and for the codec what each is made of.
import { camel, fail, last, scope_of, size_max, snake } from './model.mjs'

const width = 100
const made_from = what => `// SPDX-License-Identifier: Apache-2.0\n// Made from ${what}: change it there.\n`

// `name` as it is written within namespace `within`.
function seen_from(within, name) {
  const own = within.split('::')
  const parts = name.split('::')
  while (own.length && parts.length > 1 && own[0] === parts[0]) own.shift(), parts.shift()
  return parts.join('::')
}

const integer = { uint8: 'std::uint8_t', int8: 'std::int8_t', uint16: 'std::uint16_t', int16: 'std::int16_t', uint32: 'std::uint32_t', int32: 'std::int32_t', uint64: 'std::uint64_t', int64: 'std::int64_t' }
const plain = { ...integer, bool: 'bool', float64: 'double' }

// An extern struct's type, or where it is defined by us, its own name.
const type_name = t => t.notes.cpp?.type ?? t.name

function element_type(types, f, within) {
  if (f.notes.cpp) return f.notes.cpp.type
  if (f.kind === 'string') return 'std::string'
  if (f.kind === 'primitive') return plain[f.type] ?? fail(`${f.type} is not supported`)
  return seen_from(within, type_name(types.get(f.type)))
}

const member_name = f => /^(Instant|Duration)$/.test(f.notes.cpp?.type) ? f.name.replace(/_ns$/, '') : f.name

function member_type(types, f, within) {
  const element = element_type(types, f, within)
  if (f.many !== undefined) return `std::vector<${element}>`
  if (f.notes.present) return `std::optional<${element}>`
  if (f.notes.external) return `std::shared_ptr<const ${element}>`
  return element
}

function start_value(types, f, within) {
  if (f.many !== undefined || f.notes.present || f.notes.external) return '{}'
  if (f.kind === 'struct') return types.get(f.type).notes.cpp?.init ?? '{}'
  if (f.kind === 'enum') {
    const values = types.get(f.type).values
    return ` = ${element_type(types, f, within)}::${values[f.value ?? 0].name.toLowerCase()}`
  }
  if (f.kind === 'string') return f.value === undefined ? '{}' : ` = ${JSON.stringify(f.value)}`
  if (f.kind === 'union') return '{}'
  if (f.notes.cpp && !f.notes.cpp.type.startsWith('std::')) {
    return `{${f.value || ''}}`
  }
  if (f.type === 'bool') return ` = ${f.value ?? false}`
  return ` = ${number(f.value ?? 0, f.type)}`
}

function number(value, type) {
  if (type !== 'float64') return String(BigInt(value))
  return Number.isInteger(value) && Math.abs(value) < 1e6 ? value.toFixed(1) : value.toExponential().replace('e+', 'e')
}

// `begin`, the words with commas between them, `end`: on one line, or on as many as they need.
function listed(begin, words, end, indent = '') {
  const line = `${indent}${begin}${words.join(', ')}${end}`
  if (line.length <= width) return `${line}\n`
  const lines = ['']
  words.forEach((word, i) => {
    const next = i + 1 < words.length ? `${word}, ` : word + end
    if (`${indent}    ${lines.at(-1)}${next}`.trimEnd().length > width) lines.push('')
    lines[lines.length - 1] += next
  })
  return `${indent}${begin}\n${lines.map(l => `${indent}    ${l.trimEnd()}\n`).join('')}`
}

const doc = (lines, indent = '') => lines.map(l => `${indent}///${l ? ' ' + l : ''}\n`).join('')

// A field that is reached through another has its member there.
const is_within_other = f => f.notes.member?.includes('.')

// The comments after members stand in one column where there is room.
function members(types, fields, within) {
  const texts = fields.map(f => `  ${member_type(types, f, within)} ${member_name(f)}${start_value(types, f, within)};`)
  const column = Math.max(...texts.map((text, i) => fields[i].after ? text.length : 0))
  const fits = (text, after) => text.length + `  ///< ${after}`.length <= width
  return fields.map((f, i) => {
    const wide = texts[i].padEnd(column)
    const text = fits(wide, f.after) ? wide : texts[i]
    if (!f.after) return `${doc(f.before, '  ')}${texts[i]}\n`
    if (fits(text, f.after)) return `${doc(f.before, '  ')}${text}  ///< ${f.after}\n`
    return `${doc([...f.before, f.after], '  ')}${texts[i]}\n`
  }).join('')
}

function struct_text(types, t, within) {
  const name = last(t.name)
  const fields = t.fields.filter(f => !f.flag && !is_within_other(f))
  const compared = t.notes.compared
    ? `  friend auto operator<=>(const ${name}&, const ${name}&) = default;\n` : ''
  const union = fields.find(f => f.kind === 'union')
  const kind = union ? seen_from(within, types.get(types.get(union.type).on).name) : ''
  const which = union ? `\n  /// Which of them \`${union.name}\` is.\n  [[nodiscard]] ${kind} kind() const { return static_cast<${kind}>(${union.name}.index()); }\n` : ''
  const warning = t.notes.warning ? '  static constexpr bool kWarning = true;\n' : ''
  return `${doc(t.before)}struct ${name} {\n${members(types, fields, within)}${compared}${warning}${which}};\n`
}

function enum_text(t) {
  const name = last(t.name)
  const values = t.values.map(v => `  ${v.name.toLowerCase()},${v.after ? `  ///< ${v.after}` : ''}\n`).join('')
  const names = t.values.map(v => `"${v.name.toLowerCase()}"`)
  return `${doc(t.before)}enum class ${name} : std::uint8_t {\n${values}  count\n};\n` +
    `[[nodiscard]] constexpr std::string_view to_string(${name} value) {\n` +
    listed(`constexpr std::array<std::string_view, ${t.values.length}> kNames{`, names, '};', '  ') +
    `  const auto i = static_cast<std::size_t>(value);\n` +
    `  return i < kNames.size() ? kNames.at(i) : "unknown";\n}\n`
}

function union_text(types, t, within) {
  const branches = t.branches.map(b => seen_from(within, type_name(types.get(b.type))))
  return doc(t.before) + variant_text(last(t.name), branches)
}

// A variant whose copies are made in one source: a source that copies, moves and destroys forty
// alternatives itself takes seconds longer to compile.
function variant_text(name, alternatives) {
  return listed(`struct ${name} : std::variant<`, alternatives, '> {') + `  using variant::variant;\n` +
    `  ${name}();\n  ${name}(const ${name}&);\n  ${name}(${name}&&) noexcept;\n` +
    `  ${name}& operator=(const ${name}&);\n  ${name}& operator=(${name}&&) noexcept;\n  ~${name}();\n};\n`
}

// What variant_text() has declared; `names` are whole.
function variants_text(names) {
  return in_namespaces(names.map(name => {
    const n = last(name)
    return [scope_of(name), `${n}::${n}() = default;\n${n}::${n}(const ${n}&) = default;\n` +
      `${n}::${n}(${n}&&) noexcept = default;\n${n}& ${n}::operator=(const ${n}&) = default;\n` +
      `${n}& ${n}::operator=(${n}&&) noexcept = default;\n${n}::~${n}() = default;\n`]
  }))
}

// The source that a file with unions needs; empty for one without.
export function variants_source(file) {
  const names = file.declarations.filter(t => t.kind === 'union').map(t => t.name)
  if (names.length === 0) return ''
  return made_from(`idl/${file.name}.idl`) + include(`skein/idl/${file.name}.hpp`) + variants_text(names)
}

function declaration(types, t, within) {
  switch (t.kind) {
    case 'const': return `${doc(t.before)}inline constexpr std::size_t ${last(t.name)} = ${t.value};` +
      `${t.after ? `  ///< ${t.after}` : ''}\n`
    case 'enum': return t.notes.cpp ? '' : enum_text(t)
    case 'union': return union_text(types, t, within)
    default: return t.notes.cpp ? '' : struct_text(types, t, within)
  }
}

// Each in its namespace, with an empty line between them.
function in_namespaces(items) {
  let text = ''
  let open = ''
  for (const [namespace, item] of items) {
    if (item === '') continue
    if (namespace !== open) {
      if (open) text += `\n}  // namespace ${open}\n`
      text += `\nnamespace ${namespace} {\n`
      open = namespace
    }
    // Constants stand together.
    text += item.startsWith('inline constexpr') && /\ninline constexpr[^\n]*\n$/.test(text) ? item : `\n${item}`
  }
  return open ? `${text}\n}  // namespace ${open}\n` : text
}

const include = header => header.startsWith('<') ? `#include ${header}\n` : `#include "${header}"\n`

function headers_of(types, file, file_of) {
  const found = new Set(['<array>', '<compare>', '<cstddef>', '<cstdint>', '<memory>', '<optional>', '<string>', '<string_view>', '<variant>', '<vector>'])
  const text = file.declarations.map(t => declaration(types, t, scope_of(t.name))).join('')
  const used = { '<array>': 'std::array', '<compare>': '<=>', '<cstddef>': 'std::size_t', '<cstdint>': '_t ', '<memory>': 'std::shared_ptr', '<optional>': 'std::optional', '<string>': 'std::string ', '<string_view>': 'std::string_view', '<variant>': 'std::variant', '<vector>': 'std::vector' }
  for (const header of [...found]) {
    if (!text.includes(used[header]) && !(header === '<string>' && text.includes('std::string>'))) found.delete(header)
  }
  for (const t of file.declarations) {
    if (t.notes.cpp) continue
    for (const f of [...(t.fields ?? []), ...(t.branches ?? [])]) {
      if (f.flag) continue
      if (f.notes.cpp) found.add(f.notes.cpp.header)
      const other = types.get(f.type)
      if (other?.notes.cpp) found.add(other.notes.cpp.header)
      else if (other && file_of(f.type) !== file.name) found.add(`skein/idl/${file_of(f.type)}.hpp`)
    }
  }
  const sorted = [...found].sort()
  const system = sorted.filter(h => h.startsWith('<'))
  const own = sorted.filter(h => !h.startsWith('<'))
  return [system, own].filter(g => g.length).map(g => g.map(include).join('')).join('\n')
}

export function types_header(model, file) {
  const { types } = model
  const file_of = name => model.files.find(f => f.declarations.some(t => t.name === name)).name
  const items = file.declarations.map(t => [scope_of(t.name), declaration(types, t, scope_of(t.name))])
  return `${made_from(`idl/${file.name}.idl`)}#pragma once\n\n${headers_of(types, file, file_of)}${in_namespaces(items)}`
}

// --- what a type is made of ----------------------------------------------------------------------

function limits(f) {
  const low = f.notes.min ?? f.notes.range?.min
  const high = f.notes.max ?? f.notes.range?.max
  if (f.type === 'float64') {
    const edge = 'std::numeric_limits<double>::max()'
    return `${low === undefined ? `-${edge}` : number(low, f.type)}, ${high === undefined ? edge : number(high, f.type)}`
  }
  const edges = `std::numeric_limits<${integer[f.type]}>`
  return `${low === undefined ? `${edges}::min()` : number(low, f.type)}, ${high === undefined ? `${edges}::max()` : number(high, f.type)}`
}

function spec(f) {
  let text = { enum: 'Name{}', struct: 'Part{}', union: 'Choice{}', string: `Text{${f.bound}}` }[f.kind]
  if (f.type === 'bool') text = 'Flag{}'
  else if (f.type === 'float64') text = `Real{${limits(f)}}`
  else if (f.kind === 'primitive') text = `Whole<${integer[f.type]}>{${limits(f)}}`
  if (f.notes.present) text = `Maybe{${text}}`
  if (f.notes.external) text = 'Kept{}'
  return f.many === undefined ? text : `Many{${f.many}, ${text}}`
}

function fields_text(t, within) {
  const name = seen_from(within, type_name(t))
  if (t.kind === 'enum') return `static_assert(static_cast<std::size_t>(${name}::count) == ${t.values.length});\n`
  const type = `template <>\nstruct Type<${name}> {\n  static constexpr std::string_view kName = "${t.tool_name}";\n` +
    `  static constexpr bool kGrows = ${t.grows};\n` +
    `  static constexpr std::uint16_t kVersion = ${t.notes.version ?? 0};\n` +
    (t.notes.record ? `  static constexpr std::string_view kRecord = "${t.notes.record}";\n` : '') + `};\n`
  if (t.kind === 'union') return type
  const lines = t.fields.filter(f => !f.flag && !f.notes.non_serialized).map(f =>
    `${f.notes.appended ? '  if (f.at_end()) return;\n' : ''}` +
    `  f("${f.name}", m.${f.notes.member ?? member_name(f)}, ${spec(f)});\n`).join('')
  const unused = lines ? '' : '[[maybe_unused]] '
  return `${type}template <Of<${name}> Self, class F>\nvoid fields(${unused}Self& m, ${unused}F&& f) {\n${lines}}\n`
}

export function fields_header(model, file) {
  const made = file.declarations.filter(t => t.kind === 'struct' || t.kind === 'union' || t.kind === 'enum' && t.notes.cpp)
  const own = new Set([`skein/idl/${file.name}.hpp`, 'skein/codec/describe.hpp'])
  for (const t of made) {
    if (t.notes.cpp) own.add(t.notes.cpp.header)
    for (const f of t.fields ?? []) if (f.notes.cpp) own.add(f.notes.cpp.header)
  }
  const headers = [...own].filter(h => !h.startsWith('<')).sort()
  return `${made_from(`idl/${file.name}.idl`)}#pragma once\n\n#include <cstddef>\n#include <cstdint>\n#include <limits>\n#include <string_view>\n\n` +
    `${headers.map(include).join('')}${in_namespaces(made.map(t => ['skein::codec', fields_text(t, 'skein::codec')]))}`
}

// --- topics --------------------------------------------------------------------------------------

// All messages of the network; the alternatives stand in the order of the topics.
export function message_header(model, topics) {
  const alternatives = topics.map(t => seen_from('skein::mission', t.type))
  const file_of = name => model.files.find(f => f.declarations.some(t => t.name === name)).name
  const headers = [...new Set(topics.map(t => `skein/idl/${file_of(t.type)}.hpp`))].sort()
  return `${made_from('idl/topics.json')}#pragma once\n\n#include <variant>\n\n${headers.map(include).join('')}` +
    `\nnamespace skein::mission {\n\n/// In the order of the topics.\n${variant_text('Message', alternatives)}\n}  // namespace skein::mission\n`
}

export const message_source = () =>
  made_from('idl/topics.json') + include('skein/idl/message.hpp') + variants_text(['skein::mission::Message'])

export function topics_header(model, topics) {
  const sets = { vehicles: 'kVehicles', ground: 'kGround', all: 'kAll' }
  const rows = topics.map(t => {
    const type = model.types.get(t.type) ?? fail(`idl/topics.json: there is no ${t.type}`)
    if (!type.notes.version) fail(`${t.type} is a topic's type: it needs a @version`)
    return `    {"skein/${t.name}", "skein::wire::${type.tool_name}", ${type.notes.version}, ${sets[t.writers]}, ${sets[t.readers]}, ` +
      `${t.reliable}, air::Urgency::${t.urgency}, ${t.writer_history}, ${t.reader_history}, ${size_max(model.types, t.type)}},\n`
  })
  return `${made_from('idl/topics.json')}#pragma once\n\n#include <array>\n#include <cstddef>\n#include <cstdint>\n\n#include "skein/codec/topic_info.hpp"\n\nnamespace skein::codec {\n\n` +
    `/// What crosses the mission network; the order of mission::Message.\nenum class Topic : std::uint8_t {\n${topics.map(t => `  ${t.name},\n`).join('')}  count\n};\n` +
    `inline constexpr std::size_t kTopicCount = static_cast<std::size_t>(Topic::count);\n\n` +
    `/// Every topic. No other place names one, or a QoS value.\ninline constexpr std::array<TopicInfo, kTopicCount> kTopics{{\n${rows.join('')}}};\n\n}  // namespace skein::codec\n`
}

const leaves = (model, name) => {
  const t = model.types.get(name)
  return t.kind === 'union' ? t.branches.map(b => model.types.get(b.type)) : [t]
}

function sayers(t) {
  const words = t.notes.said_by ?? fail(`${t.name}: who may say it? @said_by("vehicle"), ("ground"), ("sensors") ...`)
  const nodes = new Map([
    ['ground', { code: 'sender == kGroundStation', text: 'the ground station' }],
    ['sensors', { code: 'sender == kSensors', text: 'a node that stands for sensors' }]])
  const each = words.split(' or ').map(w => nodes.get(w) ?? { code: `m.${w} == sender`, text: `its \`${w}\`` })
  return { code: each.map(e => e.code).join(' || '), text: each.map(e => e.text).join(' or ') }
}

export function may_say_source(model, topics) {
  const functions = topics.flatMap(t => leaves(model, t.type)).map(t => {
    const { code } = sayers(t)
    return `  bool operator()(const ${seen_from('skein::mission', t.name)}&${code.includes('m.') ? ' m' : ''}) const { return ${code}; }\n`
  })
  const unions = topics.filter(t => model.types.get(t.type).kind === 'union')
    .map(t => `  bool operator()(const ${seen_from('skein::mission', t.type)}& m) const { return std::visit(*this, m); }\n`)
  const decisions = topics.flatMap(t => leaves(model, t.type)).map(t =>
    `  bool operator()(const ${seen_from('skein::mission', t.name)}&) const { return ${Boolean(t.notes.signed)}; }\n`)
  return `${made_from('the annotations @said_by and @signed of idl/')}#include "skein/mission/may_say.hpp"\n\n#include <variant>\n\nnamespace skein::mission {\nnamespace {\n\n` +
    `struct MaySay {\n  VehicleId sender;\n\n${functions.join('')}${unions.join('')}};\n\n` +
    `struct IsSigned {\n${decisions.join('')}${unions.join('')}};\n\n}  // namespace\n\n` +
    `bool may_say(const Message& message, VehicleId sender) {\n  return std::visit(MaySay{sender}, message);\n}\n` +
    `bool is_signed(const Message& message) { return std::visit(IsSigned{}, message); }\n\n}  // namespace skein::mission\n`
}

const protection = t => t.notes.signed ? 'sealed, signed' : 'sealed'

const reached = { all: 'all', vehicles: 'vehicles', ground: 'ground' }

// docs/topics.md.
export function topics_document(model, topics) {
  const rows = topics.map(t => {
    const type = model.types.get(t.type)
    const of_union = type.kind === 'union'
    const said = of_union ? 'see below' : sayers(type).text
    const proof = of_union ? 'see below' : protection(type)
    return `| \`skein/${t.name}\` | \`${t.type}\` | ${type.notes.version} | ${reached[t.writers]} | ${reached[t.readers]} | ${said} | ${proof} | ` +
      `${t.reliable ? 'reliable' : 'best effort'} | ${t.urgency} | ${t.writer_history} | ${t.reader_history} | ${size_max(model.types, t.type)} |\n`
  })
  const parts = topics.filter(t => model.types.get(t.type).kind === 'union').map(t =>
    `\n\`${t.type}\` is one of:\n\n| message | who may say it | where there are keys |\n|---|---|---|\n` +
    leaves(model, t.type).map(l => `| ${last(l.name)} | ${sayers(l).text} | ${protection(l)} |\n`).join(''))
  return '# Topics\n\nPrinted from `idl/topics.json` and the types of `idl/` by `idl/generator`; a test compares them.\n' +
    'Durability is volatile, history is keep-last: the oldest sample gives way, so a writer never waits for a reader.\n' +
    'A reliable topic keeps the order of each sender; a loss is repaired at the next heartbeat, after 100 ms.\n' +
    'Who may say it: `mission::may_say()` compares the sender with that field of the message; what is not the sender\'s to say is dropped.\n' +
    'Where a team has keys every datagram is sealed, and decisions are signed by who takes them (security.md).\n\n' +
    '| topic | type | version | written by | read by | who may say it | where there are keys | delivery | urgency | kept by writer | kept by reader | bytes at most |\n' +
    `|---|---|---|---|---|---|---|---|---|---|---|---|\n${rows.join('')}${parts.join('')}`
}
