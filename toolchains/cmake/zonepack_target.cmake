# SPDX-License-Identifier: Apache-2.0
# What every target of the project shares: warnings, include root, bit-exact arithmetic.

find_package(Threads REQUIRED)
include(zonepack_unity)

# zonepack_library(NAME DIR...): a static library of every .cpp below the given folders.
function(zonepack_library name)
  set(sources)
  foreach(dir ${ARGN})
    file(GLOB_RECURSE found CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${dir}/*.cpp)
    list(APPEND sources ${found})
  endforeach()
  zonepack_library_of(${name} ${sources})
endfunction()

# zonepack_library_of(NAME FILE...): a static library of these sources.
function(zonepack_library_of name)
  set(sources ${ARGN})
  list(SORT sources)
  add_library(zonepack_${name} STATIC ${sources})
  add_library(zonepack::${name} ALIAS zonepack_${name})
  set_target_properties(zonepack_${name} PROPERTIES EXPORT_NAME ${name})
  zonepack_settings(zonepack_${name})
endfunction()

# The same flags everywhere, so that code which decides gives the same bits on every compiler.
# g++ 12 takes operator+ of a literal and a string for an overlapping copy (GCC bug 105651): no -Wrestrict.
# Its vectoriser of straight code makes fused multiply-adds even with -ffp-contract=off where the target
# has them (-march=native), so it is off.
function(zonepack_settings target)
  zonepack_compile_alone()
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Wshadow -ffp-contract=off
                         $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict -fno-tree-slp-vectorize> $<$<BOOL:${ZONEPACK_WERROR}>:-Werror>)
  target_compile_definitions(${target} PRIVATE EIGEN_DONT_VECTORIZE)
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                             $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/generated>
                             $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/zonepack>)
endfunction()
