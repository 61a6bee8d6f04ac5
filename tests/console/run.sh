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

"$source/modules.sh" "$source" "$work"
rm -rf "$SKEIN_WORK"
mkdir -p "$SKEIN_WORK"
cd "$work"
[ $# -gt 0 ] || set -- *.test.mjs
exec node --test --test-concurrency=1 "$@"
