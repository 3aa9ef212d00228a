# SPDX-License-Identifier: Apache-2.0
# `cmake --install` of all, in a build of some targets only (as ./demo makes it), would stop half-way with a file that is not
# there. This stops it before the first file, and says what to build. With --component it installs what that has.
#
# This comes before every other install(); what there has to be, in PROJECT_BINARY_DIR/check-built.cmake, is known at the end.
if(COUPLER_INSTALL)
  install(SCRIPT ${PROJECT_BINARY_DIR}/check-built.cmake)
endif()

# coupler_needs_built(FILE…): files that a build makes, and that are installed.
function(coupler_needs_built)
  set_property(GLOBAL APPEND PROPERTY coupler_needs_built ${ARGN})
endfunction()

# coupler_needs_target(TARGET): the same for a program or a library.
function(coupler_needs_target target)
  get_target_property(type ${target} TYPE)
  if(NOT type STREQUAL INTERFACE_LIBRARY)  # which is headers only
    coupler_needs_built($<TARGET_FILE:${target}>)
  endif()
endfunction()

# After all calls of these.
function(coupler_write_install_check)
  get_property(files GLOBAL PROPERTY coupler_needs_built)
  list(REMOVE_DUPLICATES files)
  list(JOIN files "\"\n  \"" files)
  file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/check-built.cmake CONTENT
"set(missing)
foreach(file IN ITEMS
  \"${files}\")
  if(NOT EXISTS \"\${file}\")
    get_filename_component(name \"\${file}\" NAME)
    list(APPEND missing \${name})
  endif()
endforeach()
if(missing)
  list(LENGTH missing number)
  list(GET missing 0 first)
  message(FATAL_ERROR \"Nothing is installed: \${number} of the files to install have not been built (\${first} is one). \"
    \"Build them first: cmake --build ${PROJECT_BINARY_DIR}\")
endif()
")
endfunction()
