#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# completion_test.sh COMPLETION ONBOARD SKEIN: what bash offers after some words.
set -euo pipefail
here=$(mktemp -d)
trap 'rm -rf "$here"' EXIT
cd "$here"
touch a-file.yaml
# shellcheck source=/dev/null
source "$1"
failed=0
# offers WORDS PROGRAM WORD...: the last word is the one that is typed
offers() {
  local expected=$1
  shift
  COMP_WORDS=("$@")
  COMP_CWORD=$(($# - 1))
  COMPREPLY=()
  _skein_complete "$1" "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
  [[ "${COMPREPLY[*]}" == "$expected" ]] || {
    echo "after '${*:2}': '${COMPREPLY[*]}', not '$expected'"
    failed=1
  }
}
offers status "$2" st
offers --status-socket "$2" --st
offers a-file.yaml "$2" --config ''
offers --flying "$2" status --fl
offers fleet "$3" ''
offers push "$3" fleet pu
offers a-file.yaml "$3" fleet push ''
offers --epoch "$3" fleet push a-file.yaml --ep
exit $failed
