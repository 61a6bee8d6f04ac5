#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
#
# all.sh BIN SCENARIO WORK: all that is tested on vcan0. The figures of the mission are the buses' own
# counts, from the logs of the vehicles in WORK/mission.
set -eu
bin=$1 scenario=$2 work=$3

SKEIN_CAN_INTERFACE=vcan0 SKEIN_CAN_SCRATCH_INTERFACE=vcan1 \
  "$bin/can_test" --gtest_filter='*socketcan*:SocketCan*'
rm -rf "$work/mission"
mkdir -p "$work/threads"
rm -f "$work"/threads/*
LD_PRELOAD=$(realpath "$bin/../lib/libskein_thread_watch.so") SKEIN_THREAD_WATCH=$(realpath "$work/threads") \
  "$bin/skein-hil" run "$scenario" --lead 25 --out "$work/mission"
echo "Buses of the vehicles, and their threads (lateness of control; age of the frames that can reads):"
grep -ho 'bus vcan.*' "$work"/mission/*.log
cat "$work"/threads/*.txt
if grep -hE 'bus vcan' "$work"/mission/*.log |
  grep -vE 'refused 0, lost 0;.*broken 0, dropped 0;.*lost 0$'; then
  echo "FAIL: frames, transfers or packets were lost"
  exit 1
fi
