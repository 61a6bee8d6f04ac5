#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
#
# run.sh WORK_FOLDER PROGRAMS_FOLDER SCENARIOS_FOLDER TEST
# Debian's chromium looks at missions on the bench; nothing downloads a browser. modules.sh was there.
set -eu
work=$1 test=$4
SKEIN_PROGRAMS=$2 SKEIN_SCENARIOS=$3 SKEIN_WORK=$work/runs/${test%.test.mjs}
export SKEIN_PROGRAMS SKEIN_SCENARIOS SKEIN_WORK

rm -rf "$SKEIN_WORK"
mkdir -p "$SKEIN_WORK"
cd "$work"
exec node --test "$test"
