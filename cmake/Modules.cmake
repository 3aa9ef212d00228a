# SPDX-License-Identifier: Apache-2.0
# One library and one test program a module.
#
# A cold build reads the same headers hundreds of times, so they are translated once (precompiled headers), and the files
# of a test program or of a large module several at a time. Neither may hide a missing include: scripts/lint compiles each file
# by itself. -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON and -DCOUPLER_UNITY=1 build each file by itself, too.
include(GNUInstallDirs)
include(GoogleTest)

# Programs are in build/<preset>/bin. In a catkin workspace catkin's own choice stands, so that rosrun finds them.
if(NOT COUPLER_WITH_ROS EQUAL 1 OR plain)
  set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
  set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
endif()

add_library(coupler_flags INTERFACE)
target_compile_options(coupler_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow
  -ffp-contract=off  # no fused multiply-add: a scaled value has the same last bit on every machine
  # Functions and lines, as a backtrace needs them. Variables, of which an optimised program has few, are a sixth of the time
  # to build and a third of what is written; -DCMAKE_BUILD_TYPE=Debug has them all.
  $<$<CONFIG:RelWithDebInfo>:-g1>
  $<$<BOOL:${COUPLER_WERROR}>:-Werror>)
# GCC collects its garbage from 128 MiB on, which is little more than the precompiled headers of tests have: up to a fifth of
# its time. With this each compiler takes some 400 MiB more, where there are 2000 for it.
cmake_host_system_information(RESULT memory QUERY TOTAL_PHYSICAL_MEMORY)
cmake_host_system_information(RESULT processors QUERY NUMBER_OF_LOGICAL_CORES)
math(EXPR memory "${memory} / ${processors}")
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND memory GREATER 2000)
  target_compile_options(coupler_flags INTERFACE --param=ggc-min-heapsize=1048576)
endif()
# Not of all targets of the project: ROS 2's messages are loaded by Python, which has no sanitizer.
if(COUPLER_SANITIZE)
  target_compile_options(coupler_flags INTERFACE
    -fsanitize=${COUPLER_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer
    -Og -g1  # -O1 takes twice as long to compile what is instrumented
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)  # among the checks GCC sees paths that are none: its manual warns
  target_link_options(coupler_flags INTERFACE -fsanitize=${COUPLER_SANITIZE})
endif()
if(COUPLER_COVERAGE)
  target_compile_options(coupler_flags INTERFACE --coverage -O0)
  target_link_options(coupler_flags INTERFACE --coverage)
endif()
# A test runs once: to optimise it as what it tests costs more than half of its time to compile. What it links is as it is
# installed.
add_library(coupler_test_flags INTERFACE)
target_compile_options(coupler_test_flags INTERFACE $<$<CONFIG:RelWithDebInfo>:-Og>)
target_link_libraries(coupler_test_flags INTERFACE coupler_flags)

# Their macros and flags must be those of the files that use them: one for libraries, one for test programs.
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/nothing.cpp CONTENT "int main() {}\n")
add_library(coupler_headers STATIC ${PROJECT_BINARY_DIR}/nothing.cpp)
target_link_libraries(coupler_headers PRIVATE coupler_flags tl::expected fmt::fmt)
target_precompile_headers(coupler_headers PRIVATE
  <algorithm> <array> <chrono> <cstdint> <functional> <map> <memory> <optional> <string> <string_view> <utility> <variant>
  <vector> <fmt/format.h> <tl/expected.hpp>)
if(COUPLER_TESTING)
  # The tests that a user runs, and every program that they start: neither benchmarks nor all that is made of example maps.
  add_custom_target(coupler_tests)
  add_executable(coupler_test_headers ${PROJECT_BINARY_DIR}/nothing.cpp)
  target_link_libraries(coupler_test_headers PRIVATE coupler_test_flags GTest::gmock)
  target_precompile_headers(coupler_test_headers PRIVATE
    <algorithm> <array> <chrono> <cstdint> <functional> <map> <memory> <optional> <string> <string_view> <thread>
    <utility> <variant> <vector> <gmock/gmock.h>)
endif()

# coupler_install(…): install(…), unless this is a part of another project. `colcon build --symlink-install` puts one that knows
# no COMPONENT in its place.
macro(coupler_install)
  if(COUPLER_INSTALL)
    if("${ARGV0}" STREQUAL TARGETS)
      coupler_needs_target(${ARGV1})
    endif()
    if(COMMAND _install)
      _install(${ARGN})
    else()
      install(${ARGN})
    endif()
  endif()
endmacro()

add_custom_target(coupler_dev)  # what the package coupler-dev has
# coupler_export(TARGET NAME [SET]): others link it as OpenCoupler::NAME, from here or from what is installed (headers: see
# Export.cmake). SET: of what needs ROS, coupler_driverTargets.
function(coupler_export target name)
  set(set OpenCouplerTargets)
  if(ARGC EQUAL 3)
    set(set ${ARGV2})
  endif()
  add_library(OpenCoupler::${name} ALIAS ${target})
  if(set STREQUAL OpenCouplerTargets)
    add_dependencies(coupler_dev ${target})
  endif()
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(${target} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  coupler_install(TARGETS ${target} EXPORT ${set} DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
endfunction()

# coupler_unite(NAME a.cpp …): sets NAME to files that include these, COUPLER_UNITY each. CMake's own UNITY_BUILD writes
# absolute paths, with which no two clones could share the compiler's cache. Files that are written while this is configured
# stay by themselves.
set(COUPLER_UNITY 8 CACHE STRING "How many files of a large module or a test program are compiled as one")
function(coupler_unite out)
  if(NOT COUPLER_UNITY GREATER 1)
    set(${out} ${ARGN} PARENT_SCOPE)
    return()
  endif()
  set(files ${ARGN})
  list(FILTER files EXCLUDE REGEX "^/")
  set(united ${ARGN})
  list(FILTER united INCLUDE REGEX "^/")
  set(i 0)
  while(files)
    list(SUBLIST files 0 ${COUPLER_UNITY} batch)
    list(REMOVE_ITEM files ${batch})
    set(text)
    foreach(file IN LISTS batch)
      get_filename_component(file ${file} ABSOLUTE)
      file(RELATIVE_PATH file ${PROJECT_SOURCE_DIR} ${file})
      string(APPEND text "#include \"${file}\"\n")
    endforeach()
    set(unity ${CMAKE_CURRENT_BINARY_DIR}/Unity/${out}_${i}.cpp)
    file(GENERATE OUTPUT ${unity} CONTENT "${text}")
    list(APPEND united ${unity})
    math(EXPR i "${i} + 1")
  endwhile()
  set(${out} ${united} PARENT_SCOPE)
endfunction()

# coupler_module(NAME SOURCES a.cpp … LINKS lib … [EXPORT name] [HEADERS <h> …] [UNITE [APART b.cpp …]]): the library of one
# module. LINKS are public. EXPORT: as coupler_export(). UNITE: several files are compiled as one, but for those of APART: large
# ones, those with names of others, and those that not every program links. HEADERS are precompiled for it alone, in place
# of those that most modules share: where they cost more, or where fmt is not linked. COUPLER_INCLUDE is the folder in which
# #include finds its headers. Who links it gets no flags of ours but C++17.
function(coupler_module name)
  cmake_parse_arguments(module "UNITE" "EXPORT" "SOURCES;LINKS;HEADERS;APART" ${ARGN})
  if(module_UNITE)
    coupler_unite(${name} ${module_SOURCES})
    set(module_SOURCES ${${name}})
  endif()
  add_library(${name} STATIC ${module_SOURCES} ${module_APART})
  target_compile_features(${name} PUBLIC cxx_std_17)
  target_compile_options(${name} PRIVATE $<TARGET_PROPERTY:coupler_flags,INTERFACE_COMPILE_OPTIONS>)
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${COUPLER_INCLUDE}>)
  if(module_UNITE)
    target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  endif()
  target_link_libraries(${name} PUBLIC ${module_LINKS})
  if(module_HEADERS)
    target_precompile_headers(${name} PRIVATE ${module_HEADERS})
  else()
    target_precompile_headers(${name} REUSE_FROM coupler_headers)
  endif()
  if(module_EXPORT)
    coupler_export(${name} ${module_EXPORT})
  endif()
endfunction()

# coupler_test(NAME SOURCES … LINKS …): a test program; each of its tests is a CTest test. The time limit only tells one
# that hangs from one that works on a slow machine under ThreadSanitizer.
function(coupler_test name)
  cmake_parse_arguments(test "" "" "SOURCES;LINKS" ${ARGN})
  coupler_unite(${name} ${test_SOURCES})
  add_executable(${name} ${${name}})
  target_link_libraries(${name} PRIVATE coupler_test_flags ${test_LINKS} coupler_test_paths GTest::gmock GTest::gtest_main)
  target_precompile_headers(${name} REUSE_FROM coupler_test_headers)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/test/bin)
  add_dependencies(coupler_tests ${name})
  gtest_discover_tests(${name} TEST_PREFIX "${name}: " DISCOVERY_MODE PRE_TEST PROPERTIES TIMEOUT 300)
endfunction()
