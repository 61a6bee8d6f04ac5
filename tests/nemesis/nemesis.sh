#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# Real processes under a nemesis: nemesis.sh PROGRAMS SCENARIO FOLDER RUNS SEED JOBS [ARGUMENT...]
# Flies the scenario RUNS times as processes over Fast DDS, JOBS at a time, with the seeds SEED, SEED + 1, ...
# (or, where SEED is a list with commas, these), and prints a row for each: what was done, what became of it.
# The rows are kept as FOLDER/runs.csv, and the folders of runs that broke a promise as FOLDER/SEED. The first
# failure stops nothing; ends with 1 if any run broke one. The arguments go to 'skein-hil run';
# by default: --faults nemesis.
set -euo pipefail

readonly programs=$1 scenario=$2 folder=$3 runs=$4 first=$5 jobs=$6
shift 6
arguments=("$@")
[[ " ${arguments[*]-} " == *" --faults "* ]] || arguments+=(--faults nemesis)
mkdir -p "$folder"
rows=$folder/runs.csv
echo 'seed,outcome,tasks_done,seconds,late_s,killed,started_anew,stood_still,slow,disks_full,clocks_set,cuts,other_release,broken' >"$rows"

count() { grep -cE "$1" "$2" || true; }

# fly SEED SLOT: each slot has ports, and thereby buses, of its own; so have most others that run this.
# All are below those that the kernel gives away by itself, from 32768 on.
fly() {
  local seed=$1 log=$folder/$1.log at=$SECONDS status=0 broken outcome tasks
  rm -rf "${folder:?}/$seed"
  "$programs/skein-hil" run "$scenario" --headless --dds "${arguments[@]}" --seed "$seed" \
    --port-base $((20000 + 24 * ($2 + jobs * ($$ % (530 / jobs))))) --out "$folder/$seed" >"$log" 2>&1 &
  run=$!
  wait "$run" || status=$?
  if grep -q '^interrupted;' "$log"; then exit 1; fi
  broken=$(sed -nE 's/^FAIL (.{20}).*/\1/; T; s/ +$//; p' "$log" | paste -sd ';')
  case $status in
    0) outcome=held ;;
    1) outcome=broken ;;
    *) outcome="not flown" ;;
  esac
  # What nobody could do any more is not missed, so a run that held may have done little.
  tasks=$(sed -nE 's/^(ok|FAIL) +completion +([0-9]+) tasks +([0-9]+) done.*/\3 of \2/p' "$log")
  echo "$seed,$outcome,$tasks,$((SECONDS - at)),$(sed -n 's/^the bench was late by \([0-9.]*\) s.*/\1/p' "$log"),$(
    count '^fault: .* is killed$' "$log"),$(count 'starts anew$' "$log"),$(
    count '^fault: .*stands still for .* s$' "$log"),$(count '^fault: .*% of the time' "$log"),$(
    count '^fault: .*disk of' "$log"),$(count '^fault: .*clock of .* set by' "$log"),$(
    count '^fault: .* (apart|not heard)' "$log"),$(count '^drawn: .*another release' "$log"),$broken" >>"$rows"
  tail -n 1 "$rows" | sed 's/,/ | /g'
  if ((status == 0)); then rm -rf "${folder:?}/$seed" "$log"; fi
}

seeds=()
if [[ $first == *,* ]]; then
  IFS=, read -r -a seeds <<<"$first"
else
  for ((i = 0; i < runs; ++i)); do seeds+=($((first + i))); done
fi
head -n 1 "$rows" | sed 's/,/ | /g'
slots=()
trap 'kill "${slots[@]}" 2>/dev/null || true; wait; exit 130' INT TERM
for ((slot = 0; slot < jobs; ++slot)); do
  {
    run=
    trap '[[ -z $run ]] || { kill "$run" 2>/dev/null; wait "$run"; }; exit 1' TERM
    sleep $((slot * 3)) # so that not all look for quiet buses at once
    for ((i = slot; i < ${#seeds[@]}; i += jobs)); do fly "${seeds[i]}" "$slot"; done
  } &
  slots+=($!)
done
wait
held=$(count '^[0-9]+,held,' "$rows") all=${#seeds[@]}
read -r done_tasks all_tasks < <(awk -F'[, ]' '$3 ~ /^[0-9]/ {done += $3; all += $5} END {print done + 0, all + 0}' "$rows")
echo "$held of $all runs held every promise, $done_tasks of $all_tasks tasks were done; rows: $rows"
if ((held != all)); then
  awk -F, -v folder="$folder" '/^[0-9]/ && $2 == "broken" {print "seed " $1 ": " $2 " " $NF "; " folder "/" $1 ".log ends with the command that repeats it"}' "$rows"
  unflown=$(awk -F, '/^[0-9]/ && $2 == "not flown" {print $1; exit}' "$rows")
  [[ -z $unflown ]] || echo "seed $unflown and others: not flown; $folder/$unflown.log: $(tail -n 1 "$folder/$unflown.log")"
  exit 1
fi
if ((all >= 3 && 2 * done_tasks < all_tasks)); then
  echo "so little was done that nothing is shown" >&2
  exit 1
fi
