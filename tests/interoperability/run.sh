#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
#
# run.sh SOURCE_FOLDER WORK_FOLDER CHECK.mjs ARGUMENT...: 77 where the other implementations cannot be
# had. Only one at a time may run in a work folder.
set -eu
source=$1 work=$2 check=$3
shift 3

if ! command -v node >/dev/null || ! command -v npm >/dev/null; then
  echo "skipped: it needs node and npm (Debian: nodejs npm; './dev test all' installs them)"
  exit 77
fi
mkdir -p "$work"
cp "$source/$check" "$source/package.json" "$work"
if ! cmp -s "$source/package-lock.json" "$work/package-lock.json" || ! [ -d "$work/node_modules" ]; then
  cp "$source/package-lock.json" "$work"
  if ! (cd "$work" && npm ci --ignore-scripts --no-audit --no-fund --loglevel=error); then
    rm -rf "$work/node_modules" "$work/package-lock.json"
    echo "skipped: npm could not fetch the other implementations"
    exit 77
  fi
fi
exec node "$work/$check" "$@"
