#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# with_mesh.sh [--vm] LAUNCHER WORK [--one-hop] NODES COMMAND [ARGUMENT...]
#   Runs COMMAND as root where the network namespaces skein0 to skein(NODES - 1) are machines of a mesh of
#   the kernel's batman-adv, as network.sh makes it of the same arguments: in namespaces of this machine if its kernel has what
#   that needs, else (or with --vm) in a virtual machine of tests/uml/in_uml.sh, whose LAUNCHER, WORK and
#   exit status these are.
set -euo pipefail

here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
readonly here

vm_only=
if [[ $1 == --vm ]]; then
  vm_only=yes
  shift
fi
launcher=$1 work=$2
shift 2

new=(unshare --net --mount --pid --fork --kill-child --mount-proc)
((EUID == 0)) || new+=(--map-root-user)
if [[ ! $vm_only ]] && "${new[@]}" sh -c 'ip link add bat0 type batadv && ip link add a type veth &&
    tc qdisc add dev a root netem' 2>/dev/null; then
  echo "mesh: in network namespaces of this machine, kernel $(uname -r)" >&2
  exec "${new[@]}" "$here/network.sh" "$@"
fi
exec "$here/../uml/in_uml.sh" batman-adv \
  batman-adv,veth,sch_netem,sch_prio,sch_ingress,cls_matchall,act_skbedit \
  "$launcher" "$work" "$here/network.sh" "$@"
