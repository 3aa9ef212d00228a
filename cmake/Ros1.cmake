# SPDX-License-Identifier: Apache-2.0
# catkin in a plain CMake build: no workspace needed; build/<preset>/devel/setup.bash serves the ROS tools.
# A python3 in front of the system's (pyenv, conda) has no catkin_pkg.
if(NOT PYTHON_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(PYTHON_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "Python that has catkin_pkg")
endif()
# Neither in a workspace nor for one. catkin's devel folder then names the source tree, with every build in it, as the package;
# so it stands aside, and devel has the package as ROS's tools are to see it.
set(plain OFF)
if(CMAKE_SOURCE_DIR STREQUAL PROJECT_SOURCE_DIR AND
   (NOT DEFINED CATKIN_DEVEL_PREFIX OR CATKIN_DEVEL_PREFIX STREQUAL "${PROJECT_BINARY_DIR}/catkin"))
  set(plain ON)
  set(CATKIN_DEVEL_PREFIX ${PROJECT_BINARY_DIR}/catkin)
  set(CATKIN_BUILD_BINARY_PACKAGE ON)  # no setup.bash of a workspace is installed, nor to another prefix than was asked for
endif()
set(components actionlib actionlib_msgs roscpp sensor_msgs std_msgs std_srvs diagnostic_updater message_generation)
find_package(catkin QUIET COMPONENTS ${components})
set(missing)
foreach(package catkin ${components})  # where one is not there, catkin is found all the same
  if(NOT ${package}_FOUND)
    list(APPEND missing ${package})
  endif()
endforeach()
if(missing)
  list(JOIN missing ", " missing)
  set(left_out "of ROS 1 there is no ${missing}; scripts/install-packages build ros")
  if(NOT COUPLER_ROS STREQUAL AUTO)
    message(FATAL_ERROR "COUPLER_ROS=${COUPLER_ROS}, but ${left_out}")
  endif()
  return()
endif()
set(COUPLER_WITH_ROS 1)
# Not in CATKIN_DEPENDS: that wants it in package.xml. Who links coupler_ros gets its headers from there, and it has no library.
find_package(control_msgs QUIET)

add_message_files(DIRECTORY host/msg FILES ${messages})
add_service_files(DIRECTORY host/srv FILES ${services})
add_action_files(DIRECTORY host/action FILES ${actions})
generate_messages(DEPENDENCIES actionlib_msgs std_msgs)
catkin_package(CATKIN_DEPENDS actionlib actionlib_msgs roscpp sensor_msgs std_msgs std_srvs diagnostic_updater message_runtime
               CFG_EXTRAS ${PROJECT_NAME}-extras.cmake)
# Where rosmsg and rossrv look for them; our folders are not at the top.
foreach(kind action msg srv)
  file(COPY host/${kind} DESTINATION ${CATKIN_DEVEL_PREFIX}/share/${PROJECT_NAME})
  install(DIRECTORY host/${kind} DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION} COMPONENT ros)
endforeach()
# link(FILE NAME): once; another program may be looking.
macro(link file name)
  if(NOT IS_SYMLINK ${name})
    get_filename_component(folder ${name} DIRECTORY)
    file(MAKE_DIRECTORY ${folder})
    file(CREATE_LINK ${file} ${name} SYMBOLIC)
  endif()
endmacro()
set(package ${CATKIN_DEVEL_PREFIX}/share/${PROJECT_NAME})
if(plain)
  set(devel ${PROJECT_BINARY_DIR}/devel)
  set(package ${devel}/share/${PROJECT_NAME})
  link(${PROJECT_SOURCE_DIR}/package.xml ${package}/package.xml)
  link(${PROJECT_SOURCE_DIR}/config/example-node.yaml ${package}/config/example-node.yaml)
  link(${PROJECT_SOURCE_DIR}/host/action ${package}/action)
  link(${PROJECT_SOURCE_DIR}/host/msg ${package}/msg)
  link(${PROJECT_SOURCE_DIR}/host/srv ${package}/srv)
  foreach(program coupler_driver coupler-node)
    link(${PROJECT_BINARY_DIR}/bin/${program} ${devel}/lib/${PROJECT_NAME}/${program})
  endforeach()
  file(GENERATE OUTPUT ${devel}/.catkin CONTENT "")
  set(overlay)
  if(control_msgs_FOUND AND NOT control_msgs_PREFIX STREQUAL roscpp_PREFIX)  # -Dcontrol_msgs_DIR=…
    set(overlay "export ROS_PACKAGE_PATH=\"$ROS_PACKAGE_PATH:${control_msgs_PREFIX}/share\" \\
  PYTHONPATH=\"$PYTHONPATH:${control_msgs_PREFIX}/${CATKIN_GLOBAL_PYTHON_DESTINATION}\"
")
  endif()
  file(GENERATE OUTPUT ${devel}/setup.bash CONTENT
"# Sourced by bash: ROS 1 with this build's programs, launch files and messages.
source \"${CATKIN_DEVEL_PREFIX}/setup.bash\"
without() { [ -n \"$1\" ] || return 0; local list=:$1: one=:$2:; list=\${list//\"$one\"/:}; printf %s \"\${list%:}\"; }
export CMAKE_PREFIX_PATH=\"${devel}$(without \"$CMAKE_PREFIX_PATH\" \"${devel}\")\"
ROS_PACKAGE_PATH=$(without \"$ROS_PACKAGE_PATH\" \"${PROJECT_SOURCE_DIR}\")
export ROS_PACKAGE_PATH=\"${devel}/share$(without \"\${ROS_PACKAGE_PATH#:}\" \"${devel}/share\")\"
unset -f without
${overlay}")
endif()
if(IS_SYMLINK ${package}/launch)  # of an older build folder: what follows would be written into the source
  file(REMOVE ${package}/launch)
endif()
# $(find coupler_driver)/launch/NAME.launch, in a plain build as in a workspace. The sources have other names: roslaunch looks
# for NAME.launch in the whole source tree, too, and refuses to choose between two.
foreach(name device devices simulated)
  link(${PROJECT_SOURCE_DIR}/config/launch/ros1/${name}.xml ${package}/launch/${name}.launch)
endforeach()
# The example application, as it is installed.
link(${PROJECT_SOURCE_DIR}/config/examples/sorter/sorter_ros1.xml ${package}/launch/sorter.launch)
link(${PROJECT_SOURCE_DIR}/config/examples/sorter/sorter.yaml ${package}/config/sorter.yaml)
link(${PROJECT_SOURCE_DIR}/config/examples/sorter/eject_rospy.py ${package}/../../lib/${PROJECT_NAME}/eject)
# catkin wants shared libraries and devel/lib; the modules are small static libraries.
set(BUILD_SHARED_LIBS OFF)

# It also gives its definitions and include folders to every target of the project. Here those that need ROS link
# coupler_ros. The other modules compile alike with and without ROS, so that the compiler's cache serves both.
get_directory_property(definitions COMPILE_DEFINITIONS)
list(FILTER definitions EXCLUDE REGEX ^ROS_PACKAGE_NAME)  # other packages link coupler_ros and have a name of their own
set_directory_properties(PROPERTIES COMPILE_DEFINITIONS "" INCLUDE_DIRECTORIES "")
if(control_msgs_FOUND)
  list(APPEND definitions COUPLER_WITH_CONTROL_MSGS)
endif()
add_library(coupler_ros INTERFACE)
target_compile_definitions(coupler_ros INTERFACE ${definitions})
# ROS's headers are not written for our warnings.
#catkin_lint: ignore_once missing_directory
target_include_directories(coupler_ros SYSTEM INTERFACE
  ${catkin_INCLUDE_DIRS} ${control_msgs_INCLUDE_DIRS} $<BUILD_INTERFACE:${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_INCLUDE_DESTINATION}>)
target_link_libraries(coupler_ros INTERFACE ${catkin_LIBRARIES})
