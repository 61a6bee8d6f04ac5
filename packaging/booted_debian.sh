#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# booted_debian.sh ROOT COMMAND...: starts the Debian in the folder ROOT, its systemd as process 1 in
# namespaces of this machine with a network of its own, and runs COMMAND in it as root. The exit
# status is COMMAND's; 77 where systemd does not start here. It needs root and cgroups of version 2.
set -euo pipefail

readonly root=$1 boot_within_s=60 skipped=77
shift

say() { printf 'booted Debian: %s\n' "$*"; }
skip() {
  say "skipped: $*; THE UNITS ARE NOT STARTED"
  exit $skipped
}

((EUID == 0)) || skip "it needs root"
groups=$(findmnt --noheadings --first-only --types cgroup2 --output TARGET) || skip "there are no cgroups of version 2"
group=$groups/skein-packages-$$
mkdir "$group" 2>/dev/null || skip "$groups cannot be written to"

machine=
end() {
  [[ -z $machine ]] || { kill -KILL "$machine" && wait "$machine"; } 2>/dev/null || true
  # What was in it has ended with process 1; the kernel takes a moment to see that.
  local i
  for ((i = 0; i < 50; ++i)); do
    ! find "$group" -depth -type d -exec rmdir {} + 2>/dev/null || break
    sleep 0.1
  done
}
trap end EXIT
trap 'exit 130' INT TERM HUP

# What process 1 finds, which does the rest by itself.
cat >"$root/opt/boot" <<'END_OF_BOOT'
set -eu
root=$1
mount --bind "$root" "$root"
cd "$root"
mount -t proc proc proc
mount -t sysfs -o ro sysfs sys
mount -t cgroup2 cgroup2 sys/fs/cgroup
mount -t tmpfs -o mode=755 tmpfs dev
for node in null zero full random urandom tty; do
  touch "dev/$node"
  mount --bind "/dev/$node" "dev/$node"
done
mkdir dev/pts dev/shm
mount -t devpts -o newinstance,ptmxmode=0666,mode=0620,gid=5 devpts dev/pts
ln -s pts/ptmx dev/ptmx
mount -t tmpfs -o mode=1777 tmpfs dev/shm
mount -t tmpfs -o mode=755 tmpfs run
mkdir run/before
pivot_root . run/before
umount -l run/before
exec env -i container=skein-packages PATH=/usr/sbin:/usr/bin:/sbin:/bin \
  /lib/systemd/systemd --unit=multi-user.target --log-target=journal
END_OF_BOOT
# The first shell goes into the group as process 1 of its namespace, so that nothing else is there.
# shellcheck disable=SC2016
unshare --mount --pid --net --uts --ipc --fork --kill-child --propagation private bash -c \
  'echo 0 >"$1/cgroup.procs" && exec unshare --cgroup --mount --propagation private bash "$2/opt/boot" "$2"' \
  boot "$group" "$root" </dev/null >"$root/opt/boot.log" 2>&1 &
machine=$!

first=
within() {
  nsenter --target "$first" --mount --pid --net --uts --ipc --cgroup --root --wd -- \
    env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 TERM=dumb HOME=/root "$@"
}
state=
for ((waited = 0; waited < 10 * boot_within_s; ++waited)); do
  kill -0 "$machine" 2>/dev/null || break
  if first=$(pgrep --parent "$machine") && [[ $(<"/proc/$first/comm") == systemd ]]; then
    state=$(within systemctl is-system-running 2>/dev/null || true)
    [[ $state != running && $state != degraded ]] || break
  fi
  sleep 0.1
done
[[ $state == running || $state == degraded ]] || skip "systemd does not start (${state:-ended}): $(tail -n 3 "$root/opt/boot.log")"
within "$@"
