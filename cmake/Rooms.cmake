# SPDX-License-Identifier: Apache-2.0
include(GoogleTest)

# coupler_room(NAME SOURCES a.cpp … LINKS lib …): the library of one room. LINKS are public.
function(coupler_room name)
  cmake_parse_arguments(room "" "" "SOURCES;LINKS" ${ARGN})
  add_library(${name} STATIC ${room_SOURCES})
  target_link_libraries(${name} PUBLIC coupler_flags ${room_LINKS})
endfunction()

# coupler_test(NAME SOURCES … LINKS …): a test program; each of its tests is a CTest test.
function(coupler_test name)
  cmake_parse_arguments(test "" "" "SOURCES;LINKS" ${ARGN})
  add_executable(${name} ${test_SOURCES})
  target_link_libraries(${name} PRIVATE coupler_flags ${test_LINKS} GTest::gmock GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE
    COUPLER_TEST_DIR="${PROJECT_SOURCE_DIR}/test" COUPLER_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
    COUPLER_BINARY_DIR="${PROJECT_BINARY_DIR}")
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/test/bin)
  gtest_discover_tests(${name} TEST_PREFIX "${name}: " DISCOVERY_MODE PRE_TEST PROPERTIES TIMEOUT 60)
endfunction()
