#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
#
# The first process of a virtual machine of in_uml.sh, with skein_work and skein_modules (with commas) in
# its environment: loads the modules and runs the command in the file $skein_work/command. What it says
# goes to output, its exit status to status. Then the machine is switched off.
set -eu
export PATH=/usr/sbin:/usr/bin:/sbin:/bin

: "${skein_work:?}" "${skein_modules:?}"
switch_off() {
  echo "$?" >"$skein_work/status"
  sync
  echo o >/proc/sysrq-trigger
  while :; do sleep 1; done
}

mount -t proc proc /proc
mount -t sysfs sysfs /sys
mount -t tmpfs tmpfs /dev/shm 2>/dev/null || { mkdir -p /dev/shm && mount -t tmpfs tmpfs /dev/shm; }
mount -t hostfs -o "$skein_work" hostfs "$skein_work"
trap switch_off EXIT
uname -r >"$skein_work/boots"
mv "$skein_work/boots" "$skein_work/booted"
exec >>"$skein_work/output" 2>&1
export TMPDIR=/dev/shm HOME=/dev/shm
# modprobe looks for the modules in lib/modules of a folder.
mkdir -p /dev/shm/uml/lib
ln -s /usr/lib/uml/modules /dev/shm/uml/lib/modules
# shellcheck disable=SC2046  # words
modprobe --dirname /dev/shm/uml --all $(echo "$skein_modules" | tr ',' ' ')
sh "$skein_work/command"
