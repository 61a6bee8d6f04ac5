#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# From the fleet's file to the mission on four machines that are network namespaces, and what the
# status says of a host that somebody has changed: fleet.sh PROGRAMS
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if [[ ${2-} != --inside ]]; then exec "$here/namespaces.sh" 5 "$0" "$1" --inside; fi

readonly programs=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
readonly file=$folder/fleet.yaml
sed "s|PROGRAMS|$programs|; s|FOLDER|$folder|g" "$here/fleet.yaml" >"$file"

fail() {
  echo "FAILED: $*" >&2
  tail -n 5 "$folder"/?/var/*.log >&2 || true
  exit 1
}
fleet() { "$programs/skein" fleet "$1" "$file" --out "$folder/rendered" "${@:2}"; }
tell() { ip netns exec skein0 "$programs/skein-ground" tell --json "$@"; }
# until_holds SECONDS WHAT COMMAND...
until_holds() {
  local end=$((SECONDS + $1)) what=$2
  shift 2
  until "$@"; do
    ((SECONDS < end)) || fail "not within the time: $what"
    sleep 0.2
  done
}
has() { grep -qE -- "$1" <<<"$2"; }

echo "- without an epoch nothing is rendered, and check says so"
refused=$(fleet check 2>&1) && fail "a fleet without an epoch is good"
has 'has no epoch' "$refused" || fail "$refused"

echo "- without keys no program joins a network of other machines"
fleet push --epoch now || fail "push"
refused=$(fleet start 2>&1) && fail "programs without keys are up"
has 'mission create' "$refused" || fail "$refused"

echo "- the team is enrolled"
keys() { echo "$folder/$1/var/$2/keys"; }
"$programs/skein-ground" mission create team --keys "$(keys 0 ground)" || fail "create"
"$programs/skein-ground" mission operator ada --keys "$(keys 0 ground)" <<<"correct horse" >"$folder/passwords" || fail "operator"
for id in 1 2 3; do
  "$programs/skein-onboard" enrol --id $id --keys "$(keys $id onboard-$id)" |
    "$programs/skein-ground" mission enrol - --yes --keys "$(keys 0 ground)" |
    "$programs/skein-onboard" enrol --membership - --keys "$(keys $id onboard-$id)" || fail "enrol $id"
done

echo "- a fleet that is pushed and started"
fleet push --epoch now || fail "push"
epoch=$(cat "$folder/rendered/epoch")
fleet start || fail "start"
all_heard() { [[ $(tell status 2>/dev/null | grep -c '"silent": false') == 3 ]]; }
until_holds 20 "the ground station hears all three" all_heard
fleet status || fail "the status of a fleet that was just started"

echo "- the mission: a site is told, surveyed, authorised and delivered to"
told=$(tell site 0 0 survey 5 deliver 0,120 simultaneous) || fail "$told"
site=$(grep -oE 'site [0-9]+' <<<"$told" | head -n 1 | cut -d ' ' -f 2)
authorised() { tell authorise "$site" >/dev/null 2>&1; }
unsigned_refused() { has 'skein-ground unlock' "$(tell authorise "$site" 2>&1)"; }
unlock() { ip netns exec skein0 "$programs/skein-ground" unlock --operator ada <<<"$1"; }
delivered() { has '2 delivered' "$(tell sites)"; }
until_holds 30 "nothing is authorised that no operator signs" unsigned_refused
refused=$(unlock "another horse" 2>&1) && fail "another password unlocks the key"
has 'does not open' "$refused" || fail "$refused"
unlock "correct horse" || fail "unlock"
until_holds 30 "an authorisation is asked for" authorised
until_holds 40 "both deliveries are flown" delivered

echo "- a vehicle with the team's certificate that stands in nobody's file takes part"
mkdir -p "$folder/4/etc" "$folder/4/var/onboard-4"
sed "s|id: 2$|id: 4|; s|10\.53\.0\.2|10.53.0.4|; s|$folder/2/|$folder/4/|; s|onboard-2|onboard-4|;
     s|detections-2|detections-4|; s|height_m: 110$|height_m: 130|" "$folder/2/etc/onboard-2.yaml" >"$folder/4/etc/onboard-4.yaml"
"$programs/skein-onboard" enrol --id 4 --keys "$(keys 4 onboard-4)" |
  "$programs/skein-ground" mission enrol - --yes --keys "$(keys 0 ground)" |
  "$programs/skein-onboard" enrol --membership - --keys "$(keys 4 onboard-4)" || fail "enrol 4"
ip netns exec skein4 "$programs/skein-onboard" --config "$folder/4/etc/onboard-4.yaml" >"$folder/4/var/onboard-4.log" 2>&1 &
joined=$!
began=$(date +%s%3N)
four_heard() { [[ $(tell status 2>/dev/null | grep -c '"silent": false') == 4 ]]; }
until_holds 20 "the ground station hears vehicle 4" four_heard
echo "  heard $(($(date +%s%3N) - began)) ms after its program began"
told=$(tell site 150 -150 survey 3 deliver 60 simultaneous) || fail "$told"  # the others have no loads left
site=$(grep -oE 'site [0-9]+' <<<"$told" | head -n 1 | cut -d ' ' -f 2)
fourth_delivered() { has '1 delivered' "$(tell sites)"; }
until_holds 60 "an authorisation is asked for" authorised
until_holds 60 "vehicle 4 has delivered" fourth_delivered
kill "$joined"
wait "$joined" || fail "vehicle 4 did not end cleanly"

echo "- who is revoked is heard no more; the others have another key at once, and fly on"
"$programs/skein-ground" mission revoke vehicle 3 --keys "$(keys 0 ground)" || fail "revoke"
changed() { grep -qs 'another key' "$folder/1/var/"*.log && grep -qs 'another key' "$folder/2/var/"*.log; }
until_holds 2 "the other two have the new key" changed
two_heard() { [[ $(tell status 2>/dev/null | grep -c '"silent": false') == 2 ]]; }
until_holds 20 "the one that was revoked is heard no more" two_heard
"$programs/skein-ground" mission enrol --yes --keys "$(keys 0 ground)" \
  "$("$programs/skein-onboard" enrol --id 3 --new-keys --keys "$(keys 3 onboard-3)")" |
  "$programs/skein-onboard" enrol --membership - --keys "$(keys 3 onboard-3)" || fail "enrol 3 anew"

echo "- a program that runs is given no other configuration"
refused=$(fleet push --only 2 2>&1) && fail "vehicle 2 runs and was configured"
has 'vehicle 2 .*stop it first' "$refused" || fail "$refused"

echo "- a host that somebody has changed is named with its key"
sed -i 's/latitude_deg: 31.522062/latitude_deg: 31.6/' "$folder/3/etc/onboard-3.yaml"
drifted=$(fleet status --json) && fail "vehicle 3 has drifted"
has '"key": "origin.latitude_deg"' "$drifted" || fail "$drifted"
[[ $(grep -c '"as_the_file": true' <<<"$drifted") == 3 ]] || fail "$drifted"
fleet stop --only 3
refused=$(fleet start --only 3 2>&1) && fail "vehicle 3 was started with another origin"
has 'vehicle 3 .*origin.latitude_deg' "$refused" || fail "$refused"

echo "- another address of one host is written once, and the epoch stays"
ip -n skein3 address del 10.53.0.3/24 dev eth0
ip -n skein3 address add 10.53.0.33/24 dev eth0
sed -i 's/10.53.0.3,/10.53.0.33,/' "$file"
fleet stop || fail "stop"
fleet push || fail "push with the new address"
fleet start || fail "start at the new address"
[[ $(cat "$folder/rendered/epoch") == "$epoch" ]] || fail "the epoch has changed"
until_holds 20 "the ground station hears all three again" all_heard
fleet status || fail "the status at the new address"

fleet stop || fail "the last stop"
ls "$folder"/[123]/var/onboard-?/*.mcap >/dev/null || fail "nothing is recorded"
echo "PASS"
