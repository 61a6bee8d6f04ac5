// SPDX-License-Identifier: Apache-2.0
//
// What the IDL files say, for the writers of this folder: declarations in their order, each with its
// comments. Foxglove's parser reads the language; what it drops (comments, the enumeration that a
// union switches on, which file a name is of) is picked from the lines.
import { readFileSync } from 'node:fs'
import { basename } from 'node:path'
import { parseIDL } from '@foxglove/omgidl-parser'

const annotation = /@\w+(?:\((?:[^()"]|"[^"]*")*\))?/g

export function fail(what) {
  throw new Error(what)
}

// Of one file: its declarations in order, and the comments by full name.
function scan(text) {
  const declared = []
  const comments = new Map()
  const scope = []
  let before = []
  let cpp
  for (const line of text.split('\n')) {
    const [, code, comment] = /^((?:[^/"]|"[^"]*"|\/(?!\/))*)(?:\/\/ ?(.*))?$/.exec(line)
    const words = code.replace(annotation, '').trim()
    // The parser forgets the annotations of an enumeration.
    const outside = /@cpp\(type="([^"]+)", header="([^"]+)"\)/.exec(code)
    if (outside) cpp = { type: outside[1], header: outside[2] }
    if (words === '') {
      if (comment !== undefined && code.trim() === '') before.push(comment)
      if (comment === undefined && code.trim() === '') before = []
      continue
    }
    const note = name => {
      const full = [...scope, name].join('::')
      comments.set(full, { before, after: comment ?? '' })
      return full
    }
    const opens = /^(module|struct|enum|union)\s+(\w+)(?:\s+switch\s*\(\s*(\w+)\s*\))?\s*\{/.exec(words)
    if (opens) {
      const [, kind, name, on] = opens
      const full = note(name)
      if (kind !== 'module') declared.push({ kind, name: full, on, cpp })
      scope.push(name)
    } else if (words.startsWith('const ')) {
      const [, name, value] = /(\w+)\s*=\s*(\d+)\s*;/.exec(words) ?? fail(`${words}: a constant is a whole number`)
      declared.push({ kind: 'const', name: note(name), value })
    } else if (!words.startsWith('typedef ')) {
      const last = /(\w+)\s*[;,]?\s*$/.exec(words)
      if (last) note(last[1])
    }
    if (words.includes('}')) scope.pop()
    before = []
    cpp = undefined
  }
  return { declared, comments }
}

const values = annotations => Object.fromEntries(Object.entries(annotations ?? {})
  .map(([name, a]) => [name, a.type === 'named-params' ? a.namedParams : a.value ?? true]))

const upper = text => text[0].toUpperCase() + text.slice(1)
export const camel = text => text.split('_').map(upper).join('')
export const snake = text => text.replace(/([a-z0-9])([A-Z])/g, '$1_$2').toLowerCase()
export const last = name => name.split('::').at(-1)
export const scope_of = name => name.split('::').slice(0, -1).join('::')

// { files: [{ name, declarations }], types: Map of full name to declaration }
//   const   { value }
//   enum    { values: [{ name }] }
//   struct  { fields, notes: annotations }
//   union   { on: enum's full name, branches: fields, notes }
// A field: { name, type: primitive or full name, kind: 'primitive' | 'enum' | 'struct' | 'union' |
// 'string', many: bound or undefined, bound: of a string, notes, value: default, before, after }
export function load(paths) {
  const files = paths.map(path => ({
    name: basename(path, '.idl'), ...scan(readFileSync(path, 'utf8'))
  }))
  const parsed = new Map(parseIDL(paths.map(path => readFileSync(path, 'utf8')).join('\n'))
    .map(d => [d.name, d]))
  const types = new Map()
  const kinds = new Map(files.flatMap(file => file.declared).map(d => [d.name, d.kind]))
  const words = new Map()

  const field_of = (owner, comments) => d => {
    const type = d.enumType ?? d.type
    const kind = d.enumType ? 'enum' : d.isComplex ? kinds.get(type) : type === 'string' ? type : 'primitive'
    const where = `${owner}::${d.name}`
    if (d.arrayLengths) fail(`${where}: no arrays, use a bounded sequence`)
    if (d.isArray && d.arrayUpperBound === undefined) fail(`${where}: a sequence needs a bound`)
    if (kind === 'string' && d.upperBound === undefined) fail(`${where}: a string needs a bound`)
    const notes = values(d.annotations)
    if (notes.appended && d.defaultValue === undefined && !d.isArray) fail(`${where}: what is appended needs a default`)
    return {
      name: d.name, type, kind, many: d.isArray ? d.arrayUpperBound : undefined, bound: d.upperBound,
      notes, value: d.defaultValue, ...(comments.get(where) ?? { before: [], after: '' })
    }
  }

  for (const file of files) {
    file.declarations = file.declared.map(({ kind, name, on, value, cpp }) => {
      // The parser forgets the constants of a module that is opened again.
      const d = kind === 'const' ? { value } : parsed.get(name) ?? fail(`${name}: the parser does not know it`)
      const made = { kind, name, value, notes: values(d.annotations), ...file.comments.get(name) }
      if (kind === 'enum') {
        if (cpp) made.notes.cpp = cpp
        made.values = d.definitions.map((v, i) => {
          if (v.value !== i) fail(`${name}::${v.name}: enumerators count from 0 without a gap`)
          return { name: v.name, ...file.comments.get(`${name}::${v.name}`) }
        })
      }
      if (kind === 'struct') made.fields = d.definitions.map(field_of(name, file.comments))
      if (kind === 'union') {
        made.on = [`${scope_of(name)}::${on}`, on].find(n => kinds.get(n) === 'enum') ??
          fail(`${name}: it must switch on an enumeration of its module`)
        made.branches = d.cases.map(c => field_of(name, file.comments)(c.type))
        if (made.branches.some((b, i) => b.kind !== 'struct' || b.many || d.cases[i].predicates.join() !== `${i}`)) {
          fail(`${name}: its branches are structs, one for each enumerator in their order`)
        }
      }
      types.set(name, made)
      return made
    })
  }
  // One name in tools: the last word, with its module's before it where it would be said of two.
  for (const t of types.values()) {
    if (t.kind !== 'const') words.set(last(t.name), (words.get(last(t.name)) ?? 0) + 1)
  }
  for (const t of types.values()) {
    const alone = words.get(last(t.name)) === 1 && t.kind !== 'union'
    t.tool_name = t.notes.tool_name ?? (alone ? last(t.name) : camel(last(scope_of(t.name))) + last(t.name))
    t.grows = t.kind === 'struct' && !t.notes.final
  }
  check_present(types)
  return { files, types }
}

function check_present(types) {
  for (const t of types.values()) {
    (t.fields ?? []).forEach((f, i) => {
      if (f.notes.present && t.fields[i - 1]?.name !== f.notes.present) {
        fail(`${t.name}::${f.name}: ${f.notes.present} must stand before it`)
      }
      if (f.kind === 'union' && (i + 1 !== t.fields.length || f.many)) {
        fail(`${t.name}::${f.name}: a union can only be the last member`)
      }
      if (!f.notes.appended && t.fields[i - 1]?.notes.appended && !f.notes.non_serialized) {
        fail(`${t.name}::${f.name}: what is appended stands at the end`)
      }
      if (f.notes.appended && t.notes.final) fail(`${t.name} is @final: nothing can be appended`)
      f.flag = t.fields[i + 1]?.notes.present === f.name
    })
  }
}

const sizes = { bool: 1, uint8: 1, int8: 1, uint16: 2, int16: 2, uint32: 4, int32: 4, float32: 4, uint64: 8, int64: 8, float64: 8 }

// The most bytes of a whole message. Sound, since each step's end grows with its begin.
export function size_max(types, name) {
  const scalar = (at, size) => Math.ceil(at / size) * size + size
  const one = (at, f) => {
    if (f.kind === 'enum') return scalar(at, 4)
    if (f.kind === 'string') return scalar(at, 4) + f.bound + 1
    if (f.kind === 'primitive') return scalar(at, sizes[f.type] ?? fail(`${f.type} is not supported`))
    return part(at, types.get(f.type))
  }
  const part = (at, t) => {
    if (t.kind === 'union') return Math.max(...t.branches.map(b => one(scalar(at, 4), b)))
    return t.fields.filter(f => !f.notes.non_serialized).reduce((end, f) => {
      if (f.many === undefined) return one(end, f)
      end = scalar(end, 4)
      for (let i = 0; i < f.many; ++i) end = one(end, f)
      return end
    }, t.grows ? scalar(at, 4) : at)
  }
  const whole = types.get(name)
  return 4 + part(2, { ...whole, grows: false })
}
