#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# control_timing.sh check|bench BIN WATCH WORK SECONDS
#   Flies patrol.yaml for SECONDS with the programs of BIN and the library WATCH (thread_watch.cpp) in
#   them, and refuses a control thread that allocates, locks, calls DDS or does input or output. With
#   `bench` for half of the time alone and for half beside a busy loop a core, cyclictest beside it all
#   the time, with the same period and policy; the table compares how late the two wake.
set -euo pipefail

readonly mode=$1 bin=$2 work=$4 seconds=$5
watch=$(realpath "$3")  # programs look for it from anywhere
readonly watch
scenario=$(dirname "$(realpath "${BASH_SOURCE[0]}")")/patrol.yaml
readonly scenario
readonly start_s=5  # until the mission has begun

policy=(--policy=fifo --priority=50)  # as onboard/include/skein/onboard/threads.hpp
chrt --fifo 50 true 2>/dev/null || policy=(--policy=other)
rm -rf "$work"
mkdir -p "$work"
beside=()
trap '((${#beside[@]} == 0)) || kill "${beside[@]}" 2>/dev/null || true' EXIT

# fly PHASE SECONDS
fly() {
  mkdir "$work/$1"
  if [[ $mode == bench ]]; then
    cyclictest --quiet --default-system --interval=20000 "${policy[@]}" --histogram=100000 \
      --duration="$2" >"$work/$1/cyclictest" &
    beside+=($!)
  fi
  # Its verdict is not asked for: the mission is cut off.
  LD_PRELOAD=$watch SKEIN_THREAD_WATCH=$work/$1 timeout --signal=INT "$(($2 + start_s))" \
    "$bin/skein-hil" run "$scenario" --headless --out "$work/$1/run" >"$work/$1/said" 2>&1 || true
  ((${#beside[@]} == 0)) || kill "${beside[@]}" 2>/dev/null || true
  wait
  beside=()
  cat "$work/$1"/*.txt >"$work/$1/threads" || {
    cat "$work/$1/said"
    echo "no thread was watched"
    exit 1
  }
}

value() { sed -n "s/.*\b$1=\([^ ]*\).*/\1/p" <<<"$2"; }

if [[ $mode == bench ]]; then
  fly alone $((seconds / 2))
  for ((core = 0; core < $(nproc); ++core)); do
    while :; do :; done &
    beside+=($!)
  done
  fly loaded $((seconds / 2))
else
  fly alone "$seconds"
fi

failed=
for phase in "$work"/{alone,loaded}; do
  [[ -d $phase ]] || continue
  phase=$(basename "$phase")
  echo "== $phase"
  cat "$work/$phase/threads"
  grep -ho 'ended: .* control periods, .* without a state' "$work/$phase"/run/vehicle-*.log
  grep -ho 'bus .*' "$work/$phase"/run/vehicle-*.log
  while read -r line; do
    case $(value thread "$line") in
      control)
        for what in allocations locks dds io; do
          (($(value $what "$line") == 0)) || failed="the control thread: $what"
        done
        # It waits for nothing but its period.
        (($(value waits "$line") <= $(value sleeps "$line") * 101 / 100 + 2)) ||
          failed="the control thread waits for more than its period"
        (($(value sleeps "$line") >= 5 * seconds)) || failed="too few periods to tell"
        ;;
      can)  # that others are seen to do all of it shows that the counters count
        (($(value io "$line") > 0)) || failed="the watch does not see io"
        ;;
      agent)
        for what in allocations locks; do
          (($(value $what "$line") > 0)) || failed="the watch does not see $what"
        done
        (($(value dds "$line") == 0)) || failed="the agent calls DDS, which has a process of its own"
        ;;
    esac
  done <"$work/$phase/threads"
  [[ $mode != bench ]] || awk '
    FILENAME ~ /cyclictest$/ && /^[0-9]+ [0-9]+/ { bin[$1 + 0] = $2; total += $2; if ($2 > 0) max = $1 + 0 }
    function of(part,    us, seen) {
      for (us = 0; us <= max; ++us) if ((seen += bin[us]) >= part * total) return us
    }
    FILENAME ~ /threads$/ && /thread=control/ {
      for (i = 1; i <= NF; ++i) { split($i, pair, "="); v[pair[1]] = pair[2] }
      printf "%-22s %8s %8s %8s %8s us\n", "", "p50", "p99", "p99.9", "max"
      printf "%-22s %8d %8d %8d %8d\n", "control", v["p50_us"], v["p99_us"], v["p999_us"], v["max_us"]
      printf "%-22s %8d %8d %8d %8d\n", "cyclictest", of(0.5), of(0.99), of(0.999), max
      printf "%-22s %8.2f %8.2f %8.2f %8.2f\n", "control / cyclictest", v["p50_us"] / of(0.5),
        v["p99_us"] / of(0.99), v["p999_us"] / of(0.999), v["max_us"] / max
    }' "$work/$phase/cyclictest" "$work/$phase/threads"
done
[[ -z $failed ]] || {
  echo "FAIL: $failed"
  exit 1
}
echo "PASS: the control threads allocate, lock, call DDS, read and write nothing"
