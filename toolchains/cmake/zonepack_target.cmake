# SPDX-License-Identifier: Apache-2.0
# What every target of the project shares: warnings, include root, bit-exact arithmetic.

find_package(Threads REQUIRED)

# The sources of these folders, not of folders below them: a folder is a library or part of one.
function(zonepack_sources_of result)
  set(sources)
  foreach(dir ${ARGN})
    file(GLOB found CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${dir}/*.cpp)
    list(APPEND sources ${found})
  endforeach()
  list(SORT sources)
  set(${result} ${sources} PARENT_SCOPE)
endfunction()

# zonepack_library(NAME DIR...): a static library of these folders.
function(zonepack_library name)
  zonepack_sources_of(sources ${ARGN})
  add_library(zonepack_${name} STATIC ${sources})
  add_library(zonepack::${name} ALIAS zonepack_${name})
  set_target_properties(zonepack_${name} PROPERTIES EXPORT_NAME ${name})
  zonepack_settings(zonepack_${name})
endfunction()

# zonepack_program(NAME DIR): a program of this folder.
function(zonepack_program name dir)
  zonepack_sources_of(sources ${dir})
  add_executable(${name} ${sources})
  zonepack_settings(${name})
  # All of a program is locked into a robot's memory, so it holds only what it calls (1 MiB less of zoned), and looks
  # symbols up at its start instead of in a control cycle.
  target_link_options(${name} PRIVATE -Wl,-z,now)
endfunction()

# For code that nobody waits for: half the size, in a program that is locked into memory whole, and half the time to
# compile.
function(zonepack_small target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-Os>)
endfunction()

# The same flags everywhere, so that code which decides gives the same bits on every compiler.
# g++ 12 takes operator+ of a literal and a string for an overlapping copy (GCC bug 105651): no -Wrestrict.
# Its vectoriser of straight code makes fused multiply-adds even with -ffp-contract=off where the target
# has them (-march=native), so it is off.
# Collecting garbage costs it a tenth of its time and saves a fifth of its memory (2.2 GB for the largest batch), so it
# begins late.
# A function is a section of its own, because a batch of sources is one object file: a program takes the functions it
# calls, not the batch.
function(zonepack_settings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Wshadow -ffp-contract=off
                         $<$<NOT:$<CONFIG:Debug>>:-ffunction-sections$<SEMICOLON>-fdata-sections>
                         $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict -fno-tree-slp-vectorize
                           --param=ggc-min-expand=1000 --param=ggc-min-heapsize=2000000> $<$<BOOL:${ZONEPACK_WERROR}>:-Werror>)
  target_link_options(${target} PRIVATE $<$<NOT:$<CONFIG:Debug>>:-Wl,--gc-sections>)
  target_compile_definitions(${target} PRIVATE EIGEN_DONT_VECTORIZE)
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                             $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/generated>
                             $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${target} PUBLIC cxx_std_20)
endfunction()
