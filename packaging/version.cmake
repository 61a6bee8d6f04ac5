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
# dpkg-shlibdeps knows the libraries of this machine only. The same sources need those of the same
# packages, whatever the machine, so the dependencies are taken from this machine's packages.
if(CPACK_SKEIN_CROSS)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS OFF)
  foreach(component onboard ground bench)
    file(GLOB package "${CPACK_PACKAGE_DIRECTORY}/skein-${component}_${CPACK_PACKAGE_VERSION}_amd64.deb")
    execute_process(COMMAND dpkg-deb --field "${package}" Depends
      OUTPUT_VARIABLE depends OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
    if(failed)
      message(FATAL_ERROR "skein-${component} for this machine is missing; ./dev package makes it")
    endif()
    string(TOUPPER ${component} upper)
    set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${depends}")
  endforeach()
endif()
string(REPLACE "@version@" "${CPACK_PACKAGE_VERSION}" CPACK_DEBIAN_BENCH_PACKAGE_DEPENDS
  "${CPACK_DEBIAN_BENCH_PACKAGE_DEPENDS}")
