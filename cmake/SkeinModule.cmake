# SPDX-License-Identifier: Apache-2.0
#
# skein_module(NAME LAYER n [COLD] SOURCES ... HEADERS ... [IDL ...] [DEPS ...] [PRIVATE_DEPS ...]
#              [LIBRARIES ...] [PRIVATE_LIBRARIES ...] [TESTS ...] [TEST_DEPS ...])
#   A library skein::NAME with its own include root `include/`. DEPS and PRIVATE_DEPS are Skein
#   modules and must lie in a lower layer, or the configuration fails. A header of a module that was
#   not named is not on the include path. LIBRARIES are packages. IDL names the files of
#   idl/ whose types are this module's, as skein/idl/FILE.hpp. TESTS (x_test.cpp beside the code)
#   become one test program NAME_test; TEST_DEPS are what only the tests use. COLD: it waits for people
#   and files and computes little, so it is compiled with -O1, in two thirds of the time; so are tests.
#
# skein_program(NAME COMMAND_LINE ... [SOURCES ...] DEPS ... [LIBRARIES ...])
#   An executable; the top of the graph. Nothing can depend on it. COMMAND_LINE are the sources that
#   read its arguments: CLI11's templates are compiled without optimisation, in half the time. The
#   target `programs` builds them all, and whatever else a mission needs at run time
#   (add_dependencies(programs ...)).

add_custom_target(programs)

# `./dev test` counts halves of a core: a test that flies in real time mostly waits and takes one of them,
# as is CTest's default; one that computes says PROCESSORS ${SKEIN_WHOLE_CORE}.
set(SKEIN_WHOLE_CORE 2)

function(_skein_check_layers target layer)
  foreach(dep IN LISTS ARGN)
    if(NOT TARGET skein_${dep})
      message(FATAL_ERROR "${target}: there is no module '${dep}' below it (add_subdirectory order is layer order)")
    endif()
    get_target_property(dep_layer skein_${dep} SKEIN_LAYER)
    if(NOT dep_layer LESS layer)
      message(FATAL_ERROR "${target} (layer ${layer}) must not depend on ${dep} (layer ${dep_layer})")
    endif()
  endforeach()
endfunction()

# Of the targets skein_precompiled_* of SkeinOptions, where they are there.
function(_skein_precompiled target kind)
  if(TARGET skein_precompiled_${kind})
    target_precompile_headers(${target} REUSE_FROM skein_precompiled_${kind})
    target_compile_options(${target} PRIVATE -fpch-preprocess)  # for ccache
  endif()
endfunction()

function(_skein_tests name)
  cmake_parse_arguments(T "" "OF_MISSION" "SOURCES;DEPS" ${ARGN})
  if(NOT T_SOURCES)
    return()
  endif()
  list(TRANSFORM T_DEPS PREPEND "skein::")
  add_executable(${name}_test ${T_SOURCES})
  target_link_libraries(${name}_test PRIVATE ${T_DEPS} GTest::gtest GTest::gmock GTest::gtest_main
    skein_warnings skein_cold)
  target_compile_definitions(${name}_test PRIVATE SKEIN_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  _skein_precompiled(${name}_test test${T_OF_MISSION})
  add_test(NAME ${name} COMMAND ${name}_test)
  set(seconds 300)
  if(SKEIN_SANITIZE OR CMAKE_CROSSCOMPILING)
    set(seconds 1800)  # Eigen is slow without optimisation and under QEMU, slower yet on a busy machine
  endif()
  set_tests_properties(${name} PROPERTIES TIMEOUT ${seconds} PROCESSORS ${SKEIN_WHOLE_CORE})
endfunction()

function(skein_module name)
  cmake_parse_arguments(M "COLD" "LAYER"
    "SOURCES;HEADERS;IDL;DEPS;PRIVATE_DEPS;LIBRARIES;PRIVATE_LIBRARIES;TESTS;TEST_DEPS" ${ARGN})
  if(M_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "skein_module(${name}): unknown words ${M_UNPARSED_ARGUMENTS}")
  endif()
  _skein_check_layers(${name} ${M_LAYER} ${M_DEPS} ${M_PRIVATE_DEPS})
  list(TRANSFORM M_DEPS PREPEND "skein::" OUTPUT_VARIABLE deps)
  list(TRANSFORM M_PRIVATE_DEPS PREPEND "skein::" OUTPUT_VARIABLE private_deps)
  set(of_mission "")  # its sources and tests deal with the mission's messages
  if(name STREQUAL mission OR mission IN_LIST M_DEPS OR mission IN_LIST M_PRIVATE_DEPS)
    set(of_mission _mission)
  endif()
  if(M_SOURCES)
    add_library(skein_${name} STATIC ${M_SOURCES})
    target_sources(skein_${name} PUBLIC FILE_SET HEADERS BASE_DIRS include FILES ${M_HEADERS})
    target_link_libraries(skein_${name} PUBLIC ${deps} ${M_LIBRARIES}
      PRIVATE ${private_deps} ${M_PRIVATE_LIBRARIES} $<BUILD_INTERFACE:skein_warnings>)
    set(kind module)
    if(M_COLD)
      target_link_libraries(skein_${name} PRIVATE $<BUILD_INTERFACE:skein_cold>)
      set(kind cold)
    elseif(CMAKE_CURRENT_SOURCE_DIR MATCHES "^${PROJECT_SOURCE_DIR}/core/")
      set(kind core)
    endif()
    _skein_precompiled(skein_${name} ${kind}${of_mission})
  else()
    add_library(skein_${name} INTERFACE)
    target_sources(skein_${name} INTERFACE FILE_SET HEADERS BASE_DIRS include FILES ${M_HEADERS})
    target_link_libraries(skein_${name} INTERFACE ${deps} ${M_LIBRARIES})
  endif()
  foreach(file IN LISTS M_IDL)
    target_sources(skein_${name} PUBLIC FILE_SET idl_${file} TYPE HEADERS BASE_DIRS ${SKEIN_IDL}/types/${file}
      FILES ${SKEIN_IDL}/types/${file}/skein/idl/${file}.hpp)
    add_dependencies(skein_${name} skein_idl)
  endforeach()
  add_library(skein::${name} ALIAS skein_${name})
  set_target_properties(skein_${name} PROPERTIES
    SKEIN_LAYER ${M_LAYER} VERIFY_INTERFACE_HEADER_SETS ON)
  _skein_tests(${name} OF_MISSION ${of_mission} SOURCES ${M_TESTS}
    DEPS ${name} ${M_PRIVATE_DEPS} ${M_TEST_DEPS})
endfunction()

function(skein_program name)
  cmake_parse_arguments(P "" "" "COMMAND_LINE;SOURCES;DEPS;LIBRARIES" ${ARGN})
  _skein_check_layers(${name} 100 ${P_DEPS})
  list(TRANSFORM P_DEPS PREPEND "skein::")
  add_executable(${name} ${P_COMMAND_LINE} ${P_SOURCES})
  target_link_libraries(${name} PRIVATE ${P_DEPS} ${P_LIBRARIES} skein_warnings skein_cold)
  _skein_precompiled(${name} cold)
  target_compile_options(${name} PRIVATE -fPIC)  # as those are, or GCC would not take it
  set_source_files_properties(${P_COMMAND_LINE} PROPERTIES
    COMPILE_OPTIONS "-O0;-U_FORTIFY_SOURCE" SKIP_PRECOMPILE_HEADERS ON)
  add_dependencies(programs ${name})
endfunction()
