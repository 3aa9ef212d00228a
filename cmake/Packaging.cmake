# SPDX-License-Identifier: Apache-2.0
# Debian packages: `cpack` in a build of the preset release makes coupler-node (the program and its service; neither ROS
# nor a compiler needed), coupler-tools (the program coupler) and coupler-dev (find_package(OpenCoupler)).
# scripts/build-packages does it for a board too. What goes into which one is said by install() in the modules, COMPONENT
# node, tools or dev.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "OpenCoupler maintainers <maintainers@opencoupler.org>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL node tools dev)
set(CPACK_STRIP_FILES ON)
# What is installed has the permissions that policy wants, whatever the umask here.
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
if(CMAKE_SYSTEM_PROCESSOR STREQUAL aarch64)
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
endif()

set(CPACK_DEBIAN_NODE_PACKAGE_NAME coupler-node)
set(CPACK_DEBIAN_NODE_PACKAGE_SECTION net)
set(CPACK_DEBIAN_NODE_DESCRIPTION "GPIO lines of a board as a Modbus/TCP device, described by a map
 A system service that serves the lines and registers of a map, with a user and a sandbox of its own.")
set(CPACK_DEBIAN_NODE_PACKAGE_DEPENDS "systemd | systemd-standalone-sysusers")
set(CPACK_DEBIAN_NODE_PACKAGE_SUGGESTS coupler-tools)
set(CPACK_DEBIAN_NODE_PACKAGE_CONTROL_EXTRA
    ${PROJECT_SOURCE_DIR}/config/debian/postinst
    ${PROJECT_SOURCE_DIR}/config/debian/prerm
    ${PROJECT_SOURCE_DIR}/config/debian/postrm)

set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME coupler-tools)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION net)
set(CPACK_DEBIAN_TOOLS_DESCRIPTION "Checks maps of Modbus/TCP couplers and generates C++ from them
 The program coupler of OpenCoupler.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME coupler-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_DESCRIPTION "C++ nodes and typed clients from maps of Modbus/TCP couplers
 Headers, static libraries and CMake files of OpenCoupler: find_package(OpenCoupler), coupler_add_map().")
set(libraries libexpected-dev libfmt-dev libmd-dev libyaml-cpp-dev)
if(COUPLER_WITH_GPIOD)
  list(APPEND libraries libgpiod-dev)
endif()
if(libmodbus_FOUND)
  list(APPEND libraries libmodbus-dev)
endif()
if(COUPLER_WITH_TLS)
  list(APPEND libraries libssl-dev)
endif()
if(COUPLER_WITH_PANEL)
  list(APPEND libraries libcpp-httplib-dev)
endif()
list(JOIN libraries ", " libraries)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "coupler-tools (= ${PROJECT_VERSION}), pkg-config, ${libraries}")

foreach(component node tools dev)
  coupler_install(FILES LICENSE RENAME copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/coupler-${component} COMPONENT ${component})
endforeach()

# coupler_documents(COMPONENT PATH…): what is read without the sources, with its pictures and examples.
function(coupler_documents component)
  set(folder ${PROJECT_BINARY_DIR}/documents/${component})
  list(JOIN ARGN "\" \"" paths)
  coupler_install(CODE "execute_process(COMMAND \"${PROJECT_SOURCE_DIR}/scripts/package-documents\" \"${folder}\" \"${paths}\"
    RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR \"The documents cannot be copied: \${failed}\")
  endif()" COMPONENT ${component})
  coupler_install(DIRECTORY ${folder}/ DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/coupler-${component} COMPONENT ${component})
endfunction()
coupler_documents(node docs/node.md docs/node-lines.md docs/node-safety.md docs/identity.md docs/map.md docs/map-page.png
  docs/messages.md docs/security.md docs/symptoms.md docs/time.md docs/time.svg config/example-node.yaml config/systemd/realtime.conf)
coupler_documents(tools docs/commands.md docs/couplers.md docs/diff.md docs/import-export.md docs/map.md docs/map-page.png
  docs/panel.md docs/panel.png docs/record.md)
coupler_documents(dev docs/generated.md config/examples/tank)
include(CPack)
