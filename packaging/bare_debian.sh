#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# bare_debian.sh PACKAGES WORK: installs the packages of the folder PACKAGES on a bare Debian 12 that
# mmdebstrap makes in WORK (once), and flies the team of the examples there: all must be heard at the
# ground station within two minutes of the beginning of the installation, an upgrade in flight must
# be refused, one on the ground must keep the configuration, and a removal the recordings. Then the
# same installation is booted, and its units are tried (units_trial.sh), where systemd starts.
# Needs root and a mirror of Debian; else it ends with 77. Its network is its own.
set -euo pipefail

readonly packages=$1 work=$2 skipped=77
readonly bare=$work/bare
here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
readonly here

say() { printf 'bare Debian: %s\n' "$*"; }
fail() {
  say "$*"
  exit 1
}

if ((EUID != 0)) || ! command -v mmdebstrap >/dev/null; then
  say "skipped: it needs root and mmdebstrap"
  exit $skipped
fi
mkdir -p "$work"
if [[ ! -d $bare ]]; then
  rm -rf "$bare.new"
  if ! mmdebstrap --variant=minbase --include=systemd,iproute2 bookworm "$bare.new" >"$work/mmdebstrap.log" 2>&1; then
    say "skipped: no Debian can be had here, see $work/mmdebstrap.log"
    exit $skipped
  fi
  mv "$bare.new" "$bare"
fi
rm -rf "$work/root" "$work/booted"
cp -a "$bare" "$work/root"
shopt -s nullglob
for package in onboard ground; do
  found=("$packages"/skein-"$package"_*_"$(dpkg --print-architecture)".deb)
  ((${#found[@]} == 1)) || fail "there are ${#found[@]} packages of skein-$package in $packages"
  cp "${found[0]}" "$work/root/opt/$package.deb"
done

cat >"$work/root/opt/trial" <<'END'
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive PATH=/usr/sbin:/usr/bin:/sbin:/bin
shopt -s nullglob
cd /opt
case $1 in
  install)
    apt-get -qq update
    apt-get -qq install --yes --no-install-recommends ./onboard.deb ./ground.deb >install.log 2>&1 ||
      { tail -20 install.log; exit 1; }
    cp /usr/share/skein/examples/*.yaml /etc/skein/
    ;;
  fly) # as the units would, without systemd
    ip link set lo up
    install -d -o skein -g skein /run/skein /var/lib/skein
    as_skein=(setpriv --reuid=skein --regid=skein --clear-groups --)
    "${as_skein[@]}" skein-ground --config /etc/skein/ground.yaml </dev/null >ground.log 2>&1 &
    pids=($!)
    for n in 1 2 3; do
      "${as_skein[@]}" skein-onboard --config /etc/skein/onboard-$n.yaml --status-socket /run/skein/onboard-$n.sock </dev/null >onboard-$n.log 2>&1 &
      pids+=($!)
    done
    ask() { { exec 3<>/dev/tcp/127.0.0.1/7460 && printf 'GET %s HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n' "$1" >&3 && cat <&3; } 2>/dev/null; }
    heard=
    for ((i = 0; i < 600; ++i)); do
      if ask /health | grep -q '"heard":3'; then heard=yes; break; fi
      sleep 0.1
    done
    [[ $heard ]] || { tail -5 ./*.log; echo "not all are heard"; exit 1; }
    date +%s >heard
    ask / | grep -aq '^HTTP/1.1 200' || { echo "there is no page"; exit 1; }
    skein-onboard status --socket /run/skein/onboard-1.sock
    ! dpkg -i onboard.deb >upgrade.log 2>&1 || { echo "an upgrade in flight is not refused"; exit 1; }
    grep -q 'flies: land it first' upgrade.log || { cat upgrade.log; exit 1; }
    skein-onboard --version  # still there and whole
    kill "${pids[@]}"
    wait "${pids[@]}"
    before=$(sha256sum /etc/skein/*)
    dpkg -i onboard.deb ground.deb >>upgrade.log 2>&1 || { cat upgrade.log; exit 1; }
    [[ $(sha256sum /etc/skein/*) == "$before" ]] || { echo "an upgrade changed the configuration"; exit 1; }
    dpkg --purge skein-onboard skein-ground >>upgrade.log 2>&1 || { cat upgrade.log; exit 1; }
    [[ -s /etc/skein/ground.yaml && -n $(echo /var/lib/skein/onboard-1/*) ]] || { echo "a removal took what is the crew's"; exit 1; }
    [[ ! -e /usr/bin/skein-onboard && ! -e /usr/share/skein ]] || { echo "a removal left something"; exit 1; }
    ;;
esac
END

began=$(date +%s)
unshare --mount --pid --fork --mount-proc="$work/root/proc" chroot "$work/root" bash /opt/trial install
say "installed in $(($(date +%s) - began)) s"
cp -a "$work/root" "$work/booted"
unshare --mount --pid --net --fork --mount-proc="$work/root/proc" chroot "$work/root" bash /opt/trial fly
took=$(($(<"$work/root/opt/heard") - began))
say "a team on the console $took s after the installation began"
((took <= 120)) || fail "that is more than two minutes"

# The fleet of tests/fleet, whose hosts are this one machine.
{
  sed '/^hosts:/,$d' "$here/../tests/fleet/fleet.yaml"
  echo 'hosts:'
  for n in 0 1 2 3; do echo "  - {vehicle: $n, address: 127.0.0.1}"; done
} >"$work/booted/opt/fleet.yaml"
cp "$here/units_trial.sh" "$work/booted/opt/"
for time in first again; do
  status=0
  "$here/booted_debian.sh" "$work/booted" bash /opt/units_trial.sh /opt $time || status=$?
  ((status != skipped)) || break # it has said so
  ((status == 0)) || fail "the units do not do what they promise"
done
rm -rf "$work/root" "$work/booted"
