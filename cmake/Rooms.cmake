# SPDX-License-Identifier: Apache-2.0
# One library and one test program a room.
#
# A cold build reads the same headers hundreds of times, so they are translated once (precompiled headers), and several
# files of a target at once (unity builds). Neither may hide a missing include: scripts/lint compiles each file by
# itself. -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON and -DCMAKE_UNITY_BUILD=OFF build each file by itself, too.
include(GoogleTest)

# Their macros must be those of the files that use them: one for libraries, one for test programs.
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/nothing.cpp CONTENT "int main() {}\n")
add_library(coupler_headers STATIC ${PROJECT_BINARY_DIR}/nothing.cpp)
target_link_libraries(coupler_headers PRIVATE coupler_flags tl::expected fmt::fmt)
target_precompile_headers(coupler_headers PRIVATE
  <algorithm> <array> <chrono> <cstdint> <functional> <map> <memory> <optional> <string> <string_view> <utility> <variant>
  <vector> <fmt/format.h> <tl/expected.hpp>)
if(BUILD_TESTING)
  add_executable(coupler_test_headers ${PROJECT_BINARY_DIR}/nothing.cpp)
  target_link_libraries(coupler_test_headers PRIVATE coupler_flags GTest::gmock)
  target_precompile_headers(coupler_test_headers PRIVATE
    <algorithm> <array> <chrono> <cstdint> <functional> <map> <memory> <optional> <string> <string_view> <thread>
    <utility> <variant> <vector> <gmock/gmock.h>)
endif()

# coupler_room(NAME SOURCES a.cpp … LINKS lib … [HEADERS <h> …]): the library of one room. LINKS are public. HEADERS are
# precompiled for it alone, in place of those that most rooms share: where they cost more, or where fmt is not linked.
function(coupler_room name)
  cmake_parse_arguments(room "" "" "SOURCES;LINKS;HEADERS" ${ARGN})
  add_library(${name} STATIC ${room_SOURCES})
  target_link_libraries(${name} PUBLIC coupler_flags ${room_LINKS})
  if(room_HEADERS)
    target_precompile_headers(${name} PRIVATE ${room_HEADERS})
  else()
    target_precompile_headers(${name} REUSE_FROM coupler_headers)
  endif()
endfunction()

# coupler_test(NAME SOURCES … LINKS …): a test program; each of its tests is a CTest test.
function(coupler_test name)
  cmake_parse_arguments(test "" "" "SOURCES;LINKS" ${ARGN})
  add_executable(${name} ${test_SOURCES})
  target_link_libraries(${name} PRIVATE coupler_flags ${test_LINKS} coupler_test_paths GTest::gmock GTest::gtest_main)
  target_precompile_headers(${name} REUSE_FROM coupler_test_headers)
  set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 3
    RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/test/bin)
  gtest_discover_tests(${name} TEST_PREFIX "${name}: " DISCOVERY_MODE PRE_TEST PROPERTIES TIMEOUT 60)
endfunction()
