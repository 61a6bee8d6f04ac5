#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# Machines of a fleet as network namespaces: namespaces.sh COUNT COMMAND [ARGUMENT...]
# Runs the command where namespaces skein0, skein1, ... hang on one bridge, with the addresses
# 10.53.0.10, 10.53.0.1, 10.53.0.2, ...; the bridge itself is 10.53.0.254. Needs root, or the right to
# make user namespaces; without it the exit status is 77. Whatever the command starts ends with it.
set -euo pipefail

readonly skipped=77

if [[ $1 != --inside ]]; then
  # In a user namespace nobody has real-time priority, so root goes without.
  new=(unshare --net --mount --pid --fork --kill-child --mount-proc)
  ((EUID == 0)) || new+=(--user --map-root-user)
  if ! "${new[@]}" true 2>/dev/null || ! command -v ip >/dev/null; then
    echo "skipped: this machine lets us make no network namespaces (or has no iproute2)" >&2
    exit "$skipped"
  fi
  exec "${new[@]}" "$0" --inside "$@"
fi

shift
count=$1
shift
mount -t tmpfs none /run
# Their pids are those of others outside, and so would be the names of shared memory.
mount -t tmpfs none /dev/shm
mkdir /run/netns
ip link set lo up
ip link add bridge type bridge
ip address add 10.53.0.254/24 dev bridge
ip link set bridge up
for ((i = 0; i < count; i++)); do
  ip netns add "skein$i"
  ip link add "to$i" master bridge type veth peer name eth0 netns "skein$i"
  ip link set "to$i" up
  ip -n "skein$i" link set lo up
  ip -n "skein$i" address add "10.53.0.$((i == 0 ? 10 : i))/24" dev eth0
  ip -n "skein$i" link set eth0 up
done
# Not exec: as the first process of its pid namespace the command would have to reap what it inherits.
"$@"
