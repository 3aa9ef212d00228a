# SPDX-License-Identifier: Apache-2.0
#catkin_lint: ignore order_violation catkin_order_violation
# For a system without an operating system (CMAKE_SYSTEM_NAME is Generic): OpenCoupler::node_core and coupler_add_map(), and
# nothing that these do not need. The map is turned into C++ by a `coupler` of the machine that builds, COUPLER_HOST_COUPLER.
file(GLOB core CONFIGURE_DEPENDS device/coupler/device/core/*.cpp common/coupler/modbus/*.cpp)
add_library(coupler_node_core STATIC ${core}
  common/coupler/codec/scale.cpp common/coupler/codec/text.cpp common/coupler/map/allowed_values.cpp
  common/coupler/map/identity.cpp common/coupler/map/image_layout.cpp)
target_compile_features(coupler_node_core PUBLIC cxx_std_17)
target_compile_options(coupler_node_core PUBLIC -fno-exceptions -fno-rtti -fno-threadsafe-statics)

# tl/expected.hpp alone: /usr/include has the headers of the machine that builds.
find_path(COUPLER_EXPECTED tl/expected.hpp HINTS /usr/include NO_CMAKE_FIND_ROOT_PATH)
if(NOT COUPLER_EXPECTED)
  message(FATAL_ERROR "tl/expected.hpp was not found (apt install libexpected-dev)")
endif()
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include)
file(CREATE_LINK ${COUPLER_EXPECTED}/tl ${PROJECT_BINARY_DIR}/include/tl SYMBOLIC)
target_include_directories(coupler_node_core PUBLIC common device)
#catkin_lint: ignore_once missing_directory
target_include_directories(coupler_node_core SYSTEM PUBLIC ${PROJECT_BINARY_DIR}/include)

add_library(OpenCoupler::node_core ALIAS coupler_node_core)
add_library(OpenCoupler::map ALIAS coupler_node_core)
include(cmake/CouplerMap.cmake)
