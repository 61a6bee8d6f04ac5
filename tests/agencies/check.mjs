// SPDX-License-Identifier: Apache-2.0
//
// A small mission whose ground station shows it to others: all that it sends is read by @tak-ps/node-cot
// and node-mavlink, and compared with what the vehicles recorded of themselves. Traffic is on loopback.
//   node check.mjs PROGRAMS_FOLDER EXAMPLES_FOLDER
import assert from 'node:assert/strict'
import { execFileSync, spawn } from 'node:child_process'
import { createSocket } from 'node:dgram'
import { once } from 'node:events'
import { existsSync, mkdirSync, openSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import { createServer } from 'node:net'
import { dirname, join } from 'node:path'
import { Readable } from 'node:stream'
import { fileURLToPath } from 'node:url'

const [programs, examples] = process.argv.slice(2)
const work = dirname(fileURLToPath(import.meta.url))
if (Number(process.versions.node.split('.')[0]) < 20) {
  console.log(`skipped: @tak-ps/node-cot needs node 20 or newer, this is ${process.version}`)
  process.exit(77)
}
const { CoTParser } = await import('@tak-ps/node-cot')
const { createMavLinkStream, minimal, standard, common } = await import('node-mavlink')

const kTeam = 'alpha'
const kVehicles = [1, 2, 3]
const kPlace_m = 1.0
const kAge_s = 0.5
const uas_id_of = id => `1ABCD012345678${id}`

// --- where others listen -----------------------------------------------------------------------

/** Datagrams as they come, with the moment. */
async function listener() {
  const socket = createSocket('udp4')
  const made = { socket, got: [] }
  socket.on('message', (bytes, from) => {
    made.from = from
    made.got.push({ bytes, at_ms: Date.now() })
  })
  socket.bind(0, '127.0.0.1')
  await once(socket, 'listening')
  return Object.assign(made, { port: socket.address().port })
}

/** A TAK server's port for streams: what comes in, of all connections. */
async function stream_server() {
  const server = createServer()
  const server_state = { text: '', connections: new Set(), count: 0 }
  server.on('connection', connection => {
    ++server_state.count
    server_state.connections.add(connection)
    connection.on('data', bytes => (server_state.text += bytes))
    connection.on('close', () => server_state.connections.delete(connection))
    connection.on('error', () => {})
  })
  server.listen(0, '127.0.0.1')
  await once(server, 'listening')
  return Object.assign(server_state, { server, port: server.address().port })
}

async function until(what, condition, patience_ms = 90_000) {
  const end = Date.now() + patience_ms
  while (Date.now() < end) {
    const value = await condition()
    if (value) return value
    await new Promise(resolve => setTimeout(resolve, 50))
  }
  assert.fail(`waited ${patience_ms / 1000} s for ${what}; the logs are in ${folder}`)
}

// --- the mission -------------------------------------------------------------------------------

const xml = await listener()
const protobuf = await listener()
const mavlink = await listener()
const tcp = await stream_server()
const [markers, network] = [await listener(), await listener()]  // whose ports are given on
const folder = join(work, 'mission')
rmSync(folder, { recursive: true, force: true })
mkdirSync(folder)
const epoch_ms = Math.floor(Date.now() / 1000) * 1000
const tell_socket = `skein-agencies-${network.port}`

/** An example of ours, elsewhere and at another time. */
function configure(name, more) {
  const recording = join(folder, name)
  const yaml = readFileSync(join(examples, `${name}.yaml`), 'utf8')
    .replace(/epoch_unix_ns: \d+/, `epoch_unix_ns: ${epoch_ms}000000`)
    .replace(/port: 7400/, `port: ${network.port}`)
    .replace(/recording_folder: .*/, `recording_folder: ${recording}`)
    .replace(/console: .*/, 'console: {port: 0}')
  const file = join(folder, `${name}.yaml`)
  writeFileSync(file, yaml + more)
  return file
}

const running = new Map()
function start(name, program, file) {
  const log = openSync(join(folder, `${name}.log`), 'a')
  const child = spawn(join(programs, program), ['--config', file], { stdio: ['ignore', log, log] })
  running.set(name, { child, ended: once(child, 'exit') })
}
async function stop(name) {
  const { child, ended } = running.get(name)
  child.kill('SIGTERM')
  await ended
  running.delete(name)
}
process.on('exit', () => running.forEach(({ child }) => child.kill('SIGKILL')))

markers.socket.close()
network.socket.close()
const ground_file = configure('ground', `
control_socket: ${tell_socket}
hazards:
  - {id: 1, east_m: 1500, north_m: 1500, radius_m: 120}
agencies:
  team: ${kTeam}
  cot:
    - {address: 127.0.0.1, port: ${xml.port}}
    - {address: 127.0.0.1, port: ${protobuf.port}, format: protobuf}
    - {address: 127.0.0.1, port: ${tcp.port}, transport: tcp}
  markers: {port: ${markers.port}}
  mavlink:
    - {address: 127.0.0.1, port: ${mavlink.port}}
remote_id:
  operator_id: SWE1234567890abc
  description: search for a fire
  category: open
  class: C2
  operator: {latitude_deg: 31.5, longitude_deg: 105.0, height_m: 490}
  ids: [${kVehicles.map(id => `{vehicle: ${id}, uas_id: ${uas_id_of(id)}}`).join(', ')}]
`)
start('ground', 'skein-ground', ground_file)
for (const id of kVehicles) start(`onboard-${id}`, 'skein-onboard', configure(`onboard-${id}`, ''))

const tell = line =>
  JSON.parse(execFileSync(join(programs, 'skein-ground'), ['tell', '--socket', tell_socket, '--json', line],
    { encoding: 'utf8' }))
const is_of = pattern => ({ bytes }) => new RegExp(`uid="${kTeam}-${pattern}"`).test(bytes.toString())
const said = (what, pattern, from = 0) => until(what, () => xml.got.slice(from).find(is_of(pattern)))

for (const id of kVehicles) await said(`vehicle ${id}`, `vehicle-${id}`)
await until('a connection', () => tcp.text.includes(`uid="${kTeam}-vehicle-`))
for (const connection of tcp.connections) connection.destroy()  // it is made again

// --- what comes in -----------------------------------------------------------------------------

function marker(uid, type, callsign, latitude_deg, longitude_deg) {
  const now = new Date().toISOString()
  const stale = new Date(Date.now() + 3600_000).toISOString()
  return `<?xml version="1.0"?><event version="2.0" uid="${uid}" type="${type}" how="h-g-i-g-o" time="${now}" ` +
    `start="${now}" stale="${stale}"><point lat="${latitude_deg}" lon="${longitude_deg}" hae="0" ce="9999999" ` +
    `le="9999999"/><detail><contact callsign="${callsign}"/></detail></event>`
}

const sender = createSocket('udp4')
const send = line => new Promise(resolve => sender.send(line, markers.port, '127.0.0.1', resolve))
await send(marker('their-unit', 'a-f-G-U-C', 'a fire engine', 31.53, 105.05))
await send('<event version="2.0" uid="broken"')
await send(Buffer.alloc(20_000, 'x'))
await send(marker('their-smoke', 'b-m-p-s-m', 'Smoke east', 31.525, 105.06))
const proposals = await until('the proposal', () => {
  const all = tell('proposals').data
  return all.length > 0 && all
})
assert.equal(proposals.length, 1, 'of one marker')
assert.equal(proposals[0].kind, 'smoke')
assert.equal(proposals[0].seen_by, 0)
assert.match(proposals[0].detector, /Smoke east/)
assert.deepEqual(tell('sites').data, [], 'it is no site')
assert(tell('dismiss 1').done)

// --- sites and hazards come and go -------------------------------------------------------------

assert(tell('site at 300 -100').done)
await until('a survey', () => xml.got.some(({ bytes }) => /-site-.*, surveyed,/.test(bytes.toString())))
assert(tell('site at 3000 2000').done)
const site = Math.max(...tell('sites').data.map(({ id }) => id))
await said('the second site', `site-\\d+-${site}`)
assert(tell(`withdraw site ${site}`).done)
assert(tell('hazard -1500 1500 90').done)
const hazard = tell('hazards').data.find(({ id }) => id !== 1).id
await said('the hazard', `hazard-\\d+-${hazard}`)
assert(tell(`withdraw hazard ${hazard}`).done)
const endings = pattern => xml.got.filter(is_of(pattern))
  .filter(({ bytes }) => /time="([^"]*)".*stale="\1"/.test(bytes.toString()))
await until('the end of the hazard', () => endings(`hazard-\\d+-${hazard}`).length === 3)
await until('the end of the site', () => endings(`site-\\d+-${site}`).length === 3)

// Nothing that comes in there is read, let alone obeyed.
mavlink.socket.send(Buffer.from('fd00000000000000'.repeat(8), 'hex'), mavlink.from.port, '127.0.0.1')
await until('another connection', () => tcp.count > 1 && tcp.text.split('<?xml').length > 50)
await until('enough to be compared', () => mavlink.got.length > 1500)

// After a new start all have the names that they had.
const before = xml.got.length
await stop('ground')
start('ground', 'skein-ground', ground_file)
for (const id of kVehicles) await said(`vehicle ${id} again`, `vehicle-${id}`, before)
await said('the first hazard again', `hazard-${epoch_ms / 1000}-1`, before)
for (const name of [...running.keys()].reverse()) await stop(name)

// --- what the vehicles say of themselves -------------------------------------------------------

const ground_yaml = readFileSync(ground_file, 'utf8')
const number_in = key => Number(new RegExp(`${key}: *(-?[0-9.]+)`).exec(ground_yaml)[1])
const origin = ['latitude_deg', 'longitude_deg', 'height_m'].map(number_in)

const tracks = new Map(kVehicles.map(id => {
  const tables = join(folder, `tables-${id}`)
  execFileSync(join(programs, 'skein-ground'), ['export', join(folder, `onboard-${id}`), '--csv', tables])
  const path = join(tables, `vehicle-0${id}`, 'track.csv')
  assert(existsSync(path), path)
  const rows = readFileSync(path, 'utf8').trim().split('\n').slice(1)
  return [id, rows.map(row => row.split(',').slice(0, 4).map(Number))]
}))

const kA = 6378137.0
const kE2 = 0.0066943799901413165
const rad = deg => (deg * Math.PI) / 180
function ecef([latitude_deg, longitude_deg, height_m]) {
  const [phi, lambda] = [rad(latitude_deg), rad(longitude_deg)]
  const n = kA / Math.sqrt(1 - kE2 * Math.sin(phi) ** 2)
  return [(n + height_m) * Math.cos(phi) * Math.cos(lambda), (n + height_m) * Math.cos(phi) * Math.sin(lambda),
    (n * (1 - kE2) + height_m) * Math.sin(phi)]
}
/** East, north, up from the origin. */
function enu(place) {
  const from = ecef(origin)
  const [x, y, z] = ecef(place).map((value, i) => value - from[i])
  const [phi, lambda] = [rad(origin[0]), rad(origin[1])]
  const outward = x * Math.cos(lambda) + y * Math.sin(lambda)
  return [-x * Math.sin(lambda) + y * Math.cos(lambda), -Math.sin(phi) * outward + Math.cos(phi) * z,
    Math.cos(phi) * outward + Math.sin(phi) * z]
}

/** How far from there the vehicle said that it was at that mission time. */
function error_m(vehicle, time_s, place) {
  const track = tracks.get(vehicle)
  const next = track.findIndex(([t]) => t >= time_s)
  if (next < 1) return null  // before its recording, or after it
  const [a, b] = [track[next - 1], track[next]]
  if (b[0] - a[0] > 0.2) return null
  const share = (time_s - a[0]) / (b[0] - a[0])
  const at = enu(place)
  return Math.hypot(...[0, 1, 2].map(i => a[i + 1] + share * (b[i + 1] - a[i + 1]) - at[i]))
}

/** Compares places with what the vehicles recorded; of each vehicle, so many at least. */
function judge_places(what, places, least) {
  const compared = new Map(kVehicles.map(id => [id, 0]))
  let worst_m = 0
  const ages_s = []
  for (const { vehicle, time_s, place, heard_s } of places) {
    ages_s.push(heard_s - time_s)
    const error = error_m(vehicle, time_s, place)
    if (error === null) continue
    compared.set(vehicle, compared.get(vehicle) + 1)
    worst_m = Math.max(worst_m, error)
  }
  ages_s.sort((a, b) => a - b)
  const age_s = ages_s[Math.floor(ages_s.length / 2)]  // the oldest tell of the machine's load
  console.log(`${what}: ${places.length} places, ${[...compared.values()].reduce((a, b) => a + b)} compared, ` +
    `${worst_m.toFixed(3)} m off at most; ${age_s.toFixed(3)} s old, ${ages_s.at(-1).toFixed(3)} s at most`)
  assert(worst_m <= kPlace_m, `${what}: a place is ${worst_m} m off`)
  assert(age_s <= kAge_s, `${what}: places are ${age_s} s old`)
  for (const [vehicle, count] of compared) assert(count >= least, `${what}: vehicle ${vehicle} is shown ${count} times`)
}

// --- Cursor on Target --------------------------------------------------------------------------

const since_epoch_s = ms => (ms - epoch_ms) / 1000

async function judge_cot(what, events) {
  const places = []
  const types = new Map()
  for (const { cot, at_ms } of events) {
    const { uid, type, time, stale } = cot.raw.event._attributes
    types.set(type, (types.get(type) ?? 0) + 1)
    const feature = await CoTParser.to_geojson(cot)
    assert.equal(feature.id, uid)
    assert(feature.properties.callsign.startsWith(kTeam), feature.properties.callsign)
    assert(feature.properties.remarks !== undefined, uid)
    const vehicle = new RegExp(`^${kTeam}-vehicle-(\\d+)$`).exec(uid)
    if (!vehicle) continue
    assert(Date.parse(stale) > Date.parse(time), uid)
    assert(feature.properties.course >= 0 && feature.properties.speed >= 0, uid)
    const { lat, lon, hae } = cot.raw.event.point._attributes
    places.push({ vehicle: Number(vehicle[1]), time_s: since_epoch_s(Date.parse(time)),
      place: [lat, lon, hae].map(Number), heard_s: since_epoch_s(at_ms) })
  }
  console.log(`${what}: ${events.length} events: ${[...types].map(([type, n]) => `${n} ${type}`).join(', ')}`)
  for (const type of ['a-f-A-M-F-Q', 'b-m-p-s-m', 'u-d-c-c', 'u-d-f']) assert(types.has(type), `${what}: ${type}`)
  judge_places(what, places, 20)
}

const xml_events = xml.got.map(({ bytes, at_ms }) => ({ cot: CoTParser.from_xml(bytes), at_ms }))
await judge_cot('cot by xml', xml_events)
const messages = []
for (const { bytes, at_ms } of protobuf.got) {
  assert.deepEqual([...bytes.subarray(0, 3)], [0xbf, 0x01, 0xbf])
  messages.push({ cot: await CoTParser.from_proto(bytes.subarray(3)), at_ms })
}
await judge_cot('cot by protobuf', messages)
assert.equal(messages.length, xml_events.length, 'the same is said by both')

const streamed = tcp.text.split('<?xml').slice(1).map(part => `<?xml${part}`).filter(part => part.endsWith('</event>'))
for (const part of streamed) CoTParser.from_xml(part)
console.log(`cot by tcp: ${streamed.length} events, ${tcp.count} connections`)
assert(streamed.length > 40)

const refreshed = xml_events.map(({ cot, at_ms }) => ({ ...cot.raw.event._attributes, at_ms }))
  .filter(({ uid }) => uid.startsWith(`${kTeam}-hazard-`) && uid.endsWith('-1'))
assert(refreshed.length >= 2, 'said again')
for (let i = 1; i < refreshed.length; ++i) assert(refreshed[i].at_ms < Date.parse(refreshed[i - 1].stale), 'in time')

// --- MAVLink -----------------------------------------------------------------------------------

const registry = { ...minimal.REGISTRY, ...standard.REGISTRY, ...common.REGISTRY }
const counts = new Map()
const positions = []
const trimmed = text => text.replace(/\0+$/, '')
const of_remote_id = {
  OPEN_DRONE_ID_BASIC_ID(message, id) {
    assert.equal(trimmed(Buffer.from(message.uasId).toString('latin1')), uas_id_of(id))
    assert.equal(message.idType, common.MavOdidIdType.SERIAL_NUMBER)
    assert.equal(message.uaType, common.MavOdidUaType.AEROPLANE)
  },
  OPEN_DRONE_ID_LOCATION(message, id, at_ms) {
    assert.equal(message.status, common.MavOdidStatus.AIRBORNE)
    const hour_s = (at_ms / 1000) % 3600
    const age_s = (hour_s - message.timestamp + 3600) % 3600
    assert(age_s < 2, `${age_s} s since the location`)
    positions_by_id.push({ vehicle: id, time_s: since_epoch_s(at_ms) - age_s, heard_s: since_epoch_s(at_ms),
      place: [message.latitude / 1e7, message.longitude / 1e7, message.altitudeGeodetic] })
  },
  OPEN_DRONE_ID_SYSTEM(message, id, at_ms) {
    assert.equal(message.operatorLatitude, 315000000)
    assert.equal(message.operatorLocationType, common.MavOdidOperatorLocationType.FIXED)
    assert.equal(message.categoryEu, common.MavOdidCategoryEu.OPEN)
    assert.equal(message.classEu, common.MavOdidClassEu.CLASS_2)
    assert(Math.abs(message.timestamp - (at_ms / 1000 - 1546300800)) < 3)
    groups.add(message.areaCount)
  },
  OPEN_DRONE_ID_OPERATOR_ID: message => assert.equal(trimmed(message.operatorId), 'SWE1234567890abc'),
  OPEN_DRONE_ID_SELF_ID: message => assert.equal(trimmed(message.description), 'search for a fire'),
}
const positions_by_id = []
const groups = new Set()
for (const { bytes, at_ms } of mavlink.got) {
  const packets = []
  const stream = createMavLinkStream(Readable.from([bytes]), { onCrcError: () => assert.fail('a checksum is wrong') })
  for await (const packet of stream) packets.push(packet)
  assert.equal(packets.length, 1, 'one packet a datagram')
  const [{ header, protocol, payload }] = packets
  const Message = registry[header.msgid]
  assert(Message, `message ${header.msgid} is none of MAVLink's`)
  assert.equal(header.compid, 1)
  assert(kVehicles.includes(header.sysid), `system ${header.sysid}`)
  counts.set(Message.MSG_NAME, (counts.get(Message.MSG_NAME) ?? 0) + 1)
  const message = protocol.data(payload, Message)
  if (Message.MSG_NAME === 'HEARTBEAT') {
    assert.equal(message.type, minimal.MavType.FIXED_WING)
    assert.equal(message.autopilot, minimal.MavAutopilot.GENERIC)
  }
  of_remote_id[Message.MSG_NAME]?.(message, header.sysid, at_ms)
  if (Message.MSG_NAME !== 'GLOBAL_POSITION_INT') continue
  positions.push({ vehicle: header.sysid, time_s: message.timeBootMs / 1000, heard_s: since_epoch_s(at_ms),
    place: [message.lat / 1e7, message.lon / 1e7, message.alt / 1e3] })
}
console.log(`mavlink: ${mavlink.got.length} packets: ${[...counts].map(([name, n]) => `${n} ${name}`).join(', ')}`)
for (const name of ['HEARTBEAT', 'GLOBAL_POSITION_INT', 'ATTITUDE', 'VFR_HUD', 'SYS_STATUS', 'BATTERY_STATUS', 'MISSION_CURRENT',
  'NAV_CONTROLLER_OUTPUT', 'STATUSTEXT', ...Object.keys(of_remote_id)]) {
  assert(counts.has(name), name)
}
judge_places('mavlink', positions, 60)
judge_places('remote id', positions_by_id, 10)
assert(groups.has(kVehicles.length), 'as one group')

for (const { socket } of [xml, protobuf, mavlink]) socket.close()
sender.close()
tcp.server.close()
console.log('all that was sent is accepted')
process.exit(0)
