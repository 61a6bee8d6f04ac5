#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# A trace of mission_traces in which something is otherwise, on standard output: alter.sh WHAT <TRACE
# Kinds of rows: 3 an award is said, 23 heard, 24 a confirmation heard, 31 a decision heard, 50 a lease granted.
set -euo pipefail
case $1 in
  'no award') awk '$1 != 23' ;;
  'no grant') awk '$1 != 31' ;;
  'no confirmation') awk '$1 != 24' ;;
  'a lease that is longer') awk '$1 == 50 { $16 += 1000000 } { print }' ;;
  # Both deliveries of a plan are one vehicle's, and so it has what another was awarded, too.
  'two owners') awk '$1 == 3 || $1 == 23 { w = $14; $14 = w - w % 16 + int(w / 16) % 16 } { print }' ;;
  *) exit 2 ;;
esac
