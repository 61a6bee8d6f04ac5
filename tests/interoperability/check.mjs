// SPDX-License-Identifier: Apache-2.0
//
// Compares our MAVLink with node-mavlink, both ways: node check.mjs VECTORS_PROGRAM
import { execFileSync } from 'node:child_process'
import { Readable } from 'node:stream'
import {
  MavLinkPacketSignature, MavLinkProtocolV1, MavLinkProtocolV2, createMavLinkStream,
  minimal, standard, common, ardupilotmega, development
} from 'node-mavlink'

const vectors = process.argv[2]
const registry = {
  ...minimal.REGISTRY, ...standard.REGISTRY, ...development.REGISTRY, ...common.REGISTRY,
  ...ardupilotmega.REGISTRY
}
const passphrase = 'a passphrase'
const key = MavLinkPacketSignature.key(passphrase)
const rounds = 20
let compared = 0

const ours = (args, input) =>
  execFileSync(vectors, args, { input, encoding: 'utf8', maxBuffer: 1 << 28 }).trim().split('\n')

function same(a, b, what) {
  ++compared
  if (a === b) return
  console.error(`${what} differ:\n  ours ${a}\n  node ${b}`)
  process.exit(1)
}

const hex = (value, digits) => value.toString(16).padStart(digits, '0')
const elementText = (type, value) => {
  if (type.startsWith('float')) {
    return hex(new Uint32Array(new Float32Array([value]).buffer)[0], 8)
  }
  return value.toString()
}

// What a message holds, in the words of our program.
function contentOf(message) {
  const parts = message.constructor.FIELDS.map(field => {
    const value = message[field.name]
    if (field.type === 'char[]') {
      const text = value.split('\0')[0]
      return `${field.source}=${[...text].map(c => hex(c.charCodeAt(0), 2)).join('')}`
    }
    const values = field.type.endsWith('[]') ? value : [value]
    return `${field.source}=${values.map(v => elementText(field.type, v)).join(',')}`
  })
  return [message.constructor.MSG_NAME, ...parts].join(' ')
}

// Seeded, so that a failure can be seen again.
let state = 1n
function random() {
  state = (state * 6364136223846793005n + 1442695040888963407n) & 0xffffffffffffffffn
  return state >> 11n
}
function randomElement(type) {
  const name = type.replace('[]', '').replace('_mavlink_version', '')
  if (name === 'float') return Math.fround(Number(random() % 200000n) / 7 - 14000)
  const bits = Number(name.match(/\d+/)[0])
  const kinds = [0n, (1n << BigInt(bits)) - 1n, random()]
  const raw = BigInt.asUintN(bits, kinds[Number(random() % 3n)])
  const value = name.startsWith('u') ? raw : BigInt.asIntN(bits, raw)
  return bits === 64 ? value : Number(value)
}
function randomMessage(clazz) {
  const message = new clazz()
  for (const field of clazz.FIELDS) {
    if (field.type === 'char[]') {
      const size = Number(random() % BigInt(field.length + 1))
      message[field.name] = 'x'.repeat(size)
    } else if (field.type.endsWith('[]')) {
      message[field.name] = Array.from({ length: field.length }, () => randomElement(field.type))
    } else {
      message[field.name] = randomElement(field.type)
    }
  }
  return message
}

async function nodeReads(lines, check) {
  const bytes = Buffer.concat(lines.map(line => Buffer.from(line.split(' ')[0], 'hex')))
  const magicNumbers = Object.fromEntries(
    Object.entries(registry).map(([id, clazz]) => [id, clazz.MAGIC_NUMBER]))
  const stream = createMavLinkStream(Readable.from([bytes]), {
    magicNumbers,
    onCrcError: () => { console.error('node-mavlink finds a bad checksum'); process.exit(1) }
  })
  let i = 0
  for await (const packet of stream) {
    const line = lines[i++]
    const message = packet.protocol.data(packet.payload, registry[packet.header.msgid])
    same(line.slice(line.indexOf(' ') + 1), contentOf(message), 'what we wrote and node read')
    if (check) check(packet)
  }
  same(lines.length, i, 'numbers of packets')
}

const ids = [...new Set(ours(['write', '1', '1']).map(line =>
  Buffer.from(line.split(' ')[0], 'hex').readUIntLE(7, 3)))]

await nodeReads(ours(['write', '2', String(rounds)]))
await nodeReads(ours(['write', '3', '1', passphrase]), packet =>
  same(true, packet.signature?.matches(key) ?? false, 'signatures'))

function weRead(serialize, args, what) {
  const messages = Array.from({ length: rounds }, () =>
    ids.map(id => randomMessage(registry[id]))).flat()
  const packets = messages.map(serialize)
  const lines = ours(['read', ...args], packets.map(p => p.toString('hex')).join('\n') + '\n')
  same(messages.length, lines.length, 'numbers of packets')
  lines.forEach((line, i) => same(line, contentOf(messages[i]), what))
}

const second = new MavLinkProtocolV2(1, 191)
const first = new MavLinkProtocolV1(1, 191)
weRead((message, i) => second.serialize(message, i & 255), [], 'what node wrote and we read')
weRead((message, i) => {
  const signing = new MavLinkProtocolV2(1, 191, MavLinkProtocolV2.IFLAG_SIGNED)
  return signing.sign(signing.serialize(message, i & 255), 3, key, Date.UTC(2026, 0, 1) + i)
}, [passphrase], 'what node signed and we read')
const firstIds = ids.filter(id => id < 256)
ids.splice(0, ids.length, ...firstIds)
weRead((message, i) => first.serialize(message, i & 255), [], 'what node wrote as MAVLink 1')

console.log(`${compared} comparisons with node-mavlink, ${rounds} of each message and way: the same`)
