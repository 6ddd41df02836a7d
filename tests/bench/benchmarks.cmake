# SPDX-License-Identifier: Apache-2.0
# Benchmarks: run by hand, on a machine that does nothing else. Each says what it compares.

if(ZONEPACK_BUILD_BENCHMARKS)
  zonepack_test_program(storage_bench.cpp zonepack_core)
  find_package(benchmark CONFIG REQUIRED)
  zonepack_test_program(signal_bench.cpp zonepack_core benchmark::benchmark)
  if(TARGET zonepack)
    zonepack_test_program(suggest_quality.cpp zonepack_packer_test_support zonepack_packer)
    zonepack_test_program(block_bench.cpp zonepack_packer zonepack_client)
    target_sources(suggest_quality PRIVATE ${CMAKE_CURRENT_LIST_DIR}/floor_plans.cpp)
    find_package(SQLite3 REQUIRED)
    find_package(ZLIB REQUIRED)
    zonepack_test_program(read_unzip_compress.cpp zonepack_pack_format SQLite::SQLite3 ZLIB::ZLIB Threads::Threads)
  endif()
endif()
