#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# units_trial.sh FOLDER [again]: what is run in a Debian that was booted (booted_debian.sh) and has
# skein-onboard and skein-ground: the team of the examples is started as the pages say and flies a
# mission within two minutes, and the units keep what they promise of watchdog, restarts, rights,
# journal and upgrades. FOLDER has the packages, and fleet.yaml. `again`, after another start of the
# same Debian: the units that were enabled run.
set -euo pipefail

readonly folder=$1 vehicles=(1 2 3) first_mission_within_s=120
units=(skein-ground)
for n in "${vehicles[@]}"; do units+=("skein-onboard@$n"); done

say() { printf -- '- %s\n' "$*"; }
fail() {
  printf 'FAILED: %s\n' "$*"
  journalctl --no-pager --quiet --lines=30 --output=short-precise
  exit 1
}
# until_holds SECONDS WHAT COMMAND...
until_holds() {
  local end=$((SECONDS + $1)) what=$2
  shift 2
  until "$@"; do
    ((SECONDS < end)) || fail "not within the time: $what"
    sleep 0.1
  done
}
ask() {
  {
    exec 3<>/dev/tcp/127.0.0.1/7460 &&
      printf 'GET %s HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n' "$1" >&3 && cat <&3
  } 2>/dev/null
}
property() { systemctl show --property "$2" --value "$1"; }
logged() { journalctl --no-pager --quiet "$@" | grep -q .; }
all_heard() { ask /health | grep -q '"heard":3'; }
heard() { ask /metrics | tr -d '\r' | grep -qx "skein_vehicle_up{vehicle=\"$1\"} 1"; }
# restarted UNIT TIMES
restarted() { [[ $(property "$1" NRestarts) == "$2" && $(property "$1" ActiveState) == active ]]; }
authorised() { skein-ground tell authorise "$1" >/dev/null 2>&1; }

first_mission() {
  local began told site
  began=$(date +%s%N)
  since() { awk "BEGIN { printf \"%.1f s\", ($(date +%s%N) - $began) / 1e9 }"; }
  cp /usr/share/skein/examples/*.yaml /etc/skein/
  systemctl start "${units[@]}"
  systemctl is-active --quiet "${units[@]}" || fail "a unit was started and is not active"
  say "$(since) after the packages: the units are active"
  until_holds 30 "all vehicles are heard" all_heard
  say "$(since): all vehicles are heard"
  told=$(skein-ground tell site 0 0 survey 5 deliver 090) || fail "$told"
  site=$(grep -oE 'site [0-9]+' <<<"$told" | head -n 1 | cut -d ' ' -f 2)
  until_holds 90 "the site is being surveyed" logged SKEIN_EVENT=survey_started "SKEIN_SITE=$site"
  say "$(since): the mission runs, site $site is being surveyed"
  (($(date +%s%N) - began < first_mission_within_s * 1000000000)) || fail "that is more than two minutes"
  until_holds 90 "an authorisation is asked for" authorised "$site"
  until_holds 120 "the delivery is flown" logged SKEIN_EVENT=task_done "SKEIN_SITE=$site"
  say "$(since): authorised and delivered"
}

rights() {
  local n unit pid threads realtime=
  ! prlimit --rtprio=60:60 true 2>/dev/null || realtime=yes
  for n in "${vehicles[@]}"; do
    pid=$(property "skein-onboard@$n" MainPID)
    threads=$(for thread in "/proc/$pid/task/"*; do chrt --pid "${thread##*/}"; done)
    [[ ! $realtime ]] || grep -q SCHED_FIFO <<<"$threads" || fail "vehicle $n has no thread with real-time priority: $threads"
    [[ -n $(find "/var/lib/skein/onboard-$n" -user skein -name '*.mcap' -size +0) ]] || fail "vehicle $n records nothing"
    skein-onboard status --socket "/run/skein/onboard-$n.sock" >/dev/null || fail "no status of vehicle $n"
  done
  [[ -n $(find /var/lib/skein/ground -user skein -name '*.mcap' -size +0) ]] || fail "the ground station records nothing"
  for unit in "${units[@]}"; do
    pid=$(property "$unit" MainPID)
    grep -qE '^CapEff:\s0+$' "/proc/$pid/status" || fail "$unit has capabilities"
    grep -qE '^Seccomp:\s2$' "/proc/$pid/status" || fail "$unit has no filter of system calls"
    systemd-analyze security --no-pager --threshold=20 "$unit.service" >/tmp/exposure || fail "$(tail -n 1 /tmp/exposure)"
  done
  ! journalctl --no-pager --quiet --unit 'skein-*' --grep 'not permitted|ermission denied|Read-only' |
    { [[ $realtime ]] && cat || grep -v 'without real-time priority'; } | grep . || fail "that was refused to a unit"
  # The crew is the group. Who is not of it learns nothing, and is told why.
  local crew=(setpriv --reuid=nobody --regid=nogroup --groups=skein --)
  local stranger=(setpriv --reuid=nobody --regid=nogroup --clear-groups --)
  "${crew[@]}" skein-ground tell sites >/tmp/said 2>&1 || fail "the crew gives no orders: $(</tmp/said)"
  "${crew[@]}" skein-onboard status --socket /run/skein/onboard-1.sock >/tmp/said 2>&1 || fail "the crew: $(</tmp/said)"
  ! "${stranger[@]}" skein-ground tell sites >/tmp/said 2>&1 || fail "anybody gives orders"
  grep -q 'takes no order from you' /tmp/said || fail "who gives orders is told: $(</tmp/said)"
  ! "${stranger[@]}" skein-onboard status --socket /run/skein/onboard-1.sock >/tmp/said 2>&1 || fail "anybody asks for the status"
  grep -q 'you may not ask' /tmp/said || fail "who asks for the status is told: $(</tmp/said)"
  [[ $realtime ]] || say "SKIPPED: nobody is given real-time priority here (that takes CAP_SYS_RESOURCE); the rest of the rights follows"
  say "${realtime:+real-time priority, }recordings, status and no capability under all restrictions"
}

journal() {
  local line
  line=$(journalctl --no-pager --quiet --lines=1 --output=json SKEIN_EVENT=survey_started)
  for field in '"MESSAGE_ID":"[0-9a-f]{32}"' '"SKEIN_VEHICLE":"1"' '"SKEIN_EVENT_TIME":"[0-9.]+"' \
    '"SKEIN_UNIT":"' '"SYSLOG_IDENTIFIER":"skein-' '"_SYSTEMD_UNIT":"skein-'; do
    grep -qE "$field" <<<"$line" || fail "the journal has no $field: $line"
  done
  journalctl --no-pager --quiet --catalog SKEIN_EVENT=survey_started | grep -q 'Subject: Skein: survey_started' ||
    fail "the catalog does not explain an event"
  say "events are in the journal with message id, fields and explanation"
}

watchdog() {
  local unit=skein-onboard@2 fed pid
  fed=$(property $unit WatchdogTimestampMonotonic)
  moved() { (($(property "$unit" WatchdogTimestampMonotonic) > fed)); }
  until_holds 10 "the watchdog is fed" moved
  pid=$(property $unit MainPID)
  kill -STOP "$pid"
  ! timeout 20 skein-onboard status --socket /run/skein/onboard-2.sock --flying >/dev/null 2>&1 || fail "a stopped process answers"
  until_holds 30 "the watchdog ends a process that stands still" logged --unit "$unit" --grep 'Watchdog timeout'
  until_holds 10 "it is started again" restarted "$unit" 1
  until_holds 20 "vehicle 2 is heard again" heard 2
  kill -KILL "$(property $unit MainPID)"
  until_holds 10 "a process that was killed is started again" restarted "$unit" 2
  until_holds 20 "vehicle 2 is heard once more" heard 2
  pid=$(property skein-ground MainPID)
  kill -STOP "$pid"
  until_holds 40 "the watchdog ends a ground station that stands still" restarted skein-ground 1
  until_holds 20 "it hears all again" all_heard
  say "the watchdog is fed; what stands still or is killed is started again and heard"
}

no_restart() {
  echo 'version: 1' >/etc/skein/onboard-9.yaml
  ! systemctl start skein-onboard@9 2>/tmp/said || fail "a bad configuration is started"
  [[ $(property skein-onboard@9 Result) == exit-code && $(property skein-onboard@9 ExecMainStatus) == 2 &&
    $(property skein-onboard@9 NRestarts) == 0 && $(property skein-onboard@9 ActiveState) == failed ]] ||
    fail "a bad configuration: $(systemctl show skein-onboard@9 -p Result,ExecMainStatus,NRestarts,ActiveState | tr '\n' ' ')"
  logged --unit skein-onboard@9 --grep onboard-9.yaml || fail "the journal does not say why"
  rm /etc/skein/onboard-9.yaml
  ! systemctl start skein-onboard@9 2>/tmp/said || fail "without a configuration it is started"
  say "exit status 2 is not started again"
}

upgrades() {
  ! dpkg --install "$folder/onboard.deb" >/tmp/said 2>&1 || fail "an upgrade in flight is not refused"
  grep -q 'flies: land it first' /tmp/said || fail "$(</tmp/said)"
  systemctl is-active --quiet "${units[@]}" || fail "a refused upgrade has stopped a unit"
  dpkg --install "$folder/ground.deb" >/tmp/said 2>&1 || fail "$(</tmp/said)"
  grep -q 'goes on with the version before' /tmp/said || fail "an upgrade does not say that the old one runs"
  restarted skein-ground 1 || fail "an upgrade of skein-ground has restarted it"
  systemctl enable --quiet "${units[@]}"
  systemctl stop "${units[@]}"
  for unit in "${units[@]}"; do
    [[ $(property "$unit" Result) == success ]] || fail "$unit ends with $(property "$unit" Result)"
  done
  [[ -z $(find /run/skein -name 'onboard-*.sock') ]] || fail "a process left its socket"
  dpkg --install "$folder/onboard.deb" >/tmp/said 2>&1 || fail "$(</tmp/said)"
  say "an upgrade is refused in flight, restarts nothing, and is taken on the ground"
}

# Its file is that of the examples' team, for one machine and its units. A fleet has keys.
fleet() {
  skein-ground mission create trial --days 1 >/tmp/said 2>&1 || fail "$(</tmp/said)"
  for n in "${vehicles[@]}"; do
    { skein-onboard enrol --id "$n" | skein-ground mission enrol - --yes | skein-onboard enrol --membership -; } >/tmp/said 2>&1 ||
      fail "$(</tmp/said)"
  done
  skein fleet push "$folder/fleet.yaml" --epoch now --out /tmp/fleet >/tmp/said 2>&1 || fail "$(</tmp/said)"
  skein fleet start "$folder/fleet.yaml" --out /tmp/fleet >/tmp/said 2>&1 || fail "$(</tmp/said)"
  until_holds 30 "the fleet is heard" all_heard
  skein fleet status "$folder/fleet.yaml" --out /tmp/fleet >/tmp/said 2>&1 || fail "$(</tmp/said)"
  ! skein fleet stop "$folder/fleet.yaml" --out /tmp/fleet >/tmp/said 2>&1 || fail "a fleet that flies is stopped"
  skein fleet stop "$folder/fleet.yaml" --out /tmp/fleet --force >/tmp/said 2>&1 || fail "$(</tmp/said)"
  logged --unit skein-ground --grep 'sealed, epoch 1' || fail "the fleet speaks in clear"
  say "skein fleet pushes, starts, sees and stops the units, which are enrolled"
}

if [[ ${2:-} == again ]]; then
  until_holds 30 "the units that were enabled are active after a start" systemctl is-active --quiet "${units[@]}"
  until_holds 30 "all vehicles are heard after a start" all_heard
  say "what is enabled runs after a start"
  exit
fi
first_mission
rights
journal
watchdog
no_restart
upgrades
fleet
