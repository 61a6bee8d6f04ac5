# SPDX-License-Identifier: Apache-2.0
# Read by cpack: the Debian version is the release's where its tag is the commit, and before it
# (0.2.0~git20261123123456.g3797e83) for every other commit, growing with the commit's time.
function(skein_git result)
  execute_process(COMMAND git -C ${CPACK_SKEIN_SOURCE_DIR} ${ARGN}
    OUTPUT_VARIABLE text OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

skein_git(tag describe --tags --exact-match --match v${CPACK_PACKAGE_VERSION})
skein_git(commit rev-parse --short=12 HEAD)
set(ENV{TZ} UTC)
skein_git(time log -1 --format=%cd --date=format-local:%Y%m%d%H%M%S)
if(commit AND NOT tag)
  string(APPEND CPACK_PACKAGE_VERSION "~git${time}.g${commit}")
endif()
string(REPLACE "@version@" "${CPACK_PACKAGE_VERSION}" CPACK_DEBIAN_BENCH_PACKAGE_DEPENDS
  "${CPACK_DEBIAN_BENCH_PACKAGE_DEPENDS}")
