#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
#
# interfaces.sh COMMAND [ARGUMENT...]: makes vcan0 and vcan1, then becomes COMMAND.
set -eu

ip link set lo up
for name in vcan0 vcan1; do
  ip link show dev "$name" >/dev/null 2>&1 || ip link add dev "$name" type vcan
  # Room for frames with 64 bytes of data, and for some transfers of 19 frames.
  ip link set dev "$name" mtu 72 txqueuelen 200 up
done
exec "$@"
