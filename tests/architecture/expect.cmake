# SPDX-License-Identifier: Apache-2.0
# Configures a fixture, and builds it where asked: it must succeed, or fail with the given words.
file(REMOVE_RECURSE ${BINARY})
execute_process(
  COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${BINARY} -G ${GENERATOR}
    -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_MODULE_PATH=${MODULE_PATH} -D CASE=${CASE}
  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(STEP STREQUAL "build")
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "the fixture must configure:\n${output}")
  endif()
  execute_process(
    COMMAND ${CMAKE_COMMAND} --build ${BINARY} --target all all_verify_interface_header_sets
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
endif()

if(FAILS_WITH STREQUAL "")
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "expected success:\n${output}")
  endif()
elseif(status EQUAL 0)
  message(FATAL_ERROR "expected a failure with '${FAILS_WITH}', but it succeeded:\n${output}")
else()
  string(REGEX REPLACE "[ \n]+" " " flat "${output}")
  if(NOT flat MATCHES "${FAILS_WITH}")
    message(FATAL_ERROR "it failed, but without '${FAILS_WITH}':\n${output}")
  endif()
endif()
