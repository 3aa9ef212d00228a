# SPDX-License-Identifier: Apache-2.0
# Manual pages, made from what programs say to --help. Without help2man there are none.
find_program(COUPLER_HELP2MAN help2man)
if(COUPLER_INSTALL AND NOT COUPLER_HELP2MAN)
  message(STATUS "Left out: manual pages (no help2man; apt install help2man)")
endif()
add_custom_target(coupler_man)

# coupler_man_pages(PROGRAM COMPONENT): those of a program and of its commands are installed with it. A cross build takes
# the program beside COUPLER_HOST_COUPLER, if it is there.
function(coupler_man_pages program component)
  set(file $<TARGET_FILE:${program}>)
  set(needs ${program})
  if(COUPLER_HOST_COUPLER)
    get_filename_component(file ${COUPLER_HOST_COUPLER} DIRECTORY)
    set(file ${file}/${program})
    set(needs ${file})
  endif()
  if(NOT COUPLER_HELP2MAN OR NOT COUPLER_INSTALL OR (COUPLER_HOST_COUPLER AND NOT EXISTS ${file}))
    return()
  endif()
  set(folder ${PROJECT_BINARY_DIR}/man/${program})
  set(stamp ${folder}.stamp)
  add_custom_command(OUTPUT ${stamp}
    COMMAND ${CMAKE_COMMAND} -E remove_directory ${folder}
    COMMAND ${PROJECT_SOURCE_DIR}/scripts/man-pages ${file} ${folder}
    COMMAND ${CMAKE_COMMAND} -E touch ${stamp}
    DEPENDS ${needs} ${PROJECT_SOURCE_DIR}/scripts/man-pages
    COMMENT "Writing the manual pages of ${program}" VERBATIM)
  add_custom_target(${program}_man_pages ALL DEPENDS ${stamp})
  add_dependencies(coupler_man ${program}_man_pages)
  coupler_install(DIRECTORY ${folder}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component} OPTIONAL)
endfunction()
