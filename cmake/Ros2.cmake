# SPDX-License-Identifier: Apache-2.0
# ament in a plain CMake build: no workspace needed; build/<preset>/setup.bash has the messages for rclpy and rcl.
set(remedy "source /opt/ros/DISTRO/setup.bash first; where there is no ROS 2, on Debian 12: \
source \"$(scripts/ros2-environment)/setup.bash\"")

#catkin_lint: ignore immutable_var
set(ENV{ROS_VERSION} 2)  # package.xml has conditions
# ament looks for packages in AMENT_PREFIX_PATH of the environment. Kept, so that a build configures itself again from any
# shell; and what was found in another ROS 2 than now is looked for again.
if("$ENV{AMENT_PREFIX_PATH}" STREQUAL "")
  set(ENV{AMENT_PREFIX_PATH} "${COUPLER_AMENT_PREFIX_PATH}")
elseif(NOT "$ENV{AMENT_PREFIX_PATH}" STREQUAL "${COUPLER_AMENT_PREFIX_PATH}")
  string(REPLACE ":" ";" before "${COUPLER_AMENT_PREFIX_PATH}")
  string(REPLACE ":" ";" now "$ENV{AMENT_PREFIX_PATH}")
  if(before)
    list(REMOVE_ITEM before ${now})
  endif()
  if(before)
    list(APPEND before ${COUPLER_CONTROL_MSGS})  # was built upon those, and may have been given by -Dcontrol_msgs_DIR
  endif()
  get_cmake_property(variables CACHE_VARIABLES)
  foreach(prefix IN LISTS before)
    foreach(variable IN LISTS variables)
      string(FIND "${${variable}}" "${prefix}/" position)
      if(position EQUAL 0)
        unset(${variable} CACHE)
      endif()
    endforeach()
  endforeach()
  set(COUPLER_AMENT_PREFIX_PATH "$ENV{AMENT_PREFIX_PATH}" CACHE INTERNAL "")
endif()

enable_language(C)  # of which a part of the generated code is
set(interfaces action_msgs builtin_interfaces diagnostic_msgs rcl_interfaces rosgraph_msgs sensor_msgs std_msgs std_srvs)
set(missing)
foreach(package ament_cmake rcl rcl_action rcl_yaml_param_parser rcutils rmw rosidl_default_generators rosidl_typesupport_cpp ${interfaces})
  find_package(${package} QUIET)
  if(NOT ${package}_FOUND)
    list(APPEND missing ${package})
  endif()
endforeach()
if(missing)
  list(JOIN missing ", " missing)
  set(left_out "of ROS 2 there is no ${missing}; ${remedy}")
  if(NOT COUPLER_ROS STREQUAL AUTO)
    message(FATAL_ERROR "COUPLER_ROS=${COUPLER_ROS}, but ${left_out}")
  endif()
  return()
endif()
set(COUPLER_WITH_ROS 2)
find_package(type_description_interfaces QUIET)  # not in Humble
find_package(control_msgs QUIET)

# The target that generates must have the name of the package.
set(files)
foreach(file IN LISTS messages services actions)
  string(REGEX REPLACE ".*[.]" "" kind ${file})
  file(READ ${PROJECT_SOURCE_DIR}/host/${kind}/${file} text)
  # ROS 1 has words for these two messages.
  string(REGEX REPLACE "(^|\n)time " "\\1builtin_interfaces/Time " own "${text}")
  string(REGEX REPLACE "(^|\n)duration " "\\1builtin_interfaces/Duration " own "${own}")
  if(own STREQUAL text)
    list(APPEND files ${PROJECT_SOURCE_DIR}/host:${kind}/${file})
  else()
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/interfaces/${kind}/${file} CONTENT "${own}" @ONLY)
    list(APPEND files ${PROJECT_BINARY_DIR}/interfaces:${kind}/${file})
  endif()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/host/${kind}/${file})
endforeach()
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
rosidl_generate_interfaces(${PROJECT_NAME} ${files} DEPENDENCIES action_msgs builtin_interfaces std_msgs)
if(TARGET ament_cmake_python_build_${PROJECT_NAME}_egg)
  coupler_needs_built(${PROJECT_BINARY_DIR}/ament_cmake_python/${PROJECT_NAME}/${PROJECT_NAME}.egg-info)
endif()
ament_export_dependencies(rosidl_default_runtime builtin_interfaces std_msgs)
# The messages in every language, as catkin calls that; the target above leaves Python's out.
rosidl_generator_py_get_typesupports(python)
list(TRANSFORM python PREPEND ${PROJECT_NAME}_s__)
add_custom_target(${PROJECT_NAME}_generate_messages DEPENDS ${PROJECT_NAME} ${python})

# ament gives its definition to every target of the project. The other modules compile alike with and without ROS, so that the
# compiler's cache serves both.
get_directory_property(definitions COMPILE_DEFINITIONS)
set_directory_properties(PROPERTIES COMPILE_DEFINITIONS "")
set(COUPLER_CONTROL_MSGS "" CACHE INTERNAL "")
if(control_msgs_FOUND)
  get_filename_component(prefix ${control_msgs_DIR}/../../.. ABSOLUTE)
  set(COUPLER_CONTROL_MSGS ${prefix} CACHE INTERNAL "")
  list(APPEND interfaces control_msgs)
  list(APPEND definitions COUPLER_WITH_CONTROL_MSGS)
  get_target_property(folders control_msgs::control_msgs__rosidl_generator_cpp INTERFACE_INCLUDE_DIRECTORIES)
  foreach(folder IN LISTS folders)
    if(EXISTS ${folder}/control_msgs/action/parallel_gripper_command.hpp)
      list(APPEND definitions COUPLER_WITH_PARALLEL_GRIPPER)
    endif()
  endforeach()
  if(NOT COUPLER_WITH_PARALLEL_GRIPPER IN_LIST definitions)
    message(STATUS "Left out: the driver's action ParallelGripperCommand (${control_msgs_DIR} is older than that; update control_msgs)")
  endif()
endif()
add_library(coupler_ros INTERFACE)
target_compile_definitions(coupler_ros INTERFACE ${definitions})
target_link_libraries(coupler_ros INTERFACE
  rcl::rcl rcl_action::rcl_action rcl_yaml_param_parser::rcl_yaml_param_parser rcutils::rcutils rmw::rmw rosidl_typesupport_cpp::rosidl_typesupport_cpp)
foreach(package IN LISTS interfaces)
  target_link_libraries(coupler_ros INTERFACE
    ${package}::${package}__rosidl_generator_cpp ${package}::${package}__rosidl_typesupport_cpp)
endforeach()
if(type_description_interfaces_FOUND)
  # rcl answers that service itself; who calls it makes the request and the response, which are C.
  target_link_libraries(coupler_ros INTERFACE
    type_description_interfaces::type_description_interfaces__rosidl_generator_c
    type_description_interfaces::type_description_interfaces__rosidl_typesupport_c)
endif()
# Our own: one library to link, and those that it loads at run time. The headers are not written for our warnings.
set(ours ${PROJECT_NAME}__rosidl_generator_cpp ${PROJECT_NAME}__rosidl_typesupport_cpp)
target_link_libraries(coupler_ros INTERFACE ${ours})
foreach(target IN LISTS ours)
  #catkin_lint: ignore_once missing_directory
  target_include_directories(coupler_ros SYSTEM INTERFACE $<BUILD_INTERFACE:$<TARGET_PROPERTY:${target},INTERFACE_INCLUDE_DIRECTORIES>>)
endforeach()
get_used_typesupports(loaded rosidl_typesupport_cpp)
list(TRANSFORM loaded PREPEND ${PROJECT_NAME}__)
add_dependencies(coupler_ros ${loaded})

# For coupler_driver-extras.cmake.in.
set(coupler_driver_packages rcl rcl_action rcl_yaml_param_parser rcutils rmw rosidl_typesupport_cpp ${interfaces})
if(type_description_interfaces_FOUND)
  list(APPEND coupler_driver_packages type_description_interfaces)
endif()

# The folder in which rcl is has the setup.bash of its ROS 2.
get_filename_component(prefix ${rcl_DIR}/../../.. ABSOLUTE)
set(overlay)
if(COUPLER_CONTROL_MSGS AND NOT COUPLER_CONTROL_MSGS STREQUAL prefix)  # of a workspace, or -Dcontrol_msgs_DIR=…
  set(overlay "source \"${COUPLER_CONTROL_MSGS}/share/control_msgs/local_setup.bash\"\n")
endif()
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/setup.bash CONTENT
"# Sourced by bash: the ROS 2 of this build, its programs and its messages. Not for a shell that runs ROS 1's.
source \"${prefix}/setup.bash\"
${overlay}export PATH=\"${PROJECT_BINARY_DIR}/bin:$PATH\" LD_LIBRARY_PATH=\"${PROJECT_BINARY_DIR}/lib:$LD_LIBRARY_PATH\" \\
  PYTHONPATH=\"${PROJECT_BINARY_DIR}/rosidl_generator_py\${PYTHONPATH:+:$PYTHONPATH}\"
")
