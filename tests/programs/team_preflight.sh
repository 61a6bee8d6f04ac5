#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# team_preflight.sh SKEIN_ONBOARD SKEIN_GROUND SKEIN_FC: three aircraft on the ground, one of them without a
# parameter: who is ready stands at the prompt, and what changes there within seconds.
set -euo pipefail
onboard=$1 ground=$2 fc=$3
work=$(mktemp -d)
declare -A started
stop() {
  local pid=${started[$1]-}
  unset "started[$1]"
  [[ -z $pid ]] || kill "$pid" 2>/dev/null || true
  [[ -z $pid ]] || wait "$pid" 2>/dev/null || true
}
end() {
  for name in "${!started[@]}"; do stop "$name"; done
  rm -rf "$work"
}
trap end EXIT
cd "$work"
mkfifo orders
exec {orders}<>orders

die() {
  echo "team_preflight: $*" >&2
  tail -n 5 ./*.log >&2 || true
  exit 1
}
# On a loaded machine all takes longer; on an idle one each is there after 1 to 5 s.
readonly patience_ms=20000
# Others may run on this machine.
readonly bus=$((50 + 3 * (BASHPID % 16))) port=$((21000 + BASHPID % 9000))
epoch=$(date +%s)000000000

# start_fc N LINES ARGUMENT...: what is typed there comes from the file LINES
start_fc() {
  local n=$1 lines=$2
  shift 2
  mkfifo "ready-$n"
  "$fc" --bus "mcast:$((bus + n))" --failsafe --speed-min 40 --speed-max 60 "$@" <"$lines" >"ready-$n" 2>"fc-$n.log" &
  started[fc-$n]=$!
  head -n 1 "ready-$n" | grep -q '^ready' || die "skein-fc $n is not ready"
}
# start_onboard N
start_onboard() {
  cat >"v$1.yaml" <<EOT
version: 1
vehicle: {id: $1, cruise_speed_mps: 50, speed_min_mps: 42, speed_max_mps: 58, turn_radius_m: 150,
  range_m: 40000, capabilities: [survey], sensor_radius_m: 300, height_m: 100}
origin: {latitude_deg: 31.522062, longitude_deg: 105.044327, height_m: 480}
start: {east_m: 0, north_m: 0, heading_deg: 90}
search: [[2000, 0]]
flight_controller: {kind: ardupilot, can: "mcast:$((bus + $1))"}
network: {address: 127.0.0.1, port: $port}
time: {epoch_unix_ns: $epoch}
recording_folder: $work/recording-$1
EOT
  "$onboard" --config "v$1.yaml" >"onboard-$1.log" 2>&1 &
  started[onboard-$1]=$!
}
tell() { "$ground" tell --socket "skein-preflight-$port" "$@"; }
# said_within WHAT PATTERN LINE: until the prompt answers so
said_within() {
  local begin=${EPOCHREALTIME/./} took=0
  while true; do
    tell "$3" >said 2>&1 || true
    took=$(((${EPOCHREALTIME/./} - begin) / 1000))
    grep -qE -- "$2" said && break
    ((took < patience_ms)) || die "$1: no '$2' within $took ms: $(<said)"
    sleep 0.05
  done
  echo "$1: after $took ms"
}

cat >ground.yaml <<EOT
version: 1
vehicles: [1, 2, 3, 4]
origin: {latitude_deg: 31.522062, longitude_deg: 105.044327, height_m: 480}
network: {address: 127.0.0.1, port: $port}
time: {epoch_unix_ns: $epoch}
console: {port: 0}
control_socket: skein-preflight-$port
EOT
"$ground" --config ground.yaml >ground.log 2>&1 </dev/null &
started[ground]=$!

said_within "nobody is ready who is not there" '^0 of 4 ready, 4 not: 1 \(never heard\)' preflight
start_fc 1 /dev/null
start_fc 2 /dev/null --without FS_LONG_ACTN
start_onboard 1
start_onboard 2
said_within "a parameter that is missing" 'FAIL  FS_LONG_ACTN: not told; it does not tell FS_LONG_ACTN, which must be 1' preflight
said_within "the good one is ready" '^1 of 4 ready, 3 not: 2 \(parameters\), 3 \(never heard\)' preflight
grep -qE '^ +2 +[0-9]+ s .*\*' said || die "the odd digest is not marked: $(<said)"
said_within "one vehicle's lines" '^ +ok: .*clock 1, ' 'preflight 1'
grep -q 'NOT READY\|FAIL' said && die "the good one has a fault: $(<said)"

start_fc 3 orders
start_onboard 3
said_within "another one comes" '^2 of 4 ready' preflight
echo 'prearm Compass not calibrated' >&"$orders"
said_within "an autopilot that would not arm" 'FAIL  arming: it would not arm: Compass not calibrated' preflight

stop onboard-1
said_within "one falls silent" '1 \(silent\)' preflight
said_within "its lines are old" 'as it was told last|were ok: ' 'preflight 1'

stop ground
"$ground" --config ground.yaml >ground.log 2>&1 </dev/null &
started[ground]=$!
said_within "a ground station that starts anew is told" 'FAIL  FS_LONG_ACTN: not told' preflight
tell 'preflight 9' >said 2>&1 && die "there is a vehicle 9: $(<said)"
tell --json preflight | node -e '
  const { data } = JSON.parse(require("fs").readFileSync(0, "utf8"));
  const two = data.vehicles.find(({ id }) => id === 2);
  process.exit(two.readiness === "not_ready" && two.marks[data.groups.indexOf("parameters")] === "fail" ? 0 : 1)' ||
  die "the section differs"
