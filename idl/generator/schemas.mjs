// SPDX-License-Identifier: Apache-2.0
//
// The layout of the bytes in languages that tools of others read: IDL without annotations, and ROS
// 2's .msg. What the codec adds stands there as ordinary fields: the version of a whole message, and
// the size of a part that may grow.
import { camel } from './model.mjs'

const whole = t => t.notes.version !== undefined
const version = 'version'
const size = 'size_bytes'
const stored = t => t.fields.filter(f => !f.notes.non_serialized)

// --- IDL -----------------------------------------------------------------------------------------

const idl_words = { bool: 'boolean', uint8: 'octet', int8: 'int8', uint16: 'unsigned short', int16: 'short', uint32: 'unsigned long', int32: 'long', uint64: 'unsigned long long', int64: 'long long', float64: 'double', float32: 'float' }

function idl_member(types, f) {
  const one = f.kind === 'string' ? `string<${f.bound}>` : idl_words[f.type] ?? types.get(f.type).tool_name
  return `  ${f.many === undefined ? one : `sequence<${one}, ${f.many}>`} ${f.name};\n`
}

export function wire_idl({ types }) {
  let text = '// Made from idl/: what stands in the bytes, for tools that know plain IDL.\nmodule skein {\nmodule wire {\n'
  for (const t of types.values()) {
    if (t.kind === 'enum') text += `\nenum ${t.tool_name} { ${t.values.map(v => v.name).join(', ')} };\n`
    if (t.kind === 'union') {
      const name = whole(t) ? `${t.tool_name}Body` : t.tool_name
      const on = types.get(t.on)
      text += `\nunion ${name} switch (${on.tool_name}) {\n` +
        t.branches.map((b, i) => `  case ${on.values[i].name}: ${types.get(b.type).tool_name} ${b.name};\n`).join('') + '};\n'
      if (whole(t)) text += `\nstruct ${t.tool_name} {\n  unsigned short ${version};\n  ${name} body;\n};\n`
    }
    if (t.kind === 'struct') {
      const first = whole(t) ? `  unsigned short ${version};\n` : t.grows ? `  unsigned long ${size};\n` : ''
      text += `\nstruct ${t.tool_name} {\n${first}${stored(t).map(f => idl_member(types, f)).join('')}};\n`
    }
  }
  return `${text}\n};\n};\n`
}

// --- ros2msg -------------------------------------------------------------------------------------

const ros_words = { ...Object.fromEntries(Object.keys(idl_words).map(k => [k, k])), uint8: 'uint8' }
const separator = '='.repeat(80)

// One definition with all that it is made of, each once; `branch` stands for the union.
function ros_text(types, t, branch) {
  const used = []
  const lines = (fields, constants = new Set()) => fields.map(f => {
    let text = ''
    if (f.kind === 'enum' && f.many === undefined && !constants.has(f.type)) {
      constants.add(f.type)
      text += types.get(f.type).values.map((v, i) => `uint32 ${v.name}=${i}\n`).join('')
    }
    let type = { enum: 'uint32', string: `string<=${f.bound}` }[f.kind] ?? ros_words[f.type]
    if (f.kind === 'struct') {
      type = types.get(f.type).tool_name
      if (!used.includes(f.type)) used.push(f.type)
    }
    return `${text}${type}${f.many === undefined ? '' : `[<=${f.many}]`} ${f.name}\n`
  }).join('')
  const fields = (t.kind === 'union' ? [{ kind: 'union', type: t.name, name: 'body', notes: {} }] : stored(t))
    .flatMap(f => f.kind !== 'union' ? [f] : [
      { kind: 'enum', type: types.get(f.type).on, name: 'kind', notes: {} },
      { ...branch, name: f.name }
    ])
  let text = `uint16 VERSION=${t.notes.version ?? 0}\nuint16 ${version}\n${lines(fields)}`
  for (let i = 0; i < used.length; ++i) {
    const part = types.get(used[i])
    text += `${separator}\nMSG: skein/${part.tool_name}\n${part.grows ? `uint32 ${size}\n` : ''}${lines(stored(part))}`
  }
  return text
}

// Of every whole message: { type, kind: the union's branch or -1, branch, name, version, text }.
export function ros_schemas({ types }) {
  return [...types.values()].filter(whole).flatMap(t => {
    const union = t.kind === 'union' ? t : types.get(t.fields.find(f => f.kind === 'union')?.type)
    const one = (branch, kind) => ({
      type: t.tool_name, kind, branch: branch?.name ?? '', version: t.notes.version,
      name: `skein/msg/${t.tool_name}${branch ? camel(branch.name) : ''}`, text: ros_text(types, t, branch)
    })
    return union ? union.branches.map(one) : [one(undefined, -1)]
  })
}

export function schemas_source(model) {
  const schemas = ros_schemas(model)
  const rows = schemas.map(s => `{"${s.type}", ${s.kind}, "${s.branch}", "${s.name}", ${s.version},\n R"MSG(${s.text})MSG"},\n`)
  return '// SPDX-License-Identifier: Apache-2.0\n// Made from idl/.\n#include "skein/schemas/schemas.hpp"\n\n#include <array>\n\nnamespace skein::schemas {\nnamespace {\n\n' +
    `constexpr std::array<Schema, ${schemas.length}> kSchemas{{\n${rows.join('')}}};\n\n}  // namespace\n\n` +
    'std::span<const Schema> all() { return kSchemas; }\n\n}  // namespace skein::schemas\n'
}

// --- TypeScript ----------------------------------------------------------------------------------

const ts_words = { bool: 'boolean', uint64: 'string', int64: 'string' }

function ts_type(types, f) {
  const one = f.kind === 'string' ? 'string' : f.kind === 'primitive' ? ts_words[f.type] ?? 'number' : types.get(f.type).tool_name
  return f.many === undefined ? (f.notes.present ? `${one} | null` : one) : `${one}[]`
}

export function typescript({ types }) {
  let text = '// SPDX-License-Identifier: Apache-2.0\n// Made from idl/: messages as json_of() writes them. Integers of 64 bits are strings.\n'
  const doc = t => t.before?.length ? `/** ${t.before.join('\n *  ')} */\n` : ''
  for (const t of types.values()) {
    if (t.kind === 'enum') text += `\n${doc(t)}export type ${t.tool_name} = ${t.values.map(v => `"${v.name.toLowerCase()}"`).join(' | ')};\n`
    if (t.kind === 'const') text += `\nexport const ${t.name.split('::').at(-1).replace(/^k/, '').replace(/([a-z])([A-Z])/g, '$1_$2').toLowerCase()} = ${t.value};\n`
    if (t.kind === 'union') {
      text += `\n${doc(t)}export type ${t.tool_name} =\n${t.branches.map(b => `  | { kind: "${types.get(b.type).tool_name}"; body: ${types.get(b.type).tool_name} }`).join('\n')};\n`
    }
    if (t.kind === 'struct') {
      text += `\n${doc(t)}export interface ${t.tool_name} {\n` + stored(t).filter(f => !f.flag)
        .map(f => `  ${f.name}: ${ts_type(types, f)};${f.after ? ` // ${f.after}` : ''}\n`).join('') + '}\n'
    }
  }
  return text
}
