# SPDX-License-Identifier: Apache-2.0
# find_package(OpenCoupler): the modules with EXPORT, the program coupler and coupler_add_map(), from where they are installed or,
# with -DOpenCoupler_DIR=<build folder>, from this build.
if(NOT COUPLER_INSTALL)
  return()
endif()
include(CMakePackageConfigHelpers)
set(libraries)
if(libmodbus_FOUND)
  list(APPEND libraries libmodbus)
endif()
if(COUPLER_WITH_GPIOD)
  list(APPEND libraries libgpiod)
endif()
set(folder ${CMAKE_INSTALL_LIBDIR}/cmake/OpenCoupler)
configure_package_config_file(cmake/OpenCouplerConfig.cmake.in ${PROJECT_BINARY_DIR}/OpenCouplerConfig.cmake
                              INSTALL_DESTINATION ${folder} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/OpenCouplerConfigVersion.cmake COMPATIBILITY SameMinorVersion)
configure_file(cmake/CouplerMap.cmake ${PROJECT_BINARY_DIR}/CouplerMap.cmake COPYONLY)
export(EXPORT OpenCouplerTargets NAMESPACE OpenCoupler:: FILE ${PROJECT_BINARY_DIR}/OpenCouplerTargets.cmake)

coupler_install(EXPORT OpenCouplerTargets NAMESPACE OpenCoupler:: DESTINATION ${folder} COMPONENT dev)
coupler_install(FILES ${PROJECT_BINARY_DIR}/OpenCouplerConfig.cmake ${PROJECT_BINARY_DIR}/OpenCouplerConfigVersion.cmake
                      cmake/CouplerMap.cmake
                DESTINATION ${folder} COMPONENT dev)

# Public is what generated code includes, and the folders of the libraries that are of use without it.
file(GLOB public_headers RELATIVE ${PROJECT_SOURCE_DIR}/common CONFIGURE_DEPENDS
     common/coupler/map/*.hpp common/coupler/modbus/*.hpp)
list(APPEND public_headers coupler/device/core/node_core.hpp coupler/device/node/point_hooks.hpp coupler/device/node/program.hpp)
if(TARGET OpenCoupler::client)
  list(APPEND public_headers coupler/host/client/point.hpp)
endif()
if(TARGET OpenCoupler::driver)
  list(APPEND public_headers coupler/host/ros/program.hpp)
endif()
configure_file(cmake/InstallDev.cmake.in ${PROJECT_BINARY_DIR}/InstallDev.cmake @ONLY)
coupler_install(SCRIPT ${PROJECT_BINARY_DIR}/InstallDev.cmake COMPONENT dev)

# find_package(coupler_driver), which catkin and ament make, has the driver's libraries beside the messages:
# coupler_driver-extras.cmake.in.
if(COUPLER_WITH_ROS)
  coupler_install(EXPORT coupler_driverTargets NAMESPACE OpenCoupler:: DESTINATION share/${PROJECT_NAME}/cmake COMPONENT dev)
endif()
if(COUPLER_WITH_ROS EQUAL 1)
  export(EXPORT coupler_driverTargets NAMESPACE OpenCoupler:: FILE ${PROJECT_BINARY_DIR}/coupler_driverTargets.cmake)
endif()
