#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# in_uml.sh WHAT MODULES LAUNCHER WORK COMMAND [ARGUMENT...]
#   Runs COMMAND as root in a virtual machine, the user-mode Linux of Debian, started by LAUNCHER, with
#   the kernel's MODULES (with commas). There the files of this machine can be read and only the folder
#   WORK be written. The exit status is COMMAND's; 77 if no virtual machine can be started here, so that
#   WHAT is not tested (WORK/skipped says so, too); 1 if one was started and ended before COMMAND. Why so:
#   docs/decisions/012.
set -euo pipefail
shopt -s inherit_errexit

init=$(dirname "$(realpath "${BASH_SOURCE[0]}")")/init.sh
readonly init
readonly kernel=/usr/bin/linux.uml
readonly boot_within_s=120
readonly skipped=77

say() { printf 'uml: %s\n' "$*" >&2; }

what=$1
modules=$2
launcher=$(realpath "$3")
mkdir -p "$4"
work=$(realpath "$4")
shift 4

if [[ ! -x $kernel ]] || ! command -v modprobe /sbin/modprobe >/dev/null; then
  say "this kernel has not what $what needs, and the virtual machine's packages are missing: apt-get" \
    "install user-mode-linux kmod iproute2"
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
  init="$init" skein_work="$work" skein_modules="$modules" </dev/null >"$work/boot.log" 2>&1 &
machine=$!

for ((waited = 0; waited < 10 * boot_within_s; ++waited)); do
  if [[ -e $work/booted ]] || ! kill -0 "$machine" 2>/dev/null; then break; fi
  sleep 0.1
done
if [[ ! -e $work/booted ]]; then
  tail -n 15 "$work/boot.log" >&2
  # For those who see no output of a test that was skipped.
  echo "SKIPPED: $what IS NOT TESTED. This machine's kernel has not what it needs, and user-mode Linux does" \
    "not start here (it needs ptrace, which some containers forbid); it said: $work/boot.log" |
    tee "$work/skipped" >&2
  exit $skipped
fi
say "$what in a virtual machine, user-mode Linux $(<"$work/booted")"
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
