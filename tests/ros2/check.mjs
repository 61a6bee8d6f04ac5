// SPDX-License-Identifier: Apache-2.0
//
// A mission whose bridge shows it to ROS 2: a peer of Cyclone DDS reads all topics, comes late, and proposes
// sites; places are compared with what the vehicles recorded. Traffic is on loopback.
//   node check.mjs PROGRAMS_FOLDER EXAMPLES_FOLDER PEER WORK_FOLDER
import assert from 'node:assert/strict'
import { spawn } from 'node:child_process'
import { createSocket } from 'node:dgram'
import { once } from 'node:events'
import { existsSync, openSync, readFileSync } from 'node:fs'
import { createServer } from 'node:net'
import { dirname, join } from 'node:path'
import { createInterface } from 'node:readline'
import { fileURLToPath } from 'node:url'
import { load, type_hash } from '../../groundstation/ros2/generator/messages.mjs'
import { ExampleMission } from '../interoperability/mission.mjs'

const [programs, examples, peer_program, folder] = process.argv.slice(2)
const kPlace_m = 1.0
const kAge_s = 0.5
const domain = 1 + (process.pid % 90)

async function free_udp_port() {
  const socket = createSocket('udp4').bind(0, '127.0.0.1')
  await once(socket, 'listening')
  const { port } = socket.address()
  socket.close()
  return port
}
async function free_tcp_port() {
  const server = createServer().listen(0, '127.0.0.1')
  await once(server, 'listening')
  const { port } = server.address()
  server.close()
  return port
}

const [network_port, markers_port, console_port] = [await free_udp_port(), await free_udp_port(), await free_tcp_port()]
const mission = new ExampleMission({ programs, examples, folder, network_port })
const { vehicles } = mission
const until = (what, condition, patience_ms) => mission.until(what, condition, patience_ms)
const ground_folder = join(folder, 'ground')

// --- a peer of ROS 2 -----------------------------------------------------------------------------

const topics = {
  Origin: ['rt/skein/origin'],
  NavSatFix: vehicles.map(id => `rt/skein/vehicle_${id}/fix`),
  VehicleStatus: vehicles.map(id => `rt/skein/vehicle_${id}/status`),
  Path: vehicles.map(id => `rt/skein/vehicle_${id}/plan`),
  Sites: ['rt/skein/sites'],
  Hazards: ['rt/skein/hazards'],
  Event: ['rt/skein/events'],
  ParticipantEntitiesInfo: ['ros_discovery_info'],
}
const all_topics = Object.values(topics).flat()

function start_peer(name) {
  const args = Object.entries(topics).flatMap(([type, names]) => names.map(topic => `${type}=${topic}`))
  const log = openSync(join(folder, `${name}.log`), 'a')
  const child = spawn(peer_program, [String(domain), ...args], {
    stdio: ['pipe', 'pipe', log],
    env: { ...process.env, CYCLONEDDS_URI: '<General><Interfaces><NetworkInterface address="127.0.0.1" multicast="true"/></Interfaces></General>' },
  })
  process.on('exit', () => child.kill('SIGKILL'))
  const peer = { got: new Map(all_topics.map(topic => [topic, []])), writers: new Map(), may_propose: false,
    say: line => child.stdin.write(`${line}\n`),
    newest: topic => peer.got.get(topic).at(-1)?.message,
    stop: async () => {
      child.stdin.end()
      assert.equal((await once(child, 'exit'))[0], 0, name)
    } }
  createInterface({ input: child.stdout }).on('line', line => {
    const said = JSON.parse(line)
    if (said.topic) peer.got.get(said.topic).push(said)
    else if (said.writer_of) peer.writers.set(said.writer_of, said)
    else if (said.proposals) peer.may_propose = true
  })
  return peer
}

function start_bridge(name, token, more = []) {
  mission.start(name, 'skein-ros2', ['--console', `http://127.0.0.1:${console_port}`, '--domain', String(domain),
    '--token-file', join(ground_folder, token), ...more], {
    // Faults of Debian's Fast DDS that would end a sanitized process (runtime/network/dds_carrier.cpp).
    env: { ...process.env, ASAN_OPTIONS: 'new_delete_type_mismatch=0' } })
}
const bridge_log = name => readFileSync(join(folder, `${name}.log`), 'utf8')
const bridge_args = ['--markers', `127.0.0.1:${markers_port}`]

// --- the mission -----------------------------------------------------------------------------------

mission.start_all({ console_port, more: `
hazards:
  - {id: 1, east_m: 1500, north_m: 1500, radius_m: 120}
agencies:
  team: alpha
  markers: {port: ${markers_port}}
` })
await until('the tokens', () => existsSync(join(ground_folder, 'console.observer.token')))

// Who would be let in as an operator does not want to be.
start_bridge('bridge-of-operator', 'console.token')
await until('a refusal', () => /as an operator/.test(bridge_log('bridge-of-operator')))
await mission.stop('bridge-of-operator')

start_bridge('bridge', 'console.observer.token', bridge_args)
const early = start_peer('early')
for (const topic of [...topics.NavSatFix, ...topics.VehicleStatus, 'rt/skein/hazards']) {
  await until(topic, () => early.newest(topic))
}

// --- sites and hazards come and go -------------------------------------------------------------

assert(mission.tell('site at 300 -100').done)
const surveyed = peer => peer.newest('rt/skein/sites')?.sites.some(({ status }) => status === 'done')  // it asks for no more
await until('a survey', () => surveyed(early))
assert(mission.tell('hazard -1500 1500 90').done)
await until('the hazard', () => early.newest('rt/skein/hazards').hazards.length === 2)
await until('plans', () => topics.Path.some(topic => early.newest(topic)?.poses.length > 1))

// --- who comes late ----------------------------------------------------------------------------

const late = start_peer('late')
await until('what stays', () => surveyed(late) && late.newest('rt/skein/hazards') && late.newest('rt/skein/origin') &&
  late.newest('ros_discovery_info') && late.got.get('rt/skein/events').length > 0)
await until('the same hazards', () => late.newest('rt/skein/hazards').hazards.length === 2)
assert.deepEqual(late.newest('rt/skein/hazards'), early.newest('rt/skein/hazards'))
const [first, second] = late.newest('rt/skein/hazards').hazards
assert.equal(first.radius, 120)
assert.equal(second.radius, 90)
const told = early.got.get('rt/skein/events').map(({ message }) => message)
assert.deepEqual(told.map(({ seq }) => seq), told.map((_, i) => told[0].seq + i), 'no event is missing')
assert(told.some(({ kind, level }) => kind === 'survey_done' && level === 0), 'the survey is told of')

// --- as ROS 2 sees it ----------------------------------------------------------------------------

const root = join(dirname(fileURLToPath(import.meta.url)), '../../groundstation/ros2')
const messages = load([...['builtin_interfaces', 'std_msgs', 'geometry_msgs', 'sensor_msgs', 'nav_msgs', 'rmw_dds_common']
  .map(name => join(root, 'standard', name)), join(root, 'skein_msgs')])
const kNavSatFix = 'RIHS01_62223ab3fe210a15976021da7afddc9e200dc9ec75231c1b6a557fc598a65404'
const type_of = { Origin: 'sensor_msgs/msg/NavSatFix', NavSatFix: 'sensor_msgs/msg/NavSatFix', Path: 'nav_msgs/msg/Path',
  ParticipantEntitiesInfo: 'rmw_dds_common/msg/ParticipantEntitiesInfo' }
for (const [type, names] of Object.entries(topics)) {
  const message = messages.get(type_of[type] ?? `skein_msgs/msg/${type}`)
  for (const topic of names) {
    const writer = late.writers.get(topic)
    if (type === 'Path' && !writer) continue  // of a vehicle that has had no plan
    assert.equal(writer.type_name, message.dds_name)
    assert.equal(writer.user_data, `typehash=${type_hash(message, messages)};`, topic)
  }
}
assert.equal(late.writers.get('rt/skein/vehicle_1/fix').user_data, `typehash=${kNavSatFix};`)
const nodes = late.newest('ros_discovery_info').nodes
assert.equal(nodes.length, 1)
assert.deepEqual([nodes[0].namespace, nodes[0].name], ['/skein', 'skein_bridge'])
assert.equal(nodes[0].readers.length, 1)
for (const [topic, { gid }] of late.writers) {
  if (topic !== 'ros_discovery_info') assert(nodes[0].writers.includes(gid), `${topic} is of no node`)
}

// --- what comes in -----------------------------------------------------------------------------

const sites_before = mission.tell('sites').data
await until('the bridge hears', () => late.may_propose)
late.say('31.525 105.06 1 Smoke east')
const proposals = await until('the proposal', () => {
  const all = mission.tell('proposals').data
  return all.length > 0 && all
})
assert.equal(proposals.length, 1)
assert.equal(proposals[0].kind, 'smoke')
assert.equal(proposals[0].seen_by, 0)
assert.match(proposals[0].detector, /Smoke east/)
assert(mission.tell('dismiss 1').done)
late.say('95 105.06 1 off the earth')
await until('a complaint', () => /a proposal is dropped: its latitude/.test(bridge_log('bridge')))
late.say('31.525 105.06 77 of no kind')
// A flood, each far from the others: what the bridge passes on is bounded.
for (let i = 0; i < 100; ++i) late.say(`${31.4 + 0.005 * i} 105.1 0 fire ${i}`)
await until('many proposals', () => mission.tell('proposals').data.length >= 15)
const answered = mission.tell('proposals').data.length
assert(answered <= 25, `${answered} of a flood of 100 are proposed`)
assert.deepEqual(mission.tell('sites').data.map(({ id }) => id), sites_before.map(({ id }) => id), 'none is a site')

// --- all starts anew ---------------------------------------------------------------------------

const fixes = peer => topics.NavSatFix.map(topic => peer.got.get(topic).length)
await mission.stop('ground')
mission.start('ground', 'skein-ground', ['--config', mission.ground_file])
const heard = fixes(early)
await until('the bridge finds the ground station again', () => fixes(early).every((count, i) => count > heard[i] + 5))
assert.equal(await mission.stop('bridge'), 0)
start_bridge('bridge', 'console.observer.token', bridge_args)
const again = fixes(early)
await until('the peer finds the bridge again', () => fixes(early).every((count, i) => count > again[i] + 5))
await until('enough to be compared', () => fixes(early).every(count => count > 100))
await early.stop()
await late.stop()
await mission.stop_all()

// --- what the vehicles say of themselves ---------------------------------------------------------

mission.read_tracks()
const since_epoch_s = unix_s => unix_s - mission.epoch_ms / 1000
const places_of = names => names.flatMap((topic, i) => early.got.get(topic).map(({ at, message }) => ({
  vehicle: vehicles[i], time_s: since_epoch_s(message.stamp), heard_s: since_epoch_s(at),
  place: [message.latitude, message.longitude, message.altitude] })))
for (const type of ['NavSatFix', 'VehicleStatus']) {
  const { worst_m, age_s } = mission.judge_places(type, places_of(topics[type]), 50)
  assert(worst_m <= kPlace_m, `${type}: a place is ${worst_m} m off`)
  assert(age_s <= kAge_s, `${type}: places are ${age_s} s old`)
}
const counted = [...early.got].map(([topic, got]) => `${got.length} ${topic.replace('rt/skein/', '')}`)
console.log(`read by Cyclone DDS: ${counted.join(', ')}`)
