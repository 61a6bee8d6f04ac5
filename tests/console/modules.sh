#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
#
# modules.sh SOURCE_FOLDER WORK_FOLDER: the scripts and the packages that they use, in WORK_FOLDER.
set -eu
source=$1 work=$2

command -v "${SKEIN_CHROMIUM:-chromium}" >/dev/null || {
  echo "there is no chromium; './dev test' installs it"
  exit 1
}
mkdir -p "$work"
cp "$source"/*.mjs "$source/package.json" "$work"
if ! cmp -s "$source/package-lock.json" "$work/package-lock.json" || ! [ -d "$work/node_modules" ]; then
  cp "$source/package-lock.json" "$work"
  (cd "$work" && npm install --no-save --ignore-scripts --no-audit --no-fund --loglevel=error)
fi
