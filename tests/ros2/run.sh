#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
#
# run.sh SOURCE_FOLDER WORK_FOLDER PROGRAMS_FOLDER EXAMPLES_FOLDER: builds the peer, which is not ours but for
# its main(), of IDL by Cyclone DDS, and lets it look at a mission. 77 where Cyclone DDS cannot be had.
set -eu
source=$1 work=$2 programs=$3 examples=$4

for program in idlc gcc node; do
  if ! command -v "$program" >/dev/null; then
    echo "skipped: it needs $program (Debian: cyclonedds-tools cyclonedds-dev gcc nodejs; './dev test' installs them)"
    exit 77
  fi
done
mkdir -p "$work"
(cd "$work" && idlc -l c "$source/ros2.idl")
gcc -std=gnu11 -Wall -Wextra -Werror -O1 -I"$work" -o "$work/peer" "$source/peer.c" "$work/ros2.c" -lddsc -lm
exec node "$source/check.mjs" "$programs" "$examples" "$work/peer" "$work/mission"
