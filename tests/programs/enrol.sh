#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# enrol.sh SKEIN_GROUND SKEIN_ONBOARD: a team of five as docs/keys.md has it, from nothing.
set -euo pipefail
ground=$1 onboard=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

die() {
  echo "enrol: $*" >&2
  exit 1
}
# refused STATUS TEXT COMMAND...: ends so, and says why
refused() {
  local status=$1 text=$2 got=0
  shift 2
  "$@" </dev/null >said 2>&1 || got=$?
  [[ $got == "$status" ]] || die "'$*' ended with $got, not $status: $(<said)"
  grep -qF -- "$text" said || die "'$*' did not say '$text': $(<said)"
}
at_ground() { "$ground" "$@" --keys ground; }
# on N COMMAND...: on board of vehicle N
on() { "$onboard" "${@:2}" --keys "vehicle-$1"; }

begin=$SECONDS
at_ground mission create ridge --days 2 | grep -q '^mission ridge until '
mkdir requests
for n in 1 2 3 4 5; do
  on $n enrol --id $n >requests/vehicle-$n.txt 2>>fingerprints
done
refused 1 --yes at_ground mission enrol requests/*.txt
at_ground mission enrol requests/*.txt --out answers --yes 2>compared | wc -l | grep -qx 5
cmp fingerprints compared
for n in 1 2 3 4 5; do
  on $n enrol --membership answers/vehicle-$n.txt | grep -q "^vehicle $n is a member of the mission ridge"
  on $n keys show | grep -q 'epoch        1, 0 revoked'
done
echo 'correct horse' | at_ground mission operator ada 2>/dev/null | grep -q '^ada:operator:pbkdf2-sha256'
at_ground keys show >shown
grep -q 'vehicle 5$' shown
grep -q 'operator ada$' shown
echo "a team of five enrolled in $((SECONDS - begin)) s"

# What must not be.
refused 1 'enrol with its own request' on 1 enrol --membership answers/vehicle-2.txt
refused 1 'has the keys of node 1' on 1 enrol --id 7
refused 2 'copy it again' "$onboard" enrol --membership "$(head -c 300 answers/vehicle-1.txt)" --keys vehicle-1
refused 2 'this is no request' at_ground mission enrol answers/vehicle-1.txt --yes
refused 1 'a folder of its own' at_ground mission create again
refused 1 'is no name' "$ground" mission create '../x' --keys other
refused 2 'days' "$ground" mission create x --days many --keys other
refused 1 'mission create' "$ground" mission enrol requests/vehicle-1.txt --yes --keys nowhere
[[ $(stat -c %a ground vehicle-1 ground/* vehicle-1/* | sort -u) == $'600\n700' ]] || die "not private"
chmod 644 vehicle-5/node.key
refused 1 'chmod 600' on 5 keys show
chmod 600 vehicle-5/node.key
systemd=$(realpath vehicle-5)/handed
mkdir "$systemd"
mv vehicle-5/node.key "$systemd"
CREDENTIALS_DIRECTORY=$systemd on 5 keys show >/dev/null

# One is lost.
at_ground mission revoke vehicle 3 | grep -q 'the others have the key of epoch 2'
refused 1 'no vehicle 3' at_ground mission revoke vehicle 3
at_ground keys show | grep -q 'vehicle 3  REVOKED'
at_ground keys show --json | grep -q '"epoch":2.*"good":true'
[[ $(wc -l <ground/changes) == 4 ]] || die "not a change for each of the four"
refused 1 '--new-keys' at_ground mission enrol requests/vehicle-3.txt --yes
# Who missed it asks again; he who was found again asks with other keys.
at_ground mission enrol requests/vehicle-1.txt --yes 2>/dev/null | on 1 enrol --membership - >/dev/null
on 1 keys show | grep -q 'epoch        2, 1 revoked'
on 3 enrol --id 3 --new-keys 2>/dev/null | at_ground mission enrol - --yes 2>/dev/null >answer
on 3 enrol --membership "$(<answer)" >/dev/null
on 3 keys show | grep -q 'certificate 8'
echo "all as it must be"
