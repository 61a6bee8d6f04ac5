#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# A mission of the bench whose first vehicles are on other machines, which are network namespaces:
#   mixed.sh PROGRAMS SCENARIO COUNT [ARGUMENT...]
# Vehicles 1 to COUNT are external; those that the scenario has on CAN have an emulated flight
# controller there, on vcan0 where the kernel has it. The arguments go to `skein-hil run`; its exit status is ours.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if [[ $1 != --inside ]]; then
  exec "$here/namespaces.sh" "$(($3 + 1))" "$0" --inside "$@"
fi
shift
programs=$1
scenario=$2
count=$3
shift 3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# Of the vehicle's lines, up to those of the next.
on_can() {
  awk -v start="{id: $1," '/^ *- [{]id: /{of = index($0, start)}
    of && /kind: ardupilot/{found = 1} END{exit !found}' "$scenario"
}

# The same file with the hosts: its shapes and tracks are named beside it.
fleet=$folder/$(basename "$scenario")
cp -r "$(dirname "$scenario")/." "$folder"
{
  echo "hosts:"
  echo "  - {vehicle: 0, address: 10.53.0.254}"
  for ((id = 1; id <= count; id++)); do
    can=
    if on_can "$id"; then
      bus=mcast:$((100 + id))
      if ip -n "skein$id" link add dev vcan0 type vcan 2>/dev/null; then
        ip -n "skein$id" link set dev vcan0 mtu 72 txqueuelen 200 up
        bus=vcan0
      fi
      can="can: '$bus', flight_controller: emulated,"
    fi
    echo "  - {vehicle: $id, address: 10.53.0.$id, run: ip netns exec skein$id, $can"
    echo "     programs: $programs, radio_plugin: $(dirname "$programs")/lib/skein/libskein_radio.so,"
    echo "     configurations: $folder/$id/etc, recordings: $folder/$id/var}"
  done
} >>"$fleet"

status=0
"$programs/skein-hil" run "$fleet" --external "1-$count" "$@" || status=$?
((status == 0)) || tail -n 3 "$folder"/*/var/*.log >&2 || true
exit "$status"
