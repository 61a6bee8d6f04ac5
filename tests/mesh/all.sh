#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# all.sh BIN SCENARIO LAUNCHER WORK: all that is tested over the mesh.
set -euo pipefail

bin=$1 scenario=$2 launcher=$3 work=$4
here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
mkdir -p "$work"

# on NETWORK_ARGUMENT... : beside machines of a network of their own
on() { "$here/with_mesh.sh" "$launcher" "$work/machine" "$@"; }
nodes=$(($(grep -c '^ *- {id: [0-9]*, type: ' "$scenario") + 1))
fly() {
  rm -rf "$work/machine/$1"
  on "${@:3}" "$nodes" "$here/fly.sh" "$bin" "$2" --lead 60 --out "$work/machine/$1"
}

echo "The mesh and the modelled radio:"
on 6 "$here/probe.sh" "$bin/mesh_probe" 6 10.54.0.255 0.3

echo "The mission in virtual time:"
"$bin/skein-hil" simulate "$scenario"

echo "Over the mesh:"
fly mission "$scenario"
"$bin/mesh_delays" "$scenario" "$work/machine/mission" 0.3

echo "With the same links, but nobody passes anything on; nothing may be delivered, since nobody is granted it:"
one_hop=$work/one-hop.yaml
sed 's/, mesh: all}/}/; s/^duration_max_s: .*/duration_max_s: 60/' "$scenario" >"$one_hop"
if fly one-hop "$one_hop" --one-hop >"$work/one-hop.txt"; then
  echo "FAIL: it was flown without a mesh"
  exit 1
fi
grep -E '^[0-9.]+ s  vehicle|completion' "$work/one-hop.txt"
grep -q 'authorisation late' "$work/one-hop.txt"
