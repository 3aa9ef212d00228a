# SPDX-License-Identifier: Apache-2.0
# Part of another project (add_subdirectory(), FetchContent): only what is linked is built, and nothing of ours is set there.
# The top of a catkin workspace is catkin's.
set(COUPLER_IS_PART ON)
if(CMAKE_SOURCE_DIR STREQUAL PROJECT_SOURCE_DIR OR DEFINED CATKIN_TOPLEVEL)
  set(COUPLER_IS_PART OFF)
endif()
set(on ON)
set(automatic AUTO)
if(COUPLER_IS_PART)
  set(on OFF)
  set(automatic OFF)
endif()
option(COUPLER_INSTALL "Install programs, headers and libraries" ${on})
set(COUPLER_ROS ${automatic} CACHE STRING "Build the ROS driver: AUTO or ON (for ROS 2 where ROS_VERSION is 2, else for ROS 1), OFF, 1, 2")
if(NOT COUPLER_ROS MATCHES "^(AUTO|ON|OFF|1|2)$")
  message(FATAL_ERROR "COUPLER_ROS=${COUPLER_ROS}: it knows AUTO, ON, OFF, 1 and 2")
endif()
set(COUPLER_ROS_VERSION 1)
if(COUPLER_ROS EQUAL 2 OR (COUPLER_ROS MATCHES "^(AUTO|ON)$" AND "$ENV{ROS_VERSION}" STREQUAL 2))
  set(COUPLER_ROS_VERSION 2)
  # `colcon build` says nothing about tests and examples, and means none.
  option(BUILD_TESTING "Build the tests" OFF)
  option(COUPLER_EXAMPLES "Build the programs of the example maps" OFF)
endif()
set(COUPLER_TESTING OFF)
if(NOT COUPLER_IS_PART)
  include(CTest)
  set(COUPLER_TESTING ${BUILD_TESTING})
endif()
option(COUPLER_EXAMPLES "Build the programs of the example maps" ${on})
# Another compiler may warn of more, and a user must not have to mend that.
set(as_errors OFF)
if(NOT COUPLER_IS_PART AND CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION MATCHES "^12\\.")
  set(as_errors ON)
endif()
option(COUPLER_WERROR "Treat compiler warnings as errors (by default with GCC 12, which the tests run with)" ${as_errors})
option(COUPLER_COVERAGE "Instrument for gcov" OFF)
set(COUPLER_SANITIZE "" CACHE STRING "Sanitizers, as -fsanitize= takes them")
option(COUPLER_SERIAL "Reach couplers on serial lines; RTU over TCP is there without it" ON)
set(COUPLER_TLS ${automatic} CACHE STRING "Modbus/TCP Security, by OpenSSL 3: AUTO, ON or OFF")
set(COUPLER_PANEL ${automatic} CACHE STRING "coupler panel, by cpp-httplib: AUTO, ON or OFF")
set(COUPLER_GPIOD AUTO CACHE STRING "Build the libgpiod backend: AUTO, ON or OFF")

if(NOT COUPLER_IS_PART AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE RelWithDebInfo CACHE STRING "" FORCE)
endif()

set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

find_program(COUPLER_CCACHE ccache)
if(COUPLER_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # The sloppiness lets ccache serve files that use a precompiled header; the other two let clones share the cache, where
  # paths are relative to the folder that holds sources and build: in a catkin workspace they are side by side.
  set(base ${PROJECT_SOURCE_DIR})
  file(RELATIVE_PATH build ${base} ${PROJECT_BINARY_DIR})
  while(build MATCHES "^\\.\\./")
    get_filename_component(base ${base} DIRECTORY)
    file(RELATIVE_PATH build ${base} ${PROJECT_BINARY_DIR})
  endwhile()
  set(CMAKE_CXX_COMPILER_LAUNCHER
      ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
      CCACHE_BASEDIR=${base} CCACHE_NOHASHDIR=1
      ${COUPLER_CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${CMAKE_CXX_COMPILER_LAUNCHER})
endif()

# Every test program is linked: mold does it in a fraction of the time. What is installed is built without tests, and linked
# as the distribution does.
if(COUPLER_TESTING AND NOT CMAKE_EXE_LINKER_FLAGS MATCHES "-fuse-ld=" AND NOT CMAKE_VERSION VERSION_LESS 3.18)
  include(CheckLinkerFlag)
  check_linker_flag(CXX -fuse-ld=mold COUPLER_HAS_MOLD)  # it may be missing, or the compiler too old for it
  if(COUPLER_HAS_MOLD)
    add_link_options(-fuse-ld=mold)
  endif()
endif()
