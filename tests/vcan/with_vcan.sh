#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# with_vcan.sh [--vm] LAUNCHER WORK COMMAND [ARGUMENT...]
#   Runs COMMAND as root where vcan0 and vcan1 are SocketCAN interfaces of its own: in a network
#   namespace of this machine if its kernel has vcan, else (or with --vm) in a virtual machine of
#   tests/uml/in_uml.sh, whose LAUNCHER, WORK and exit status these are.
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

namespace=(unshare --net)
((EUID == 0)) || namespace+=(--map-root-user)
if [[ ! $vm_only ]] && "${namespace[@]}" ip link add dev vcan0 type vcan 2>/dev/null; then
  echo "vcan: in a network namespace of this machine, kernel $(uname -r)" >&2
  exec "${namespace[@]}" "$here/interfaces.sh" "$@"
fi
exec "$here/../uml/in_uml.sh" SocketCAN can-raw,vcan "$launcher" "$work" "$here/interfaces.sh" "$@"
