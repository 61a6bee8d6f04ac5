// SPDX-License-Identifier: Apache-2.0
//
// Reads a recording of ours with MCAP's own library, decodes every record twice, by the file's
// ros2msg schema and by the IDL of the bytes, and compares both with what our program says was written:
//   node check_recording.mjs RECORDING_VECTORS WIRE_IDL WORK_FOLDER
import { execFileSync } from 'node:child_process'
import { readFileSync, mkdirSync, rmSync } from 'node:fs'
import { join } from 'node:path'
import { McapIndexedReader, McapStreamReader } from '@mcap/core'
import { parse as parseRos } from '@foxglove/rosmsg'
import { MessageReader as RosReader } from '@foxglove/rosmsg2-serialization'
import { parseIDL } from '@foxglove/omgidl-parser'
import { MessageReader as IdlReader } from '@foxglove/omgidl-serialization'
import { decompress } from 'fzstd'

const [program, idlFile, work] = process.argv.slice(2)
const folder = join(work, 'recording')
rmSync(folder, { recursive: true, force: true })
mkdirSync(folder, { recursive: true })
const lines = execFileSync(program, [folder], { encoding: 'utf8', maxBuffer: 1 << 28 })
  .trim().split('\n').map(line => line.split('\t'))
const bytes = readFileSync(join(folder, 'recording.mcap'))
const decompressHandlers = { zstd: (packed, size) => decompress(packed, new Uint8Array(Number(size))) }

let compared = 0
function fail(what) {
  console.error(what)
  process.exit(1)
}

// What the codec adds to the fields of a message, as idl/README.md has it.
const added = new Set(['version', 'size_bytes', 'kind'])

// `ours` as our program says it in JSON (integers of 64 bits are strings, what is not there is
// null), `theirs` as a library reads it from the bytes, `type` what the schema says of both: an
// enumerator's number is that of its own message, and two enumerations may have one of a name.
function same(ours, theirs, type, where) {
  ++compared
  if (Array.isArray(ours)) {
    const list = Array.from(theirs)
    if (ours.length !== list.length) fail(`${where}: ${ours.length} and ${list.length} elements`)
    ours.forEach((one, i) => same(one, list[i], type, `${where}[${i}]`))
  } else if (ours !== null && typeof ours === 'object') {
    const fields = Object.keys(theirs).filter(key => !added.has(key) || key in ours)
    const expected = Object.keys(ours).flatMap(key => `has_${key.replace(/_rad$/, '')}` in theirs
      ? [`has_${key.replace(/_rad$/, '')}`, key] : [key])
    if (expected.join() !== fields.join()) fail(`${where}: ${expected}; ${fields}`)
    for (const key of Object.keys(ours)) {
      const flag = theirs[`has_${key.replace(/_rad$/, '')}`]
      if (flag !== undefined && flag !== (ours[key] !== null)) fail(`${where}.${key}: ${flag}`)
      if (flag !== false) same(ours[key], theirs[key], type.of(key), `${where}.${key}`)
    }
  } else if (typeof ours === 'string' && typeof theirs === 'number') {
    if (type.constants.get(ours.toUpperCase()) !== theirs) fail(`${where}: ${ours} is not ${theirs}`)
  } else if (typeof theirs === 'bigint') {
    if (ours !== theirs.toString()) fail(`${where}: ${ours} and ${theirs}`)
  } else if (ours !== theirs) {
    fail(`${where}: ${ours} and ${theirs}`)
  }
}

// A message that ends in a union: what a library makes of its branch, in the shape of our JSON.
function branch_of(ours, theirs) {
  return 'kind' in ours && 'body' in ours && Object.keys(ours).length === 2
    ? [ours.body, theirs.body] : [{ ...ours, body: ours.body.body }, theirs]
}

// By IDL a union has its branch's name, by ros2msg it is the field itself; and the schema's name
// tells which.
function inShapeOf(schema, message) {
  const [branch, ...others] = Object.keys(message.body)
  const camel = branch.split('_').map(word => word[0].toUpperCase() + word.slice(1)).join('')
  if (others.length > 0 || !schema.endsWith(camel)) fail(`${schema} has ${branch}`)
  return { ...message, body: message.body[branch] }
}

const idl = parseIDL(readFileSync(idlFile, 'utf8'))
const idlTypes = new Set(idl.filter(d => d.aggregatedKind === 'struct').map(d => d.name))
const withUnion = new Set(['CoalitionMessage', 'MissionEvent'])
// Of "skein/msg/CoalitionMessageBid": the message whose branch it is.
function typeOf(schema) {
  const short = schema.split('/').at(-1)
  const whole = [...withUnion].find(name => short.startsWith(name)) ?? short
  if (!idlTypes.has(`skein::wire::${whole}`)) fail(`no IDL for ${schema}`)
  return whole
}
const decoders = new Map()
function decoderOf(schema) {
  if (decoders.has(schema.id)) return decoders.get(schema.id)
  if (schema.encoding !== 'ros2msg') fail(`${schema.name}: encoding ${schema.encoding}`)
  const definitions = parseRos(new TextDecoder().decode(schema.data), { ros2: true })
  const types = new Map()
  for (const { name, definitions: fields } of definitions) {
    const complex = new Map(fields.filter(f => f.isComplex).map(f => [f.name, f.type]))
    const described = {
      constants: new Map(fields.filter(f => f.isConstant).map(f => [f.name, Number(f.value)])),
      of: field => complex.has(field) ? types.get(complex.get(field)) : described
    }
    types.set(name, described)
  }
  const type = typeOf(schema.name)
  const decoder = {
    ros: new RosReader(definitions), idl: new IdlReader(`skein::wire::${type}`, idl),
    described: types.get(definitions[0].name),
    union: withUnion.has(type)
  }
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
  const decoder = decoderOf(schema)
  const ours = JSON.parse(text)
  const byRos = decoder.ros.readMessage(message.data)
  const byIdl = decoder.idl.readMessage(message.data)
  const pairs = [[byRos, 'ros2msg'], [decoder.union ? inShapeOf(schema.name, byIdl) : byIdl, 'IDL']]
  for (const [theirs, by] of pairs) {
    const [mine, yours] = decoder.union ? branch_of(ours, theirs) : [ours, theirs]
    const { described } = decoder
    same(mine, yours, mine === ours.body ? described.of('body') : described, `${where}, by ${by}`)
  }
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
