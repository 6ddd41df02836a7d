# SPDX-License-Identifier: Apache-2.0
# What aarch64.cmake and armhf.cmake share: Debian's cross compiler, a sysroot made by
# toolchains/cross/sysroot.sh, and qemu-user for programs that the build itself runs (tests).
#   ZONEPACK_CPU       an -mcpu name, e.g. cortex-a72; default: runs on every processor of the architecture
#   ZONEPACK_SYSROOTS  folder of the sysroots; default: the environment's, else build/
set(CMAKE_SYSTEM_NAME Linux)
# try_compile() reads this file again, and sees only the variables named here.
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES ZONEPACK_CPU ZONEPACK_SYSROOTS)
if(NOT ZONEPACK_SYSROOTS)
  set(ZONEPACK_SYSROOTS $ENV{ZONEPACK_SYSROOTS})
endif()
if(NOT ZONEPACK_SYSROOTS)
  get_filename_component(ZONEPACK_SYSROOTS ${CMAKE_CURRENT_LIST_DIR}/../../build ABSOLUTE)
endif()
set(CMAKE_SYSROOT ${ZONEPACK_SYSROOTS}/sysroot-${debian_arch})
if(NOT EXISTS ${CMAKE_SYSROOT})
  message(FATAL_ERROR "no sysroot ${CMAKE_SYSROOT}; make it with toolchains/run cross ${debian_arch}")
endif()

set(CMAKE_C_COMPILER ${debian_triplet}-gcc)
set(CMAKE_CXX_COMPILER ${debian_triplet}-g++)
set(CMAKE_STRIP ${debian_triplet}-strip)
set(CMAKE_LIBRARY_ARCHITECTURE ${debian_triplet})
set(CMAKE_INSTALL_LIBDIR lib/${debian_triplet} CACHE STRING "where Debian puts libraries of several architectures")
set(CMAKE_FIND_ROOT_PATH ${CMAKE_SYSROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)  # flatc runs here
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_DIR} "")
set(ENV{PKG_CONFIG_LIBDIR} ${CMAKE_SYSROOT}/usr/lib/${debian_triplet}/pkgconfig:${CMAKE_SYSROOT}/usr/share/pkgconfig)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${CMAKE_SYSROOT})

# The same packages from any folder: no path of the build machine in a program.
get_filename_component(source_dir ${CMAKE_CURRENT_LIST_DIR}/../.. ABSOLUTE)
set(cross_flags "-ffile-prefix-map=${source_dir}/=")
if(ZONEPACK_CPU)
  string(APPEND cross_flags " -mcpu=${ZONEPACK_CPU}")
endif()
set(CMAKE_C_FLAGS_INIT "${cross_flags} ${debian_flags}")
set(CMAKE_CXX_FLAGS_INIT "${cross_flags} ${debian_flags}")
# A library that a library needs.
set(CMAKE_EXE_LINKER_FLAGS_INIT -Wl,-rpath-link,${CMAKE_SYSROOT}/usr/lib/${debian_triplet})

find_program(ZONEPACK_QEMU_USER ${debian_qemu})
if(ZONEPACK_QEMU_USER)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${ZONEPACK_QEMU_USER} -L ${CMAKE_SYSROOT})
endif()
