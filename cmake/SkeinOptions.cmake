# SPDX-License-Identifier: Apache-2.0
# Compiler settings of every target of the project, in one place.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

set(SKEIN_SANITIZE "" CACHE STRING "Sanitizers to compile with, as -fsanitize= takes them")

find_program(SKEIN_CCACHE ccache)
if(SKEIN_CCACHE)
  # What ccache must overlook to work with precompiled headers (its manual says so).
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
    CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${SKEIN_CCACHE})
endif()

# Warnings of our own code; generated and third-party code does not link this target.
add_library(skein_warnings INTERFACE)
target_compile_options(skein_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror
  # False alarms on sums of strings in GCC 12 (its bug 105651). Clang, which lints and fuzzes, has them.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict -Wno-array-bounds -Wno-stringop-overflow>
  # Of what libstdc++ 12 itself deprecates and uses, in std::stable_sort.
  $<$<CXX_COMPILER_ID:Clang>:-Wno-deprecated-declarations>)

# Of tests, and of modules that are COLD (SkeinModule.cmake); Debug is what is sanitized.
add_library(skein_cold INTERFACE)
target_compile_options(skein_cold INTERFACE $<$<CONFIG:Release>:-O1> $<$<CONFIG:Debug>:-O0>)

# GCC looks for what it may forget again and again, in up to a fifth of its time; with this it takes 50 MB more.
add_compile_options($<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:GNU>>:--param=ggc-min-heapsize=524288>)

# Every object: the same doubles on every compiler (no fused multiply-add), sanitizers where asked.
add_compile_options(-ffp-contract=off)
if(SKEIN_SANITIZE)
  # GCC sees more paths in what is instrumented, and warns of what none of them does (its manual,
  # -fsanitize); so it does where the library asserts, in packages (CMakePresets.json).
  add_compile_options(-fsanitize=${SKEIN_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    add_compile_options(-Wno-maybe-uninitialized)
  endif()
  add_link_options(-fsanitize=${SKEIN_SANITIZE})
endif()

# A fault of memory becomes an end of the process more often than a way in; the test `hardened` reads
# it off the programs. Sanitizers find such faults themselves, and are not at one with these.
if(NOT SKEIN_SANITIZE)
  add_compile_options(-fstack-protector-strong -fstack-clash-protection)
  add_compile_options($<$<CONFIG:Release>:-D_FORTIFY_SOURCE=3>)
  if(CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
    add_compile_options(-fcf-protection)
  elseif(CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
    add_compile_options(-mbranch-protection=standard)
  endif()
  add_link_options(-Wl,-z,relro,-z,now)
endif()

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(GTest REQUIRED)
find_package(Threads REQUIRED)

# Precompiled, with GCC: what nearly every source of core, of the other modules, or of their tests
# includes of the standard library and of others; for modules that deal with the mission's messages,
# those too. Public headers are checked without it (all_verify_interface_header_sets), and the other
# compilers and the linter do without.
option(SKEIN_PRECOMPILE "Precompile headers that most sources include (GCC only)" ON)
if(SKEIN_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC takes it only for sources that define what it was made with.
  find_package(fmt REQUIRED)
  get_target_property(fmt_definitions fmt::fmt INTERFACE_COMPILE_DEFINITIONS)
  if(fmt_definitions)
    add_compile_definitions(${fmt_definitions})
  endif()
  set(precompiled_core <algorithm> <array> <chrono> <cmath> <cstdint> <filesystem> <functional>
    <limits> <map> <memory> <optional> <set> <span> <sstream> <string> <string_view> <utility>
    <variant> <vector> <Eigen/Core> <Eigen/Geometry>)
  set(precompiled_module ${precompiled_core} <fmt/format.h>)
  set(precompiled_cold ${precompiled_module})
  set(precompiled_test ${precompiled_module} <gmock/gmock.h> <gtest/gtest.h>)
  foreach(kind core module cold test)
    set(precompiled_${kind}_mission ${precompiled_${kind}} <skein/mission/messages.hpp>)
  endforeach()
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/precompiled.cpp CONTENT "")
  foreach(kind core module cold test core_mission module_mission cold_mission test_mission)
    set(target skein_precompiled_${kind})
    add_library(${target} OBJECT ${CMAKE_BINARY_DIR}/precompiled.cpp)
    target_link_libraries(${target} PRIVATE Eigen3::Eigen skein_warnings)
    target_precompile_headers(${target} PRIVATE ${precompiled_${kind}})
    if(kind MATCHES "^cold|^test")
      target_link_libraries(${target} PRIVATE skein_cold)
    endif()
    if(kind MATCHES "^test")
      target_link_libraries(${target} PRIVATE GTest::gmock)
      # As programs are compiled, or GCC would not take it.
      set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
      target_compile_options(${target} PRIVATE -fPIE)
    endif()
    if(kind MATCHES "_mission$")
      add_dependencies(${target} skein_idl)
      target_include_directories(${target} PRIVATE
        $<TARGET_PROPERTY:skein_mission,INTERFACE_INCLUDE_DIRECTORIES>)
    endif()
  endforeach()
endif()
