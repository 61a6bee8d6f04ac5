// SPDX-License-Identifier: Apache-2.0
//
// What it takes to add a message and fields: a copy of idl/ and of one user is changed, both are made
// and built, and the release before and the one after read each other's bytes:
//   node growth.mjs SOURCE WORK GENERATOR_FOLDER COMPILER LIBRARIES
import { execFileSync } from 'node:child_process'
import { cpSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs'
import { join } from 'node:path'

const [source, work, generator, compiler, libraries] = process.argv.slice(2)
const fixture = join(source, 'tests/architecture/fixtures/growth')

function check(holds, what) {
  if (holds) return
  console.error(what)
  process.exit(1)
}

function edit(file, from, to) {
  const text = readFileSync(file, 'utf8')
  check(text.includes(from), `${file} has no '${from}'`)
  writeFileSync(file, text.replace(from, to))
}

function copy(name) {
  const root = join(work, name)
  rmSync(root, { recursive: true, force: true })
  mkdirSync(root, { recursive: true })
  cpSync(join(source, 'idl'), join(root, 'idl'), { recursive: true })
  cpSync(fixture, join(root, 'user'), { recursive: true })
  return root
}

function build(root) {
  const idl = join(root, 'idl')
  const order = /set\(files ([a-z ]+)\)/.exec(readFileSync(join(idl, 'CMakeLists.txt'), 'utf8'))[1]
  const files = order.split(' ').map(file => join(idl, `${file}.idl`))
  const generated = join(root, 'generated')
  execFileSync('node', [join(generator, 'generate.mjs'), generated, join(idl, 'topics.json'), ...files], { stdio: 'pipe' })
  const binary = join(root, 'build')
  execFileSync('cmake', ['-S', join(root, 'user'), '-B', binary, '-G', 'Ninja', `-DSKEIN=${source}`,
    `-DGENERATED=${generated}`, `-DCMAKE_CXX_COMPILER=${compiler}`, `-DLIBRARIES=${libraries}`,
    '-DCMAKE_CXX_COMPILER_LAUNCHER=' + (process.env.SKEIN_LAUNCHER ?? '')], { stdio: 'pipe' })
  execFileSync('cmake', ['--build', binary], { stdio: ['ignore', 'pipe', 'inherit'] })
  return (what, input) => execFileSync(join(binary, 'growth'), [what], { input, encoding: 'utf8' })
}

function changed(a, b, folder = '') {
  return readdirSync(join(a, folder), { withFileTypes: true }).flatMap(entry => {
    const path = join(folder, entry.name)
    if (entry.isDirectory()) return changed(a, b, path)
    return readFileSync(join(a, path)).equals(readFileSync(join(b, path))) ? [] : [path]
  })
}

const before = copy('before')
const after = copy('after')
edit(join(after, 'idl/mission.idl'), '  unsigned long messages_dropped;',
  '  @appended @default(42) unsigned long added;\n  unsigned long messages_dropped;')
// Appended fields stand at the end: the other way round the generator must refuse.
let refused = ''
try {
  build(after)
} catch (error) {
  refused = String(error.stderr ?? error)
}
check(refused.includes('what is appended stands at the end'), `not refused: ${refused}`)

edit(join(after, 'idl/mission.idl'), '  @appended @default(42) unsigned long added;\n', '')
edit(join(after, 'idl/mission.idl'), '  @appended @default(0) DeclinedCall declined;\n',
  '  @appended @default(0) DeclinedCall declined;\n  @appended @default(42) unsigned long added;\n')
edit(join(after, 'idl/domain.idl'), '  Amount reward_decay_per_s;    // beta (eq. 9)\n',
  '  Amount reward_decay_per_s;\n  @appended @default(TRUE) boolean charted;\n')
edit(join(after, 'idl/coalition.idl'), '  Instant time_ns;  // when it came into that state\n',
  // Short: a sequence of long ones would be more than the older leaves room for (kRoomToGrow).
  '  Instant time_ns;\n  @appended @default("once") string<7> tried;\n')
edit(join(after, 'idl/mission.idl'), '// How a vehicle\'s program is,',
  '// "I am here."\n@version(1) @said_by("vehicle")\nstruct Beacon {\n  VehicleId vehicle;\n  Point3 position_m;\n};\n\n// How a vehicle\'s program is,')
edit(join(after, 'idl/topics.json'), '\n]',
  ',\n  {"name": "beacon", "type": "skein::mission::Beacon", "writers": "vehicles", "readers": "all", "reliable": false, "urgency": "state", "writer_history": 1, "reader_history": 8}\n]')
edit(join(after, 'user/user.cpp'), '  // the user\'s change\n',
  '  if (what == "beacon") {\n    const mission::Beacon beacon{VehicleId{3}, {1.0, 2.0, 3.0}};\n' +
  '    if (mission::may_say(beacon, VehicleId{3}) && !mission::may_say(beacon, VehicleId{4})) print(beacon);\n  }\n')

const older = build(before)
const newer = build(after)
const touched = changed(join(before, 'idl'), join(after, 'idl')).concat(changed(join(before, 'user'), join(after, 'user')))
check(touched.sort().join() === 'coalition.idl,domain.idl,mission.idl,topics.json,user.cpp', `touched: ${touched}`)

const [topic, , json] = newer('beacon').trim().split('\t')
check(topic === 'skein/beacon' && JSON.parse(json).position_m.z_m === 3, `a beacon is ${json}`)

// Without what was appended, which must be the default where `fill` says so.
const defaults = { added: 42, charted: true, tried: 'once' }
let filled = 0
function without(value, fill) {
  if (Array.isArray(value)) return value.map(one => without(one, fill))
  if (value === null || typeof value !== 'object') return value
  return Object.fromEntries(Object.entries(value).filter(([name, one]) => {
    if (!(name in defaults)) return true
    if (fill) check(one === defaults[name], `${name} is ${one}`)
    ++filled
    return false
  }).map(([name, one]) => [name, without(one, fill)]))
}

const lines = text => text.trim().split('\n')
function exchange(from, to, says, fill) {
  const written = lines(from('write'))
  const read = lines(to('read', written.join('\n') + '\n'))
  check(read.length === written.length, `${says}: ${read.length} of ${written.length} lines`)
  written.forEach((line, i) => {
    const [topic, , json] = line.split('\t')
    if (read[i] === 'unknown topic') return check(topic === 'skein/beacon', `${says}: ${topic} is unknown`)
    check(read[i].startsWith('{'), `${says}: ${topic}: ${read[i]}`)
    const [sent, got] = [without(JSON.parse(json)), without(JSON.parse(read[i]), fill)]
    check(JSON.stringify(sent) === JSON.stringify(got), `${says}: ${topic}:\n${JSON.stringify(sent)}\n${JSON.stringify(got)}`)
  })
  return written.length
}
const count = exchange(older, newer, 'the newer reads the older', true) + exchange(newer, older, 'the older reads the newer', false)
check(filled > 10, `only ${filled} fields were looked at`)

// An incompatible change is told with both versions.
const [bytes] = lines(older('write')).filter(line => line.startsWith('skein/telemetry\t'))
const [name, hex] = bytes.split('\t')
const said = newer('read', `${name}\t${hex.slice(0, 8)}0700${hex.slice(12)}\n`).trim()
check(/^its skein::wire::Telemetry is of version 7, ours of version \d+$/.test(said), said)
console.log(`${count} messages exchanged between two releases, ${filled} appended fields: ${said}`)
