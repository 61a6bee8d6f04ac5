// SPDX-License-Identifier: Apache-2.0
//
// Reads a recording of ours with MCAP's own library, decodes every record twice, by the file's
// ros2msg schema and by our IDL, and compares both with what our program says was written:
//   node check_recording.mjs RECORDING_VECTORS IDL_FOLDER WORK_FOLDER
import { execFileSync } from 'node:child_process'
import { readFileSync, mkdirSync, rmSync } from 'node:fs'
import { join } from 'node:path'
import { McapIndexedReader, McapStreamReader } from '@mcap/core'
import { parse as parseRos } from '@foxglove/rosmsg'
import { MessageReader as RosReader } from '@foxglove/rosmsg2-serialization'
import { parseIDL } from '@foxglove/omgidl-parser'
import { MessageReader as IdlReader } from '@foxglove/omgidl-serialization'
import { decompress } from 'fzstd'

const [program, idlFolder, work] = process.argv.slice(2)
const folder = join(work, 'recording')
rmSync(folder, { recursive: true, force: true })
mkdirSync(folder, { recursive: true })
const lines = execFileSync(program, [folder], { encoding: 'utf8', maxBuffer: 1 << 28 })
  .trim().split('\n').map(line => line.split('\t'))
const bytes = readFileSync(join(folder, 'recording.mcap'))
const decompressHandlers = { zstd: (packed, size) => decompress(packed, new Uint8Array(Number(size))) }

const unionSchema = 'skein/msg/CoalitionMessage'
let compared = 0
function fail(what) {
  console.error(what)
  process.exit(1)
}

// What our program prints: {a: 1, b: [NAME, "text"]}. Integers become BigInt, names {name}.
function valueOf(text) {
  let at = 0
  const expect = sign => { if (text[at++] !== sign) fail(`expected ${sign} at ${at} of ${text}`) }
  const items = (end, one) => {
    while (text[at] !== end) {
      one()
      if (text[at] === ',') at += 2
    }
    ++at
  }
  function value() {
    if (text[at] === '{') {
      const object = {}
      ++at
      items('}', () => {
        const name = /[a-z_0-9]+/y
        name.lastIndex = at
        const key = name.exec(text)[0]
        at += key.length
        expect(':')
        expect(' ')
        object[key] = value()
      })
      return object
    }
    if (text[at] === '[') {
      const list = []
      ++at
      items(']', () => list.push(value()))
      return list
    }
    if (text[at] === '"') {
      let string = ''
      for (++at; text[at] !== '"'; ++at) {
        if (text[at] === '\\') ++at
        string += text[at]
      }
      ++at
      return string
    }
    const word = text.slice(at).match(/^[^,\]}]+/)[0]
    at += word.length
    if (word === 'true' || word === 'false') return word === 'true'
    if (/^-?\d+$/.test(word)) return BigInt(word)
    return /^[A-Z]/.test(word) ? { name: word } : Number(word)
  }
  return value()
}

// `ours` as valueOf() gives it, `theirs` as a library does.
function same(ours, theirs, constants, where) {
  ++compared
  if (typeof ours === 'object' && ours.name !== undefined && Object.keys(ours).length === 1 &&
      typeof theirs === 'number') {
    if (constants.get(ours.name) !== theirs) fail(`${where}: ${ours.name} is not ${theirs}`)
  } else if (Array.isArray(ours)) {
    const list = Array.from(theirs)
    if (ours.length !== list.length) fail(`${where}: ${ours.length} and ${list.length} elements`)
    ours.forEach((one, i) => same(one, list[i], constants, `${where}[${i}]`))
  } else if (typeof ours === 'object') {
    const names = Object.keys(theirs)
    if (Object.keys(ours).join() !== names.join()) fail(`${where}: ${Object.keys(ours)}; ${names}`)
    for (const key of names) same(ours[key], theirs[key], constants, `${where}.${key}`)
  } else if (typeof ours === 'bigint' && typeof theirs === 'number') {
    if (Number(ours) !== theirs) fail(`${where}: ${ours} and ${theirs}`)
  } else if (typeof ours === 'number' && Number.isNaN(ours)) {
    if (!Number.isNaN(theirs)) fail(`${where}: ${ours} and ${theirs}`)
  } else if (typeof ours === 'string' ? ours !== theirs.replace(/[\0-\x1f]/g, ' ') : ours !== theirs) {
    fail(`${where}: ${ours} and ${theirs}`)
  }
}

// A message of the IDL in the shape of the schema: the union's branch instead of the union, of which
// the schema's name tells. The discriminator is not given.
function inShapeOf(schema, message, kind) {
  if (!schema.startsWith(unionSchema)) return message
  const [branch, ...others] = Object.keys(message.body)
  const camel = branch.split('_').map(word => word[0].toUpperCase() + word.slice(1)).join('')
  if (others.length > 0 || unionSchema + camel !== schema) fail(`${schema} has ${branch}`)
  return { version: message.version, kind, body: message.body[branch] }
}

const idl = parseIDL(['domain', 'coalition', 'formation', 'mission', 'recording']
  .map(name => readFileSync(join(idlFolder, `${name}.idl`), 'utf8').replace(/^#include.*$/gm, ''))
  .join('\n'))
const idlTypes = new Map(idl.filter(d => d.aggregatedKind === 'struct')
  .map(d => [d.name.split('::').at(-1), d.name]))
const decoders = new Map()
function decoderOf(schema) {
  if (decoders.has(schema.id)) return decoders.get(schema.id)
  if (schema.encoding !== 'ros2msg') fail(`${schema.name}: encoding ${schema.encoding}`)
  const definitions = parseRos(new TextDecoder().decode(schema.data), { ros2: true })
  const constants = new Map(definitions.flatMap(d => d.definitions)
    .filter(d => d.isConstant).map(d => [d.name, Number(d.value)]))
  const short = schema.name.split('/').at(-1)
  const type = idlTypes.get(short) ?? idlTypes.get('CoalitionMessage')
  if (!idlTypes.has(short) && !short.startsWith('CoalitionMessage')) fail(`no IDL for ${short}`)
  const decoder = { ros: new RosReader(definitions), idl: new IdlReader(type, idl), constants }
  decoders.set(schema.id, decoder)
  return decoder
}

const readable = {
  size: async () => BigInt(bytes.length),
  read: async (offset, length) => bytes.subarray(Number(offset), Number(offset + length))
}
const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers })
if (reader.header.profile !== 'ros2') fail(`profile ${reader.header.profile}`)
if (Number(reader.statistics.messageCount) !== lines.length) fail('the statistics are wrong')
// Records of one moment may come in any order, but those of a channel in theirs.
const written = new Map()
for (const [time, topic, text] of lines) {
  const key = `${topic} at ${time}`
  written.set(key, [...(written.get(key) ?? []), text])
}
let i = 0
let last = 0n
for await (const message of reader.readMessages()) {
  const channel = reader.channelsById.get(message.channelId)
  const schema = reader.schemasById.get(channel.schemaId)
  const { topic } = channel
  const where = `${topic} at ${message.logTime}`
  const text = written.get(where)?.shift() ?? fail(`${where}: not written`)
  ++i
  if (message.logTime < last) fail(`${where}: too late`)
  last = message.logTime
  if (channel.messageEncoding !== 'cdr') fail(`${where}: ${channel.messageEncoding}`)
  const sender = topic.startsWith('/ground/') ? 0 : Number(topic.match(/^\/vehicle_(\d+)\//)[1])
  if (channel.metadata.get('sender') !== String(sender)) fail(`${where}: the sender is wrong`)
  const space = text.indexOf(' ')
  if (schema.name !== text.slice(0, space)) fail(`${where}: ${schema.name}`)
  const decoder = decoderOf(schema)
  const ours = valueOf(text.slice(space + 1))
  const byRos = decoder.ros.readMessage(message.data)
  const byIdl = inShapeOf(schema.name, decoder.idl.readMessage(message.data), byRos.kind)
  same(ours, byRos, decoder.constants, `${where}, by ros2msg`)
  same(ours, byIdl, decoder.constants, `${where}, by IDL`)
}
if (i !== lines.length) fail(`${i} of ${lines.length} records were read`)
for await (const metadata of reader.readMetadata()) {
  if (metadata.name !== 'skein' || metadata.metadata.get('node') !== '7' ||
      metadata.metadata.get('instance') !== '18446744073709551615' ||
      !metadata.metadata.get('configuration').includes('\u00e4')) fail('the metadata is wrong')
}

// From the front, with every checksum.
const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true })
stream.append(bytes)
let streamed = 0
for (let record; (record = stream.nextRecord());) streamed += record.type === 'Message' ? 1 : 0
if (!stream.done() || streamed !== lines.length) fail(`${streamed} records from the front`)

console.log(`${lines.length} records on ${reader.channelsById.size} channels, ${compared} values: the same`)
