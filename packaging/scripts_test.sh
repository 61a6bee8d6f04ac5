#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# scripts_test.sh FOLDER: the maintainer scripts are read by sh, and an upgrade is refused in flight
# and where the vehicle's process says nothing, and only then.
set -eu
for script in "$1"/*/*; do sh -n "$script"; done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
# A socket of nobody, and a program that answers as it is told to.
python3 -c 'import socket, sys; socket.socket(socket.AF_UNIX).bind(sys.argv[1])' "$folder/onboard-7.sock" || exit 77
mkdir "$folder/bin"
cat >"$folder/bin/skein-onboard" <<'END'
#!/bin/sh
exit "$ANSWER"
END
chmod +x "$folder/bin/skein-onboard"
sed -e "s|/run/skein|$folder|g" -e "s|/usr/bin/skein-onboard|$folder/bin/skein-onboard|g" \
  "$1/onboard/preinst" >"$folder/preinst"
failed=0
# expect STATUS ANSWER [OVERRIDE]
expect() {
  status=0
  ANSWER=$2 SKEIN_IN_FLIGHT=${3:-} sh "$folder/preinst" upgrade 0.1.0 2>"$folder/said" || status=$?
  [ "$status" = "$1" ] || {
    echo "answer $2: status $status, not $1: $(cat "$folder/said")"
    failed=1
  }
}
expect 1 0
expect 0 1
expect 0 3
expect 1 4
expect 0 0 allowed
exit $failed
