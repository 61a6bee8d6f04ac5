// SPDX-License-Identifier: Apache-2.0
//
// All that other agencies' systems would be sent of a mission of many vehicles in virtual time, read
// by @tak-ps/node-cot and node-mavlink and held against where the vehicles were.
//   node mission.mjs PROGRAM VEHICLES SECONDS
import assert from 'node:assert/strict'
import { spawn } from 'node:child_process'
import { PassThrough } from 'node:stream'

const [program, vehicles_text = '50', seconds_text = '300'] = process.argv.slice(2)
const [kVehicles, kSeconds] = [Number(vehicles_text), Number(seconds_text)]
if (Number(process.versions.node.split('.')[0]) < 20) {
  console.log(`skipped: @tak-ps/node-cot needs node 20 or newer, this is ${process.version}`)
  process.exit(77)
}
const { CoTParser } = await import('@tak-ps/node-cot')
const { createMavLinkStream, minimal, standard, common } = await import('node-mavlink')

const kPlace_m = 1.0
const kAge_s = 0.5
const kEpoch_ms = 1_760_000_000_000
const kTruth = 0, kXml = 1, kProtobuf = 2, kMavlink = 3

// --- where they were ---------------------------------------------------------------------------

const kA = 6378137.0
const kE2 = 0.0066943799901413165
const rad = deg => (deg * Math.PI) / 180
function ecef(latitude_deg, longitude_deg, height_m) {
  const [phi, lambda] = [rad(latitude_deg), rad(longitude_deg)]
  const n = kA / Math.sqrt(1 - kE2 * Math.sin(phi) ** 2)
  return [(n + height_m) * Math.cos(phi) * Math.cos(lambda), (n + height_m) * Math.cos(phi) * Math.sin(lambda),
    (n * (1 - kE2) + height_m) * Math.sin(phi)]
}

/** Of each vehicle the last seconds, ten a second. */
const kKept = 300
const truth = new Map()
function take_truth(bytes, time_s) {
  const vehicle = bytes.readUInt16LE(0)
  const place = ecef(bytes.readDoubleLE(2), bytes.readDoubleLE(10), bytes.readDoubleLE(18))
  if (!truth.has(vehicle)) truth.set(vehicle, [])
  const track = truth.get(vehicle)
  track.push([time_s, place])
  if (track.length > 2 * kKept) track.splice(0, kKept)
}
/** How far from there it was then; null where that is not known. */
function error_m(vehicle, time_s, place) {
  const track = truth.get(vehicle) ?? []
  let next = track.length - 1
  while (next > 0 && track[next - 1][0] >= time_s) --next
  if (next < 1 || track[next][0] < time_s - 0.002) return null
  const [[t0, a], [t1, b]] = [track[next - 1], track[next]]
  const share = Math.min(1, (time_s - t0) / (t1 - t0))
  return Math.hypot(...[0, 1, 2].map(i => a[i] + share * (b[i] - a[i]) - place[i]))
}

class Places {
  constructor(what) {
    Object.assign(this, { what, count: 0, compared: 0, worst_m: 0, oldest_s: 0, of: new Map() })
  }
  take(vehicle, time_s, heard_s, latitude_deg, longitude_deg, height_m) {
    ++this.count
    this.of.set(vehicle, (this.of.get(vehicle) ?? 0) + 1)
    this.oldest_s = Math.max(this.oldest_s, heard_s - time_s)
    const error = error_m(vehicle, time_s, ecef(latitude_deg, longitude_deg, height_m))
    if (error === null) return
    ++this.compared
    this.worst_m = Math.max(this.worst_m, error)
  }
  judge(least_per_s) {
    console.log(`${this.what}: ${this.count} places, ${this.compared} compared, ${this.worst_m.toFixed(3)} m off at ` +
      `most, ${this.oldest_s.toFixed(3)} s old at most`)
    assert(this.compared > 0.9 * this.count, `${this.what}: too few can be compared`)
    assert(this.worst_m <= kPlace_m, `${this.what}: a place is ${this.worst_m} m off`)
    assert(this.oldest_s <= kAge_s, `${this.what}: a place is ${this.oldest_s} s old when it is sent`)
    assert.equal(this.of.size, kVehicles, `${this.what}: of all vehicles`)
    for (const [vehicle, count] of this.of) {
      assert(count >= least_per_s * kSeconds, `${this.what}: vehicle ${vehicle} is shown ${count} times`)
    }
  }
}
const cot_places = new Places('cot')
const protobuf_places = new Places('cot by protobuf')
const mavlink_places = new Places('mavlink')
const rejected = []
const counts = new Map()
const count = name => counts.set(name, (counts.get(name) ?? 0) + 1)
function reject(what, why) {
  rejected.push(`${what}: ${why}`)
}

// --- Cursor on Target --------------------------------------------------------------------------

async function take_cot(what, places, bytes, heard_s, read) {
  try {
    const cot = await read(bytes)
    const { uid, type, time, stale } = cot.raw.event._attributes
    count(`${what} ${type}`)
    const feature = await CoTParser.to_geojson(cot)
    assert.equal(feature.id, uid)
    const vehicle = /^alpha-vehicle-(\d+)$/.exec(uid)
    if (!vehicle) return
    assert(Date.parse(stale) > Date.parse(time), uid)
    const { lat, lon, hae } = cot.raw.event.point._attributes
    places.take(Number(vehicle[1]), (Date.parse(time) - kEpoch_ms) / 1000, heard_s, Number(lat), Number(lon), Number(hae))
  } catch (error) {
    reject(what, error.message)
  }
}

// --- MAVLink -----------------------------------------------------------------------------------

const registry = { ...minimal.REGISTRY, ...standard.REGISTRY, ...common.REGISTRY }
const datagrams = new PassThrough()
const packets = createMavLinkStream(datagrams)
let sent_packets = 0
let read_packets = 0
let heard_s = 0
packets.on('error', error => reject('mavlink', error.message))
packets.on('data', packet => {
  ++read_packets
  const { header, payload, protocol } = packet
  const Message = registry[header.msgid]
  if (!Message) return reject('mavlink', `message ${header.msgid} is not known`)
  let message
  try {
    message = protocol.data(payload, Message)
  } catch (error) {
    return reject('mavlink', error.message)
  }
  count(`mavlink ${Message.MSG_NAME}`)
  if (Message.MSG_NAME === 'GLOBAL_POSITION_INT') {
    mavlink_places.take(header.sysid, message.timeBootMs / 1000, heard_s, message.lat / 1e7, message.lon / 1e7, message.alt / 1e3)
  } else if (Message.MSG_NAME === 'OPEN_DRONE_ID_BASIC_ID') {
    const id = Buffer.from(message.uasId).toString('latin1').replace(/\0+$/, '')
    if (id !== `1ABCD${header.sysid}`) reject('mavlink', `Remote ID ${id} of ${header.sysid}`)
  }
})
/** Waits until the parser has read all that it was given. */
async function drain() {
  for (let i = 0; read_packets < sent_packets && i < 10_000; ++i) await new Promise(resolve => setImmediate(resolve))
}

// --- all of it ---------------------------------------------------------------------------------

const child = spawn(program, [String(kVehicles), String(kSeconds)], { stdio: ['ignore', 'pipe', 'inherit'] })
const ended = new Promise(resolve => child.on('exit', resolve))
const begun_ms = Date.now()
let rest = Buffer.alloc(0)
const kHead = 13
for await (const chunk of child.stdout) {
  let bytes = rest.length > 0 ? Buffer.concat([rest, chunk]) : chunk
  let at = 0
  while (bytes.length - at >= kHead) {
    const length = bytes.readUInt32LE(at + 9)
    if (bytes.length - at < kHead + length) break
    const kind = bytes[at]
    const time_s = Number(bytes.readBigInt64LE(at + 1)) / 1e9
    const body = bytes.subarray(at + kHead, at + kHead + length)
    at += kHead + length
    if (kind !== kMavlink && sent_packets > read_packets) await drain()
    if (kind === kTruth) {
      take_truth(body, time_s)
    } else if (kind === kXml) {
      await take_cot('cot by xml', cot_places, body, time_s, text => CoTParser.from_xml(text))
    } else if (kind === kProtobuf) {
      assert.deepEqual([...body.subarray(0, 3)], [0xbf, 0x01, 0xbf])
      await take_cot('cot by protobuf', protobuf_places, body, time_s, of => CoTParser.from_proto(of.subarray(3)))
    } else {
      if (heard_s !== time_s) await drain()
      heard_s = time_s
      ++sent_packets
      datagrams.write(Buffer.from(body))
    }
  }
  rest = bytes.subarray(at)
}
await drain()
assert.equal(await ended, 0, 'the mission was flown')
assert.equal(rest.length, 0, 'of whole records')

console.log([...counts].map(([name, n]) => `${n} ${name}`).join('\n'))
cot_places.judge(0.9)
protobuf_places.judge(0.9)
mavlink_places.judge(2.0)
const messages = [...counts.values()].reduce((a, b) => a + b, 0)
console.log(`${messages} messages, ${rejected.length} rejected, ${sent_packets - read_packets} packets not found, in ` +
  `${((Date.now() - begun_ms) / 1000).toFixed(0)} s`)
assert.deepEqual(rejected.slice(0, 5), [])
assert.equal(read_packets, sent_packets, 'every packet is found')
for (const name of ['cot by xml a-f-A-M-F-Q', 'cot by xml b-m-p-s-m', 'cot by xml u-d-f',
  'mavlink HEARTBEAT', 'mavlink MISSION_CURRENT', 'mavlink OPEN_DRONE_ID_LOCATION', 'mavlink OPEN_DRONE_ID_SYSTEM']) {
  assert(counts.has(name), name)
}
process.exit(0)
