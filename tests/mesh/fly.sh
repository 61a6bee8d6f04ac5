#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# fly.sh PROGRAMS SCENARIO [ARGUMENT...]: flies the scenario beside the machines of network.sh. The ground
# station and all vehicles are on them, and what they say goes over the mesh, to its broadcast address.
# The arguments go to `skein-hil run`; its exit status is ours.
set -euo pipefail

programs=$(realpath "$1")
scenario=$2
shift 2
here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

mapfile -t ids <<<"$(sed -n 's/^ *- {id: \([0-9]*\), type: .*/\1/p' "$scenario")"
fleet=$folder/$(basename "$scenario")
{
  cat "$scenario"
  echo "air: {group: 10.54.0.255}"
  echo "hosts:"
  echo "  - {vehicle: 0, address: 10.54.0.100, run: ip netns exec skein0}"
  for id in "${ids[@]}"; do
    echo "  - {vehicle: $id, address: 10.54.0.$id, run: ip netns exec skein$id, programs: $programs,
     configurations: $folder/$id/etc, recordings: $folder/$id/var}"
  done
} >"$fleet"

status=0
"$programs/skein-hil" run "$fleet" --external "0,$(IFS=, && echo "${ids[*]}")" --address 10.54.0.254 \
  --links "$here/links.sh" --headless "$@" || status=$?
((status == 0)) || tail -n 3 "$folder"/*/var/*.log >&2 || true
exit "$status"
