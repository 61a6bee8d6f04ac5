#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# units_test.sh FOLDER: systemd finds nothing wrong with the units in FOLDER, and they leave little
# open: an exposure of 2.0 at most (0 is best, 10 worst).
set -eu
if ! command -v systemd-analyze >/dev/null; then
  echo "skipped: there is no systemd-analyze (Debian: systemd)"
  exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for unit in 'skein-onboard@.service' skein-ground.service skein-ros2.service; do
  # The programs need not be installed where this runs.
  sed -E 's|^ExecStart=[^ ]+|ExecStart=/bin/true|' "$1/$unit" >"$folder/$unit"
done
cp "$folder/skein-onboard@.service" "$folder/skein-onboard@7.service"
failed=0
for unit in skein-onboard@7.service skein-ground.service skein-ros2.service; do
  # Of ours only: the machine's own units may be wrong.
  if systemd-analyze verify --man=no "$folder/$unit" 2>&1 | grep -F skein; then failed=1; fi
  systemd-analyze security --no-pager --offline=true --threshold=20 "$folder/$unit" >"$folder/exposure" || {
    cat "$folder/exposure"
    failed=1
  }
  tail -1 "$folder/exposure"
done
exit $failed
