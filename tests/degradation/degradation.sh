#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# What a team does when its radio is bad: degradation.sh PROGRAMS SCENARIO [short | CASE...]
# Flies the scenario in virtual time, with many seeds, and as processes, all at once, with each of the cases
# below (all by default; short: as processes two of them that are over soon), and prints a table. Fails where
# anything but the mission's completion is broken: a team that cannot work must still be safe. It fails, too,
# where a mission is not finished in a case in which it can be. Vehicles 1 to 6 are those of
# scenarios/coalition-6.yaml.
set -euo pipefail

readonly programs=$1 scenario=$2
shift 2
readonly all=(undisturbed loss-50 loss-90 loss-90-for-60s 5-kB/s-each 5-kB/s-for-all half-cut-for-120s flood)
# lead: seconds from the start of so many programs to that of the mission.
cases=("$@") flown=("$@") seeds=100 lead=20
if (($# == 0)); then cases=("${all[@]}") flown=("${all[@]}"); fi
if [[ ${1-} == short ]]; then cases=("${all[@]}") flown=(5-kB/s-each flood) seeds=25 lead=10; fi
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

# What a mission under that case comes to: done; worked, where a delivery may stay open of which nobody knows
# whether it was flown; or anything that is safe.
expected() {
  case $1 in
    loss-50) echo worked ;;
    loss-90) echo safe ;;
    *) echo "done" ;;
  esac
}

# Of the summary of many seeds: in how many all sites were done, after how long, what was left open, and
# what else was broken.
simulated_verdict() {
  awk -v seeds="$seeds" '
    /^violated / {
      for (i = 3; i < NF; i += 2) {
        sub(/,$/, "", $(i + 1))
        if ($i == "completion") open = $(i + 1); else broken = broken "; BROKEN " $i " in " $(i + 1)
      }
    }
    /^all sites / {
      sites = $5
      if ($5 > 0) took = sprintf("%.0f (%.0f to %.0f) s", $12 - 5, $8 - 5, $16 - 5)
    }
    END {
      if (sites == "") broken = broken "; BROKEN no summary"
      text = sites == seeds ? "done" : sites + 0 " of " seeds " done"
      if (took != "") text = text " after " took
      if (sites == seeds && open > 0) text = text ", open in " open
      print text broken
    }' "$1"
}

# Of a flight: when the last site was done, or that it was not; and what was broken besides.
flown_verdict() {
  awk '
    /^FAIL / && $2 != "completion" && $2 != "coalitions" {broken = broken "; BROKEN " $0}
    /assessments done/ && $3 != "-" {last = sprintf("done after %.0f s", $3)}
    /^ok +completion/ {done = last}
    /^(ok|FAIL) / {judged = 1}
    END {print (done == "" ? "not done" : done) broken (judged ? "" : "; BROKEN nothing was judged")}
  ' "$1"
}

# as_expected CASE VERDICT
as_expected() {
  [[ $2 != *BROKEN* ]] || return 1
  case $(expected "$1") in
    "done") [[ $2 == done* && $2 != *open* ]] ;;
    worked) [[ $2 == done* || $2 == "not done" ]] ;;
    safe) ;;
  esac
}

name() { tr / - <<<"$1"; }
for case in "${cases[@]}"; do spoilt "$case" >"$folder/$(name "$case").yaml"; done
for case in "${flown[@]}"; do
  at=$folder/$(name "$case")
  "$programs/skein-hil" run "$at.yaml" --headless --lead "$lead" --out "$at.run" >"$at.flown" 2>&1 &
done
wait
for case in "${cases[@]}"; do
  at=$folder/$(name "$case")
  "$programs/skein-hil" simulate "$at.yaml" --runs "$seeds" >"$at.simulated" 2>&1 || true
done

printf '%-18s | %-40s | %s\n' case "virtual time, $seeds seeds: mean (range)" processes
status=0
for case in "${cases[@]}"; do
  at=$folder/$(name "$case")
  simulated=$(simulated_verdict "$at.simulated")
  flight=-
  if [[ -e $at.flown ]]; then flight=$(flown_verdict "$at.flown"); fi
  printf '%-18s | %-40s | %s\n' "$case" "$simulated" "$flight"
  if ! as_expected "$case" "$simulated"; then
    echo "$case, in virtual time: not $(expected "$case")" >&2
    tail -n 30 "$at.simulated" >&2
    status=1
  fi
  if [[ $flight != - ]] && ! as_expected "$case" "$flight"; then
    echo "$case, as processes: not $(expected "$case")" >&2
    cat "$at.flown" >&2
    status=1
  fi
done
exit "$status"
