#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# check.sh SKEIN_ONBOARD SKEIN_FC: `skein-onboard check` against an autopilot, in real time.
set -euo pipefail
onboard=$1 fc=$2
work=$(mktemp -d)
fc_pid=
# A bus of its own: others may run on this machine. 50 to 99 are of team_preflight.sh, 100 on of can_tools.sh.
bus=mcast:$((20 + BASHPID % 30))
stop_fc() {
  [[ -z $fc_pid ]] || kill "$fc_pid" 2>/dev/null || true
  [[ -z $fc_pid ]] || wait "$fc_pid" || true
  fc_pid=
}
trap 'stop_fc; rm -rf "$work"' EXIT
cd "$work"

die() {
  echo "check: $*" >&2
  exit 1
}
start_fc() {
  mkfifo ready
  "$fc" --bus "$bus" --failsafe --speed-min 40 --speed-max 60 "$@" </dev/null >ready &
  fc_pid=$!
  head -n 1 ready | grep -q '^ready'
  rm ready
}
# checked STATUS ARGUMENT...: ends so; what it says is in the file said
checked() {
  local status=$1 got=0
  shift
  "$onboard" check --config v.yaml "$@" >said 2>&1 || got=$?
  [[ $got == "$status" ]] || die "ended with $got, not $status: $(<said)"
}
says() { grep -qE -- "$1" said || die "does not say '$1': $(<said)"; }

configure() {
  cat >v.yaml <<EOT
version: 1
vehicle: {id: 7, cruise_speed_mps: 50, speed_min_mps: 42, speed_max_mps: 58, turn_radius_m: 150,
  range_m: 40000, capabilities: [survey], sensor_radius_m: 300, height_m: 100}
origin: {latitude_deg: 31.522062, longitude_deg: 105.044327, height_m: 480}
start: {east_m: 0, north_m: 0, heading_deg: 90}
search: [[2000, 0]]
flight_controller: {kind: ardupilot, can: "$bus"$1}
network: {address: 127.0.0.1, port: $((20000 + BASHPID % 10000)), peers: [{id: 0, address: 127.0.0.1, port: 19999}]}
time: {epoch_unix_ns: $(date +%s)000000000}
recording_folder: $work/recording
EOT
}

configure ""
begin=$(date +%s%3N)
checked 1
took=$(($(date +%s%3N) - begin))
says '^FAIL  CAN frames: none heard; not one frame comes from the bus mcast:'
# On a loaded machine a process starts late; on an idle one this takes 4.1 s.
((took < 15000)) || die "it took $took ms to find no autopilot"
echo "no autopilot: said after $took ms"

start_fc
checked 0
lines=$(grep -cE '^(ok  |warn|FAIL)  ' said)
((lines >= 30)) || die "$lines checks: $(<said)"
echo "$lines checks with an autopilot on the ground"
says '^ok    HEARTBEAT: heard'
says '^ok    ROLL_LIMIT_DEG: ROLL_LIMIT_DEG is 64\.5'
says '^ok    arming: it would arm'
checked 0 --json
node -e 'const r = JSON.parse(require("fs").readFileSync("said", "utf8")); process.exit(r.good && r.checks.length >= 30 ? 0 : 1)' ||
  die "no JSON: $(<said)"
configure ", companion_node_id: 10, node_id: 11"
checked 1
says "^FAIL  companion's node id: somebody sends as node 10"
configure ", node_id: 11"
checked 1
says "^FAIL  flight controller's node: .*heard are: 10 \(its serial port is for node 42\)\. Set"
stop_fc

configure ""
start_fc --no-serial
checked 1
says '^FAIL  serial port over CAN: .*set CAN_D1_UC_SER_EN 1'
stop_fc
start_fc --turn-radius 300 --without FS_LONG_ACTN --at '0 prearm Compass not calibrated'
checked 1
says '^FAIL  ROLL_LIMIT_DEG: .*turn_radius_m is 150: set ROLL_LIMIT_DEG to 65'
says '^FAIL  FS_LONG_ACTN: not told'
says '^FAIL  arming: it would not arm: Compass not calibrated'
stop_fc
echo "speed_mps: 3" >>v.yaml
checked 1
says '^FAIL  configuration: v\.yaml; '
