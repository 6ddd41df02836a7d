# SPDX-License-Identifier: Apache-2.0
# The readers under bytes that someone made up. test_fuzz runs the entries over changed packs with any
# compiler; with -DZONEPACK_BUILD_FUZZERS=ON and clang there is one libFuzzer program for each entry:
#   cmake -B build/fuzz -DCMAKE_CXX_COMPILER=clang++ -DZONEPACK_BUILD_FUZZERS=ON
#   build/fuzz/bin/write_fuzz_seeds seeds && build/fuzz/bin/fuzz_chunk seeds/chunk
# corpus/KIND holds inputs that are kept; add it to the command, and -rss_limit_mb=512 for a bound of memory (sanitizers
# take most of it; test_fuzz holds each kind to tens of MiB):
#   build/fuzz/bin/fuzz_sqlite -rss_limit_mb=512 seeds/sqlite tests/fuzz/corpus/sqlite
option(ZONEPACK_BUILD_FUZZERS "Build the libFuzzer programs (needs clang)" OFF)
if(NOT ZONEPACK_BUILD_PACKER)
  return()
endif()

set(fuzz_dir ${CMAKE_CURRENT_LIST_DIR})
set(fuzz_libraries zonepack_packer_test_support zonepack_packer zonepack_runtime)
add_library(zonepack_fuzz STATIC ${fuzz_dir}/entries.cpp ${fuzz_dir}/input_entries.cpp ${fuzz_dir}/input_seeds.cpp
            ${fuzz_dir}/nvblox_entries.cpp ${fuzz_dir}/reference_checks.cpp ${fuzz_dir}/seeds.cpp)
zonepack_settings(zonepack_fuzz)
target_link_libraries(zonepack_fuzz PUBLIC ${fuzz_libraries})

add_executable(test_fuzz ${fuzz_dir}/chunk_check_test.cpp ${fuzz_dir}/input_mutation_test.cpp
               ${fuzz_dir}/mutation_test.cpp ${fuzz_dir}/nvblox_mutation_test.cpp)
zonepack_settings(test_fuzz)
target_link_libraries(test_fuzz PRIVATE zonepack_fuzz GTest::gtest GTest::gtest_main)
zonepack_list_tests(test_fuzz fuzz 600)

if(ZONEPACK_BUILD_FUZZERS)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "ZONEPACK_BUILD_FUZZERS needs clang: -DCMAKE_CXX_COMPILER=clang++")
  endif()
  set(instrument -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all -g -O1)
  foreach(library zonepack_platform zonepack_pack_format zonepack_packer zonepack_fuzz
                  zonepack_packer_test_support zonepack_report zonepack_core zonepack_runtime)
    target_compile_options(${library} PRIVATE ${instrument})
    target_link_options(${library} INTERFACE -fsanitize=address,undefined)
  endforeach()
  foreach(entry pack index chunk block manifest dbc geojson settings sqlite msgpack pcd recording protocol voxels nvblox)
    add_executable(fuzz_${entry} ${fuzz_dir}/fuzz_${entry}.cpp)
    zonepack_settings(fuzz_${entry})
    target_compile_options(fuzz_${entry} PRIVATE ${instrument})
    target_link_options(fuzz_${entry} PRIVATE -fsanitize=fuzzer,address,undefined)
    target_link_libraries(fuzz_${entry} PRIVATE zonepack_fuzz)
  endforeach()
  add_executable(write_fuzz_seeds ${fuzz_dir}/write_seeds.cpp)
  zonepack_settings(write_fuzz_seeds)
  target_link_libraries(write_fuzz_seeds PRIVATE zonepack_fuzz)
endif()
