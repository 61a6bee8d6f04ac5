#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# Makes the links of network.sh's ether as the lines on its input say: of `skein-hil run --links`
# (docs/mesh.md).
set -euo pipefail

while read -r from to state delay_ms jitter_ms loss; do
  how='loss 100%'
  if [[ $state == up ]]; then
    millionths=$((10#${loss/./}))
    how="delay ${delay_ms}ms ${jitter_ms}ms loss $((millionths / 10000)).$(printf %04d $((millionths % 10000)))%"
  fi
  printf 'qdisc replace dev radio%d parent 1:%x netem limit 1000 %s\n' "$to" $((from + 1)) "$how"
done | tc -n ether -batch -
