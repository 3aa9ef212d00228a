# SPDX-License-Identifier: Apache-2.0

# coupler_add_map(NAME map.yaml [DOCS]): both sides of a coupler from one map.
#   NAME_map     library: the map as constant data, coupler::maps::NAME::map in "NAME_map.hpp"
#   NAME_node    program: the node that serves it (links no YAML parser)
#   NAME_driver  program: the ROS driver for it, where the ROS driver itself is built
#   NAME_docs    with DOCS: its register map for people, NAME.md and NAME.html in NAME_generated
#   NAME_client  library: a typed C++ client without ROS, coupler::maps::NAME::Client in "NAME_client.hpp", where
#                libmodbus is
#   NAME_hooks   library: for a node with code of its own, coupler::maps::NAME::NodeHooks in "NAME_hooks.hpp"
#   NAME_core    library: for a node without an operating system, coupler::maps::NAME::NodeCore in "NAME_core.hpp"
# The map's lock, map.yaml.lock, must be up to date if the map leaves addresses out (`coupler check map.yaml`).
# Both programs link the same NAME_map, so they cannot disagree. Works after find_package(OpenCoupler), in this tree, and in a
# project that has this tree as a part (add_subdirectory(), FetchContent). What nothing links is not built there unless it is
# asked for. A cross build cannot run the `coupler` that it makes; it is given one that runs here.
set(COUPLER_HOST_COUPLER "" CACHE FILEPATH "The program coupler of this machine, for cross builds")
if(CMAKE_CROSSCOMPILING AND NOT COUPLER_HOST_COUPLER)
  message(FATAL_ERROR "A cross build needs the generator of a native one: build the target coupler without the "
                      "toolchain file and say -DCOUPLER_HOST_COUPLER=<that build>/bin/coupler")
endif()

function(coupler_add_map name map)
  cmake_parse_arguments(PARSE_ARGV 2 add "DOCS" "" "")
  if(add_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "coupler_add_map(${name}): '${add_UNPARSED_ARGUMENTS}' is no option of it; it knows DOCS")
  endif()
  get_filename_component(map ${map} ABSOLUTE BASE_DIR ${CMAKE_CURRENT_SOURCE_DIR})
  set(out ${CMAKE_CURRENT_BINARY_DIR}/${name}_generated)
  set(stamp ${out}/${name}.stamp)
  set(flags $<TARGET_NAME_IF_EXISTS:coupler_flags>)  # warnings, where this tree is built
  if(COUPLER_HOST_COUPLER)
    set(generator ${COUPLER_HOST_COUPLER})
  elseif(TARGET coupler)
    set(generator coupler)
  else()
    set(generator $<TARGET_FILE:OpenCoupler::coupler>)
  endif()
  set(files ${out}/${name}_client.cpp ${out}/${name}_client.hpp ${out}/${name}_core.hpp ${out}/${name}_driver.cpp
            ${out}/${name}_hooks.hpp ${out}/${name}_map.cpp ${out}/${name}_map.hpp ${out}/${name}_node.cpp)

  # A build does not write into the sources: a lock that is missing or not up to date stops it. Whether there is one is
  # in a file, for a lock that is gone makes nothing newer.
  file(GLOB lock CONFIGURE_DEPENDS ${map}.lock)
  file(GENERATE OUTPUT ${out}/${name}.lock_found CONTENT "${lock}\n")
  # The stamp is what gets newer; the files keep their time unless their content changes, so that a map that was only
  # touched compiles nothing. The program carries the templates: a change to them comes through it.
  add_custom_command(OUTPUT ${stamp} BYPRODUCTS ${files}
    COMMAND ${generator} generate ${map} --out ${out} --name ${name} --quiet --locked
    COMMAND ${CMAKE_COMMAND} -E touch ${stamp}
    DEPENDS ${map} ${lock} ${out}/${name}.lock_found ${generator}
    COMMENT "Generating ${name} from its map" VERBATIM)
  add_custom_target(${name}_generate DEPENDS ${stamp})
  set_source_files_properties(${files} PROPERTIES GENERATED TRUE)

  add_library(${name}_map STATIC EXCLUDE_FROM_ALL ${out}/${name}_map.cpp)
  target_include_directories(${name}_map PUBLIC ${out})
  target_compile_features(${name}_map PUBLIC cxx_std_17)
  target_link_libraries(${name}_map PUBLIC OpenCoupler::map PRIVATE ${flags})
  add_dependencies(${name}_map ${name}_generate)

  add_library(${name}_core INTERFACE)
  target_link_libraries(${name}_core INTERFACE ${name}_map OpenCoupler::node_core)

  if(NOT CMAKE_SYSTEM_NAME STREQUAL Generic)  # see cmake/Microcontroller.cmake
    add_executable(${name}_node ${out}/${name}_node.cpp)
    target_link_libraries(${name}_node PRIVATE ${name}_map OpenCoupler::node ${flags})
    add_dependencies(${name}_node ${name}_generate)

    add_library(${name}_hooks INTERFACE)
    target_link_libraries(${name}_hooks INTERFACE ${name}_map OpenCoupler::node)
  endif()

  if(TARGET OpenCoupler::client)
    add_library(${name}_client STATIC EXCLUDE_FROM_ALL ${out}/${name}_client.cpp)
    target_link_libraries(${name}_client PUBLIC ${name}_map OpenCoupler::client PRIVATE ${flags})
    add_dependencies(${name}_client ${name}_generate)
  endif()

  if(TARGET OpenCoupler::driver)
    add_executable(${name}_driver ${out}/${name}_driver.cpp)
    target_link_libraries(${name}_driver PRIVATE ${name}_map OpenCoupler::driver ${flags})
    add_dependencies(${name}_driver ${name}_generate)
  endif()

  if(add_DOCS)
    set(docs_stamp ${out}/${name}_docs.stamp)
    add_custom_command(OUTPUT ${docs_stamp} BYPRODUCTS ${out}/${name}.html ${out}/${name}.md
      COMMAND ${generator} generate ${map} --docs --out ${out} --name ${name} --quiet --locked
      COMMAND ${CMAKE_COMMAND} -E touch ${docs_stamp}
      DEPENDS ${map} ${lock} ${out}/${name}.lock_found ${generator}
      COMMENT "Documenting ${name}" VERBATIM)
    add_custom_target(${name}_docs ALL DEPENDS ${docs_stamp})
  endif()
endfunction()
