#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
#
# guest.sh in-namespace COMMAND [ARGUMENT...]
#   Makes vcan0 and vcan1, then becomes COMMAND.
# guest.sh, as the first process of a virtual machine, with skein_work in its environment
#   The same for the command in the file $skein_work/command; what it says goes to output, its exit
#   status to status. Then the machine is switched off.
set -eu
export PATH=/usr/sbin:/usr/bin:/sbin:/bin

make_interfaces() {
  ip link set lo up
  for name in vcan0 vcan1; do
    ip link show dev "$name" >/dev/null 2>&1 || ip link add dev "$name" type vcan
    # Room for frames with 64 bytes of data, and for some transfers of 19 frames.
    ip link set dev "$name" mtu 72 txqueuelen 200 up
  done
}

if [ "${1:-}" = in-namespace ]; then
  shift
  make_interfaces
  exec "$@"
fi

: "${skein_work:?}"
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
modules=/usr/lib/uml/modules/$(uname -r)/kernel
for module in net/can/can net/can/can-raw drivers/net/can/dev/can-dev drivers/net/can/vcan; do
  insmod "$modules/$module.ko"
done
make_interfaces
sh "$skein_work/command"
