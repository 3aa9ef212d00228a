# SPDX-License-Identifier: Apache-2.0
# Finds what the modules link. What is optional and absent is named in one line, with its remedy.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tl-expected REQUIRED)
pkg_check_modules(libmd REQUIRED IMPORTED_TARGET libmd)

if(CMAKE_DISABLE_FIND_PACKAGE_libmodbus)
  set(libmodbus_FOUND FALSE)  # pkg_check_modules() does not know that variable, and its last answer is in the cache
else()
  pkg_check_modules(libmodbus IMPORTED_TARGET libmodbus>=3.1.6)
endif()
if(NOT libmodbus_FOUND)
  message(STATUS "Left out: the host's Modbus client, coupler_driver and the node's libmodbus oracle test "
                 "(no libmodbus; apt install libmodbus-dev)")
endif()
if(libmodbus_FOUND AND NOT COUPLER_SERIAL)
  message(STATUS "Left out: couplers on serial lines (COUPLER_SERIAL=OFF)")
endif()

# OFF, or the folder of coupler/device/gpio that speaks to it: libgpiod 2 shares no API with libgpiod 1.
set(COUPLER_WITH_GPIOD OFF)
if(NOT COUPLER_GPIOD STREQUAL OFF)
  pkg_check_modules(libgpiod IMPORTED_TARGET libgpiod>=1.6)
  if(libgpiod_FOUND AND libgpiod_VERSION VERSION_LESS 2)
    set(COUPLER_WITH_GPIOD libgpiod1)
  elseif(libgpiod_FOUND)
    set(COUPLER_WITH_GPIOD libgpiod2)
  elseif(COUPLER_GPIOD STREQUAL ON)
    message(FATAL_ERROR "COUPLER_GPIOD=ON, but libgpiod 1.6 or 2 was not found (apt install libgpiod-dev)")
  endif()
endif()
if(NOT COUPLER_WITH_GPIOD)
  message(STATUS "Left out: GPIO lines; coupler-node runs with --sim only "
                 "(no libgpiod 1.6 or 2, or COUPLER_GPIOD=OFF; apt install libgpiod-dev)")
endif()

# The protocol of OpenSSL 1.1 is the same, but not all of the functions that are used here are in it.
set(COUPLER_WITH_TLS OFF)
if(NOT COUPLER_TLS STREQUAL OFF)
  find_package(OpenSSL 3.0 QUIET)
  if(OPENSSL_FOUND)
    set(COUPLER_WITH_TLS ON)
  elseif(COUPLER_TLS STREQUAL ON)
    message(FATAL_ERROR "COUPLER_TLS=ON, but OpenSSL 3 was not found (apt install libssl-dev)")
  endif()
endif()
if(NOT COUPLER_WITH_TLS)
  message(STATUS "Left out: TLS, coupler certificates, coupler pin (no OpenSSL 3, or COUPLER_TLS=OFF; apt install libssl-dev)")
endif()

# Ubuntu 22.04 does not have it.
set(COUPLER_WITH_PANEL OFF)
if(NOT COUPLER_PANEL STREQUAL OFF)
  pkg_check_modules(httplib QUIET IMPORTED_TARGET cpp-httplib>=0.11)
  if(httplib_FOUND AND libmodbus_FOUND)
    set(COUPLER_WITH_PANEL ON)
  elseif(COUPLER_PANEL STREQUAL ON)
    message(FATAL_ERROR "COUPLER_PANEL=ON, but cpp-httplib 0.11 or libmodbus was not found "
                        "(apt install libcpp-httplib-dev libmodbus-dev)")
  endif()
endif()
if(NOT COUPLER_WITH_PANEL)
  message(STATUS "Left out: coupler panel (no cpp-httplib, no libmodbus, or COUPLER_PANEL=OFF; "
                 "apt install libcpp-httplib-dev libmodbus-dev)")
endif()

find_package(pugixml QUIET)
if(NOT pugixml_FOUND)
  message(STATUS "Left out: coupler import modbuspal (no pugixml; apt install libpugixml-dev)")
endif()

if(COUPLER_TESTING)
  find_package(GTest REQUIRED)
endif()
