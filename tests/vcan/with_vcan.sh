#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# with_vcan.sh [--vm] LAUNCHER WORK COMMAND [ARGUMENT...]
#   Runs COMMAND as root where vcan0 and vcan1 are SocketCAN interfaces of its own: in a network
#   namespace of this machine if its kernel has vcan, else (or with --vm) in a virtual machine, the
#   user-mode Linux of Debian, started by LAUNCHER. There the files of this machine can be read and
#   only the folder WORK be written. The exit status is COMMAND's; 77 if no virtual machine can be
#   started here, 1 if one was started and ended before COMMAND. Why so: docs/decisions/012.
set -euo pipefail
shopt -s inherit_errexit

guest=$(dirname "$(realpath "${BASH_SOURCE[0]}")")/guest.sh
readonly guest
readonly kernel=/usr/bin/linux.uml
readonly boot_within_s=120
readonly skipped=77

say() { printf 'vcan: %s\n' "$*" >&2; }

vm_only=
if [[ $1 == --vm ]]; then
  vm_only=yes
  shift
fi
launcher=$(realpath "$1")
mkdir -p "$2"
work=$(realpath "$2")
shift 2

namespace=(unshare --net)
((EUID == 0)) || namespace+=(--map-root-user)
if [[ ! $vm_only ]] && "${namespace[@]}" ip link add dev vcan0 type vcan 2>/dev/null; then
  say "in a network namespace of this machine, kernel $(uname -r)"
  exec "${namespace[@]}" "$guest" in-namespace "$@"
fi

if [[ ! -x $kernel ]] || ! command -v insmod /sbin/insmod >/dev/null; then
  say "this kernel has no vcan, and the virtual machine's packages are missing: apt-get install" \
    "user-mode-linux kmod iproute2"
  exit 1
fi

rm -rf "$work"/{boot.log,booted,command,output,skipped,status,uml}
mkdir "$work/uml"
touch "$work/output"
{
  printf 'cd %q\n' "$PWD"
  printf '%q ' "$@"
} >"$work/command"

machine=
trap '[[ -z $machine ]] || { kill "$machine" && wait "$machine"; } 2>/dev/null || true
      rm -rf "$work/uml"' EXIT
trap 'exit 130' INT TERM HUP

# TMPDIR holds its memory, a file without a name. On a disk the machine stops now and then to be written;
# but in containers /dev/shm is often small or noexec.
memory_in=$work/uml
read -r free_blocks block_size < <(stat --file-system --format='%a %S' /dev/shm 2>/dev/null) || free_blocks=0
if ((free_blocks * block_size > 2 ** 30)) && [[ ! $(findmnt --noheadings --output OPTIONS /dev/shm) =~ noexec ]]; then
  memory_in=/dev/shm
fi
TMPDIR=$memory_in "$launcher" "$kernel" mem=1G quiet con=null con0=null,fd:1 \
  uml_dir="$work/uml/" umid=vm rootfstype=hostfs hostfs=/ ro \
  init="$guest" skein_work="$work" </dev/null >"$work/boot.log" 2>&1 &
machine=$!

for ((waited = 0; waited < 10 * boot_within_s; ++waited)); do
  if [[ -e $work/booted ]] || ! kill -0 "$machine" 2>/dev/null; then break; fi
  sleep 0.1
done
if [[ ! -e $work/booted ]]; then
  tail -n 15 "$work/boot.log" >&2
  # For those who see no output of a test that was skipped.
  echo "SKIPPED: SocketCAN IS NOT TESTED. This machine's kernel has no vcan, and user-mode Linux does" \
    "not start here (it needs ptrace, which some containers forbid); it said: $work/boot.log" |
    tee "$work/skipped" >&2
  exit $skipped
fi
say "in a virtual machine, user-mode Linux $(<"$work/booted")"
tail --pid="$machine" --sleep-interval=0.2 -n +1 -f "$work/output" &
wait $! || true  # in the background, so that a signal to this shell is heard at once
wait "$machine" || true
machine=
if [[ ! -e $work/status ]]; then
  tail -n 30 "$work/boot.log" >&2
  say "the virtual machine ended before the command did; see $work/boot.log"
  exit 1
fi
exit "$(<"$work/status")"
