#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# The list of parts names what a program loads, what it was built with and what its page has.
#   parts_test.sh SOURCE PROGRAM
set -euo pipefail
command -v node dpkg-query >/dev/null || exit 77
list=$(mktemp)
trap 'rm -f "$list"' EXIT
SOURCE_DATE_EPOCH=1770000000 node "$1/packaging/parts.mjs" 1.2.3 "$1/groundstation/web/package-lock.json" "$list" -- "$2" -- libeigen3-dev
for wanted in '"spdxVersion": "SPDX-2.3"' '"created": "2026-02-02T02:40:00Z"' '"SPDXRef-library-libfastrtps' '"SPDXRef-library-libssl3' \
  '"SPDXRef-build-libeigen3-dev' '"SPDXRef-npm-preact"' 'pkg:deb/debian/libc6@'; do
  grep -qF -- "$wanted" "$list" || { echo "parts: no $wanted in"; cat "$list"; exit 1; }
done
