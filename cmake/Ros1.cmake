# SPDX-License-Identifier: Apache-2.0
# catkin in a plain CMake build: no workspace needed; build/<preset>/devel/setup.bash serves the ROS tools.
# A python3 in front of the system's (pyenv, conda) has no catkin_pkg.
if(NOT PYTHON_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(PYTHON_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "Python that has catkin_pkg")
endif()
find_package(catkin QUIET COMPONENTS roscpp std_msgs std_srvs diagnostic_updater message_generation)
if(NOT catkin_FOUND)
  if(NOT COUPLER_ROS STREQUAL AUTO)
    message(FATAL_ERROR "COUPLER_ROS=${COUPLER_ROS}, but catkin with roscpp, std_msgs, std_srvs, diagnostic_updater and "
                        "message_generation was not found (scripts/install-packages ros)")
  endif()
  return()
endif()
set(COUPLER_WITH_ROS 1)

add_message_files(DIRECTORY host/msg FILES ${messages})
add_service_files(DIRECTORY host/srv FILES ${services})
generate_messages(DEPENDENCIES std_msgs)
catkin_package(CATKIN_DEPENDS roscpp std_msgs std_srvs diagnostic_updater message_runtime)
# Where rosmsg and rossrv look for them; our folders are not at the top.
foreach(file ${messages} ${services})
  get_filename_component(kind ${file} EXT)
  string(SUBSTRING ${kind} 1 -1 kind)
  configure_file(host/${kind}/${file} ${CATKIN_DEVEL_PREFIX}/share/${PROJECT_NAME}/${kind}/${file} COPYONLY)
endforeach()
# catkin wants shared libraries and devel/lib; the modules are small static libraries.
set(BUILD_SHARED_LIBS OFF)

# It also gives its definitions and include folders to every target of the project. Here those that need ROS link
# coupler_ros. The other modules compile alike with and without ROS, so that the compiler's cache serves both.
get_directory_property(definitions COMPILE_DEFINITIONS)
set_directory_properties(PROPERTIES COMPILE_DEFINITIONS "" INCLUDE_DIRECTORIES "")
add_library(coupler_ros INTERFACE)
target_compile_definitions(coupler_ros INTERFACE ${definitions})
# ROS's headers are not written for our warnings.
target_include_directories(coupler_ros SYSTEM INTERFACE
  ${catkin_INCLUDE_DIRS} ${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_INCLUDE_DESTINATION})
target_link_libraries(coupler_ros INTERFACE ${catkin_LIBRARIES})
