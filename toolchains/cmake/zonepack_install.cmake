# SPDX-License-Identifier: Apache-2.0
# install(): programs, libraries, headers and the package that find_package(zonepack) reads, in the components
# runtime (the robot), tools (the workstation) and dev: toolchains/deb/packages.sh makes a .deb of each.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/zonepack)
add_custom_target(installed)  # builds all that install() takes, and no tests

function(zonepack_install_libraries export)
  install(TARGETS ${ARGN} EXPORT ${export} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
          COMPONENT dev)
  add_dependencies(installed ${ARGN})
  install(EXPORT ${export} NAMESPACE zonepack:: DESTINATION ${package_dir} COMPONENT dev)
endfunction()

# Headers stand below include/zonepack as they stand in the source tree: a program includes <zonepack/client.hpp>, or
# <zonepack/runtime/map/loader.hpp>.
function(zonepack_install_headers)
  foreach(dir ${ARGN})
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/${dir} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/zonepack
            COMPONENT dev FILES_MATCHING PATTERN "*.hpp" PATTERN "*.h")
  endforeach()
endfunction()

zonepack_install_libraries(zonepack-client zonepack_platform zonepack_views zonepack_protocol
                           zonepack_client)
zonepack_install_libraries(zonepack-runtime zonepack_gpio zonepack_pack_format zonepack_report zonepack_core
                           zonepack_run zonepack_runtime)
zonepack_install_headers(platform runtime)
install(DIRECTORY ${PROJECT_BINARY_DIR}/generated/runtime
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/zonepack COMPONENT dev FILES_MATCHING PATTERN "*_generated.h")
if(ZONEPACK_BUILD_PACKER)
  zonepack_install_libraries(zonepack-packer zonepack_version zonepack_command_line zonepack_packer zonepack_packer_commands)
  zonepack_install_headers(packer)
endif()
file(WRITE ${PROJECT_BINARY_DIR}/client.hpp "// SPDX-License-Identifier: Apache-2.0
// The map in zoned's memory, for C++20.
#pragma once
#include \"zonepack/runtime/client/client.hpp\"
")
file(WRITE ${PROJECT_BINARY_DIR}/client.h "/* SPDX-License-Identifier: Apache-2.0 */
/* The map in zoned's memory, for C. */
#pragma once
#include \"zonepack/runtime/client/zonepack_client.h\"
")
install(FILES ${PROJECT_BINARY_DIR}/client.hpp ${PROJECT_BINARY_DIR}/client.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/zonepack COMPONENT dev)
file(RELATIVE_PATH PREFIX_FROM_PC ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(${PROJECT_SOURCE_DIR}/toolchains/cmake/zonepack.pc.in ${PROJECT_BINARY_DIR}/zonepack.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/zonepack.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)
set(mend "include(\"${PROJECT_SOURCE_DIR}/toolchains/cmake/zonepack_installed.cmake\")")
install(CODE "${mend}
  zonepack_mend_headers(\"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}/zonepack\")"
        COMPONENT dev)
# A program, its manual page and its completion for bash.
function(zonepack_install_program program component)
  if(NOT TARGET ${program})
    return()
  endif()
  install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${component})
  add_dependencies(installed ${program})
  install(FILES ${PROJECT_SOURCE_DIR}/toolchains/deb/man/${program}.1
          DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component})
  install(FILES ${PROJECT_SOURCE_DIR}/toolchains/deb/completions/${program}
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT ${component})
endfunction()
zonepack_install_program(zoned runtime)
zonepack_install_program(zonectl runtime)
zonepack_install_program(zonepack tools)
zonepack_install_program(zoneloc localizer)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/config/ DESTINATION ${CMAKE_INSTALL_DATADIR}/zonepack/config
        COMPONENT runtime PATTERN "*.service" EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/config/zoned.service DESTINATION lib/systemd/system COMPONENT runtime)
install(CODE "${mend}
  zonepack_mend_unit(\"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/lib/systemd/system/zoned.service\"
                     \"\${CMAKE_INSTALL_PREFIX}\")"
        COMPONENT runtime)
if(TARGET zoneloc)
  install(FILES ${PROJECT_SOURCE_DIR}/config/zoneloc.service DESTINATION lib/systemd/system COMPONENT localizer)
  install(CODE "${mend}
  zonepack_mend_unit(\"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/lib/systemd/system/zoneloc.service\"
                     \"\${CMAKE_INSTALL_PREFIX}\")"
          COMPONENT localizer)
  install(FILES ${PROJECT_SOURCE_DIR}/runtime/localize/camera/CAMERA.md
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/zonepack-localizer COMPONENT localizer)
endif()
# For programs in other languages: the files and the socket, byte by byte.
install(FILES ${PROJECT_SOURCE_DIR}/runtime/pack_format/FORMAT.md ${PROJECT_SOURCE_DIR}/runtime/protocol/PROTOCOL.md
        DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT dev)
install(FILES ${PROJECT_SOURCE_DIR}/runtime/protocol/protocol.fbs DESTINATION ${CMAKE_INSTALL_DATADIR}/zonepack
        COMPONENT dev)

configure_package_config_file(${PROJECT_SOURCE_DIR}/toolchains/cmake/zonepackConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/zonepackConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/zonepackConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/zonepackConfig.cmake
              ${PROJECT_BINARY_DIR}/zonepackConfigVersion.cmake DESTINATION ${package_dir}
        COMPONENT dev)
