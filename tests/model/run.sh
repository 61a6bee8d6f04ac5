#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# The model of the contract net (docs/model.md): every state of each configuration, every mutant found,
# recorded missions accepted, and altered ones not.
#   run.sh verify [CONFIGURATION...] | mutants | traces PROGRAMS SCENARIO FAULTS MISSIONS
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
readonly here
work=$(mktemp -d)
readonly work
trap 'rm -rf "$work"' EXIT
command -v spin >/dev/null || {
  echo "model: spin is not installed; apt-get install spin" >&2
  exit 77
}

# What is bounded, by configuration: what they look at is in docs/model.md.
times='-DLEASE=2 -DGUARD=1 -DV=3 -DK=2'
# After it no fault comes any more: a run without end in which something is left to do is an acceptance cycle.
healing="-DV=3 -DK=10 -DHELD=1 -DTENDERS -DWORKS -DGUARD=0 -DFIRST=2 -DROUNDS_MAX=1 -DCRASHES=1 -DHEALS -DHEARD_TOGETHER"
declare -Ar configurations=(
  [leases]="$times -DT=1 -DC=1 -DFIRST=1 -DTENDERS -DWITHOUT_ELECTORS -DROUNDS_MAX=2"
  [leases-crash]="$times -DT=1 -DC=1 -DFIRST=1 -DTENDERS -DWITHOUT_ELECTORS -DROUNDS_MAX=1 -DCRASHES=1 -DWORKS"
  [authority]="$times -DT=3 -DC=2 -DFIRST=1 -DAUTHORITY -DROUNDS_MAX=1"
  [rejoining]="-DLEASE=1 -DGUARD=0 -DV=3 -DK=2 -DT=3 -DC=2 -DFIRST=1 -DAUTHORITY -DROUNDS_MAX=1 -DCRASHES=1 -DWITHDRAWALS -DREJOINS"
  [gate]="$times -DT=1 -DC=2 -DFIRST=1 -DAHEAD=2 -DDELIVERIES=1 -DWITHOUT_ELECTORS -DGATE -DROUNDS_MAX=2 -DTAKE_BACKS=1"
  [two-leaders]="-DLEASE=2 -DGUARD=0 -DV=3 -DK=2 -DT=1 -DC=2 -DFIRST=2 -DAHEAD=2 -DDELIVERIES=1 -DWITHOUT_ELECTORS -DGATE -DROUNDS_MAX=2 -DTWO_LEADERS"
  [healing]="$healing -DLEASE=2 -DT=1 -DC=1 -DWITHOUT_ELECTORS -DLEADER_STAYS -DROUNDS_END=3 -DFAULT_TICKS=2"
  [healing-take-over]="$healing -DLEASE=3 -DSILENCE=2 -DT=2 -DC=4 -DSTANDS -DROUNDS_END=5 -DFAULT_TICKS=1"
)
# Not two-leaders: it is larger than 4 GB.
readonly order=(leases leases-crash authority rejoining gate healing healing-take-over)

# mutant configuration: where it is found
readonly mutants=(
  "LEASE_TOO_LONG=1 leases" "NO_CLOCK_GUARD leases" "BID_KEEPS_TASK leases"
  "NO_PROMISES authority" "SUCCESSOR_DOES_NOT_WAIT authority" "HALF_IS_ENOUGH authority"
  "OLD_LEAVING_COUNTS rejoining" "OLD_RENEWAL_COUNTS rejoining"
  "ASKS_ONCE healing" "LEASES_NEVER_END healing"
  "GATE_WITHOUT_GRANT gate" "GATE_WITHOUT_LEASE gate" "LATE_COPY_GRANTS gate"
)

usage() { sed -n '3,6s/^# \?//p' "${BASH_SOURCE[0]}"; }

# search FOLDER DEFINITION...: its result is in FOLDER/out
search() {
  local at=$work/$1
  shift
  mkdir -p "$at" && cp "$here"/*.pml "$at"
  local -a search=(-DSAFETY) run=()
  [[ $* != *-DHEALS* ]] || { search=(-DNOREDUCE) && run=(-a); }
  (cd "$at" && spin "$@" -a explore.pml >spin.out && cc -O2 -w "${search[@]}" -DCOLLAPSE -DMEMLIM=4000 -o pan pan.c &&
    ./pan "${run[@]}" -m1000000 >out 2>&1) || { cat "$at"/*.out "$at/out" 2>/dev/null; return 1; }
}
figures() {
  awk '/states, stored/ { states = $1 } /total actual memory/ { mb = $1 } /elapsed time/ { s = $4 } /errors:/ { e = $NF }
       END { printf "%d states, %.0f MB, %.1f s, errors: %s\n", states, mb, s, e }' "$1"
}

verify() {
  local name failed=0
  (($#)) || set -- "${order[@]}"
  for name in "$@"; do
    [[ -v configurations[$name] ]] || { echo "model: there is no configuration '$name'; there are ${!configurations[*]}" >&2; exit 2; }
    # Options are words on purpose.
    # shellcheck disable=SC2086
    search "$name" ${configurations[$name]}
    printf 'model: %-16s %s\n' "$name" "$(figures "$work/$name/out")"
    if ! grep -q 'errors: 0' "$work/$name/out" || grep -q 'Search not completed\|max search depth too small' "$work/$name/out"; then
      grep '^pan' "$work/$name/out"
      failed=1
    fi
  done
  return "$failed"
}

find_mutants() {
  local line mutant name failed=0
  for line in "${mutants[@]}"; do
    read -r mutant name <<<"$line"
    # shellcheck disable=SC2086
    search mutant ${configurations[$name]} -DMUTANT_"$mutant"
    if grep -q 'errors: [1-9]' "$work/mutant/out"; then
      printf 'model: %-26s is found in %s: %s\n' "$mutant" "$name" "$(figures "$work/mutant/out")"
    else
      printf 'model: %-26s is not found in %s\n' "$mutant" "$name"
      failed=1
    fi
  done
  return "$failed"
}

# replay_traces PROGRAMS SCENARIO FAULTS MISSIONS
replay_traces() {
  (($# == 4)) || { usage >&2 && exit 2; }
  local programs=$1 scenario=$2 faults=$3 missions=$4 first step=5 failed=0
  [[ -x $programs/mission_traces ]] || { echo "model: there is no $programs/mission_traces; ./dev build makes it" >&2 && exit 2; }
  cp "$here"/*.pml "$work"
  (cd "$work" && spin -a replay.pml && cc -O1 -w -DSAFETY -DNOREDUCE -DVECTORSZ=16000 -o pan pan.c)
  for ((first = 1; first <= missions; first += step)); do
    "$programs/mission_traces" "$scenario" "$faults" "$first" "$((first + step - 1))" |
      "$work/pan" -m3000000 >>"$work/replayed" || failed=1
  done
  grep '^rejected' "$work/replayed" || true
  awk '/traces of/ { a += $1; rows += $4; r += $7 }
       END { printf "model: %d traces of %d rows accepted, %d rejected\n", a, rows, r; exit !(a + r) }' "$work/replayed" ||
    { echo "model: nothing was replayed" >&2 && return 1; }

  # Each of these must be rejected, or nothing is shown: of the first mission that has all of it.
  local what
  for ((first = 1; first <= missions; ++first)); do
    "$programs/mission_traces" "$scenario" "$faults" "$first" "$first" >"$work/trace"
    awk '{ seen[$1] = 1 } END { exit !(seen[3] && seen[23] && seen[24] && seen[31] && seen[50]) }' "$work/trace" && break
  done
  ((first <= missions)) || { echo "model: in none of these missions anything was awarded, granted and confirmed; fly more" >&2 && return 1; }
  for what in 'no award' 'no grant' 'no confirmation' 'a lease that is longer' 'two owners'; do
    "$here/alter.sh" "$what" <"$work/trace" >"$work/altered"
    if cmp -s "$work/trace" "$work/altered"; then
      echo "model: the trace of mission $first has nothing to alter for: $what" && failed=1
    elif "$work/pan" -m3000000 <"$work/altered" >"$work/out"; then
      echo "model: a trace with $what is accepted" && failed=1
    else
      echo "model: with $what: $(grep -m1 '^rejected' "$work/out")"
    fi
  done
  return "$failed"
}

case ${1:-} in
  verify) shift && verify "$@" ;;
  mutants) find_mutants ;;
  traces) shift && replay_traces "$@" ;;
  -h | --help) usage ;;
  *) usage >&2 && exit 2 ;;
esac
