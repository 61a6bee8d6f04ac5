#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# What a team does when its radio is bad: degradation.sh PROGRAMS SCENARIO [CASE...]
# Flies the scenario in virtual time and as processes, with each of the cases below (all by default), and
# prints a table. Fails where anything but the mission's completion is broken: a team that cannot work must
# still be safe. Vehicles 1 to 6 are those of scenarios/coalition-6.yaml.
set -euo pipefail

readonly programs=$1 scenario=$2
shift 2
(($#)) || set -- undisturbed loss-50 loss-90 loss-90-for-60s 5-kB/s-each 5-kB/s-for-all half-cut-for-120s flood
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# The scenario with what is wrong in that case.
spoilt() {
  local radio='' delay=0.2 more=''
  case $1 in
    undisturbed) ;;
    loss-50) more='faults: [{at_s: 0, for_s: 290, loss_ratio: 0.5}]' ;;
    loss-90) more='faults: [{at_s: 0, for_s: 290, loss_ratio: 0.9}]' ;;
    loss-90-for-60s) more='faults: [{at_s: 0, for_s: 60, loss_ratio: 0.9}]' ;;
    5-kB/s-each) more='air: {limit_bytes_per_s: 5000}' ;;
    # Of the channel, by seven; what all bid takes 0.6 s of it.
    5-kB/s-for-all) radio='bytes_per_s: 5000, ' delay=2 more='air: {limit_bytes_per_s: 700}' ;;
    half-cut-for-120s) more='faults: [{at_s: 5, for_s: 120, partition: [[1, 2, 3], [4, 5, 6]]}]' ;;
    flood) radio='bytes_per_s: 100000, ' more='faults: [{at_s: 5, for_s: 280, flood_vehicle: 6}]' ;;
    *) echo "degradation: there is no case '$1'" >&2 && exit 2 ;;
  esac
  # Range enough to wait for the radio.
  sed "s/^radio: {/radio: {$radio/; s/^duration_max_s: .*/duration_max_s: 300/; s/^  range_m: .*/  range_m: 20000/
       s/message_delay_s: 0.2/message_delay_s: $delay/; s/authorisation_lead_s: 4/authorisation_lead_s: 6/" "$scenario"
  printf '%s\n' "$more"
}

# Of a run's output: when the last site was done, or that it was not; and what was broken besides.
verdict() {
  awk '
    /^VIOLATED:/ {violated = 1}
    (/^FAIL / && $2 != "completion" && $2 != "coalitions") || (violated && /^  [a-z ]+: [0-9.]+ s, /) {broken = broken "; BROKEN " $0}
    /^DONE: / {done = sprintf("done after %.0f s", $8 - 5)}
    /assessments done/ && $3 != "-" {last = sprintf("done after %.0f s", $3)}
    /^ok +completion/ {done = last}
    END {print (done == "" ? "not done" : done) broken}
  ' "$1"
}

printf '%-20s | %-28s | %s\n' case "virtual time" processes
status=0
for case in "$@"; do
  file=$folder/$(tr / - <<<"$case").yaml
  spoilt "$case" >"$file"
  "$programs/skein-hil" simulate "$file" >"$folder/simulated" 2>&1 || true
  "$programs/skein-hil" run "$file" --headless --out "$folder/run" >"$folder/flown" 2>&1 || true
  rm -rf "$folder/run"
  simulated=$(verdict "$folder/simulated") flown=$(verdict "$folder/flown")
  printf '%-20s | %-28s | %s\n' "$case" "$simulated" "$flown"
  if [[ "$simulated $flown" == *BROKEN* ]]; then
    status=1
    grep -hE '^(FAIL|fail)' "$folder/simulated" "$folder/flown" >&2 || true
  fi
done
exit "$status"
