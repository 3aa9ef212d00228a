# SPDX-License-Identifier: Apache-2.0
# Debian packages: `cpack` in a build of the preset release makes coupler-node (the program and its service; neither ROS
# nor a compiler needed) and coupler-tools (the program coupler). scripts/build-packages does it for a board too.
# What goes into which one is said by install() in the modules, COMPONENT node or tools.
include(GNUInstallDirs)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "OpenCoupler maintainers <maintainers@opencoupler.org>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL node tools)
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

coupler_install(FILES LICENSE RENAME copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/coupler-node COMPONENT node)
coupler_install(FILES LICENSE RENAME copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/coupler-tools COMPONENT tools)
coupler_install(FILES docs/node.md docs/identity.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/coupler-node COMPONENT node)
coupler_install(FILES docs/import-export.md docs/map.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/coupler-tools COMPONENT tools)
include(CPack)
