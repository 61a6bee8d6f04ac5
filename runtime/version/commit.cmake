# SPDX-License-Identifier: Apache-2.0
# cmake -D SOURCE=tree -D OUTPUT=file -P commit.cmake: writes the tree's commit as a C string,
# "gCOMMIT" or "gCOMMIT.dirty"; "" where there is no git, as in an archive of the sources, unless
# the environment has it in SKEIN_COMMIT.
set(commit "$ENV{SKEIN_COMMIT}")
if(NOT commit)
  execute_process(COMMAND git -C ${SOURCE} rev-parse --short=12 HEAD
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(failed)
    set(commit "")
  else()
    set(commit "g${commit}")
    execute_process(COMMAND git -C ${SOURCE} status --porcelain --untracked-files=no
      OUTPUT_VARIABLE changed ERROR_QUIET)
    if(changed)
      string(APPEND commit ".dirty")
    endif()
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "\"${commit}\"\n")
