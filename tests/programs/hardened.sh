#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# hardened.sh PROGRAM...: each has what cmake/SkeinOptions.cmake says of faults of memory.
set -euo pipefail

failed=0
# expect PROGRAM WHAT TEXT PATTERN
expect() {
  grep -q -- "$4" <<<"$3" && return
  echo "$1: no $2"
  failed=1
}

for program in "$@"; do
  header=$(readelf --wide --file-header --program-headers --dynamic --notes "$program")
  symbols=$(readelf --wide --dyn-syms "$program")
  expect "$program" "position that is free to choose (PIE)" "$header" 'Type: *DYN'
  expect "$program" "table of addresses that is read-only (RELRO)" "$header" GNU_RELRO
  expect "$program" "binding at the start (BIND_NOW)" "$header" 'Flags:.*NOW'
  expect "$program" "stack protector" "$symbols" __stack_chk_fail
  expect "$program" "checked copies (FORTIFY)" "$symbols" '__[a-z]*_chk@'
  if grep -q 'Machine:.*X86-64' <<<"$header"; then
    # Debian's own start files have no mark, so the whole has none: the functions' beginnings are counted.
    (($(LC_ALL=C grep -aoP '\xf3\x0f\x1e\xfa' "$program" | wc -l) > 100)) || {
      echo "$program: no checked jumps (CET)"
      failed=1
    }
  fi
  if grep -q 'RWE' <<<"$header"; then
    echo "$program: memory that is written and executed"
    failed=1
  fi
done
exit $failed
