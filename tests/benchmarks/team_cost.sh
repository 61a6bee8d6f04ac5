#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# What a mission of processes costs: team_cost.sh PROGRAMS SCENARIO [ARGUMENT...]
# Flies it in a network of its own (needs root, or the right to make user namespaces), and prints the
# processor time of all its processes, and what a node sends, headers included, as loopback counts it
# while the mission runs. The arguments go to `skein-hil run`.
set -euo pipefail

if [[ $1 != --inside ]]; then
  new=(unshare --net)
  ((EUID == 0)) || new+=(--map-root-user)
  exec "${new[@]}" "$0" --inside "$@"
fi
shift
programs=$1 scenario=$2
shift 2
ip link set lo up
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# Bytes and packets that loopback has sent.
sent() { awk '$1 == "lo:" {print $10, $11}' /proc/net/dev; }

began=$(date +%s%N)
"$programs/skein-hil" run "$scenario" --headless --out "$folder/run" "$@" >"$folder/log" 2>&1 &
mission=$!
until grep -qs 'vehicles heard' "$folder/log"; do
  kill -0 "$mission" 2>/dev/null || { cat "$folder/log" >&2; exit 1; }
  sleep 0.1
done
vehicles=("$folder"/run/vehicle-*.yaml)
nodes=$((${#vehicles[@]} + 1))
read -r bytes packets < <(sent)
from=$(date +%s%N)
status=0
while kill -0 "$mission" 2>/dev/null; do
  read -r bytes_now packets_now < <(sent)
  to=$(date +%s%N)
  sleep 1
done
wait "$mission" || status=$?
read -r user system < <(awk '{print $16, $17}' /proc/$$/stat)
ticks=$(getconf CLK_TCK)
took_ms=$((($(date +%s%N) - began) / 1000000))
grep -E 'vehicles heard|^FAIL|^PASS' "$folder/log"
awk -v u="$user" -v s="$system" -v ticks="$ticks" -v ms="$took_ms" -v nodes="$nodes" \
  -v bytes=$((bytes_now - bytes)) -v packets=$((packets_now - packets)) -v ns=$((to - from)) 'BEGIN {
  printf "%d nodes, %.0f s: processor time %.1f s user, %.1f s system: %.1f %% of one\n",
    nodes, ms / 1e3, u / ticks, s / ticks, 1e5 * (u + s) / ticks / ms
  printf "a node sends %.2f kB/s in %.1f packets/s\n", bytes / ns * 1e6 / nodes, packets / ns * 1e9 / nodes
}'
exit "$status"
