#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
#
# can_tools.sh SKEIN_HIL RECORD: what is replayed to a bus is what a dump of it hears and records.
set -eu
hil=$1 record=$2
work=$(mktemp -d)
dump=
end() {
  [ -z "$dump" ] || kill "$dump" 2>/dev/null || true
  rm -rf "$work"
}
trap end EXIT

head -n 3000 "$record" >"$work/sent.log"
bus=mcast:$((100 + $$ % 150))
"$hil" can dump "$bus" --log "$work/heard.log" >"$work/dump.txt" 2>"$work/dump.err" &
dump=$!
until grep -q listening "$work/dump.err"; do
  kill -0 "$dump"
  sleep 0.1
done
"$hil" can replay "$work/sent.log" "$bus" --rate 20 >"$work/replay.txt"
last=$(tail -n 1 "$work/sent.log" | cut -d' ' -f3)
for _ in $(seq 300); do
  ! tail -n 1 "$work/heard.log" 2>/dev/null | grep -qF "$last" || break
  sleep 0.1
done
kill -INT "$dump"
wait "$dump"
dump=

cut -d' ' -f3 "$work/sent.log" >"$work/sent"
cut -d' ' -f3 "$work/heard.log" >"$work/heard"
cmp "$work/sent" "$work/heard"
tail -n 3 "$work/replay.txt" >"$work/summary"
tail -n 3 "$work/dump.txt" | cmp - "$work/summary"
cat "$work/summary"
