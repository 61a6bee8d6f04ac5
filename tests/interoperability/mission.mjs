// SPDX-License-Identifier: Apache-2.0
//
// A small mission of real processes on loopback, of the examples that are installed, for programs that are
// not ours to look at; and what its vehicles recorded of themselves, to hold against what was seen.
import assert from 'node:assert/strict'
import { execFileSync, spawn } from 'node:child_process'
import { once } from 'node:events'
import { mkdirSync, openSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import { join } from 'node:path'

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
function enu(origin, place) {
  const from = ecef(origin)
  const [x, y, z] = ecef(place).map((value, i) => value - from[i])
  const [phi, lambda] = [rad(origin[0]), rad(origin[1])]
  const outward = x * Math.cos(lambda) + y * Math.sin(lambda)
  return [-x * Math.sin(lambda) + y * Math.cos(lambda), -Math.sin(phi) * outward + Math.cos(phi) * z,
    Math.cos(phi) * outward + Math.sin(phi) * z]
}

export class ExampleMission {
  vehicles = [1, 2, 3]
  epoch_ms = Math.floor(Date.now() / 1000) * 1000
  running = new Map()

  /** `network_port` and the next ones are the mission's; `folder` is made anew. */
  constructor({ programs, examples, folder, network_port }) {
    Object.assign(this, { programs, examples, folder, network_port })
    this.control_socket = `skein-example-${network_port}`
    rmSync(folder, { recursive: true, force: true })
    mkdirSync(folder, { recursive: true })
    process.on('exit', () => this.running.forEach(({ child }) => child.kill('SIGKILL')))
  }

  /** An example, elsewhere and at another time; with `more` keys. */
  configure(name, more = '', console_port = 0) {
    const yaml = readFileSync(join(this.examples, `${name}.yaml`), 'utf8')
      .replace(/epoch_unix_ns: \d+/, `epoch_unix_ns: ${this.epoch_ms}000000`)
      .replace(/port: 7400/, `port: ${this.network_port}`)
      .replace(/recording_folder: .*/, `recording_folder: ${join(this.folder, name)}`)
      .replace(/console: .*/, `console: {port: ${console_port}}`)
    const file = join(this.folder, `${name}.yaml`)
    writeFileSync(file, yaml + more)
    return file
  }

  start(name, program, args, options = {}) {
    const log = openSync(join(this.folder, `${name}.log`), 'a')
    const child = spawn(join(this.programs, program), args, { stdio: ['ignore', log, log], ...options })
    this.running.set(name, { child, ended: once(child, 'exit') })
  }
  start_all({ more = '', console_port = 0 }) {
    this.ground_file = this.configure('ground', `\ncontrol_socket: ${this.control_socket}\n${more}`, console_port)
    this.start('ground', 'skein-ground', ['--config', this.ground_file])
    for (const id of this.vehicles) {
      this.start(`onboard-${id}`, 'skein-onboard', ['--config', this.configure(`onboard-${id}`)])
    }
  }
  async stop(name) {
    const { child, ended } = this.running.get(name)
    child.kill('SIGTERM')
    const [status] = await ended
    this.running.delete(name)
    return status
  }
  async stop_all() {
    for (const name of [...this.running.keys()].reverse()) await this.stop(name)
  }

  tell(line) {
    return JSON.parse(execFileSync(join(this.programs, 'skein-ground'),
      ['tell', '--socket', this.control_socket, '--json', line], { encoding: 'utf8' }))
  }

  async until(what, condition, patience_ms = 90_000) {
    const end = Date.now() + patience_ms
    while (Date.now() < end) {
      const value = await condition()
      if (value) return value
      await new Promise(resolve => setTimeout(resolve, 50))
    }
    assert.fail(`waited ${patience_ms / 1000} s for ${what}; the logs are in ${this.folder}`)
  }

  /** Once all have ended: reads what the vehicles said of themselves. */
  read_tracks() {
    const yaml = readFileSync(this.ground_file, 'utf8')
    const number_in = key => Number(new RegExp(`${key}: *(-?[0-9.]+)`).exec(yaml)[1])
    this.origin = ['latitude_deg', 'longitude_deg', 'height_m'].map(number_in)
    this.tracks = new Map(this.vehicles.map(id => {
      const tables = join(this.folder, `tables-${id}`)
      execFileSync(join(this.programs, 'skein-ground'), ['export', join(this.folder, `onboard-${id}`), '--csv', tables])
      const rows = readFileSync(join(tables, `vehicle-0${id}`, 'track.csv'), 'utf8').trim().split('\n').slice(1)
      return [id, rows.map(row => row.split(',').slice(0, 4).map(Number))]
    }))
  }

  /** How far from [latitude, longitude, height] the vehicle was at that mission time; null: not recorded. */
  error_m(vehicle, time_s, place) {
    const track = this.tracks.get(vehicle)
    const next = track.findIndex(([t]) => t >= time_s)
    if (next < 1) return null
    const [a, b] = [track[next - 1], track[next]]
    if (b[0] - a[0] > 0.2) return null
    const share = (time_s - a[0]) / (b[0] - a[0])
    const at = enu(this.origin, place)
    return Math.hypot(...[0, 1, 2].map(i => a[i + 1] + share * (b[i + 1] - a[i + 1]) - at[i]))
  }

  /** Of places {vehicle, time_s, place, heard_s}: the worst error, and ages, sorted; of each vehicle `least`. */
  judge_places(what, places, least) {
    const compared = new Map(this.vehicles.map(id => [id, 0]))
    let worst_m = 0
    for (const { vehicle, time_s, place } of places) {
      const error = this.error_m(vehicle, time_s, place)
      if (error === null) continue
      compared.set(vehicle, compared.get(vehicle) + 1)
      worst_m = Math.max(worst_m, error)
    }
    const ages_s = places.map(({ time_s, heard_s }) => heard_s - time_s).sort((a, b) => a - b)
    const age_s = ages_s[Math.floor(ages_s.length / 2)]  // the oldest tell of the machine's load
    console.log(`${what}: ${places.length} places, ${[...compared.values()].reduce((a, b) => a + b)} compared, ` +
      `${worst_m.toFixed(3)} m off at most; ${age_s.toFixed(3)} s old, ${ages_s.at(-1).toFixed(3)} s at most`)
    for (const [vehicle, count] of compared) assert(count >= least, `${what}: vehicle ${vehicle} is shown ${count} times`)
    return { worst_m, age_s }
  }
}
