#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
#
# run.sh SOURCE_FOLDER WORK_FOLDER PROGRAMS_FOLDER SCENARIOS_FOLDER [TEST...]
# Debian's chromium looks at missions on the bench; nothing downloads a browser.
set -eu
source=$1 work=$2
SKEIN_PROGRAMS=$3 SKEIN_SCENARIOS=$4 SKEIN_WORK=$work/runs
export SKEIN_PROGRAMS SKEIN_SCENARIOS SKEIN_WORK
shift 4

command -v "${SKEIN_CHROMIUM:-chromium}" >/dev/null || {
  echo "there is no chromium; './dev test' installs it"
  exit 1
}
rm -rf "$SKEIN_WORK"
mkdir -p "$work" "$SKEIN_WORK"
cp "$source"/*.mjs "$source/package.json" "$work"
if ! cmp -s "$source/package-lock.json" "$work/package-lock.json" || ! [ -d "$work/node_modules" ]; then
  cp "$source/package-lock.json" "$work"
  (cd "$work" && npm install --no-save --ignore-scripts --no-audit --no-fund --loglevel=error)
fi
cd "$work"
[ $# -gt 0 ] || set -- *.test.mjs
exec node --test --test-concurrency=1 "$@"
